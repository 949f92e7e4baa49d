/* port.h - the line to the device: one interface, three kinds.
 *
 *     serial:/dev/ttyUSB0[@BAUD]   a serial port, by libserialport; 1 Mbaud 8N1 unless told otherwise
 *     pty:PATH                     a pseudo-terminal, or a link to one: what limber-sim device --pty makes
 *     tcp:HOST:PORT                limber-sim device --tcp, or a serial-to-network adapter
 *
 * A port is a number of bytes each way and nothing else; it is never waited for inside a read. Whoever
 * opens it holds it alone where the system allows that.
 */
#ifndef LIMBER_PORT_H
#define LIMBER_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PORT_WHY_BYTES = 500, PORT_PATH_BYTES = 256, PORT_BAUD = 1000000 };

/* What happened and what to try, for one line on stderr. */
typedef char port_why[PORT_WHY_BYTES];

typedef struct port port;

typedef struct {
    const char *prefix; /* "serial:" */
    /* Fills path and fd. False with *why. */
    bool (*open)(port *p, const char *where, port_why why);
    /* Bytes read or written, 0: none at the moment, -1 with errno: the port is gone. */
    long (*read)(port *p, void *bytes, size_t room);
    long (*write)(port *p, const void *bytes, size_t bytes_n);
    void (*close)(port *p);
} port_kind;

struct port {
    const port_kind *kind; /* NULL: not open */
    char path[PORT_PATH_BYTES];
    int fd;       /* to wait for */
    void *handle; /* libserialport's */
};

extern const port_kind port_serial, port_fd, port_tcp;

/* The form of a port's name: SIM_OK, or SIM_BAD_INPUT after complaining. A bare /dev/... will do. */
int port_check_name(const char *name);

/* The only serial port that looks like a board: its name in name[PORT_PATH_BYTES]; else LIMBER_DEVICE after
 * saying which ports there are. */
int port_choose(char *name);

/* False with *why; p is then closed. name has passed port_check_name. */
bool port_open(port *p, const char *name, port_why why);
void port_close(port *p);

/* As port_kind's. A port that can be read but has no bytes is gone: *why tells so, and -1. */
long port_read(port *p, void *bytes, size_t room, port_why why);

/* All of the bytes, waiting for the line if it is full. False with *why after half a second, or at once if
 * the port is gone. */
bool port_write(port *p, const void *bytes, size_t bytes_n, port_why why);

/* Waits until the port can be read, other_fd can (-1: none), an interrupt comes, or timeout_us is over. */
typedef struct {
    bool port, other;
} port_events;
port_events port_wait(const port *p, int other_fd, int64_t timeout_us);

/* --- hints, port_hints.c ------------------------------------------------------------------------- */

/* Why opening `path` failed with this errno, and what to do about it. */
void port_explain(const char *path, int error, port_why why);

/* Takes the file for this process alone; false with EBUSY in errno if another has it. */
bool port_lock(int fd);

/* Warns if an FTDI adapter gathers bytes for longer than 2 ms. */
void port_warn_of_latency_timer(const port *p);

#endif
