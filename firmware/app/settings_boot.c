/* settings_boot.c - what the flash holds, and which of it is not needed; see settings.h. */
#include "settings_record.h"

#include <string.h>

/* A damaged record's stated sequence is believed if it is so little ahead: torn and half-erased words
 * state anything. */
enum { BELIEVED_AHEAD = 64 };

static bool newer(uint32_t a, uint32_t b)
{
    return (int32_t)(a - b) > 0;
}

static void read(const settings *s, int sector, uint32_t offset, void *bytes, uint32_t bytes_n)
{
    s->hal->flash_read(s->hal->context, sector, offset, bytes, bytes_n);
}

static bool is_blank(const settings *s, int sector, uint32_t offset, uint32_t bytes_n)
{
    uint8_t piece[SETTINGS_STEP_BYTES];
    for (uint32_t done = 0; done < bytes_n;) {
        const uint32_t left = bytes_n - done;
        const uint32_t n = left < sizeof piece ? left : (uint32_t)sizeof piece;
        read(s, sector, offset + done, piece, n);
        for (uint32_t i = 0; i < n; i++) {
            if (piece[i] != 0xFFu) {
                return false;
            }
        }
        done += n;
    }
    return true;
}

static uint32_t checksum(const settings *s, int sector, uint32_t offset, uint32_t bytes_n)
{
    uint8_t piece[SETTINGS_STEP_BYTES];
    uint32_t crc = CRC32C_START;
    for (uint32_t done = 0; done < bytes_n;) {
        const uint32_t left = bytes_n - done;
        const uint32_t n = left < sizeof piece ? left : (uint32_t)sizeof piece;
        read(s, sector, offset + done, piece, n);
        crc = crc32c_add(crc, piece, n);
        done += n;
    }
    return crc32c_finish(crc);
}

/* Whether a whole record starts at record->offset; fills in the rest of *record as stated there, and
 * *marked, whether one at least pretends to. */
static bool find_record(const settings *s, int sector, settings_record *record, bool *marked)
{
    uint32_t head[SETTINGS_HEAD_WORDS], tail[SETTINGS_TAIL_WORDS];
    const uint32_t room = s->sector_size - record->offset;
    *marked = false;
    if (room < sizeof head + sizeof tail) {
        return false;
    }
    read(s, sector, record->offset, head, sizeof head);
    record->payload_n = head[1];
    record->version = head[2];
    record->sequence = head[3];
    *marked = head[0] == SETTINGS_MARK && record->payload_n > 0 && record->payload_n <= room &&
              settings_record_bytes(record->payload_n) <= room;
    if (!*marked) {
        return false;
    }
    const uint32_t body_n = SETTINGS_HEAD_BYTES + settings_padded(record->payload_n);
    read(s, sector, record->offset + body_n, tail, sizeof tail);
    return tail[1] == SETTINGS_COMMIT && tail[0] == checksum(s, sector, record->offset, body_n);
}

static settings_sector look_through(const settings *s, int sector)
{
    settings_sector found = {0};
    for (uint32_t at = 0; at < s->sector_size;) {
        settings_record record = {.offset = at};
        bool marked;
        if (find_record(s, sector, &record, &marked)) {
            if (found.copies_n == 0 || !newer(found.newest.sequence, record.sequence)) {
                found.newest = record;
            }
            found.copies_n++;
            found.damaged = found.claim_known = false;
            at += settings_on_grid(settings_record_bytes(record.payload_n), SETTINGS_GRID_BYTES);
            found.end = at;
            continue;
        }
        const uint32_t left = s->sector_size - at;
        const uint32_t slot_n = left < SETTINGS_GRID_BYTES ? left : SETTINGS_GRID_BYTES;
        if (!is_blank(s, sector, at, slot_n)) {
            found.damaged = true;
            if (marked && (!found.claim_known || newer(record.sequence, found.claim))) {
                found.claim = record.sequence;
                found.claim_known = true;
            }
            found.end = at + slot_n;
        }
        at += slot_n;
    }
    return found;
}

/* Could what is damaged in the other sector have been saved after the newest whole record? */
static bool other_may_be_newer(const settings *s, uint32_t bytes)
{
    const settings_sector *other = &s->sector[1 - s->active];
    if (!other->damaged) {
        return false;
    }
    if (!settings_has_room(s, s->active, bytes)) {
        return true; /* the next save went there */
    }
    const uint32_t ahead = other->claim - s->sector[s->active].newest.sequence;
    return other->claim_known && ahead >= 1 && ahead <= BELIEVED_AHEAD;
}

static settings_origin origin(const settings *s, uint32_t bytes)
{
    if (s->active < 0) {
        return s->sector[0].end == 0 && s->sector[1].end == 0 ? SETTINGS_NONE : SETTINGS_DAMAGED;
    }
    /* in the newest record's own sector, what comes after it was written after it */
    return s->sector[s->active].damaged || other_may_be_newer(s, bytes) ? SETTINGS_OLDER
                                                                        : SETTINGS_NEWEST;
}

/* The sector to erase now, or -1. */
static int not_needed(const settings *s, uint32_t bytes)
{
    if (s->active >= 0) {
        const int other = 1 - s->active;
        const bool kept_for_fallback =
            s->sector[s->active].copies_n < 2 && settings_has_room(s, s->active, bytes);
        return s->sector[other].end > 0 && !kept_for_fallback ? other : -1;
    }
    /* Nothing whole anywhere. What there is stays, as evidence, while a save has room beside it. */
    const bool room = settings_has_room(s, 0, bytes) || settings_has_room(s, 1, bytes);
    return room ? -1 : 1;
}

settings_error settings_boot(settings *s, const hal *hal, uint32_t payload_max)
{
    memset(s, 0, sizeof *s);
    s->hal = hal;
    s->sector_size = hal->flash_sector_size(hal->context);
    for (int i = 0; i < HAL_FLASH_SECTORS_N; i++) {
        s->sector[i] = look_through(s, i);
    }
    const settings_sector *a = &s->sector[0], *b = &s->sector[1];
    s->active = a->copies_n == 0 && b->copies_n == 0 ? -1 : a->copies_n == 0 ? 1 : 0;
    if (a->copies_n > 0 && b->copies_n > 0 && newer(b->newest.sequence, a->newest.sequence)) {
        s->active = 1;
    }
    const uint32_t bytes = settings_record_bytes(payload_max);
    s->origin = origin(s, bytes);

    const int erase = not_needed(s, bytes);
    if (erase < 0) {
        return SETTINGS_OK;
    }
    s->erased = true;
    const bool done = hal->flash_erase(hal->context, erase);
    s->sector[erase] = look_through(s, erase);
    return done && s->sector[erase].end == 0 ? SETTINGS_OK : SETTINGS_E_FLASH;
}
