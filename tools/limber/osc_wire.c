/* osc_wire.c - see osc_wire.h. */
#include "osc_wire.h"

#include <lo/lo.h>
#include <string.h>

enum { BUNDLE_BYTES = 16, SIZE_BYTES = 4 };

static const char BUNDLE[8] = "#bundle";
static const char ADDRESS[] = "/VMC/Ext/Tra/Pos";

void osc_wire_came(osc_wire *w, size_t bytes_n)
{
    w->bytes_n = bytes_n;
    w->taken_n = 0;
}

/* liblo aligns its arguments to 4, its union wants 8. */
static double float_of(const lo_arg *argument)
{
    float value;
    memcpy(&value, (const char *)argument, sizeof value);
    return (double)value;
}

/* A pose of our tracker; the first one heard is ours where nobody has chosen. */
static bool take_pose(osc_wire *w, lo_message m, track_sample *sample)
{
    const char *const types = lo_message_get_types(m);
    if (types == NULL || strcmp(types, "sfffffff") != 0) {
        w->unreadable++;
        return false;
    }
    lo_arg **const arguments = lo_message_get_argv(m);
    const char *const serial = (const char *)arguments[0];
    const size_t serial_n = strlen(serial);
    if (serial_n >= sizeof w->serial) {
        w->unreadable++;
        return false;
    }
    if (w->serial[0] == '\0') {
        memcpy(w->serial, serial, serial_n + 1);
    }
    if (strcmp(w->serial, serial) != 0) {
        w->others++;
        return false;
    }
    *sample = (track_sample){.t_s = 0.0};
    for (int i = 0; i < 3; i++) {
        sample->position_m[i] = float_of(arguments[1 + i]);
    }
    for (int i = 0; i < 4; i++) {
        sample->orientation[i] = float_of(arguments[4 + i]);
    }
    return true;
}

static bool take_message(osc_wire *w, uint8_t *bytes, size_t bytes_n, track_sample *sample)
{
    if (bytes_n < sizeof ADDRESS || memcmp(bytes, ADDRESS, sizeof ADDRESS) != 0) {
        const bool is_osc = bytes_n > 0 && bytes[0] == '/' && memchr(bytes, '\0', bytes_n) != NULL;
        w->others += is_osc;
        w->unreadable += !is_osc;
        return false;
    }
    int result;
    const lo_message m = lo_message_deserialise(bytes, bytes_n, &result);
    if (m == NULL) {
        w->unreadable++;
        return false;
    }
    const bool came = take_pose(w, m, sample);
    lo_message_free(m);
    return came;
}

static bool is_bundle(const uint8_t *bytes, size_t bytes_n)
{
    return bytes_n >= BUNDLE_BYTES && memcmp(bytes, BUNDLE, sizeof BUNDLE) == 0;
}

static size_t size_at(const uint8_t *bytes)
{
    return (size_t)bytes[0] << 24 | (size_t)bytes[1] << 16 | (size_t)bytes[2] << 8 | bytes[3];
}

/* A bundle in a bundle begins where its size says that a message would: entering it is passing its head, and
 * after its last element comes the outer one's next. */
bool osc_wire_next(osc_wire *w, track_sample *sample)
{
    if (w->taken_n == 0 && !is_bundle(w->bytes, w->bytes_n)) {
        const size_t bytes_n = w->bytes_n;
        w->taken_n = w->bytes_n = 0;
        return bytes_n > 0 && take_message(w, w->bytes, bytes_n, sample);
    }
    w->taken_n = w->taken_n == 0 ? BUNDLE_BYTES : w->taken_n;
    while (w->bytes_n - w->taken_n >= SIZE_BYTES) {
        const size_t size = size_at(w->bytes + w->taken_n);
        w->taken_n += SIZE_BYTES;
        uint8_t *const element = w->bytes + w->taken_n;
        if (size > w->bytes_n - w->taken_n || size % 4 != 0) {
            break;
        }
        const bool nested = is_bundle(element, size);
        w->taken_n += nested ? BUNDLE_BYTES : size;
        if (!nested && take_message(w, element, size, sample)) {
            return true;
        }
    }
    w->unreadable += w->taken_n < w->bytes_n; /* the rest is cut or lies about its size */
    w->bytes_n = w->taken_n = 0;
    return false;
}
