/* settings.c - loading and saving; see settings.h. The search at boot is in settings_boot.c. */
#include "settings_record.h"

#include <string.h>

const char *settings_error_text(settings_error error)
{
    switch (error) {
    case SETTINGS_BUSY:
        return "the save is under way";
    case SETTINGS_OK:
        return "no error";
    case SETTINGS_E_NONE:
        return "no settings are stored";
    case SETTINGS_E_SIZE:
        return "the settings have no length, or one that does not fit";
    case SETTINGS_E_FULL:
        return "no room to save: restart the device, which makes some, then save again";
    case SETTINGS_E_FLASH:
        return "the flash reported an error";
    case SETTINGS_E_READ_BACK:
        return "the flash does not read back what was written";
    case SETTINGS_E_SAVING:
        return "another save is under way, or none is";
    }
    return "unknown error";
}

const char *settings_origin_text(settings_origin origin)
{
    switch (origin) {
    case SETTINGS_NONE:
        return "never saved: defaults";
    case SETTINGS_NEWEST:
        return "as saved last";
    case SETTINGS_OLDER:
        return "recovered from an older copy: the last save is damaged or was cut off";
    case SETTINGS_DAMAGED:
        return "no stored copy is whole: defaults";
    }
    return "unknown origin";
}

settings_error settings_load(const settings *s, void *payload, uint32_t room, uint32_t *payload_n,
                             uint32_t *version)
{
    if (s->active < 0) {
        return SETTINGS_E_NONE;
    }
    const settings_record *record = &s->sector[s->active].newest;
    if (record->payload_n > room) {
        return SETTINGS_E_SIZE;
    }
    s->hal->flash_read(s->hal->context, s->active, record->offset + SETTINGS_HEAD_BYTES, payload,
                       record->payload_n);
    /* what was copied must be what has a checksum, so it is the copy that is checked */
    uint32_t head[SETTINGS_HEAD_WORDS], tail[SETTINGS_TAIL_WORDS];
    settings_head(record, head);
    const uint32_t zero = 0;
    uint32_t crc = crc32c_add(CRC32C_START, head, sizeof head);
    crc = crc32c_add(crc, payload, record->payload_n);
    crc = crc32c_add(crc, &zero, settings_padded(record->payload_n) - record->payload_n);
    const uint32_t body_n = SETTINGS_HEAD_BYTES + settings_padded(record->payload_n);
    s->hal->flash_read(s->hal->context, s->active, record->offset + body_n, tail, sizeof tail);
    if (tail[0] != crc32c_finish(crc) || tail[1] != SETTINGS_COMMIT) {
        return SETTINGS_E_READ_BACK;
    }
    *payload_n = record->payload_n;
    *version = record->version;
    return SETTINGS_OK;
}

/* The sector to append a record of that many bytes to, or -1. */
static int place(const settings *s, uint32_t bytes)
{
    if (s->active >= 0) {
        if (settings_has_room(s, s->active, bytes)) {
            return s->active;
        }
        /* only a blank one: else older records would lie in the sector of the newest one's successors */
        const int other = 1 - s->active;
        return s->sector[other].end == 0 && settings_has_room(s, other, bytes) ? other : -1;
    }
    const int emptier = s->sector[1].end < s->sector[0].end ? 1 : 0;
    return settings_has_room(s, emptier, bytes) ? emptier : -1;
}

settings_error settings_save_begin(settings *s, uint32_t version, const void *payload,
                                   uint32_t payload_n)
{
    if (s->save.phase != SETTINGS_IDLE) {
        return SETTINGS_E_SAVING;
    }
    if (payload_n == 0 || payload_n > s->sector_size ||
        settings_record_bytes(payload_n) > s->sector_size) {
        return SETTINGS_E_SIZE;
    }
    const int sector = place(s, settings_record_bytes(payload_n));
    if (sector < 0) {
        return SETTINGS_E_FULL;
    }
    s->save.phase = SETTINGS_WRITE;
    s->save.sector = sector;
    s->save.record = (settings_record){
        .offset = s->sector[sector].end,
        .sequence = s->active >= 0 ? s->sector[s->active].newest.sequence + 1u : 1u,
        .version = version,
        .payload_n = payload_n,
    };
    s->save.payload = payload;
    s->save.done = 0;
    s->save.crc = CRC32C_START;
    /* whatever becomes of it, the next save goes behind it */
    s->sector[sector].end +=
        settings_on_grid(settings_record_bytes(payload_n), SETTINGS_GRID_BYTES);
    return SETTINGS_OK;
}

