/* track_reader.c - see track_reader.h. */
#include "track_reader.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim.h"

enum { VALUES_N = 8, COLUMNS_MAX = 64, LINE_MAX_BYTES = 4096 };
enum { T, X, Y, Z, QX, QY, QZ, QW };

static const char *const TUM_NAMES[VALUES_N] = {"timestamp", "tx", "ty", "tz",
                                                "qx",        "qy", "qz", "qw"};

/* Names a CSV column may have, without its unit in brackets; EuRoC's come last. */
static const char *const CSV_NAMES[VALUES_N][6] = {
    {"timestamp", "time", "t", "timestamp_s", "timestamp_ns", "t_ns"},
    {"tx", "x", "px", "pos_x", "position_x", "p_rs_r_x"},
    {"ty", "y", "py", "pos_y", "position_y", "p_rs_r_y"},
    {"tz", "z", "pz", "pos_z", "position_z", "p_rs_r_z"},
    {"qx", "q_x", "rot_x", "quat_x", "orientation_x", "q_rs_x"},
    {"qy", "q_y", "rot_y", "quat_y", "orientation_y", "q_rs_y"},
    {"qz", "q_z", "rot_z", "quat_z", "orientation_z", "q_rs_z"},
    {"qw", "q_w", "rot_w", "quat_w", "orientation_w", "q_rs_w"},
};

typedef struct {
    const char *path;
    long line;
    bool comma_separated; /* CSV with a header; otherwise TUM */
    bool started;         /* the first header or sample has been seen */
    bool nanoseconds;
    int columns_n;
    int column[VALUES_N]; /* where each value stands */
    int64_t first_ns;
    long hidden_line; /* where a comment was that may be EuRoC's header; 0: nowhere */
    char hidden_header[LINE_MAX_BYTES];
    track_sample *samples;
    size_t samples_n, room_n;
} reader;

static char *trim(char *text)
{
    while (isspace((unsigned char)*text)) {
        text++;
    }
    char *end = text + strlen(text);
    while (end > text && isspace((unsigned char)end[-1])) {
        end--;
    }
    *end = '\0';
    return text;
}

/* Splits in place; returns the number of fields, or -1 where there are too many. Empty CSV fields
 * count; runs of blanks in a TUM line separate once. */
static int split(char *line, bool comma_separated, char *fields[COLUMNS_MAX])
{
    int n = 0;
    char *rest = line;
    for (;;) {
        char *field = strsep(&rest, comma_separated ? "," : " \t");
        if (field == NULL) {
            return n;
        }
        if (!comma_separated && *field == '\0') {
            continue;
        }
        if (n == COLUMNS_MAX) {
            return -1;
        }
        fields[n++] = trim(field);
    }
}

/* The unit in brackets after a column's name ("p_RS_R_x [m]"), cut off the name; "" where none is. */
static const char *cut_unit(char *name)
{
    char *open = strchr(name, '[');
    if (open == NULL) {
        return "";
    }
    *open = '\0';
    char *close = strchr(open + 1, ']');
    if (close != NULL) {
        *close = '\0';
    }
    (void)trim(name);
    for (char *c = name + strlen(name); c > name && isspace((unsigned char)c[-1]); c--) {
        c[-1] = '\0';
    }
    return trim(open + 1);
}

static int value_named(const char *name)
{
    for (int value = 0; value < VALUES_N; value++) {
        for (int i = 0; i < 6; i++) {
            if (strcasecmp(name, CSV_NAMES[value][i]) == 0) {
                return value;
            }
        }
    }
    return -1;
}

