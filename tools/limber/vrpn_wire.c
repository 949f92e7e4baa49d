/* vrpn_wire.c - see vrpn_wire.h. */
#include "vrpn_wire.h"

#include <stdio.h>
#include <string.h>

enum { HEADER_BYTES = 24, POSE_BYTES = 64, SENDER_DESCRIPTION = -1, TYPE_DESCRIPTION = -2 };

const char vrpn_wire_cookie[VRPN_COOKIE_BYTES + 1] = "vrpn: ver. 07.38  0";

static const char POSE_TYPE[] = "vrpn_Tracker Pos_Quat";

typedef struct {
    uint32_t length, s, us;
    int32_t sender, type;
} header;

static uint32_t u32_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static double f64_at(const uint8_t *bytes)
{
    const uint64_t bits = (uint64_t)u32_at(bytes) << 32 | u32_at(bytes + 4);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void vrpn_wire_start(vrpn_wire *w)
{
    w->greeted = w->sender_known = w->type_known = false;
    w->bytes_n = w->taken_n = 0;
    w->others_text[0] = '\0';
    w->broken = NULL;
}

uint8_t *vrpn_wire_room(vrpn_wire *w, size_t *room)
{
    w->bytes_n -= w->taken_n;
    memmove(w->bytes, w->bytes + w->taken_n, w->bytes_n);
    w->taken_n = 0;
    *room = sizeof w->bytes - w->bytes_n;
    return w->bytes + w->bytes_n;
}

void vrpn_wire_came(vrpn_wire *w, size_t bytes_n)
{
    w->bytes_n += bytes_n;
}

/* Through the last point of the version all must be the same. */
static bool take_cookie(vrpn_wire *w)
{
    if (w->bytes_n - w->taken_n < VRPN_COOKIE_BYTES) {
        return false;
    }
    if (memcmp(w->bytes + w->taken_n, vrpn_wire_cookie, strlen("vrpn: ver. 07.")) != 0) {
        w->broken = "it does not greet as VRPN 07 does";
        return false;
    }
    w->taken_n += VRPN_COOKIE_BYTES;
    w->greeted = true;
    return true;
}

/* The body of a description as a text; false: it is none. */
static bool read_name(const uint8_t *body, size_t body_n, char name[VRPN_NAME_BYTES])
{
    const size_t name_n = body_n >= 4 ? u32_at(body) : 0; /* with its zero */
    if (name_n < 1 || name_n > VRPN_NAME_BYTES || name_n > body_n - 4 ||
        memchr(body + 4, '\0', name_n) == NULL) {
        return false;
    }
    memcpy(name, body + 4, name_n);
    return true;
}

static void take_sender(vrpn_wire *w, int32_t sender, const char *name)
{
    if (strcmp(name, w->tracker) == 0) {
        w->sender = sender;
        w->sender_known = true;
        return;
    }
    w->sender_known = w->sender_known && w->sender != sender;
    const size_t n = strlen(w->others_text);
    if (strcmp(name, "VRPN Control") != 0 && n + strlen(name) + 3 < sizeof w->others_text) {
        snprintf(w->others_text + n, sizeof w->others_text - n, "%s%s", n > 0 ? ", " : "", name);
    }
}

static void take_description(vrpn_wire *w, const header *h, const uint8_t *body, size_t body_n)
{
    char name[VRPN_NAME_BYTES];
    if (!read_name(body, body_n, name)) {
        w->unreadable++;
    } else if (h->type == SENDER_DESCRIPTION) {
        take_sender(w, h->sender, name);
    } else if (strcmp(name, POSE_TYPE) == 0) {
        w->type = h->sender;
        w->type_known = true;
    } else {
        w->type_known = w->type_known && w->type != h->sender;
    }
}

/* True for a pose of ours. */
static bool take_pose(vrpn_wire *w, const header *h, const uint8_t *body, size_t body_n,
                      track_sample *sample)
{
    if (body_n != POSE_BYTES || h->us >= 1000000) {
        w->unreadable++;
        return false;
    }
    if (!w->sender_known || h->sender != w->sender || (int32_t)u32_at(body) != w->sensor) {
        w->others++;
        return false;
    }
    *sample = (track_sample){.t_s = (double)h->s + (double)h->us * 1e-6};
    for (size_t i = 0; i < 3; i++) {
        sample->position_m[i] = f64_at(body + 8 + 8 * i);
    }
    for (size_t i = 0; i < 4; i++) {
        sample->orientation[i] = f64_at(body + 32 + 8 * i);
    }
    return true;
}

bool vrpn_wire_next(vrpn_wire *w, track_sample *sample)
{
    if (w->broken != NULL || (!w->greeted && !take_cookie(w))) {
        return false;
    }
    while (w->bytes_n - w->taken_n >= HEADER_BYTES) {
        const uint8_t *const bytes = w->bytes + w->taken_n;
        const header h = {u32_at(bytes), u32_at(bytes + 4), u32_at(bytes + 8),
                          (int32_t)u32_at(bytes + 12), (int32_t)u32_at(bytes + 16)};
        if (h.length < HEADER_BYTES || h.length > sizeof w->bytes - 8) {
            w->unreadable++;
            w->broken = "a message of a length that cannot be";
            return false;
        }
        const size_t padded_n = (h.length + 7u) / 8u * 8u, body_n = h.length - HEADER_BYTES;
        if (w->bytes_n - w->taken_n < padded_n) {
            return false;
        }
        w->taken_n += padded_n;
        if (h.type == SENDER_DESCRIPTION || h.type == TYPE_DESCRIPTION) {
            take_description(w, &h, bytes + HEADER_BYTES, body_n);
        } else if (w->type_known && h.type == w->type &&
                   take_pose(w, &h, bytes + HEADER_BYTES, body_n, sample)) {
            return true;
        }
    }
    return false;
}
