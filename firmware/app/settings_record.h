/* settings_record.h - how a record lies in flash: shared by settings.c and settings_boot.c, nobody else. */
#ifndef LIMBER_SETTINGS_RECORD_H
#define LIMBER_SETTINGS_RECORD_H

#include "crc32c.h"
#include "settings.h"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "words are written as they lie in memory: low byte first"
#endif

enum {
    SETTINGS_HEAD_WORDS = 4, /* mark, payload_n, version, sequence */
    SETTINGS_TAIL_WORDS = 2, /* checksum, commit */
    SETTINGS_HEAD_BYTES = 4 * SETTINGS_HEAD_WORDS,
    SETTINGS_TAIL_BYTES = 4 * SETTINGS_TAIL_WORDS,
};

#define SETTINGS_MARK 0x52424D4Cu /* "LMBR" */
/* Half its bits are programmed, so a torn one does not pass for it. */
#define SETTINGS_COMMIT 0x600D5AA5u

static inline uint32_t settings_on_grid(uint32_t bytes, uint32_t grid)
{
    return (bytes + grid - 1u) / grid * grid;
}

static inline uint32_t settings_padded(uint32_t payload_n)
{
    return settings_on_grid(payload_n, 4u);
}

static inline uint32_t settings_record_bytes(uint32_t payload_n)
{
    return SETTINGS_HEAD_BYTES + settings_padded(payload_n) + SETTINGS_TAIL_BYTES;
}

static inline void settings_head(const settings_record *record, uint32_t *head)
{
    head[0] = SETTINGS_MARK;
    head[1] = record->payload_n;
    head[2] = record->version;
    head[3] = record->sequence;
}

static inline bool settings_has_room(const settings *s, int sector, uint32_t bytes)
{
    return s->sector[sector].end <= s->sector_size &&
           bytes <= s->sector_size - s->sector[sector].end;
}

#endif
