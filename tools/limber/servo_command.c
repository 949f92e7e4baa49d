/* servo_command.c - limber servo: scan, id, baud, test; servos are set up one by one with these. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interrupt.h"
#include "link_options.h"
#include "progress.h"
#include "servo_ask.h"
#include "servo_scan.h"

enum { OPTION_BAUD = 1, OPTION_FIRST, OPTION_LAST, OPTION_FROM_BAUD, OPTION_TURN };

enum { BAUD_MIN = 9600, BAUD_MAX = 4500000 };
#define TURN_MAX_RAD 0.5 /* SERVO_TEST allows no more */

static const char EXAMPLES[] =
    "  limber servo scan                    # at the baud rate of the device's servo_baud\n"
    "  limber servo scan --baud all --json\n"
    "  limber servo test 7 --turn -0.3      # by 0.3 rad clockwise, and back\n\n"
    "Smart servos come from the factory with id 1 at 57,600 baud, all of them. With ONE of them on "
    "the bus at a time:\n"
    "  limber servo scan --baud 57600 --last 1\n"
    "  limber servo id 1 7 --baud 57600\n"
    "  limber servo baud 7 1000000 --from-baud 57600\n"
    "  limber servo test 7\n"
    "then tell the device which servo it is to the rod, and keep that:\n"
    "  limber params set servo_kind=bus servo_id[1]=7\n"
    "  limber params save\n\n"
    "The device must be disarmed. Each of these switches the supply of ALL servos on, until 10 s "
    "after the last.\n"
    "Ctrl-C, or limber disarm from elsewhere, ends a test at once and switches the supply off.\n"
    "PWM channels cannot tell whether a servo is there: scan lists them all. A hobby servo that is "
    "tested jumps to the middle of its travel first.\n";

typedef struct {
    link_options link;
    session s;
    unsigned given; /* of the options, 1 << OPTION_... */
    bool all_bauds;
    int baud; /* 0: the device's servo_baud */
    int first_id, last_id;
    double turn_rad;
} servo_command;

static int assign(servo_command *c, const int *numbers)
{
    const message request = {.type = MESSAGE_SERVO_ASSIGN,
                             .servo_assign = {.old_id = (uint8_t)numbers[0],
                                              .new_id = (uint8_t)numbers[1],
                                              .baud = (uint32_t)c->baud}};
    const int result = servo_ask(&c->s, &request, numbers[0]);
    if (result == SIM_OK) {
        printf("servo %d is servo %d now, and stays it without power\n", numbers[0], numbers[1]);
    }
    return result;
}

static int set_baud(servo_command *c, const int *numbers)
{
    const message request = {.type = MESSAGE_SERVO_SET_BAUD,
                             .servo_set_baud = {.id = (uint8_t)numbers[0],
                                                .baud = (uint32_t)c->baud,
                                                .new_baud = (uint32_t)numbers[1]}};
    const int result = servo_ask(&c->s, &request, numbers[0]);
    if (result == SIM_OK) {
        printf("servo %d talks at %d baud now; servo_baud of the device must say the same\n",
               numbers[0], numbers[1]);
    }
    return result;
}

static int test(servo_command *c, const int *numbers)
{
    const message request = {.type = MESSAGE_SERVO_TEST,
                             .servo_test = {.id = (uint8_t)numbers[0],
                                            .baud = (uint32_t)c->baud,
                                            .turn_rad = (float)c->turn_rad}};
    progress_show("servo %d turns by %g rad and back", numbers[0], c->turn_rad);
    const int result = servo_ask(&c->s, &request, numbers[0]);
    progress_clear();
    if (result == SIM_OK) {
        printf("servo %d has turned by %g rad and back\n", numbers[0], c->turn_rad);
    }
    return result;
}

static int look_around(const servo_command *c, session *s)
{
    const servo_scan_options options = {.baud = (uint32_t)c->baud,
                                        .all_bauds = c->all_bauds,
                                        .first_id = c->first_id,
                                        .last_id = c->last_id,
                                        .json = c->link.json != 0};
    return servo_scan(s, &options);
}

typedef enum { SCAN, ID, BAUD, TEST, VERBS_N } verb;
static const struct {
    const char *name, *what;
    int numbers_n;
    int max[2]; /* of its arguments, from 0 */
} VERBS[VERBS_N] = {
    {"scan", "nothing", 0, {0, 0}},
    {"id", "OLD and NEW", 2, {SERVO_ID_LAST, SERVO_ID_LAST}},
    {"baud", "ID and NEW_BAUD", 2, {SERVO_ID_LAST, BAUD_MAX}},
    {"test", "ID", 1, {SERVO_ID_LAST, 0}},
};

/* Options that only one of them knows. */
static const struct {
    int option;
    const char *name;
    verb of;
} OWN_OPTIONS[] = {{OPTION_FIRST, "--first", SCAN},
                   {OPTION_LAST, "--last", SCAN},
                   {OPTION_FROM_BAUD, "--from-baud", BAUD},
                   {OPTION_TURN, "--turn", TEST}};
enum { OWN_OPTIONS_N = sizeof OWN_OPTIONS / sizeof OWN_OPTIONS[0] };

