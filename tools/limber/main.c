/* main.c - limber: picks the command. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "limber.h"
#include "progress.h"

static const struct {
    const char *name;
    int (*run)(int argc, const char **argv);
    const char *what;
} COMMANDS[] = {
    {"ports", limber_ports_command, "list the serial ports, and which one a board may hang on"},
    {"info", limber_info_command, "who is there: build, state, limits, counters"},
    {"stream", limber_stream_command,
     "let the rod follow a track, or a live tracker: VRPN, OSC, stdin"},
    {"params", limber_params_command, "list, get, set, save, load, defaults"},
    {"preset", limber_preset_command, "make it a foil, a whip, ...; also while it moves"},
    {"arm", limber_arm_command, "give the servos torque"},
    {"disarm", limber_disarm_command, "take the torque away"},
    {"estop", limber_estop_command, "torque off within one tick, latched"},
    {"clear", limber_clear_command, "leave FAULT or ESTOP for DISARMED"},
    {"servo", limber_servo_command, "find and set up servos, one by one: scan, id, baud, test"},
    {"scene", limber_scene_command,
     "objects that the rod touches: send, show, put, move, remove, clear"},
    {"shape", limber_shape_command, "pull the rod into a shape, or let it go"},
    {"record", limber_record_command, "write the angles that the device sends as CSV"},
    {"monitor", limber_monitor_command, "watch it live: state, rates, limits, angles as bars"},
    {"latency", limber_latency_command, "measure pose -> angles, split into line, solve and reply"},
};
enum { COMMANDS_N = sizeof COMMANDS / sizeof COMMANDS[0] };

int limber_refuse(const char *format, ...)
{
    char line[1000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    progress_clear();
    (void)sim_complain("%s", line);
    return LIMBER_DEVICE;
}

void limber_note(const char *format, ...)
{
    char line[1000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    progress_clear();
    (void)sim_complain("%s", line);
}

uint64_t limber_now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static void print_help(void)
{
    printf("limber - talks to the rod: the board on a serial port, or limber-sim device\n\n"
           "Usage: limber COMMAND [OPTION...]\n\nCommands:\n");
    for (int i = 0; i < COMMANDS_N; i++) {
        printf("  %-8s %s\n", COMMANDS[i].name, COMMANDS[i].what);
    }
    printf("\n  limber COMMAND --help   tells more, with examples\n"
           "  limber --version\n\n"
           "Ports: serial:/dev/ttyUSB0[@BAUD]   pty:PATH   tcp:HOST:PORT\n"
           "Without --port: $LIMBER_PORT, else the only USB serial port there is.\n"
           "Exit codes: 0 fine, 1 poses unaccounted for, 2 bad input, 3 internal failure,\n"
           "            4 device not there, lost or refusing, 130 interrupted (and disarmed)\n");
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        return sim_complain("no command given; try limber --help");
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_help();
        return SIM_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("limber %s\n", SIM_VERSION);
        return SIM_OK;
    }
    for (int i = 0; i < COMMANDS_N; i++) {
        if (strcmp(argv[1], COMMANDS[i].name) == 0) {
            return COMMANDS[i].run(argc - 1, (const char **)argv + 1);
        }
    }
    return sim_complain("unknown command '%s'; try limber --help", argv[1]);
}

int main(int argc, char **argv)
{
    sim_program_name = "limber";
    const int result = run(argc, argv);
    if ((fflush(stdout) != 0 || ferror(stdout)) && result == SIM_OK) {
        return sim_complain("the standard output cannot be written");
    }
    return result;
}
