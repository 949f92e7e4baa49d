/* sim.c - limber-sim: picks the command. */
#include "sim.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int (*run)(int argc, const char **argv);
    const char *what;
} COMMANDS[] = {
    {"replay", sim_replay_command, "bend a rod along a recorded track; summary, CSV, report, hash"},
    {"device", sim_device_command, "be the board: a device on a PTY or TCP port, in real time"},
    {"servos", sim_servos_command, "be smart servos on a bus, for an emulated board"},
    {"params", sim_params_command, "print a complete, commented parameter file"},
    {"tracks", sim_tracks_command, "write the paper's five motions and damaged variants of them"},
};
enum { COMMANDS_N = sizeof COMMANDS / sizeof COMMANDS[0] };

static void print_help(void)
{
    printf("limber-sim - the rod of the board, on your desk: same sources, same bits\n\n"
           "Usage: limber-sim COMMAND [OPTION...]\n\nCommands:\n");
    for (int i = 0; i < COMMANDS_N; i++) {
        printf("  %-8s %s\n", COMMANDS[i].name, COMMANDS[i].what);
    }
    printf("\n  limber-sim COMMAND --help   tells more, with examples\n"
           "  limber-sim --version\n\n"
           "Exit codes: 0 fine, 1 the hash differs, 2 bad input, 3 internal failure\n");
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        return sim_complain("no command given; try limber-sim --help");
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_help();
        return SIM_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("limber-sim %s\n", SIM_VERSION);
        return SIM_OK;
    }
    for (int i = 0; i < COMMANDS_N; i++) {
        if (strcmp(argv[1], COMMANDS[i].name) == 0) {
            return COMMANDS[i].run(argc - 1, (const char **)argv + 1);
        }
    }
    return sim_complain("unknown command '%s'; try limber-sim --help", argv[1]);
}

int main(int argc, char **argv)
{
    const int result = run(argc, argv);
    if ((fflush(stdout) != 0 || ferror(stdout)) && result != SIM_INTERNAL) {
        return sim_complain("the standard output cannot be written");
    }
    return result;
}
