/* line.h - the device's end of a line on this machine: a pseudo terminal or a TCP port. Never blocks. */
#ifndef LIMBER_LINE_H
#define LIMBER_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LINE_OUT_BYTES = 8192 };

typedef struct {
    int fd;        /* of the PTY's device side, or of the connected client; -1: nobody there */
    int listen_fd; /* of TCP; -1 for a PTY */
    int kept_fd;   /* the PTY's other side: open, so that a tool may come and go */
    char *link;    /* the PTY's name, removed at the end */
    uint8_t out[LINE_OUT_BYTES];
    size_t out_n;
    int stuck_n; /* flushes in a row that nobody took anything of */
} line;

/* A PTY whose other side is found under the name `link` (a symbolic link), or the TCP port of
 * "127.0.0.1:5555" (port 0: any; *port tells). Return SIM_OK, or an exit code after complaining. */
int line_open_pty(line *l, const char *link);
int line_open_tcp(line *l, const char *address, int *port);
void line_close(line *l);

size_t line_read(line *l, uint8_t *bytes, size_t room);

/* All or nothing, into the queue; line_flush sends what the other side takes. */
bool line_write(line *l, const uint8_t *bytes, size_t bytes_n);
size_t line_free(const line *l);
void line_flush(line *l);

#endif
