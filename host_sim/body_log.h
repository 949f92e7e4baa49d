/* body_log.h - everything that ever happened to the device's body, in a file; and the same again from it.
 *
 * Written by `limber-sim device --log`, replayed by `limber-sim replay --per-tick` without resampling, through the
 * same rod, blend and limits: the angles come out the same to the bit. Structs as they lie in memory: for
 * the machine that wrote it.
 */
#ifndef LIMBER_BODY_LOG_H
#define LIMBER_BODY_LOG_H

#include <stdint.h>
#include <stdio.h>

#include "device.h"

typedef struct {
    FILE *file; /* NULL: only the hash is kept */
    uint32_t ticks_n;
    uint64_t hash; /* of all angles, tick by tick (angle_hash.h) */
} body_log;

/* path may be NULL. Returns SIM_OK, or complains. */
int body_log_open(body_log *log, const char *path);

/* Returns SIM_OK, or complains where the disk was full. */
int body_log_close(body_log *log, const char *path);

/* The device starts afresh: before device_init. */
void body_log_start(body_log *log);

/* What the device calls; its context is the body_log. */
device_watcher body_log_watcher(body_log *log);

/* Runs a log; angles_path may be NULL. Prints ticks and hash. Returns an exit code. */
int body_log_replay(const char *path, const char *angles_path, uint64_t *hash);

#endif
