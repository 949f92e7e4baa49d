/* flash_fixture.h - two sectors of flash whose power can fail at any word, and blocks of settings to keep
 * in them. */
#ifndef LIMBER_FLASH_FIXTURE_H
#define LIMBER_FLASH_FIXTURE_H

#include <stdio.h>

#include "settings.h"
#include "test_support.h"
#include "unity.h"

enum { FLASH_BYTES = 4096, BLOCK_MAX = 900 };

typedef struct {
    uint8_t bytes[HAL_FLASH_SECTORS_N][FLASH_BYTES];
    int erasures[HAL_FLASH_SECTORS_N];
    int words_left; /* until the power fails, in the middle of a word; -1: never */
    int words;      /* written or tried, erasures too */
    bool dead;
    bool may_erase; /* only during settings_boot */
    bool refuses;   /* reports an error for what is written or erased */
    bool stuck;     /* the word at stuck_at cannot be programmed, and that goes unnoticed */
    uint32_t stuck_at;
    uint32_t seed;      /* of what a torn word becomes */
    size_t written_max; /* bytes by one call */
} flash_chips;

static inline uint32_t *flash_word(flash_chips *f, int sector, uint32_t offset)
{
    return (uint32_t *)(void *)&f->bytes[sector][offset];
}

static inline bool flash_power_fails(flash_chips *f)
{
    f->words++;
    if (f->words_left < 0) {
        return false;
    }
    f->dead = f->words_left == 0;
    f->words_left -= f->dead ? 0 : 1;
    return f->dead;
}

static inline uint32_t flash_size(void *context)
{
    (void)context;
    return FLASH_BYTES;
}

static inline void flash_read(void *context, int sector, uint32_t offset, void *bytes, size_t n)
{
    const flash_chips *f = context;
    TEST_ASSERT_TRUE(offset <= FLASH_BYTES && n <= FLASH_BYTES - offset);
    memcpy(bytes, &f->bytes[sector][offset], n);
}

static inline bool flash_write(void *context, int sector, uint32_t offset, const void *bytes,
                               size_t n)
{
    flash_chips *f = context;
    TEST_ASSERT_TRUE(offset % 4 == 0 && n % 4 == 0 && offset <= FLASH_BYTES &&
                     n <= FLASH_BYTES - offset);
    f->written_max = n > f->written_max ? n : f->written_max;
    for (size_t at = 0; at < n; at += 4) {
        if (f->dead || f->refuses) {
            return false;
        }
        uint32_t value, *word = flash_word(f, sector, offset + (uint32_t)at);
        memcpy(&value, (const uint8_t *)bytes + at, 4);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0xFFFFFFFFu, *word, "written over something");
        if (flash_power_fails(f)) { /* some of the bits to clear are cleared: none, or all, too */
            const uint32_t few = random_bits(&f->seed), fewer = random_bits(&f->seed);
            const int kind = random_below(&f->seed, 4);
            value |= kind == 0   ? few
                     : kind == 1 ? few & fewer
                     : kind == 2 ? few | fewer
                                 : 0xFFFFFFFFu << (few & 31u);
        }
        *word &= f->stuck && offset + at == f->stuck_at ? 0xFFFFFFFFu : value;
    }
    return !f->dead;
}

/* Cut off, an erased sector is anything: erased words, old ones, old ones with bits gone up, noise. */
static inline bool flash_erase(void *context, int sector)
{
    flash_chips *f = context;
    TEST_ASSERT_TRUE_MESSAGE(f->may_erase, "erased while the servos may have power");
    if (f->dead || f->refuses) {
        return false;
    }
    const bool cut = flash_power_fails(f);
    const int erased_of_8 = random_below(&f->seed, 9);
    for (uint32_t at = 0; at < FLASH_BYTES; at += 4) {
        uint32_t *word = flash_word(f, sector, at);
        const int kind = random_below(&f->seed, 8);
        *word = !cut || kind < erased_of_8       ? 0xFFFFFFFFu
                : random_below(&f->seed, 4) == 0 ? *word
                : random_below(&f->seed, 8) == 0 ? random_bits(&f->seed)
                                                 : *word | random_bits(&f->seed);
    }
    f->erasures[sector] += cut ? 0 : 1;
    return !cut;
}

static inline hal flash_hal(flash_chips *f)
{
    return (hal){.context = f,
                 .flash_sector_size = flash_size,
                 .flash_read = flash_read,
                 .flash_write = flash_write,
                 .flash_erase = flash_erase};
}

static inline void flash_blank(flash_chips *f)
{
    memset(f, 0, sizeof *f);
    memset(f->bytes, 0xFF, sizeof f->bytes);
    f->words_left = -1;
    f->seed = 1;
}

/* Power comes back, for good. */
static inline void flash_revive(flash_chips *f)
{
    f->dead = false;
    f->words_left = -1;
}

/* Block number `generation`: its length and every byte follow from that number, runs of blank bytes that
 * look like erased flash included. */
typedef struct {
    uint32_t n;
    uint8_t bytes[BLOCK_MAX];
} block;

static inline block block_of(uint32_t generation)
{
    block b;
    uint32_t seed = generation * 2654435761u + 1u;
    seed = seed == 0 ? 1 : seed;
    b.n = 1 + random_bits(&seed) % BLOCK_MAX;
    int run = 0;
    uint8_t fill = 0;
    for (uint32_t i = 0; i < BLOCK_MAX; i++) {
        if (run-- <= 0) {
            run = random_below(&seed, 300);
            fill = random_below(&seed, 3) == 0 ? 0xFFu : 0u;
        }
        b.bytes[i] = fill == 0xFFu ? fill : (uint8_t)random_bits(&seed);
    }
    return b;
}

static inline settings_error boot(settings *s, const hal *h)
{
    flash_chips *f = h->context;
    f->may_erase = true;
    const settings_error error = settings_boot(s, h, BLOCK_MAX);
    f->may_erase = false;
    return error;
}

static inline settings_error save(settings *s, uint32_t generation)
{
    const block b = block_of(generation);
    return settings_save(s, generation, b.bytes, b.n);
}

/* The generation that loads, or 0; the test fails if it is not that generation to the last byte. */
static inline uint32_t loaded(const settings *s)
{
    uint8_t bytes[BLOCK_MAX];
    uint32_t n = 0, generation = 0;
    const settings_error error = settings_load(s, bytes, sizeof bytes, &n, &generation);
    if (error != SETTINGS_OK) {
        TEST_ASSERT_EQUAL_INT(SETTINGS_E_NONE, error);
        return 0;
    }
    const block b = block_of(generation);
    TEST_ASSERT_EQUAL_UINT32(b.n, n);
    TEST_ASSERT_EQUAL_MEMORY(b.bytes, bytes, n);
    return generation;
}

#endif
