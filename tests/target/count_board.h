/* count_board.h - a whole device that follows, for counting: its line and its bus are the board's own drivers (uart.h,
 * timebase.h) on registers that are memory, and the servos those of tests/servos. What the hardware does between
 * two ticks is done here.
 */
#ifndef LIMBER_COUNT_BOARD_H
#define LIMBER_COUNT_BOARD_H

#include "device.h"
#include "timebase.h"
#include "uart.h"
#include "watchdog.h"

typedef struct {
    device device;
    uart line, bus;
    timebase clock;
    watchdog watch;
} count_board;
extern count_board counted;

/* Two servos a link on a bus of 4 Mbaud, a pose and ANGLES every tick: from the start until it is ACTIVE. model:
 * ROD_MODEL_... False, and says why, if that is not to be. */
bool count_board_follow(int model, int links_n);

/* From one tick to the next: what was sent has left, the servos have got theirs, and their answers are there. */
void count_board_pass(void);

rod_pose count_board_hand(void);
void count_board_say(const message *m);
void count_board_say_pose(void);
uint32_t count_board_now_us(void);

#endif
