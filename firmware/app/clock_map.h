/* clock_map.h - when, on the device's clock, did the sender's clock read this?
 *
 * The sender (the PC) stamps its poses with its own microseconds. TIMESYNC exchanges carry two legs, one
 * each way, with the clock of either end at both ends of the leg: that bounds the offset between the
 * clocks by half the delay of the two legs together, and halves it where both took equally long (as NTP
 * does). Either end may ask first; the order of the legs does not matter.
 *
 *   choice   of the last eight exchanges the one with the least delay counts, an older one only if it was
 *            better by the 244 ppm that two clocks may have parted since: queues lengthen a delay, nothing
 *            shortens it
 *   drift    from two such exchanges 32 s or more apart, within +-100 ppm, each later one counting a
 *            quarter; what is left is in the offset
 *   steps    the first eight exchanges move the offset at once, a later one by a quarter of
 *            what it says, and 500 us at most: poses do not jump in time, and luck averages out
 *   jumps    an exchange whose offset cannot be true (further off than half its own delay, half the
 *            map's and 5 ms) is left out; three in a row that agree mean that a clock was set: the third
 *            is believed at once
 *   silence  60 s without an exchange: nothing is known any more
 *
 * Both clocks are uint32 microseconds and wrap at 2^32 (71 min); every difference here is taken modulo
 * that, and the last rule keeps all of them far below half of it. Pure state, caller-owned, no heap, no
 * division in clock_map_to_device; an exchange looks at eight others and divides once. From the main
 * loop, not from interrupts. Integers and float32 only: the same answers on every machine.
 *
 * Measured (tests: clock_map), an exchange a second for four hours, clocks up to 100 ppm apart, legs of
 * 0.2 ms and on top of each a queue of 0 to 4 ms: 0.36 ms rms, 1.4 ms at worst; with no queue, 40 us.
 *
 * Sources: D. Mills, RFC 5905 (clock filter, section 10: minimum delay of eight).
 */
#ifndef LIMBER_CLOCK_MAP_H
#define LIMBER_CLOCK_MAP_H

#include <stdbool.h>
#include <stdint.h>

enum { CLOCK_WINDOW_N = 8 };

/* Longer than this, the two legs together say too little: such an exchange is left out. */
#define CLOCK_DELAY_MAX_US 100000
#define CLOCK_STEP_MAX_US 500
#define CLOCK_JUMP_MIN_US 5000
#define CLOCK_SILENCE_MAX_US 60000000u
#define CLOCK_DRIFT_MAX 100e-6f

/* One exchange: what each clock read, us, as each leg left and as it arrived. */
typedef struct {
    uint32_t device_sent_us, sender_received_us; /* the leg device -> sender */
    uint32_t sender_sent_us, device_received_us; /* the leg sender -> device */
} clock_exchange;

/* What an exchange says: at sender_us the device's clock read sender_us + offset_us. */
typedef struct {
    uint32_t sender_us, offset_us, delay_us;
} clock_sample;

/* Treat the members as private, but for the three counters. */
typedef struct {
    uint32_t used, left_out, jumps; /* exchanges by what became of them; jumps believed */
    bool synced;
    clock_sample window[CLOCK_WINDOW_N];
    int window_n, window_next;
    clock_sample base; /* the map: offset at a moment ... */
    float drift;       /* ... and how much the device's clock gains on the sender's, per us */
    clock_sample far;  /* the earlier exchange that drift is measured against */
    bool far_known, drift_known;
    uint32_t exchanged_us; /* device's clock at the last exchange used */
    int strangers; /* exchanges in a row left out as impossible, and the last one's offset */
    uint32_t stranger_offset_us;
} clock_map;

/* Nothing known, counters at 0. */
void clock_map_init(clock_map *map);

/* Takes one exchange. False: left out (its legs took less than no time or over 100 ms together, or its
 * offset cannot be true), the map is as it was. */
bool clock_map_exchange(clock_map *map, const clock_exchange *exchange);

/* Once a tick, or at least once a minute: forgets what has become too old. */
void clock_map_tick(clock_map *map, uint32_t now_us);

/* The device's clock when the sender's read sender_us (a moment within 35 min of now), into *device_us.
 * False, and *device_us untouched, while nothing is known. */
bool clock_map_to_device(const clock_map *map, uint32_t sender_us, uint32_t *device_us);

#endif
