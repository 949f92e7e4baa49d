/* port_serial.c - real serial ports, by libserialport. */
#include <errno.h>
#include <libserialport.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>

#include "port.h"

/* "/dev/ttyUSB0@921600" into path and baud. */
static bool take_name(port *p, const char *where, int *baud, port_why why)
{
    *baud = PORT_BAUD;
    snprintf(p->path, sizeof p->path, "%s", where);
    char *const at = strrchr(p->path, '@');
    if (at == NULL) {
        return true;
    }
    char *end;
    const long number = strtol(at + 1, &end, 10);
    if (end == at + 1 || *end != '\0' || number < 1200 || number > 20000000) {
        snprintf(why, PORT_WHY_BYTES,
                 "serial:%.100s: the baud rate must be a number, %d if none is"
                 " given",
                 where, PORT_BAUD);
        return false;
    }
    *baud = (int)number;
    *at = '\0';
    return true;
}

static bool configure(struct sp_port *handle, int baud)
{
    return sp_set_bits(handle, 8) == SP_OK && sp_set_parity(handle, SP_PARITY_NONE) == SP_OK &&
           sp_set_stopbits(handle, 1) == SP_OK &&
           sp_set_flowcontrol(handle, SP_FLOWCONTROL_NONE) == SP_OK &&
           sp_set_baudrate(handle, baud) == SP_OK;
}

static bool open_handle(port *p, struct sp_port *handle, int baud, port_why why)
{
    if (sp_open(handle, SP_MODE_READ_WRITE) != SP_OK) {
        port_explain(p->path, sp_last_error_code(), why);
        return false;
    }
    if (!configure(handle, baud)) {
        snprintf(why, PORT_WHY_BYTES,
                 "serial:%.100s: does not take %d baud 8N1 (%s); try another rate, as in "
                 "serial:%.100s@115200, and give the board the same",
                 p->path, baud, strerror(sp_last_error_code()), p->path);
    } else if (sp_get_port_handle(handle, &p->fd) != SP_OK || !port_lock(p->fd)) {
        port_explain(p->path, errno, why);
    } else {
        (void)ioctl(p->fd, TIOCEXCL);
        (void)sp_flush(handle, SP_BUF_INPUT); /* what waits there is old */
        return true;
    }
    sp_close(handle);
    return false;
}

static bool open_serial(port *p, const char *where, port_why why)
{
    struct sp_port *handle = NULL;
    int baud;
    if (!take_name(p, where, &baud, why)) {
        return false;
    }
    if (sp_get_port_by_name(p->path, &handle) != SP_OK) {
        const int error = sp_last_error_code();
        port_explain(p->path, error == 0 ? ENOENT : error, why);
        return false;
    }
    if (!open_handle(p, handle, baud, why)) {
        sp_free_port(handle);
        return false;
    }
    p->handle = handle;
    return true;
}

/* libserialport gives 0 both where nothing waits and where the adapter is unplugged. */
static bool hung_up(const port *p)
{
    struct pollfd state = {.fd = p->fd, .events = POLLIN};
    errno = EIO;
    return poll(&state, 1, 0) == 1 && (state.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

static long read_serial(port *p, void *bytes, size_t room)
{
    const int n = sp_nonblocking_read(p->handle, bytes, room);
    if (n < 0) {
        errno = sp_last_error_code();
        return -1;
    }
    return n == 0 && hung_up(p) ? -1 : n;
}

static long write_serial(port *p, const void *bytes, size_t bytes_n)
{
    const int n = sp_nonblocking_write(p->handle, bytes, bytes_n);
    if (n < 0) {
        errno = sp_last_error_code();
        return -1;
    }
    return n;
}

static void close_serial(port *p)
{
    sp_close(p->handle);
    sp_free_port(p->handle);
}

const port_kind port_serial = {"serial:", open_serial, read_serial, write_serial, close_serial};
