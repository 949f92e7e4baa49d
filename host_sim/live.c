/* live.c - see live.h. */
#include "live.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dynamixel_x.h"
#include "options.h"
#include "sim.h"

static volatile sig_atomic_t asked_to_stop;

static void stop(int signal_number)
{
    (void)signal_number;
    asked_to_stop = 1;
}

void live_catch_signals(void)
{
    signal(SIGINT, stop);
    signal(SIGTERM, stop);
    signal(SIGPIPE, SIG_IGN);
}

bool live_asked_to_stop(void)
{
    return asked_to_stop != 0;
}

int live_open_line(line *l, const char *title, const char *pty, const char *tcp)
{
    int port = 0;
    const int result = pty != NULL ? line_open_pty(l, pty) : line_open_tcp(l, tcp, &port);
    if (result == SIM_OK && pty != NULL) {
        printf("%spty:%s\n", title, pty);
    } else if (result == SIM_OK) {
        printf("%stcp:127.0.0.1:%d\n", title, port);
    }
    fflush(stdout);
    return result;
}

int live_text(char **to, const char *text)
{
    free(*to);
    *to = strdup(text);
    return SIM_OK;
}

int live_servo_baud(const char *option, const char *text, uint32_t *to)
{
    double baud;
    if (options_number(option, text, 9600.0, 4500000.0, &baud) != SIM_OK) {
        return SIM_BAD_INPUT;
    }
    *to = (uint32_t)baud;
    return dxl_x_baud_code(*to) >= 0 ? SIM_OK
                                     : sim_complain("%s %.40s: smart servos have 9600, 57600, "
                                                    "115200, 1000000, 2000000, 3000000, 4000000 "
                                                    "and 4500000",
                                                    option, text);
}
