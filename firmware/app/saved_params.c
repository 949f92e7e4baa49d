/* saved_params.c - see saved_params.h. */
#include "saved_params.h"

#include <string.h>

#include "crc32c.h"

enum { HEAD_BYTES = 8 };

static uint32_t name_hash(const char *name)
{
    return crc32c(name, strlen(name));
}

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        to[i] = (uint8_t)(value >> 8 * i);
    }
}

static uint32_t get_u32(const uint8_t *from)
{
    return (uint32_t)from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 |
           (uint32_t)from[3] << 24;
}

uint32_t saved_params_bytes_max(void)
{
    uint32_t bytes = 0;
    for (int i = 0; i < params_count(); i++) {
        params_info info;
        (void)params_describe(ROD_MAX_LINKS, i, &info);
        bytes += info.flags & PARAM_KEPT ? HEAD_BYTES + 4u * info.entries_n : 0u;
    }
    return bytes;
}

uint32_t saved_params_pack(const params_set *set, uint8_t *bytes)
{
    uint8_t *to = bytes;
    for (int i = 0; i < params_count(); i++) {
        params_info info;
        (void)params_describe(set->rod.links_n, i, &info);
        if ((info.flags & PARAM_KEPT) == 0) {
            continue;
        }
        put_u32(to, name_hash(info.name));
        put_u32(to + 4, info.entries_n);
        to += HEAD_BYTES;
        for (int entry = 0; entry < info.entries_n; entry++, to += 4) {
            const float value = params_get(set, i, entry);
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            put_u32(to, bits);
        }
    }
    return (uint32_t)(to - bytes);
}

static int find_by_hash(uint32_t hash)
{
    for (int i = 0; i < params_count(); i++) {
        params_info info;
        (void)params_describe(1, i, &info);
        if (name_hash(info.name) == hash) {
            return i;
        }
    }
    return -1;
}

void saved_params_unpack(const uint8_t *bytes, uint32_t bytes_n, params_set *set)
{
    uint32_t at = 0;
    while (at + HEAD_BYTES <= bytes_n) {
        const int index = find_by_hash(get_u32(bytes + at));
        const uint32_t entries_n = get_u32(bytes + at + 4);
        at += HEAD_BYTES;
        if (entries_n > (bytes_n - at) / 4u) {
            return;
        }
        for (uint32_t entry = 0; entry < entries_n; entry++, at += 4) {
            const uint32_t bits = get_u32(bytes + at);
            float value;
            memcpy(&value, &bits, sizeof value);
            if (index >= 0) {
                params_put(set, index, (int)entry, value);
            }
        }
    }
}