static int read_header(reader *r, char *line)
{
    char *fields[COLUMNS_MAX];
    bool is_euroc = false, in_seconds = false;
    r->comma_separated = true;
    r->columns_n = split(line, true, fields);
    if (r->columns_n < 0) {
        return sim_complain("%s:%ld: more than %d columns", r->path, r->line, COLUMNS_MAX);
    }
    for (int value = 0; value < VALUES_N; value++) {
        r->column[value] = -1;
    }
    for (int i = 0; i < r->columns_n; i++) {
        const char *unit = cut_unit(fields[i]);
        const int value = value_named(fields[i]);
        if (value < 0) {
            continue; /* velocities, confidences and the like */
        }
        if (r->column[value] >= 0) {
            return sim_complain("%s:%ld: two columns for %s", r->path, r->line, TUM_NAMES[value]);
        }
        r->column[value] = i;
        const bool is_ns = strcasecmp(unit, "ns") == 0 || strcasestr(fields[i], "_ns") != NULL;
        if (value == T) {
            r->nanoseconds = is_ns;
            in_seconds = strcmp(unit, "s") == 0;
        }
        const bool unit_known = *unit == '\0' ||
                                (value == T && (is_ns || strcmp(unit, "s") == 0)) ||
                                (value >= X && value <= Z && strcmp(unit, "m") == 0) || value >= QX;
        if (!unit_known) {
            return sim_complain(
                "%s:%ld: column '%s' is in %s; times are read in s or ns, positions in m "
                "(take the unit away and give --scale)",
                r->path, r->line, fields[i], unit);
        }
        is_euroc = is_euroc || strcasecmp(fields[i], "p_rs_r_x") == 0;
    }
    /* EuRoC's first headers give the time no unit: it is nanoseconds in all of them */
    r->nanoseconds = r->nanoseconds || (is_euroc && !in_seconds);
    for (int value = 0; value < VALUES_N; value++) {
        if (r->column[value] < 0) {
            return sim_complain("%s:%ld: the header has no column for %s", r->path, r->line,
                                TUM_NAMES[value]);
        }
    }
    return SIM_OK;
}

static int read_number(const reader *r, const char *text, int value, double *number)
{
    char *end;
    *number = strtod(text, &end);
    if (end == text || *end != '\0') {
        return sim_complain("%s:%ld: %s is not a number: '%.40s'", r->path, r->line,
                            TUM_NAMES[value], text);
    }
    if (!isfinite(*number) || fabs(*number) > 1e18) {
        return sim_complain("%s:%ld: %s is not a finite, sensible number: '%.40s'", r->path,
                            r->line, TUM_NAMES[value], text);
    }
    return SIM_OK;
}

/* Nanoseconds since 1970 have more digits than a double: counted as integers from the first sample. */
static int read_nanoseconds(reader *r, const char *text, double *t_s)
{
    char *end;
    errno = 0;
    const int64_t ns = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || ns < 0) {
        return sim_complain("%s:%ld: timestamp is not a count of nanoseconds: '%.40s'", r->path,
                            r->line, text);
    }
    if (r->samples_n == 0) {
        r->first_ns = ns;
    }
    *t_s = (double)(ns - r->first_ns) / 1e9;
    return SIM_OK;
}

static int add_sample(reader *r, const double values[VALUES_N])
{
    if (r->samples_n > 0 && values[T] < r->samples[r->samples_n - 1].t_s) {
        return sim_complain("%s:%ld: time runs backwards, by %.9g s", r->path, r->line,
                            r->samples[r->samples_n - 1].t_s - values[T]);
    }
    if (r->samples_n == r->room_n) {
        r->room_n = r->room_n == 0 ? 4096 : 2 * r->room_n;
        track_sample *grown = realloc(r->samples, r->room_n * sizeof *grown);
        if (grown == NULL) {
            return sim_give_up("%s: out of memory at line %ld", r->path, r->line);
        }
        r->samples = grown;
    }
    r->samples[r->samples_n++] = (track_sample){values[T],
                                                {values[X], values[Y], values[Z]},
                                                {values[QX], values[QY], values[QZ], values[QW]},
                                                r->line};
    return SIM_OK;
}

static int read_sample(reader *r, char *line)
{
    char *fields[COLUMNS_MAX];
    const int n = split(line, r->comma_separated, fields);
    if (n != r->columns_n) {
        return sim_complain("%s:%ld: %d columns where %d are expected (%s)", r->path, r->line,
                            n < 0 ? COLUMNS_MAX + 1 : n, r->columns_n,
                            r->comma_separated ? "as the header has"
                                               : "timestamp tx ty tz qx qy qz qw");
    }
    double values[VALUES_N];
    for (int value = 0; value < VALUES_N; value++) {
        const char *text = fields[r->column[value]];
        const int result = value == T && r->nanoseconds
                               ? read_nanoseconds(r, text, &values[T])
                               : read_number(r, text, value, &values[value]);
        if (result != SIM_OK) {
            return result;
        }
    }
    return add_sample(r, values);
}