/* link_number, of those without a fraction; from 0 on. */
static int whole_number(const char *title, const char *text, int min, int max, int *value)
{
    double number;
    if (link_number(title, text, min, max, &number) != SIM_OK) {
        return SIM_BAD_INPUT;
    }
    *value = (int)number;
    return number > *value ? sim_complain("%s %.40s: must be a whole number", title, text) : SIM_OK;
}

static int take_arguments(poptContext context, verb *what, int *numbers)
{
    const char *word = poptGetArg(context);
    if (word == NULL) {
        return sim_complain("servo: say what: scan, id, baud or test; try limber servo --help");
    }
    for (*what = SCAN; *what < VERBS_N && strcmp(word, VERBS[*what].name) != 0; ++*what) {
    }
    if (*what == VERBS_N) {
        return sim_complain("servo %.40s: must be scan, id, baud or test", word);
    }
    for (int i = 0; i < VERBS[*what].numbers_n; i++) {
        char title[32];
        word = poptGetArg(context);
        if (word == NULL) {
            return sim_complain("servo %s: needs %s; try limber servo --help", VERBS[*what].name,
                                VERBS[*what].what);
        }
        snprintf(title, sizeof title, "servo %s", VERBS[*what].name);
        if (whole_number(title, word, 0, VERBS[*what].max[i], &numbers[i]) != SIM_OK) {
            return SIM_BAD_INPUT;
        }
    }
    return link_no_more_arguments(context, "servo");
}

static int take_baud(servo_command *c, const char *option, const char *text, bool all_may_be)
{
    c->all_bauds = all_may_be && strcmp(text, "all") == 0;
    return c->all_bauds ? SIM_OK : whole_number(option, text, BAUD_MIN, BAUD_MAX, &c->baud);
}

static int take_option(servo_command *c, int option, const char *text)
{
    c->given |= 1u << option;
    switch (option) {
    case OPTION_BAUD:
        return take_baud(c, "--baud", text, true);
    case OPTION_FROM_BAUD:
        return take_baud(c, "--from-baud", text, false);
    case OPTION_FIRST:
        return whole_number("--first", text, 0, SERVO_ID_LAST, &c->first_id);
    case OPTION_LAST:
        return whole_number("--last", text, 0, SERVO_ID_LAST, &c->last_id);
    default:
        return link_number("--turn", text, -TURN_MAX_RAD, TURN_MAX_RAD, &c->turn_rad);
    }
}

/* Whether what was given belongs to it, and together. */
static int check_options(const servo_command *c, verb what)
{
    const unsigned both = 1u << OPTION_BAUD | 1u << OPTION_FROM_BAUD;
    for (int i = 0; i < OWN_OPTIONS_N; i++) {
        if ((c->given & 1u << OWN_OPTIONS[i].option) != 0 && OWN_OPTIONS[i].of != what) {
            return sim_complain("servo %s: %s is for %s only", VERBS[what].name,
                                OWN_OPTIONS[i].name, VERBS[OWN_OPTIONS[i].of].name);
        }
    }
    if ((c->given & both) == both) {
        return sim_complain("servo baud: --baud and --from-baud say the same; give one of them");
    }
    return what != SCAN && c->all_bauds
               ? sim_complain("servo %s: --baud all is for scan only", VERBS[what].name)
               : SIM_OK;
}

static int act(servo_command *c, poptContext context)
{
    verb what = SCAN;
    int numbers[2];
    int result = take_arguments(context, &what, numbers);
    if (result == SIM_OK) {
        result = check_options(c, what);
    }
    if (result == SIM_OK) {
        result = link_open(&c->link, &c->s);
    }
    if (result == SIM_OK) {
        interrupt_catch(); /* until now there was nothing to stop */
        result = what == SCAN   ? look_around(c, &c->s)
                 : what == ID   ? assign(c, numbers)
                 : what == BAUD ? set_baud(c, numbers)
                                : test(c, numbers);
    }
    return result;
}

static int run(servo_command *c, poptContext context)
{
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "servo", EXAMPLES)) != 0;) {
        if (option == OPTION_HELP) {
            return SIM_OK;
        }
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        char *const text = poptGetOptArg(context);
        result = take_option(c, option, text);
        free(text);
    }
    return result == SIM_OK ? act(c, context) : result;
}

int limber_servo_command(int argc, const char **argv)
{
    servo_command c = {.last_id = SERVO_ID_LAST, .turn_rad = 0.2};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&c.link),
        LINK_JSON_OPTION(&c.link),
        {"baud", 0, POPT_ARG_STRING, NULL, OPTION_BAUD,
         "talk to servos at this rate (the device's servo_baud); scan: or at all of them",
         "BAUD|all"},
        {"from-baud", 0, POPT_ARG_STRING, NULL, OPTION_FROM_BAUD, "baud: the rate until now",
         "BAUD"},
        {"first", 0, POPT_ARG_STRING, NULL, OPTION_FIRST, "scan: from this id (0)", "ID"},
        {"last", 0, POPT_ARG_STRING, NULL, OPTION_LAST, "scan: to this id (252)", "ID"},
        {"turn", 0, POPT_ARG_STRING, NULL, OPTION_TURN, "test: by so much, rad (0.2)", "RAD"},
        OPTIONS_END};
    argv[0] = "limber servo"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "scan | id OLD NEW | baud ID NEW_BAUD | test ID [OPTION...]");
    const int result = run(&c, context);
    poptFreeContext(context);
    link_close(&c.link, &c.s);
    return result;
}
