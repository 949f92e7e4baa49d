/* limber.h - what every part of the PC tool shares: exit codes, commands, the clock.
 *
 * Complaints go through sim_complain and sim_give_up (sim.h), under the name "limber".
 */
#ifndef LIMBER_LIMBER_H
#define LIMBER_LIMBER_H

#include <stdint.h>

#include "sim.h"

/* Beside SIM_OK, SIM_BAD_INPUT and SIM_INTERNAL: a contract for people's scripts. */
enum {
    LIMBER_UNBALANCED = 1,    /* poses were sent that nobody can account for */
    LIMBER_DEVICE = 4,        /* the device is not there, was lost, or refused */
    LIMBER_INTERRUPTED = 130, /* Ctrl-C before the end; the device was disarmed first */
};

/* One line on stderr, as sim_complain; for what the device is to blame for. Returns LIMBER_DEVICE. */
int limber_refuse(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* One line on stderr that is not an error. */
void limber_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A clock that only runs forward, us; its low 32 bits are what goes over the wire. */
uint64_t limber_now_us(void);

/* The commands: argv[0] is the command's own name. Each returns an exit code. */
int limber_ports_command(int argc, const char **argv);
int limber_info_command(int argc, const char **argv);
int limber_stream_command(int argc, const char **argv);
int limber_params_command(int argc, const char **argv);
int limber_preset_command(int argc, const char **argv);
int limber_arm_command(int argc, const char **argv);
int limber_disarm_command(int argc, const char **argv);
int limber_estop_command(int argc, const char **argv);
int limber_clear_command(int argc, const char **argv);
int limber_servo_command(int argc, const char **argv);
int limber_scene_command(int argc, const char **argv);
int limber_shape_command(int argc, const char **argv);
int limber_record_command(int argc, const char **argv);
int limber_latency_command(int argc, const char **argv);
int limber_monitor_command(int argc, const char **argv);

#endif
