/* port.c - see port.h. */
#include "port.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "limber.h"

static const int64_t FULL_MAX_US = 500000;

static const port_kind *const KINDS[] = {&port_serial, &port_fd, &port_tcp};
enum { KINDS_N = sizeof KINDS / sizeof KINDS[0] };

/* The kind, and what comes after its prefix. */
static const port_kind *kind_of(const char *name, const char **where)
{
    for (int i = 0; i < KINDS_N; i++) {
        const size_t n = strlen(KINDS[i]->prefix);
        if (strncmp(name, KINDS[i]->prefix, n) == 0) {
            *where = name + n;
            return **where == '\0' ? NULL : KINDS[i];
        }
    }
    *where = name;
    if (strncmp(name, "/dev/pts/", 9) == 0) {
        return &port_fd;
    }
    return strncmp(name, "/dev/", 5) == 0 ? &port_serial : NULL;
}

int port_check_name(const char *name)
{
    const char *where;
    if (kind_of(name, &where) == NULL || strlen(name) >= PORT_PATH_BYTES) {
        return sim_complain("--port %.60s: must be serial:/dev/ttyUSB0[@BAUD], pty:PATH or "
                            "tcp:HOST:PORT; limber ports lists the serial ones",
                            name);
    }
    return SIM_OK;
}

bool port_open(port *p, const char *name, port_why why)
{
    const char *where;
    *p = (port){.fd = -1};
    const port_kind *const kind = kind_of(name, &where);
    if (!kind->open(p, where, why)) {
        *p = (port){.fd = -1};
        return false;
    }
    p->kind = kind;
    return true;
}

void port_close(port *p)
{
    if (p->kind != NULL) {
        p->kind->close(p);
    }
    *p = (port){.fd = -1};
}

static void say_gone(const port *p, int error, port_why why)
{
    snprintf(why, PORT_WHY_BYTES, "%s%.200s is gone (%s)", p->kind->prefix, p->path,
             error == 0 || error == EIO ? "closed at the other end" : strerror(error));
}

long port_read(port *p, void *bytes, size_t room, port_why why)
{
    errno = 0;
    const long n = p->kind->read(p, bytes, room);
    if (n < 0) {
        say_gone(p, errno, why);
    }
    return n;
}

bool port_write(port *p, const void *bytes, size_t bytes_n, port_why why)
{
    const char *from = bytes;
    const uint64_t start_us = limber_now_us();
    while (bytes_n > 0) {
        errno = 0;
        const long n = p->kind->write(p, from, bytes_n);
        if (n < 0) {
            say_gone(p, errno, why);
            return false;
        }
        from += n;
        bytes_n -= (size_t)n;
        if (n == 0) {
            const int64_t left_us = FULL_MAX_US - (int64_t)(limber_now_us() - start_us);
            if (left_us <= 0) {
                snprintf(why, PORT_WHY_BYTES, "%s%.200s takes no more bytes", p->kind->prefix,
                         p->path);
                return false;
            }
            struct pollfd room = {.fd = p->fd, .events = POLLOUT};
            (void)poll(&room, 1, (int)(left_us / 1000) + 1);
        }
    }
    return true;
}

port_events port_wait(const port *p, int other_fd, int64_t timeout_us)
{
    struct pollfd files[2] = {{.fd = p->fd, .events = POLLIN}, {.fd = other_fd, .events = POLLIN}};
    if (timeout_us < 0) {
        timeout_us = 0;
    }
    const struct timespec timeout = {(time_t)(timeout_us / 1000000),
                                     (long)(timeout_us % 1000000) * 1000};
    if (ppoll(files, 2, &timeout, NULL) <= 0) {
        return (port_events){false, false};
    }
    return (port_events){files[0].revents != 0, files[1].revents != 0};
}
