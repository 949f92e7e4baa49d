/* param_file.c - parameter files: INI, as limber-sim params writes them; sections are for people only. */
#include <stdlib.h>

#include "ini_lines.h"
#include "param_text.h"

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

static int take(void *context, const ini_piece *piece)
{
    param_assignments *const all = context;
    if (piece->key == NULL) {
        return SIM_OK; /* a [section] */
    }
    return piece->continued ? go_on(all, piece->value)
                            : param_assignments_add(all, piece->origin, piece->key, piece->value);
}

int param_assignments_read_ini(param_assignments *all, const char *path)
{
    long lines_n;
    const int result = ini_lines_read(path, take, all, &lines_n);
    return result == SIM_OK && all->items_n == 0
               ? sim_complain("%s: no parameter in it; limber params list --ini prints a complete "
                              "file",
                              path)
               : result;
}
