/* info_command.c - limber info: all that the device tells about itself. */
#include <stdio.h>
#include <string.h>

#include "link_options.h"
#include "scene_requests.h"
#include "stats_request.h"
#include "texts.h"

static const char EXAMPLES[] = "  limber info\n"
                               "  limber info --port pty:build/rod\n"
                               "  limber info --json | jq .state\n";

static void print_boot(const session *s)
{
    const message_boot_report *boot = &s->boot;
    printf("start      %s%s%s; clock %s, %.4g MHz; settings: %s\n",
           message_value_meaning(&message_values_reset_causes, boot->cause),
           boot->fault == FAULT_CODE_NONE ? "" : ", after ",
           boot->fault == FAULT_CODE_NONE ? ""
                                          : message_value_name(&message_values_faults, boot->fault),
           message_value_meaning(&message_values_clock_kinds, boot->clock), boot->clock_hz * 1e-6,
           message_value_meaning(&message_values_settings_origins, boot->settings));
    if (boot->pc != 0 || boot->cfsr != 0) {
        printf("crash      pc 0x%08x, lr 0x%08x, cfsr 0x%08x\n", boot->pc, boot->lr, boot->cfsr);
    }
    if ((boot->flags & BOOT_ESTOP_IGNORED) != 0) {
        printf("e-stop     %s\n",
               message_value_meaning(&message_values_boot_flags, BOOT_ESTOP_IGNORED));
    }
}

static void print_counter(void *context, const char *name, uint32_t value)
{
    (void)context;
    if (value != 0) {
        printf("  %-22s %10u\n", name, value);
    }
}

/* What the device was asked for, beside what it tells by itself. */
typedef struct {
    message_stats stats;
    int objects_n; /* in its scene; -1: it is older than those */
} answers;

static void print_info(const session *s, const answers *a)
{
    const message_hello *device = &s->device;
    const message_heartbeat *beat = &s->heartbeat;
    char flags[200];
    printf("port       %s\n", s->name);
    printf("device     %s %s, protocol %d.%d\n", device->device, device->build,
           device->protocol_major, device->protocol_minor);
    texts_flags(&message_values_features, device->features, flags, sizeof flags);
    printf("features   %s\n", flags);
    printf("rod        %d links of at most %d; tick %g Hz of at most %g; angles at %g Hz\n",
           device->links_n, device->links_max, (double)device->tick_hz, (double)device->tick_max_hz,
           (double)device->angles_hz);
    if (a->objects_n >= 0) {
        printf("scene      %d object%s to touch\n", a->objects_n, a->objects_n == 1 ? "" : "s");
    }
    if (device->line_baud != 0) {
        printf("line       %u baud\n", device->line_baud);
    }
    printf("state      %s: %s\n", session_state_name(s),
           message_value_meaning(&message_values_device_states, beat->state));
    if (beat->fault != FAULT_CODE_NONE) {
        printf("fault      %s: %s\n", message_value_name(&message_values_faults, beat->fault),
               message_value_meaning(&message_values_faults, beat->fault));
    }
    texts_flags(&message_values_heartbeat_flags, beat->flags, flags, sizeof flags);
    printf("flags      %s\n", flags);
    printf("tick       %u us mean, %u us longest\n", beat->tick_mean_us, beat->tick_max_us);
    if (s->boot_known) {
        print_boot(s);
    }
    printf("clock      known to within %d us\n", clock_sync_error_us(&s->clock, limber_now_us()));
    printf("counters since the start (those not 0)\n");
    stats_each(&a->stats, print_counter, NULL);
    print_counter(NULL, "lengths_restored", s->rod_stats.lengths_restored);
}

static void add_counter(void *context, const char *name, uint32_t value)
{
    cJSON_AddNumberToObject(context, name, value);
}

