/* track_reader.h - the text of a track file to samples; refuses what is not one, with line and reason. */
#ifndef LIMBER_TRACK_READER_H
#define LIMBER_TRACK_READER_H

#include <stddef.h>

#include "track.h"

/* Every sample as written (units of the file, quaternions as they are), times never running backwards.
 * Returns SIM_OK with *samples from malloc and at least one of them, or an exit code after complaining. */
int track_reader_read(const char *path, track_sample **samples, size_t *samples_n);

#endif
