/* settings.h - what outlives a reset: copies of one block of bytes, appended to two sectors of flash.
 *
 * A power cut at any moment leaves the settings of before or of after, never a mixture; and if they are
 * not the newest, or are not there, that is said (settings_origin).
 *
 *     settings_boot(&settings, hal, sizeof block);          // before the servos have power: may erase
 *     settings_load(&settings, &block, sizeof block, &n, &version);
 *     ...                                                   // DISARMED only:
 *     settings_save_begin(&settings, VERSION, &block, sizeof block);
 *     while (settings_save_step(&settings) == SETTINGS_BUSY) // one step a tick
 *
 * A record starts at a multiple of 256 bytes of its sector. 32-bit words, low byte first:
 *
 *     mark "LMBR" · payload's bytes · payload's version · sequence · payload, filled up with 0 to a word
 *     · CRC-32C of all before · commit word
 *
 * The commit word is written last, after all else has been read back. A record counts if mark, length, CRC
 * and commit are right; that with the highest sequence is the newest.
 *
 * Saving never erases (an erase stalls code in flash for 1 to 2 s): it appends behind everything that is
 * not blank, torn pieces included, and goes on in the other sector when this one is full and that
 * one blank. settings_boot erases the other one as soon as it is not needed: once this one holds two
 * whole copies, so that there is always an older one to fall back on, or has no room. A half-erased
 * sector counts as not blank and is erased again. What cannot be seen: bits that an interrupted erase or
 * write left weak, so that they read right now and not later; the CRC finds them when they turn.
 *
 * Cost: booting reads both sectors whole, about 15 instructions a byte; a step of saving writes or reads
 * back SETTINGS_STEP_BYTES, 16 words of 16 us on an STM32F4. 128 KB hold 46 records of 64 joints (2.5
 * KB), and F405 flash endures 10,000 erasures. Caller-owned, no heap, main loop only.
 */
#ifndef LIMBER_SETTINGS_H
#define LIMBER_SETTINGS_H

#include "hal.h"

typedef enum {
    SETTINGS_BUSY = 1,
    SETTINGS_OK = 0,
    SETTINGS_E_NONE = -1,
    SETTINGS_E_SIZE = -2,
    SETTINGS_E_FULL = -3,
    SETTINGS_E_FLASH = -4,
    SETTINGS_E_READ_BACK = -5,
    SETTINGS_E_SAVING = -6,
} settings_error;

/* One clear sentence for each error; never NULL. */
const char *settings_error_text(settings_error error);

typedef enum {
    SETTINGS_NONE,   /* both sectors blank: never saved */
    SETTINGS_NEWEST, /* what was saved last */
    SETTINGS_OLDER, /* recovered from an older copy: what was saved after it is damaged or unfinished */
    SETTINGS_DAMAGED, /* something was saved, or begun, but no copy is whole: defaults must be used */
} settings_origin;

/* Half a sentence for people; never NULL. */
const char *settings_origin_text(settings_origin origin);

enum { SETTINGS_GRID_BYTES = 256, SETTINGS_STEP_BYTES = 64 };

/* Where a whole record lies. */
typedef struct {
    uint32_t offset, sequence, version, payload_n;
} settings_record;

/* What a sector holds. Private. */
typedef struct {
    uint32_t end;           /* all from here on is blank; a multiple of the grid */
    int copies_n;           /* whole records */
    settings_record newest; /* if copies_n > 0 */
    bool damaged;           /* after the last whole record there is something else */
    bool claim_known;
    uint32_t claim; /* the highest sequence that a damaged record states */
} settings_sector;

/* Treat the members as private, but for origin and erased. */
typedef struct {
    const hal *hal;
    settings_origin origin; /* as booted; NEWEST again after a save */
    bool erased;            /* settings_boot erased a sector */
    uint32_t sector_size;
    int active; /* the sector of the newest record, or -1 */
    settings_sector sector[HAL_FLASH_SECTORS_N];
    struct { /* a save under way */
        enum { SETTINGS_IDLE, SETTINGS_WRITE, SETTINGS_READ_BACK } phase;
        int sector;
        settings_record record;
        const uint8_t *payload;
        uint32_t done; /* bytes of the record, in this phase */
        uint32_t crc;
    } save;
} settings;

/* Looks through both sectors, chooses the newest whole record and erases what is not needed (see above).
 * payload_max is the largest block that will be saved: it decides what counts as full. The hal must
 * outlive *s. Returns SETTINGS_E_FLASH if erasing failed; loading works all the same. Takes 30 ms, or
 * about 2 s if it erases. */
settings_error settings_boot(settings *s, const hal *hal, uint32_t payload_max);

/* The newest whole copy into *payload, its length and its version. SETTINGS_E_NONE: origin tells why;
 * SETTINGS_E_SIZE: longer than room; SETTINGS_E_READ_BACK: the flash reads other than at boot. On an
 * error *payload may hold anything. */
settings_error settings_load(const settings *s, void *payload, uint32_t room, uint32_t *payload_n,
                             uint32_t *version);

/* Starts a save. *payload must not change until the last step. SETTINGS_E_FULL: neither sector has room,
 * restart to have one erased; SETTINGS_E_SIZE: 0 bytes or more than a sector takes. */
settings_error settings_save_begin(settings *s, uint32_t version, const void *payload,
                                   uint32_t payload_n);

/* The next piece: SETTINGS_BUSY until all is written, read back and committed, then SETTINGS_OK. After
 * an error the settings of before are still there and the save is over. */
settings_error settings_save_step(settings *s);

/* Begin and all steps at once: for tools and tests, and where nothing else waits. */
settings_error settings_save(settings *s, uint32_t version, const void *payload,
                             uint32_t payload_n);

#endif