static cJSON *boot_json(const message_boot_report *boot)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "cause",
                            message_value_name(&message_values_reset_causes, boot->cause));
    cJSON_AddStringToObject(json, "fault", message_value_name(&message_values_faults, boot->fault));
    cJSON_AddStringToObject(json, "settings",
                            message_value_name(&message_values_settings_origins, boot->settings));
    cJSON_AddStringToObject(json, "clock",
                            message_value_name(&message_values_clock_kinds, boot->clock));
    cJSON_AddNumberToObject(json, "clock_hz", boot->clock_hz);
    cJSON_AddItemToObject(json, "flags", texts_flags_json(&message_values_boot_flags, boot->flags));
    cJSON_AddNumberToObject(json, "settings_sequence", boot->settings_sequence);
    cJSON_AddNumberToObject(json, "pc", boot->pc);
    cJSON_AddNumberToObject(json, "lr", boot->lr);
    cJSON_AddNumberToObject(json, "cfsr", boot->cfsr);
    return json;
}

static cJSON *info_json(const session *s, const answers *a)
{
    const message_hello *device = &s->device;
    const message_heartbeat *beat = &s->heartbeat;
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "port", s->name);
    cJSON_AddStringToObject(json, "device", device->device);
    cJSON_AddStringToObject(json, "build", device->build);
    char version[16];
    snprintf(version, sizeof version, "%d.%d", device->protocol_major, device->protocol_minor);
    cJSON_AddStringToObject(json, "protocol", version);
    cJSON_AddItemToObject(json, "features",
                          texts_flags_json(&message_values_features, device->features));
    cJSON_AddNumberToObject(json, "links", device->links_n);
    cJSON_AddNumberToObject(json, "links_max", device->links_max);
    cJSON_AddItemToObject(json, "tick_hz", texts_float_json(device->tick_hz));
    cJSON_AddItemToObject(json, "tick_max_hz", texts_float_json(device->tick_max_hz));
    cJSON_AddItemToObject(json, "angles_hz", texts_float_json(device->angles_hz));
    cJSON_AddNumberToObject(json, "line_baud", device->line_baud);
    if (a->objects_n >= 0) {
        cJSON_AddNumberToObject(json, "objects", a->objects_n);
    }
    cJSON_AddStringToObject(json, "state", session_state_name(s));
    cJSON_AddStringToObject(json, "fault", message_value_name(&message_values_faults, beat->fault));
    cJSON_AddItemToObject(json, "flags",
                          texts_flags_json(&message_values_heartbeat_flags, beat->flags));
    cJSON_AddNumberToObject(json, "uptime_ms", beat->uptime_ms);
    cJSON_AddNumberToObject(json, "tick_mean_us", beat->tick_mean_us);
    cJSON_AddNumberToObject(json, "tick_longest_us", beat->tick_max_us);
    cJSON_AddNumberToObject(json, "clock_error_us",
                            clock_sync_error_us(&s->clock, limber_now_us()));
    if (s->boot_known) {
        cJSON_AddItemToObject(json, "boot", boot_json(&s->boot));
    }
    cJSON *counters = cJSON_AddObjectToObject(json, "counters");
    stats_each(&a->stats, add_counter, counters);
    add_counter(counters, "lengths_restored", s->rod_stats.lengths_restored);
    return json;
}

static int tell(link_options *link, session *s)
{
    answers a;
    int result = link_open(link, s);
    if (result == SIM_OK) {
        result = session_wait_for_state(s);
    }
    if (result == SIM_OK) {
        result = stats_request(s, &a.stats);
    }
    if (result == SIM_OK) {
        result = scene_requests_count(s, &a.objects_n);
    }
    if (result == SIM_OK && link->json) {
        texts_print_json(info_json(s, &a));
    } else if (result == SIM_OK) {
        print_info(s, &a);
    }
    return result;
}

int limber_info_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {LINK_PORT_OPTION(&link), LINK_JSON_OPTION(&link),
                                       OPTIONS_END};
    session s = {0};
    bool help;
    argv[0] = "limber info"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    int result = link_take_options(context, "info", EXAMPLES, &help);
    if (result == SIM_OK && !help) {
        result = link_no_more_arguments(context, "info");
    }
    if (result == SIM_OK && !help) {
        result = tell(&link, &s);
    }
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}
