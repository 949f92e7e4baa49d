/* shape_text.c - see shape_text.h. */
#include "shape_text.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rod_config.h"
#include "sim.h"

/* --- ready-made ----------------------------------------------------------------------------------- */

static void bend_arc(double degrees, int links_n, rod_joint *angles_rad)
{
    for (int i = 0; i < links_n; i++) {
        angles_rad[i][ROD_THETA] = (float)(degrees * M_PI / 180.0 / links_n);
        angles_rad[i][ROD_PHI] = 0.0f;
    }
}

/* Curvature and torsion of a helix that rises by a quarter of its radius a radian: the direction of the bend turns
 * evenly along the rod. */
static void bend_coil(double turns, int links_n, rod_joint *angles_rad)
{
    const double rise = 0.25, along = 2.0 * M_PI * turns / sqrt(1.0 + rise * rise);
    for (int i = 0; i < links_n; i++) {
        const double direction = along * rise * (i + 0.5) / links_n;
        angles_rad[i][ROD_THETA] = (float)(along / links_n * cos(direction));
        angles_rad[i][ROD_PHI] = (float)(along / links_n * sin(direction));
    }
}

static const struct {
    const char *name;
    double most; /* a joint's angle stays under half a turn by far */
    const char *unit;
    void (*bend)(double amount, int links_n, rod_joint *angles_rad);
} READY_MADE[] = {{"arc:", 360.0, " degrees", bend_arc}, {"coil:", 10.0, " turns", bend_coil}};

static int bend(const char *shape, int links_n, rod_joint *angles_rad, bool *is_ready_made)
{
    for (size_t i = 0; i < sizeof READY_MADE / sizeof READY_MADE[0]; i++) {
        const size_t name_n = strlen(READY_MADE[i].name);
        if (strncmp(shape, READY_MADE[i].name, name_n) != 0) {
            continue;
        }
        *is_ready_made = true;
        char *end;
        const char *const text = shape + name_n;
        const double amount = strtod(text, &end), most = READY_MADE[i].most;
        if (end == text || *end != '\0' || !(fabs(amount) <= most)) {
            return sim_complain("%.60s: must be %s and a number from %g to %g%s", shape,
                                READY_MADE[i].name, -most, most, READY_MADE[i].unit);
        }
        READY_MADE[i].bend(amount, links_n, angles_rad);
        return SIM_OK;
    }
    *is_ready_made = false;
    return SIM_OK;
}

/* --- tables --------------------------------------------------------------------------------------- */

static const struct table {
    const char *header;
    int columns_n;
    double most; /* of every number; an angle is at most half a turn */
    double scale;
} TABLES[] = {{"theta,phi", 2, M_PI, 1.0},
              {"theta_deg,phi_deg", 2, 180.0, M_PI / 180.0},
              {"x,y,z", 3, 1e6, 1.0}};
enum { TABLES_N = sizeof TABLES / sizeof TABLES[0], ROWS_MAX = ROD_MAX_LINKS + 1 };

typedef struct {
    const struct table *table; /* NULL: the header has not been seen */
    int rows_n;
    double rows[ROWS_MAX][3];
} shape_rows;

static int take_header(shape_rows *rows, const char *origin, const char *line)
{
    for (int i = 0; i < TABLES_N; i++) {
        if (strcmp(line, TABLES[i].header) == 0) {
            rows->table = &TABLES[i];
            return SIM_OK;
        }
    }
    return sim_complain("%s: '%.40s' is no header of a shape; it must be theta,phi or "
                        "theta_deg,phi_deg or x,y,z",
                        origin, line);
}

static int take_row(shape_rows *rows, const char *origin, char *line)
{
    const struct table *const t = rows->table;
    const double most = t->most;
    int columns_n = 0;
    if (rows->rows_n == ROWS_MAX) {
        return sim_complain("%s: more than %d rows; a rod has at most %d links", origin, ROWS_MAX,
                            ROD_MAX_LINKS);
    }
    for (char *word; (word = strsep(&line, ",")) != NULL; columns_n++) {
        char *end;
        const double number = strtod(word, &end);
        if (end == word || *end != '\0' || !(fabs(number) <= most)) {
            return sim_complain("%s: '%.40s': must be a number from %g to %g", origin, word, -most,
                                most);
        }
        if (columns_n < t->columns_n) {
            rows->rows[rows->rows_n][columns_n] = number * t->scale;
        }
    }
    rows->rows_n++;
    return columns_n == t->columns_n ? SIM_OK
                                     : sim_complain("%s: %d columns where %s has %d", origin,
                                                    columns_n, t->header, t->columns_n);
}

