/* osc_wire.h - one UDP packet of OSC: tracker poses out. liblo takes messages apart; bundles are walked here.
 *
 *     /VMC/Ext/Tra/Pos ,sfffffff   serial, x y z, qx qy qz qw; alone or in bundles, nested or not
 *
 * The times of bundles are not used: VMC's senders write "now". Other addresses are others' business and counted;
 * what is not OSC, or no pose at that address, is unreadable. OSC 1.0, opensoundcontrol.org; VMC protocol,
 * protocol.vmc.info. No sockets here; liblo takes memory for one message at a time.
 */
#ifndef LIMBER_OSC_WIRE_H
#define LIMBER_OSC_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "track.h"

enum { OSC_PACKET_BYTES = 65536, OSC_SERIAL_BYTES = 128 };

typedef struct {
    char serial[OSC_SERIAL_BYTES]; /* of the tracker; empty: the first one heard, from then on */
    long unreadable, others;       /* messages, or what may have been some */

    uint8_t bytes[OSC_PACKET_BYTES];
    size_t bytes_n, taken_n;
} osc_wire;

/* The bytes_n bytes that have been put into w->bytes are the packet. */
void osc_wire_came(osc_wire *w, size_t bytes_n);

/* The next pose in the packet. */
bool osc_wire_next(osc_wire *w, track_sample *sample);

#endif
