/* graphics.h - the rod for whatever draws it: OSC over UDP, to one address.
 *
 *     /limber/angles ,iiff...    tick, state, then theta and phi of each joint, base first, rad
 *     /limber/nodes  ,iiifff...  tick, first node, nodes of the whole rod, then x y z of each node, m
 *
 * One message in a packet, as the device sends them: ANGLES at angles_rate, NODES at nodes_rate. tick counts the
 * device's ticks, modulo 2^32 as an int32; state is DEVICE_...; an angle that is not known is NaN. Nodes
 * begin with the base; a rod of more than 90 links comes in several messages of one tick. Axes are the rod's: right-
 * handed, z up, from where the base was at first. For Unity: (-x, z, -y). Nobody need be there; what the
 * system refuses to send is counted. By liblo, from one thread, never waiting.
 */
#ifndef LIMBER_GRAPHICS_H
#define LIMBER_GRAPHICS_H

#include <lo/lo.h>
#include <stdint.h>

#include "messages.h"

typedef struct {
    const char *name; /* as given; the caller's */
    lo_address to;
    uint64_t angles_n, nodes_n, unsent_n; /* messages */
} graphics;

/* "osc:HOST:PORT". SIM_OK, or SIM_BAD_INPUT after complaining. Close it with graphics_close in any case. */
int graphics_open(graphics *g, const char *name);
void graphics_close(graphics *g);

/* Sends it; nothing where g is NULL. */
void graphics_angles(graphics *g, const message_angles *angles);
void graphics_nodes(graphics *g, const message_nodes *nodes);

#endif