/* Blanks have no meaning in a table of numbers, and a remark none for a program. */
static void tidy(char *line)
{
    char *to = line;
    for (const char *c = line; *c != '\0' && *c != '#'; c++) {
        if (*c != ' ' && *c != '\t' && *c != '\r' && *c != '\n') {
            *to++ = *c;
        }
    }
    *to = '\0';
}

static int read_rows(const char *path, FILE *file, shape_rows *rows)
{
    char line[200];
    int result = SIM_OK;
    for (long n = 1; result == SIM_OK && fgets(line, sizeof line, file) != NULL; n++) {
        char origin[160];
        snprintf(origin, sizeof origin, "%.130s:%ld", path, n);
        if (strlen(line) == sizeof line - 1) {
            return sim_complain("%s: longer than %zu characters", origin, sizeof line - 2);
        }
        tidy(line);
        if (*line != '\0') {
            result = rows->table == NULL ? take_header(rows, origin, line)
                                         : take_row(rows, origin, line);
        }
    }
    return result == SIM_OK && ferror(file)
               ? sim_complain("%s: cannot be read: %s", path, strerror(errno))
               : result;
}

static int take_points(const char *path, const shape_rows *rows, int links_n, rod_joint *angles_rad)
{
    static const rod_pose UPRIGHT = {.orientation = {.w = 1.0f}};
    vec3 links[ROD_MAX_LINKS];
    for (int i = 0; i < links_n; i++) {
        const double *a = rows->rows[i], *b = rows->rows[i + 1];
        const double length = hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
        if (!(length > 0.0)) {
            return sim_complain("%s: point %d is where point %d is; a link has a length", path,
                                i + 2, i + 1);
        }
        links[i] = (vec3){(float)((b[0] - a[0]) / length), (float)((b[1] - a[1]) / length),
                          (float)((b[2] - a[2]) / length)};
    }
    memset(angles_rad, 0, (size_t)links_n * sizeof *angles_rad);
    kinematics_angles(&UPRIGHT, links, links_n, angles_rad);
    return SIM_OK;
}

static int take_rows(const char *path, const shape_rows *rows, int links_n, rod_joint *angles_rad)
{
    if (rows->table == NULL) {
        return sim_complain("%s: empty; a shape is a table with the header theta,phi or "
                            "theta_deg,phi_deg or x,y,z",
                            path);
    }
    const bool points = rows->table->columns_n == 3;
    const int needed = links_n + (points ? 1 : 0);
    if (rows->rows_n != needed) {
        return sim_complain("%s: %d rows of %s for a rod of %d links; it needs %d, %s", path,
                            rows->rows_n, rows->table->header, links_n, needed,
                            points ? "the base's own point first" : "one per joint");
    }
    if (points) {
        return take_points(path, rows, links_n, angles_rad);
    }
    for (int i = 0; i < links_n; i++) {
        angles_rad[i][ROD_THETA] = (float)rows->rows[i][0];
        angles_rad[i][ROD_PHI] = (float)rows->rows[i][1];
    }
    return SIM_OK;
}

int shape_text_read(const char *shape, int links_n, rod_joint *angles_rad)
{
    bool is_ready_made;
    int result = bend(shape, links_n, angles_rad, &is_ready_made);
    if (is_ready_made) {
        return result;
    }
    FILE *const file = fopen(shape, "r");
    if (file == NULL) {
        return sim_complain("%s: %s; a shape is a file, arc:DEGREES or coil:TURNS", shape,
                            strerror(errno));
    }
    shape_rows rows = {.table = NULL};
    result = read_rows(shape, file, &rows);
    fclose(file);
    return result == SIM_OK ? take_rows(shape, &rows, links_n, angles_rad) : result;
}
