/* vrpn_wire.h - VRPN's TCP protocol as a client reads it: bytes in, poses of one tracker's sensor out.
 *
 *     cookie    24 bytes, once each way: "vrpn: ver. 07.38  0"; the major version must be ours
 *     message   header of 24: u32 length, i32 s, i32 us, i32 sender, i32 type, u32 of no meaning; body. The length
 *               counts the header and the body, not what pads the body to a multiple of 8. Big-endian.
 *     sender -1 (its own type)  what a number stands for: header's sender is the number, body: u32 length, name,
 *     type   -2                 zero; servers tell all of theirs after the cookie, and later ones as they come
 *     "vrpn_Tracker Pos_Quat"   i32 sensor, i32 of no meaning, f64 x y z, f64 qx qy qz qw; m
 *
 * From vrpn_Connection.C (finish_new_connection_setup, getOneTCPMessage, marshall_message, pack_sender_description)
 * and vrpn_Tracker.C (encode_to). A client need say nothing but its cookie. No sockets here, no heap; 64 KB,
 * which is what VRPN itself allows a message.
 */
#ifndef LIMBER_VRPN_WIRE_H
#define LIMBER_VRPN_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "track.h"

enum {
    VRPN_COOKIE_BYTES = 24,
    VRPN_NAME_BYTES = 100, /* with its zero */
    VRPN_OTHERS_BYTES = 200,
};

/* What the client sends once it is connected: VRPN_COOKIE_BYTES. */
extern const char vrpn_wire_cookie[VRPN_COOKIE_BYTES + 1];

typedef struct {
    char tracker[VRPN_NAME_BYTES];
    int32_t sensor;

    bool greeted, sender_known, type_known;
    int32_t sender, type;
    long unreadable, others;             /* messages, of all connections */
    char others_text[VRPN_OTHERS_BYTES]; /* names of other senders, as far as they fit */
    const char *broken;                  /* why nothing more can be understood; NULL: it can */

    uint8_t bytes[65536];
    size_t bytes_n, taken_n;
} vrpn_wire;

/* A new connection; tracker and sensor stay. */
void vrpn_wire_start(vrpn_wire *w);

/* Where the next bytes go, and how many fit: at least one while nothing is broken. */
uint8_t *vrpn_wire_room(vrpn_wire *w, size_t *room);
void vrpn_wire_came(vrpn_wire *w, size_t bytes_n);

/* The next pose that is complete. False: none yet, or broken. */
bool vrpn_wire_next(vrpn_wire *w, track_sample *sample);

#endif
