/* line.c - see line.h. */
#include "line.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "sim.h"

enum { STUCK_MAX_N = 500 };
static const line NOBODY = {.fd = -1, .listen_fd = -1, .kept_fd = -1};

int line_open_pty(line *l, const char *link)
{
    *l = NOBODY;
    struct stat status;
    if (lstat(link, &status) == 0 && !S_ISLNK(status.st_mode)) {
        return sim_complain("--pty %s: there is a file of that name; name one that may be made",
                            link);
    }
    l->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (l->fd < 0 || grantpt(l->fd) != 0 || unlockpt(l->fd) != 0) {
        return sim_give_up("no pseudo terminal to be had: %s", strerror(errno));
    }
    const char *name = ptsname(l->fd);
    l->kept_fd = open(name, O_RDWR | O_NOCTTY);
    struct termios raw;
    if (l->kept_fd < 0 || tcgetattr(l->kept_fd, &raw) != 0) {
        return sim_give_up("%s: %s", name, strerror(errno));
    }
    cfmakeraw(&raw);
    tcsetattr(l->kept_fd, TCSANOW, &raw);
    unlink(link);
    if (symlink(name, link) != 0) {
        return sim_complain("--pty %s: %s", link, strerror(errno));
    }
    l->link = strdup(link);
    return SIM_OK;
}

int line_open_tcp(line *l, const char *address, int *port)
{
    *l = NOBODY;
    struct sockaddr_in to = {.sin_family = AF_INET};
    char host[64];
    unsigned number;
    if (sscanf(address, "%63[^:]:%u", host, &number) != 2 || number > 65535 ||
        inet_pton(AF_INET, host, &to.sin_addr) != 1) {
        return sim_complain("--tcp %.60s: must be ADDRESS:PORT, as 127.0.0.1:5555", address);
    }
    to.sin_port = htons((uint16_t)number);
    const int yes = 1;
    l->listen_fd = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    setsockopt(l->listen_fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    socklen_t length = sizeof to;
    if (bind(l->listen_fd, (struct sockaddr *)&to, sizeof to) != 0 ||
        listen(l->listen_fd, 1) != 0 ||
        getsockname(l->listen_fd, (struct sockaddr *)&to, &length) != 0) {
        return sim_complain("--tcp %s: %s", address, strerror(errno));
    }
    *port = ntohs(to.sin_port);
    return SIM_OK;
}

void line_close(line *l)
{
    const int fds[] = {l->fd, l->listen_fd, l->kept_fd};
    for (int i = 0; i < 3; i++) {
        if (fds[i] >= 0) {
            close(fds[i]);
        }
    }
    if (l->link != NULL) {
        unlink(l->link);
        free(l->link);
    }
    *l = NOBODY;
}

static void hang_up(line *l)
{
    if (l->listen_fd >= 0 && l->fd >= 0) {
        close(l->fd);
        l->fd = -1;
        l->out_n = 0;
    }
}

/* One client at a time; the next one takes over. */
static void accept_client(line *l)
{
    const int client = l->listen_fd >= 0 ? accept4(l->listen_fd, NULL, NULL, SOCK_NONBLOCK) : -1;
    if (client >= 0) {
        const int yes = 1;
        hang_up(l);
        setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        l->fd = client;
    }
}

size_t line_read(line *l, uint8_t *bytes, size_t room)
{
    accept_client(l);
    if (l->fd < 0) {
        return 0;
    }
    const ssize_t n = read(l->fd, bytes, room);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) {
        hang_up(l);
    }
    return n > 0 ? (size_t)n : 0;
}

bool line_write(line *l, const uint8_t *bytes, size_t bytes_n)
{
    if (bytes_n > line_free(l)) {
        return false;
    }
    memcpy(l->out + l->out_n, bytes, bytes_n);
    l->out_n += bytes_n;
    return true;
}

size_t line_free(const line *l)
{
    return sizeof l->out - l->out_n;
}

void line_flush(line *l)
{
    const ssize_t n = l->fd >= 0 && l->out_n > 0 ? write(l->fd, l->out, l->out_n) : 0;
    if (n > 0) {
        memmove(l->out, l->out + n, l->out_n - (size_t)n);
        l->out_n -= (size_t)n;
    }
    l->stuck_n = n > 0 || l->out_n == 0 ? 0 : l->stuck_n + 1;
    if (l->fd < 0 || l->stuck_n > STUCK_MAX_N) {
        /* nobody there: lost, as on a cable; a tool that comes later must not read old news first */
        l->out_n = 0;
        l->stuck_n = 0;
        if (l->kept_fd >= 0) {
            tcflush(l->kept_fd, TCIFLUSH);
        }
    }
}
