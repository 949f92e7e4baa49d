/* servo_scan.c - see servo_scan.h. */
#include "servo_scan.h"

#include <stdio.h>

#include "progress.h"
#include "servo_ask.h"
#include "texts.h"

/* Those of the smart servos that the device knows; ROBOTIS e-Manual, X series, Baud Rate(8). */
static const uint32_t BAUDS[] = {9600, 57600, 115200, 1000000, 2000000, 3000000, 4000000, 4500000};
enum { BAUDS_N = sizeof BAUDS / sizeof BAUDS[0] };

typedef struct {
    session *s;
    const servo_scan_options *options;
    int found_n;
    bool rate_skipped; /* the board cannot make the one being scanned at */
    bool channels;     /* what was found are PWM channels, which know no rates */
    cJSON *rows;       /* NULL: for people */
} scan;

static void print_row(const scan *c, const message_servo_info *info)
{
    char error[100];
    servo_ask_error_text(info->hardware_error, error, sizeof error);
    if (c->found_n == 0) {
        printf(" id     baud  model  firmware   position  supply  temperature\n");
    }
    printf("%3d  %7u  %5u  %8d  %+.3f rad  %4.1f V  %9.0f C  %s\n", info->id, info->baud,
           info->model, info->firmware, (double)info->position_rad, (double)info->supply_v,
           (double)info->temperature_c, error);
    fflush(stdout);
}

static cJSON *row_json(const message_servo_info *info)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "id", info->id);
    cJSON_AddNumberToObject(json, "baud", info->baud);
    cJSON_AddNumberToObject(json, "model", info->model);
    cJSON_AddNumberToObject(json, "firmware", info->firmware);
    cJSON_AddNumberToObject(json, "hardware_error", info->hardware_error);
    cJSON_AddItemToObject(json, "position_rad", texts_float_json(info->position_rad));
    cJSON_AddItemToObject(json, "supply_v", texts_float_json(info->supply_v));
    cJSON_AddItemToObject(json, "temperature_c", texts_float_json(info->temperature_c));
    return json;
}

static void show(scan *c, const message_servo_info *info)
{
    progress_clear();
    if (c->rows != NULL) {
        cJSON_AddItemToArray(c->rows, row_json(info));
    } else {
        print_row(c, info);
    }
    c->channels = info->baud == 0;
    c->found_n++;
}

/* SERVO_BEYOND: of a rate that the board cannot make, which comes as the value, or of an id that is no PWM channel,
 * and then nobody is there. A rate that the user did not choose is passed over. */
static int beyond(scan *c, uint32_t baud, int id)
{
    const bool is_rate = c->s->answer.nack.value > 0.0f;
    if (is_rate && !c->options->all_bauds) {
        return servo_ask_complain(c->s, id);
    }
    if (is_rate) {
        c->rate_skipped = true;
        limber_note("%u baud: skipped, the board cannot make that rate", baud);
    }
    return SIM_OK;
}

/* One id that has not answered as it should: silent, beyond what the device can do, or worth a line. */
static int not_found(scan *c, uint32_t baud, int id)
{
    const uint8_t reason = c->s->answer.nack.reason;
    port_why text;
    if (!servo_ask_is_about_servo(c->s)) {
        return servo_ask_complain(c->s, id);
    }
    if (reason == REASON_SERVO_BEYOND) {
        return beyond(c, baud, id);
    }
    if (reason != REASON_SERVO_SILENT) {
        servo_ask_describe(c->s, id, text);
        limber_note("%s", text);
    }
    return SIM_OK;
}

static int look_for(scan *c, uint32_t baud, int id)
{
    const message ask = {.type = MESSAGE_SERVO_PING,
                         .servo_ping = {.id = (uint8_t)id, .baud = baud}};
    switch (servo_ask_try(c->s, &ask)) {
    case REQUEST_WAITING:
        return servo_ask_stop(c->s);
    case REQUEST_DONE:
        show(c, &c->s->answer.servo_info);
        return SIM_OK;
    default:
        return not_found(c, baud, id);
    }
}

static int scan_at(scan *c, uint32_t baud)
{
    const servo_scan_options *o = c->options;
    int result = SIM_OK;
    c->rate_skipped = false;
    for (int id = o->first_id; result == SIM_OK && !c->rate_skipped && id <= o->last_id; id++) {
        if (baud == 0) {
            progress_show("id %d of %d, %d found", id, o->last_id, c->found_n);
        } else {
            progress_show("%u baud, id %d of %d, %d found", baud, id, o->last_id, c->found_n);
        }
        result = look_for(c, baud, id);
    }
    progress_clear();
    return result;
}

static int scan_all_bauds(scan *c)
{
    int result = SIM_OK;
    for (int i = 0; result == SIM_OK && !c->channels && i < BAUDS_N; i++) {
        result = scan_at(c, BAUDS[i]);
    }
    return result;
}

int servo_scan(session *s, const servo_scan_options *options)
{
    scan c = {.s = s, .options = options, .rows = options->json ? cJSON_CreateArray() : NULL};
    const int result = options->all_bauds ? scan_all_bauds(&c) : scan_at(&c, options->baud);
    if (c.rows != NULL && (result == SIM_OK || result == LIMBER_INTERRUPTED)) {
        texts_print_json(c.rows);
    } else {
        cJSON_Delete(c.rows);
    }
    return result == SIM_OK && c.found_n == 0
               ? limber_refuse("no servo answers%s; have they power, is the bus connected?",
                               options->all_bauds ? "" : " at this baud rate; try --baud all")
               : result;
}