static int commas_in(const char *line)
{
    int n = 0;
    for (; *line != '\0'; line++) {
        n += *line == ',';
    }
    return n;
}

/* A CSV header begins with a name and has commas. */
static bool is_header(const char *line)
{
    return isalpha((unsigned char)*line) && strncasecmp(line, "nan", 3) != 0 &&
           strncasecmp(line, "inf", 3) != 0 && strchr(line, ',') != NULL;
}

/* The first line that is neither blank nor a comment decides what the file is. */
static int start(reader *r, char *line)
{
    r->started = true;
    if (is_header(line)) {
        return read_header(r, line);
    }
    if (strchr(line, ',') == NULL) {
        r->columns_n = VALUES_N;
        for (int value = 0; value < VALUES_N; value++) {
            r->column[value] = value;
        }
        return read_sample(r, line);
    }
    if (r->hidden_line == 0) {
        return sim_complain("%s:%ld: comma-separated, but no header line names the columns "
                            "(timestamp,tx,ty,tz,qx,qy,qz,qw)",
                            r->path, r->line);
    }
    const long line_number = r->line;
    r->line = r->hidden_line;
    const int result = read_header(r, r->hidden_header);
    r->line = line_number;
    return result == SIM_OK ? read_sample(r, line) : result;
}

static int read_line(reader *r, char *line)
{
    line = trim(line);
    if (*line == '#') {
        /* EuRoC hides its header behind a '#', other files write prose there: what follows tells */
        if (!r->started && commas_in(line) >= VALUES_N - 1) {
            strcpy(r->hidden_header, line + strspn(line, "# \t"));
            r->hidden_line = r->line;
        }
        return SIM_OK;
    }
    if (*line == '\0') {
        return SIM_OK;
    }
    return r->started ? read_sample(r, line) : start(r, line);
}

typedef enum { LINE_READ, LINE_NOT_TEXT, LINE_TOO_LONG, LINE_END } line_kind;

/* One line without its end. A track is text: anything else is refused before its bytes are taken for
 * numbers, and before an endless file fills the memory. */
static line_kind next_line(FILE *file, char line[LINE_MAX_BYTES])
{
    size_t length = 0;
    int c;
    while ((c = getc(file)) != EOF && c != '\n') {
        if (c < ' ' && !isspace(c)) {
            return LINE_NOT_TEXT;
        }
        if (length == LINE_MAX_BYTES - 1) {
            return LINE_TOO_LONG;
        }
        line[length++] = (char)c;
    }
    line[length] = '\0';
    return c == EOF && length == 0 ? LINE_END : LINE_READ;
}

static int read_stream(reader *r, FILE *file)
{
    static const char BYTE_ORDER_MARK[] = "\xEF\xBB\xBF";
    char line[LINE_MAX_BYTES];
    for (;;) {
        const line_kind kind = next_line(file, line);
        r->line++;
        if (kind == LINE_END) {
            break;
        }
        if (kind == LINE_NOT_TEXT) {
            return sim_complain("%s:%ld: not a text file", r->path, r->line);
        }
        if (kind == LINE_TOO_LONG) {
            return sim_complain("%s:%ld: longer than %d characters: not a track", r->path, r->line,
                                LINE_MAX_BYTES - 1);
        }
        const bool marked = r->line == 1 && strncmp(line, BYTE_ORDER_MARK, 3) == 0;
        const int result = read_line(r, marked ? line + 3 : line);
        if (result != SIM_OK) {
            return result;
        }
    }
    return ferror(file) ? sim_complain("%s: cannot be read: %s", r->path, strerror(errno)) : SIM_OK;
}

int track_reader_read(const char *path, track_sample **samples, size_t *samples_n)
{
    reader r = {.path = path};
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    int result = read_stream(&r, file);
    fclose(file);
    if (result == SIM_OK && r.samples_n == 0) {
        result = sim_complain(
            "%s: no samples in it (expected lines of timestamp tx ty tz qx qy qz qw)", path);
    }
    if (result != SIM_OK) {
        free(r.samples);
        return result;
    }
    *samples = r.samples;
    *samples_n = r.samples_n;
    return SIM_OK;
}
