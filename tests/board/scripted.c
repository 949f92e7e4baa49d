/* scripted.c - see scripted.h. */
#include "scripted.h"

#include <stddef.h>

scripted_write scripted_writes[SCRIPTED_WRITES_MAX];
int scripted_writes_n, scripted_reads_n;

static script current;

void scripted_start(script s)
{
    current = s;
    scripted_writes_n = scripted_reads_n = 0;
}

uint32_t reg_read(const reg *place)
{
    scripted_reads_n++;
    return current.read != NULL ? current.read(place, *place) : *place;
}

void reg_write(reg *place, uint32_t value)
{
    if (scripted_writes_n < SCRIPTED_WRITES_MAX) {
        scripted_writes[scripted_writes_n++] = (scripted_write){place, value};
    }
    if (current.write == NULL || !current.write(place, value)) {
        *place = value;
    }
}

int scripted_first_write(const reg *place)
{
    for (int i = 0; i < scripted_writes_n; i++) {
        if (scripted_writes[i].place == place) {
            return i;
        }
    }
    return -1;
}

int scripted_last_write(const reg *place)
{
    for (int i = scripted_writes_n - 1; i >= 0; i--) {
        if (scripted_writes[i].place == place) {
            return i;
        }
    }
    return -1;
}
