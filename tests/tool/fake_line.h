/* fake_line.h - the fake device's end of a line: a PTY behind a link, or a TCP port of this machine. */
#ifndef LIMBER_FAKE_LINE_H
#define LIMBER_FAKE_LINE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    const char *pty_link; /* NULL: TCP */
    int listener, fd;     /* -1: none */
    int slave;            /* kept open, so that the PTY outlives its users */
} fake_line;

/* Makes it and says where on stdout: "ready PLACE". Exits on failure. */
void fake_line_open(fake_line *line, const char *pty_link);
void fake_line_close(fake_line *line);

/* Waits a moment for bytes; returns how many came. */
size_t fake_line_read(fake_line *line, void *bytes, size_t room, int wait_ms);
void fake_line_write(fake_line *line, const void *bytes, size_t bytes_n);

#endif
