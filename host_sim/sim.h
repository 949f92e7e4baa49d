/* sim.h - what every part of limber-sim shares: exit codes and the one way to complain.
 *
 * Host only: double, heap and libm are allowed here; nothing of this reaches the board.
 */
#ifndef LIMBER_SIM_H
#define LIMBER_SIM_H

/* A contract for people's CI; README, "Exit codes". */
enum {
    SIM_OK = 0,
    SIM_HASH_DIFFERS = 1,
    SIM_BAD_INPUT = 2,
    SIM_INTERNAL = 3,
};

#define SIM_VERSION "0.1.0"

/* Who complains: "limber-sim"; the PC tool puts its own name here before anything else. */
extern const char *sim_program_name;

/* One line on stderr, "limber-sim: ...", and SIM_BAD_INPUT to return. Says where, why and what to do. */
int sim_complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The same for what is not the user's fault; returns SIM_INTERNAL. */
int sim_give_up(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The commands: argv[0] is the command's own name. Each returns an exit code. */
int sim_replay_command(int argc, const char **argv);
int sim_params_command(int argc, const char **argv);
int sim_tracks_command(int argc, const char **argv);
int sim_device_command(int argc, const char **argv);
int sim_servos_command(int argc, const char **argv);

#endif
