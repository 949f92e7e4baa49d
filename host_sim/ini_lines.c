/* ini_lines.c - see ini_lines.h. */
#include "ini_lines.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdio.h>
#include <string.h>

#include "sim.h"

/* inih calls back neither for a section nor with the place it is at: its lines are read here. */
typedef struct {
    ini_take take;
    void *context;
    const char *path;
    FILE *file;
    long line;
    bool in_value;     /* a key stands above in this section, so that a value can go on */
    char section[200]; /* inih itself keeps less of a long one */
    ini_piece piece;
    int result;
} reading;

static void hand_over(reading *r, const char *key, const char *value)
{
    r->piece.section = r->section;
    r->piece.key = key;
    r->piece.value = value;
    snprintf(r->piece.origin, sizeof r->piece.origin, "%.140s:%ld", r->path, r->line);
    r->result = r->take(r->context, &r->piece);
}

/* One line without its end; false at the end of the file or after complaining. */
static bool read_line(reading *r, char *buffer, int size)
{
    int c = EOF, used = 0;
    r->line++;
    while ((c = getc(r->file)) != EOF && c != '\n') {
        if (c < ' ' && !isspace(c)) {
            r->result = sim_complain("%s:%ld: not a text file", r->path, r->line);
            return false;
        }
        if (used == size - 2) {
            r->result = sim_complain("%s:%ld: longer than %d characters; go on with the list on an "
                                     "indented line",
                                     r->path, r->line, size - 2);
            return false;
        }
        buffer[used++] = (char)c;
    }
    buffer[used] = '\0';
    r->line -= c == EOF && used == 0;
    return c != EOF || used > 0;
}

/* Remarks may follow a value after a blank; inih's versions differ on them in lines that go on. */
static void cut_remark(char *line)
{
    for (char *c = line; *c != '\0'; c++) {
        if ((*c == ';' || *c == '#') && c > line && isspace((unsigned char)c[-1])) {
            *c = '\0';
            return;
        }
    }
}

static int refuse(const char *path, long line)
{
    return sim_complain("%s:%ld: neither a [section], a key = value nor a comment", path, line);
}

static void begin_section(reading *r, const char *start)
{
    const char *end = strchr(start, ']');
    r->in_value = false;
    if (end == NULL) {
        r->result = refuse(r->path, r->line);
        return;
    }
    snprintf(r->section, sizeof r->section, "%.*s", (int)(end - start - 1), start + 1);
    hand_over(r, NULL, NULL);
}

static char *next_line(char *buffer, int size, void *context)
{
    reading *r = context;
    if (r->result != SIM_OK || !read_line(r, buffer, size)) {
        return NULL;
    }
    cut_remark(buffer);
    const char *start = buffer;
    if (r->line == 1 && strncmp(start, "\xEF\xBB\xBF", 3) == 0) {
        start += 3; /* a byte-order mark */
    }
    r->piece.continued = r->in_value && isspace((unsigned char)*start);
    start += strspn(start, " \t");
    if (!r->piece.continued && *start == '[') {
        begin_section(r, start);
    }
    return r->result == SIM_OK ? buffer : NULL;
}

static int take_key(void *context, const char *section, const char *key, const char *value)
{
    reading *r = context;
    (void)section;
    if (r->result == SIM_OK) {
        r->in_value = true;
        hand_over(r, key, value);
    }
    return r->result == SIM_OK;
}

int ini_lines_read(const char *path, ini_take take, void *context, long *lines_n)
{
    reading r = {.take = take, .context = context, .path = path, .file = fopen(path, "r")};
    if (r.file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    const int line = ini_parse_stream(next_line, &r, take_key, &r);
    const bool unreadable = ferror(r.file) != 0;
    fclose(r.file);
    *lines_n = r.line;
    if (r.result == SIM_OK && unreadable) {
        return sim_complain("%s: cannot be read: %s", path, strerror(errno));
    }
    return r.result == SIM_OK && line != 0 ? refuse(path, line) : r.result;
}
