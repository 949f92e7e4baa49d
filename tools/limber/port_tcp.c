/* port_tcp.c - a device behind a TCP port. */
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "port.h"

enum { CONNECT_MAX_MS = 2000 };

/* Connected, or -1 with errno. */
static int connect_to(const struct addrinfo *address)
{
    const int fd = socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    int error = errno;
    if (fd < 0) {
        return -1;
    }
    if (connect(fd, address->ai_addr, address->ai_addrlen) != 0) {
        error = errno;
        if (error == EINPROGRESS) {
            struct pollfd done = {.fd = fd, .events = POLLOUT};
            socklen_t size = sizeof error;
            if (poll(&done, 1, CONNECT_MAX_MS) == 1) {
                getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
            } else {
                error = ETIMEDOUT;
            }
        }
        if (error != 0) {
            close(fd);
            errno = error;
            return -1;
        }
    }
    const int on = 1; /* a pose must not wait for the next one */
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return fd;
}

static bool open_tcp(port *p, const char *where, port_why why)
{
    char host[PORT_PATH_BYTES];
    struct addrinfo *addresses = NULL;
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    snprintf(p->path, sizeof p->path, "%s", where);
    snprintf(host, sizeof host, "%s", where);
    char *const colon = strrchr(host, ':');
    if (colon == NULL || colon == host || colon[1] == '\0') {
        snprintf(why, PORT_WHY_BYTES, "tcp:%.100s: must be tcp:HOST:PORT", where);
        return false;
    }
    *colon = '\0';
    char *name = host;
    if (*name == '[' && colon[-1] == ']') { /* [::1]:5555 */
        name++;
        colon[-1] = '\0';
    }
    const int failed = getaddrinfo(name, colon + 1, &hints, &addresses);
    if (failed != 0) {
        snprintf(why, PORT_WHY_BYTES, "tcp:%.100s: %s", where, gai_strerror(failed));
        return false;
    }
    int error = 0;
    for (const struct addrinfo *a = addresses; a != NULL && p->fd < 0; a = a->ai_next) {
        p->fd = connect_to(a);
        error = errno;
    }
    freeaddrinfo(addresses);
    if (p->fd < 0) {
        snprintf(why, PORT_WHY_BYTES,
                 "tcp:%.100s: %s; is the device running there (limber-sim device --tcp %.100s)?",
                 where, strerror(error), where);
        return false;
    }
    return true;
}

static long none_now(long n)
{
    return n < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : n;
}

static long read_tcp(port *p, void *bytes, size_t room)
{
    const long n = recv(p->fd, bytes, room, 0);
    return n == 0 ? -1 : none_now(n); /* the other end closed it */
}

static long write_tcp(port *p, const void *bytes, size_t bytes_n)
{
    return none_now(send(p->fd, bytes, bytes_n, MSG_NOSIGNAL));
}

static void close_tcp(port *p)
{
    close(p->fd);
}

const port_kind port_tcp = {"tcp:", open_tcp, read_tcp, write_tcp, close_tcp};
