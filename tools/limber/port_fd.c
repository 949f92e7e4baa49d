/* port_fd.c - pseudo-terminals, which libserialport cannot open. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <termios.h>
#include <unistd.h>

#include "port.h"

static bool prepare(int fd)
{
    struct termios settings;
    if (tcgetattr(fd, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    return tcsetattr(fd, TCSANOW, &settings) == 0 && port_lock(fd) &&
           tcflush(fd, TCIFLUSH) == 0; /* what waits there is old */
}

static bool open_fd(port *p, const char *where, port_why why)
{
    snprintf(p->path, sizeof p->path, "%s", where);
    p->fd = open(where, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (p->fd < 0 || !prepare(p->fd)) {
        port_explain(where, errno, why);
        if (p->fd >= 0) {
            close(p->fd);
        }
        return false;
    }
    return true;
}

static long none_now(long n)
{
    return n < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : n;
}

static long read_fd(port *p, void *bytes, size_t room)
{
    const long n = read(p->fd, bytes, room);
    return n == 0 ? -1 : none_now(n); /* the other end hung up */
}

static long write_fd(port *p, const void *bytes, size_t bytes_n)
{
    return none_now(write(p->fd, bytes, bytes_n));
}

static void close_fd(port *p)
{
    close(p->fd);
}

const port_kind port_fd = {"pty:", open_fd, read_fd, write_fd, close_fd};
