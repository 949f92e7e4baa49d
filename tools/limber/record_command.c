/* record_command.c - limber record: the angles that the device sends, into a file. */
#include <stdio.h>
#include <stdlib.h>

#include "angles_csv.h"
#include "interrupt.h"
#include "link_options.h"
#include "progress.h"

enum { OPTION_SECONDS = 1, IDLE_US = 100000 };

static const char EXAMPLES[] =
    "  limber record angles.csv --seconds 10\n"
    "  limber record angles.csv              # until Ctrl-C\n"
    "  limber stream hand.txt --angles angles.csv    # while streaming: one program to a port\n"
    "  limber stream hand.txt --poses run.txt        # the poses, as a track for limber-sim "
    "replay\n\n"
    "The file is what limber-sim replay --angles writes: t,theta1,phi1,... in s and rad; here in "
    "steps of 0.1 mrad.\n";

static void listen(void *context, const message *m, const frame *f, uint64_t at_us)
{
    (void)f;
    (void)at_us;
    if (m->type == MESSAGE_ANGLES) {
        angles_csv_add(context, &m->angles);
    }
}

static int record(session *s, angles_csv *csv, const char *path, double seconds)
{
    int result = angles_csv_open(csv, path, (double)s->device.tick_hz);
    if (result != SIM_OK) {
        return result;
    }
    interrupt_catch();
    s->listener = listen;
    s->context = csv;
    const uint64_t start_us = limber_now_us(), most_us = (uint64_t)(seconds * 1e6);
    while (!s->lost && !interrupt_came() && limber_now_us() - start_us < most_us) {
        (void)session_step(s, limber_now_us() + IDLE_US, -1);
        progress_show("%.1f s, %llu angles", (double)(limber_now_us() - start_us) * 1e-6,
                      (unsigned long long)csv->rows_n);
    }
    progress_clear();
    const uint64_t rows_n = csv->rows_n;
    if (s->lost) {
        result = session_complain(s);
    } else if (rows_n == 0) {
        result = limber_refuse("no ANGLES came; limber params get angles_rate tells how often they "
                               "should");
    }
    /* what came before the device was lost is worth keeping */
    const int closed = angles_csv_close(csv, SIM_OK);
    if (rows_n > 0 && closed == SIM_OK) {
        printf("%s: %llu rows\n", path, (unsigned long long)rows_n);
    }
    return result == SIM_OK ? closed : result;
}

static int run(poptContext context, link_options *link, session *s)
{
    double seconds = 1e9; /* until Ctrl-C */
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "record", EXAMPLES)) != 0;) {
        if (option == OPTION_HELP) {
            return SIM_OK;
        }
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        char *const text = poptGetOptArg(context);
        result = link_number("--seconds", text, 0.1, 1e6, &seconds);
        free(text);
    }
    const char *const path =
        result == SIM_OK ? options_one_argument(context, "record", "file to write") : NULL;
    if (path == NULL) {
        return SIM_BAD_INPUT;
    }
    result = link_open(link, s);
    angles_csv csv;
    return result == SIM_OK ? record(s, &csv, path, seconds) : result;
}

int limber_record_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&link),
        {"seconds", 0, POPT_ARG_STRING, NULL, OPTION_SECONDS, "for so long (until Ctrl-C)", "S"},
        OPTIONS_END};
    session s = {0};
    argv[0] = "limber record"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "OUT.csv [OPTION...]");
    const int result = run(context, &link, &s);
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}
