/* body_log.c - see body_log.h. */
#include "body_log.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "angle_hash.h"
#include "output.h"
#include "sim.h"

typedef enum {
    LOG_START = 'B',
    LOG_CHANGED = 'C',
    LOG_OBJECT = 'O',
    LOG_SHAPE = 'S',
    LOG_PLACED = 'P',
    LOG_TICKED = 'T'
} log_kind;

static const char MAGIC[16] = "limber body 2\n";

typedef struct {
    char magic[16];
    uint32_t links_max, params_bytes, input_bytes;
} log_header;

static log_header header_here(void)
{
    log_header h = {.links_max = ROD_MAX_LINKS,
                    .params_bytes = sizeof(params_set),
                    .input_bytes = sizeof(body_input)};
    memcpy(h.magic, MAGIC, sizeof MAGIC);
    return h;
}

static void add(body_log *log, log_kind kind, uint8_t detail, const void *bytes, size_t bytes_n)
{
    if (log->file != NULL) {
        const uint8_t head[2] = {(uint8_t)kind, detail};
        fwrite(head, 1, sizeof head, log->file);
        if (bytes_n > 0) {
            fwrite(bytes, 1, bytes_n, log->file);
        }
    }
}

static void changed(void *context, const params_set *set, bool all_new)
{
    add(context, LOG_CHANGED, all_new, set, sizeof *set);
}

static void put(void *context, int index, const scene_object *object)
{
    add(context, LOG_OBJECT, (uint8_t)index, object, sizeof *object);
}

static void shaped(void *context, const body_shape *shape)
{
    add(context, LOG_SHAPE, 0, shape, sizeof *shape);
}

static void placed(void *context, const float *positions_rad, int servos_n)
{
    add(context, LOG_PLACED, 0, positions_rad, (size_t)servos_n * sizeof *positions_rad);
}

static uint64_t add_angles(uint64_t hash, const body *b, rod_joint *angles_rad)
{
    body_angles(b, angles_rad);
    return angle_hash_add(hash, &angles_rad[0][0], b->map.servos_n);
}

static void ticked(void *context, const body_input *input, const body *b)
{
    body_log *log = context;
    rod_joint angles_rad[ROD_MAX_LINKS];
    add(log, LOG_TICKED, 0, input, sizeof *input);
    log->hash = add_angles(log->hash, b, angles_rad);
    log->ticks_n++;
}

void body_log_start(body_log *log)
{
    add(log, LOG_START, 0, NULL, 0);
}

device_watcher body_log_watcher(body_log *log)
{
    return (device_watcher){log, changed, put, shaped, placed, ticked};
}

int body_log_open(body_log *log, const char *path)
{
    *log = (body_log){.hash = ANGLE_HASH_START};
    if (path == NULL) {
        return SIM_OK;
    }
    log->file = fopen(path, "wb");
    if (log->file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    const log_header h = header_here();
    fwrite(&h, sizeof h, 1, log->file);
    return SIM_OK;
}

int body_log_close(body_log *log, const char *path)
{
    if (log->file == NULL) {
        return SIM_OK;
    }
    const bool whole = !ferror(log->file);
    const bool closed = fclose(log->file) == 0;
    return whole && closed ? SIM_OK
                           : sim_complain("%s: the log is not whole: %s", path, strerror(errno));
}

/* --- replay ------------------------------------------------------------------------------------- */

typedef struct {
    body body;
    params_set set;
    bool started;
    long ticks_n;
    uint64_t hash;
    output angles;
} rerun;

static void write_heading(const rerun *r)
{
    if (r->angles.file != NULL) {
        fprintf(r->angles.file, "t");
        for (int joint = 1; joint <= r->set.rod.links_n; joint++) {
            fprintf(r->angles.file, ",theta%d,phi%d", joint, joint);
        }
        fprintf(r->angles.file, "\n");
    }
}

static bool take_change(rerun *r, bool all_new)
{
    params_refusal why;
    const bool good = r->started ? body_change(&r->body, &r->set, all_new, &why)
                                 : body_init(&r->body, &r->set, &why);
    r->started = true;
    return good;
}

static void take_tick(rerun *r, const body_input *input)
{
    rod_joint angles_rad[ROD_MAX_LINKS];
    body_tick(&r->body, input);
    r->hash = add_angles(r->hash, &r->body, angles_rad);
    if (r->ticks_n == 0) {
        write_heading(r);
    }
    if (r->angles.file != NULL) {
        const double rate_hz = round(1.0 / (double)r->set.rod.tick_s);
        fprintf(r->angles.file, "%.9g", (double)r->ticks_n / rate_hz);
        for (int i = 0; i < r->set.rod.links_n; i++) {
            fprintf(r->angles.file, ",%.9g,%.9g", (double)angles_rad[i][0],
                    (double)angles_rad[i][1]);
        }
        fprintf(r->angles.file, "\n");
    }
    r->ticks_n++;
}

static bool take_record(rerun *r, FILE *file, int kind, int detail)
{
    body_input input;
    body_shape shape;
    scene_object object;
    float positions_rad[SERVOS_MAX];
    switch (kind) {
    case LOG_START:
        r->started = false;
        return true;
    case LOG_CHANGED:
        return fread(&r->set, sizeof r->set, 1, file) == 1 && take_change(r, detail != 0);
    case LOG_OBJECT:
        return r->started && fread(&object, sizeof object, 1, file) == 1 &&
               body_put_object(&r->body, detail, &object, NULL) == ROD_OK;
    case LOG_SHAPE:
        return r->started && fread(&shape, sizeof shape, 1, file) == 1 &&
               body_take_shape(&r->body, &shape) == ROD_OK;
    case LOG_PLACED: {
        const size_t servos_n = r->started ? (size_t)r->body.map.servos_n : 0;
        return servos_n > 0 && fread(positions_rad, sizeof(float), servos_n, file) == servos_n &&
               body_place(&r->body, positions_rad) == SERVO_OK;
    }
    case LOG_TICKED:
        if (!r->started || fread(&input, sizeof input, 1, file) != 1) {
            return false;
        }
        take_tick(r, &input);
        return true;
    default:
        return false;
    }
}

int body_log_replay(const char *path, const char *angles_path, uint64_t *hash)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return sim_complain("%s: %s", path, strerror(errno));
    }
    log_header found;
    const log_header expected = header_here();
    if (fread(&found, sizeof found, 1, file) != 1 || memcmp(&found, &expected, sizeof found) != 0) {
        fclose(file);
        return sim_complain("%s: not a log of this build's limber-sim device --log", path);
    }
    rerun *r = calloc(1, sizeof *r);
    int result = r == NULL ? sim_give_up("out of memory") : SIM_OK;
    if (result == SIM_OK && angles_path != NULL) {
        result = output_open(&r->angles, angles_path);
    }
    if (result == SIM_OK) {
        r->hash = ANGLE_HASH_START;
        int kind;
        while (result == SIM_OK && (kind = getc(file)) != EOF) {
            const int detail = getc(file);
            if (!take_record(r, file, kind, detail)) {
                result = sim_complain("%s: broken off or damaged after tick %ld", path, r->ticks_n);
            }
        }
        *hash = r->hash;
        const int closed = output_close(&r->angles, result == SIM_OK);
        result = outputs_finish(result == SIM_OK ? closed : result);
    }
    if (result == SIM_OK) {
        printf("ticks      %ld\nhash       %016llx\n", r->ticks_n, (unsigned long long)r->hash);
    }
    free(r);
    fclose(file);
    return result;
}
