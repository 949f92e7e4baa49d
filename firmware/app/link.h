/* link.h - the device's end of the line: bytes in, messages out, and what goes first when it is full.
 *
 * Reads what has arrived, hands over one good message at a time; sends messages with a drop class each
 * (message_list.h): answers and faults wait in a queue until there is room, the rest is dropped and counted
 * when the line is too full for its class: logs first, then telemetry, nodes, angles. Bounded work per tick.
 * Caller-owned, no heap; main loop only. About 5 KB.
 */
#ifndef LIMBER_LINK_H
#define LIMBER_LINK_H

#include "frame.h"
#include "hal.h"
#include "messages.h"

enum {
    LINK_QUEUE_BYTES = 2048,   /* answers that wait for room */
    LINK_READ_MAX_BYTES = 512, /* looked at in one tick: five times what 1 Mbaud brings in 1 ms */
};

typedef struct {
    uint32_t unknown, length;            /* good frames that are no message */
    uint32_t dropped[MESSAGE_DROP_KEPT]; /* by class */
    uint32_t answers_lost;               /* the queue was full: the tool asks again */
} link_counts;

typedef struct {
    const hal *hal;
    frame_decoder decoder;
    uint8_t session;   /* of the last HELLO; goes into every frame sent */
    uint16_t seq[256]; /* next of each message type */
    link_counts counts;
    uint8_t in[LINK_READ_MAX_BYTES];
    size_t in_n, in_next;
    uint8_t queue[LINK_QUEUE_BYTES]; /* whole frames, the oldest first */
    size_t queue_n;
    size_t line_room; /* the most the line has ever had free: its size */
} device_link;

void link_init(device_link *l, const hal *hal);

/* Before the first link_receive of a tick: takes what has arrived and sends what waits. */
void link_begin_tick(device_link *l);

/* The next good message of this tick, with the header it came in. False when there is none left. */
bool link_receive(device_link *l, message *m, frame *header);

/* Send; t_us goes into the header. False if it was dropped. */
bool link_send(device_link *l, const message *m, uint32_t t_us);

/* A text, or one more text or number behind it, into a message's field of that size; cut off where it is too long. */
void link_text(char *field, size_t room, const char *text);
void link_text_add(char *field, size_t room, const char *text);
void link_text_add_number(char *field, size_t room, uint32_t number);

#endif
