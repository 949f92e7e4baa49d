/* param_file.c - parameter files: INI, as limber-sim params writes them; sections are for people only. */
#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdlib.h>
#include <string.h>

#include "param_text.h"

/* inih calls back without saying where it is: its lines are read here, so that they can be counted. */
typedef struct {
    param_assignments *all;
    const char *path;
    FILE *file;
    long line;
    bool in_value;  /* a key stands above in this section, so that a value can go on */
    bool continued; /* the line begins with a blank: more of the one before */
    int result;
} reading;

static char *next_line(char *buffer, int size, void *context)
{
    reading *r = context;
    int c = EOF, used = 0;
    r->line++;
    while (r->result == SIM_OK && (c = getc(r->file)) != EOF && c != '\n') {
        if (c < ' ' && !isspace(c)) {
            r->result = sim_complain("%s:%ld: not a text file", r->path, r->line);
        } else if (used == size - 2) {
            r->result = sim_complain(
                "%s:%ld: longer than %d characters; go on with the list on an indented line",
                r->path, r->line, size - 2);
        } else {
            buffer[used++] = (char)c;
        }
    }
    if (r->result != SIM_OK || (c == EOF && used == 0)) {
        r->line--;
        return NULL;
    }
    buffer[used] = '\0';
    for (char *remark = buffer + 1; used > 0 && *remark != '\0'; remark++) {
        if ((*remark == ';' || *remark == '#') && isspace((unsigned char)remark[-1])) {
            *remark = '\0'; /* after a value; whole lines are inih's */
            break;
        }
    }
    r->continued = r->in_value && isspace((unsigned char)*buffer);
    if (!r->continued && buffer[strspn(buffer, " \t")] == '[') {
        r->in_value = false;
    }
    return buffer;
}

/* Adds to the last assignment. */
static int go_on(param_assignments *all, const char *values)
{
    param_assignment *const last = &all->items[all->items_n - 1];
    char *longer = NULL;
    if (asprintf(&longer, "%s %s", last->values, values) < 0) {
        return sim_give_up("out of memory");
    }
    free(last->values);
    last->values = longer;
    return SIM_OK;
}

static int take(void *context, const char *section, const char *name, const char *value)
{
    reading *r = context;
    char origin[160];
    (void)section;
    if (r->result != SIM_OK) {
        return 0;
    }
    r->in_value = true;
    snprintf(origin, sizeof origin, "%.140s:%ld", r->path, r->line);
    r->result =
        r->continued ? go_on(r->all, value) : param_assignments_add(r->all, origin, name, value);
    return r->result == SIM_OK;
}

int param_assignments_read_ini(param_assignments *all, const char *path)
{
    reading r = {.all = all, .path = path, .file = fopen(path, "r")};
    if (r.file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    const int line = ini_parse_stream(next_line, &r, take, &r);
    const bool unreadable = ferror(r.file) != 0;
    fclose(r.file);
    if (r.result == SIM_OK && unreadable) {
        return sim_complain("%s: cannot be read: %s", path, strerror(errno));
    }
    if (r.result == SIM_OK && line != 0) {
        return sim_complain("%s:%d: neither a [section], a key = value nor a comment", path, line);
    }
    if (r.result == SIM_OK && all->items_n == 0) {
        return sim_complain("%s: no parameter in it; limber params list --ini prints a complete "
                            "file",
                            path);
    }
    return r.result;
}