/* Bytes `at` and on of the record without its tail, as many as fit a step; returns how many. */
static uint32_t body_piece(const settings *s, uint32_t at, uint8_t *piece)
{
    const settings_record *record = &s->save.record;
    const uint32_t body_n = SETTINGS_HEAD_BYTES + settings_padded(record->payload_n);
    const uint32_t n = body_n - at < SETTINGS_STEP_BYTES ? body_n - at : SETTINGS_STEP_BYTES;
    uint32_t head[SETTINGS_HEAD_WORDS];
    settings_head(record, head);
    const uint8_t *head_bytes = (const uint8_t *)head;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t byte = at + i, in_payload = byte - SETTINGS_HEAD_BYTES;
        piece[i] = byte < SETTINGS_HEAD_BYTES       ? head_bytes[byte]
                   : in_payload < record->payload_n ? s->save.payload[in_payload]
                                                    : 0;
    }
    return n;
}

static bool write(const settings *s, uint32_t at, const void *bytes, size_t bytes_n)
{
    return s->hal->flash_write(s->hal->context, s->save.sector, s->save.record.offset + at, bytes,
                               bytes_n);
}

static bool reads_back(const settings *s, uint32_t at, const void *bytes, size_t bytes_n)
{
    uint8_t there[SETTINGS_STEP_BYTES];
    s->hal->flash_read(s->hal->context, s->save.sector, s->save.record.offset + at, there, bytes_n);
    return memcmp(there, bytes, bytes_n) == 0;
}

static settings_error step_write(settings *s, uint32_t body_n)
{
    if (s->save.done == body_n) {
        const uint32_t checksum = crc32c_finish(s->save.crc);
        s->save.phase = SETTINGS_READ_BACK;
        s->save.done = 0;
        return write(s, body_n, &checksum, sizeof checksum) ? SETTINGS_BUSY : SETTINGS_E_FLASH;
    }
    uint8_t piece[SETTINGS_STEP_BYTES];
    const uint32_t n = body_piece(s, s->save.done, piece);
    s->save.crc = crc32c_add(s->save.crc, piece, n);
    if (!write(s, s->save.done, piece, n)) {
        return SETTINGS_E_FLASH;
    }
    s->save.done += n;
    return SETTINGS_BUSY;
}

static settings_error step_read_back(settings *s, uint32_t body_n)
{
    if (s->save.done < body_n) {
        uint8_t piece[SETTINGS_STEP_BYTES];
        const uint32_t n = body_piece(s, s->save.done, piece);
        if (!reads_back(s, s->save.done, piece, n)) {
            return SETTINGS_E_READ_BACK;
        }
        s->save.done += n;
        return SETTINGS_BUSY;
    }
    const uint32_t checksum = crc32c_finish(s->save.crc), commit = SETTINGS_COMMIT;
    if (!reads_back(s, body_n, &checksum, sizeof checksum)) {
        return SETTINGS_E_READ_BACK;
    }
    const uint32_t commit_at = body_n + (uint32_t)sizeof checksum;
    if (!write(s, commit_at, &commit, sizeof commit)) {
        return SETTINGS_E_FLASH;
    }
    return reads_back(s, commit_at, &commit, sizeof commit) ? SETTINGS_OK : SETTINGS_E_READ_BACK;
}

settings_error settings_save_step(settings *s)
{
    if (s->save.phase == SETTINGS_IDLE) {
        return SETTINGS_E_SAVING;
    }
    const uint32_t body_n = SETTINGS_HEAD_BYTES + settings_padded(s->save.record.payload_n);
    const settings_error error =
        s->save.phase == SETTINGS_WRITE ? step_write(s, body_n) : step_read_back(s, body_n);
    if (error == SETTINGS_BUSY) {
        return error;
    }
    s->save.phase = SETTINGS_IDLE;
    if (error == SETTINGS_OK) {
        settings_sector *sector = &s->sector[s->save.sector];
        sector->newest = s->save.record;
        sector->copies_n++;
        s->active = s->save.sector;
        s->origin = SETTINGS_NEWEST;
    }
    return error;
}

settings_error settings_save(settings *s, uint32_t version, const void *payload, uint32_t payload_n)
{
    settings_error error = settings_save_begin(s, version, payload, payload_n);
    if (error == SETTINGS_OK) {
        do {
            error = settings_save_step(s);
        } while (error == SETTINGS_BUSY);
    }
    return error;
}
