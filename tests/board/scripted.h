/* scripted.h - registers that answer as a test says: what the drivers see when REGISTERS_SCRIPTED is defined.
 *
 * A test hands its drivers blocks of its own memory. Without a script these hold what was written. A script is
 * a model of the hardware: it sees each access first. All writes are kept, in order.
 */
#ifndef LIMBER_SCRIPTED_H
#define LIMBER_SCRIPTED_H

#include <stdbool.h>

#include "registers.h"

/* read: what the place reads, held being what it holds. write: true where it has been dealt with. */
typedef struct {
    uint32_t (*read)(const reg *place, uint32_t held);
    bool (*write)(reg *place, uint32_t value);
} script;

typedef struct {
    reg *place;
    uint32_t value;
} scripted_write;

enum { SCRIPTED_WRITES_MAX = 4096 };
extern scripted_write scripted_writes[SCRIPTED_WRITES_MAX]; /* the first so many */
extern int scripted_writes_n, scripted_reads_n;

/* From now on; forgets what was written and read. */
void scripted_start(script s);

/* The place among the writes of the first (last) to it, from 0; -1: there was none. */
int scripted_first_write(const reg *place);
int scripted_last_write(const reg *place);

#endif
