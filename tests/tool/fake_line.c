/* fake_line.c - see fake_line.h. */
#include "fake_line.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

static void fail(const char *what)
{
    perror(what);
    exit(3);
}

static void open_pty(fake_line *line)
{
    line->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (line->fd < 0 || grantpt(line->fd) != 0 || unlockpt(line->fd) != 0) {
        fail("pty");
    }
    line->slave = open(ptsname(line->fd), O_RDWR | O_NOCTTY);
    struct termios settings;
    tcgetattr(line->slave, &settings);
    cfmakeraw(&settings);
    tcsetattr(line->slave, TCSANOW, &settings);
    unlink(line->pty_link);
    if (symlink(ptsname(line->fd), line->pty_link) != 0) {
        fail(line->pty_link);
    }
    printf("ready %s\n", line->pty_link);
}

static void open_tcp(fake_line *line)
{
    struct sockaddr_in address = {.sin_family = AF_INET,
                                  .sin_addr = {.s_addr = htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    line->listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    if (bind(line->listener, (struct sockaddr *)&address, sizeof address) != 0 ||
        listen(line->listener, 1) != 0 ||
        getsockname(line->listener, (struct sockaddr *)&address, &size) != 0) {
        fail("tcp");
    }
    printf("ready 127.0.0.1:%d\n", ntohs(address.sin_port));
}

void fake_line_open(fake_line *line, const char *pty_link)
{
    *line = (fake_line){pty_link, -1, -1, -1};
    if (pty_link != NULL) {
        open_pty(line);
    } else {
        open_tcp(line);
    }
    fflush(stdout);
}

static void drop(int *fd)
{
    if (*fd >= 0) {
        close(*fd);
    }
    *fd = -1;
}

void fake_line_close(fake_line *line)
{
    if (line->pty_link != NULL) {
        unlink(line->pty_link);
    }
    drop(&line->fd);
    drop(&line->slave);
    drop(&line->listener);
}

size_t fake_line_read(fake_line *line, void *bytes, size_t room, int wait_ms)
{
    struct pollfd files[2] = {{.fd = line->fd, .events = POLLIN},
                              {.fd = line->listener, .events = POLLIN}};
    if (poll(files, 2, wait_ms) <= 0) {
        return 0;
    }
    if (files[1].revents != 0) {
        const int on = 1;
        drop(&line->fd); /* the newest client has the device */
        line->fd = accept4(line->listener, NULL, NULL, SOCK_NONBLOCK);
        setsockopt(line->fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        return 0;
    }
    const long n = read(line->fd, bytes, room);
    if (n == 0 && line->listener >= 0) {
        drop(&line->fd);
    }
    return n > 0 ? (size_t)n : 0;
}

void fake_line_write(fake_line *line, const void *bytes, size_t bytes_n)
{
    if (line->fd < 0) {
        return;
    }
    /* a line that is full loses what does not fit, as a UART would */
    if (line->listener >= 0) {
        (void)!send(line->fd, bytes, bytes_n, MSG_NOSIGNAL);
    } else {
        (void)!write(line->fd, bytes, bytes_n);
    }
}
