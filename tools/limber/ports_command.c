/* ports_command.c - limber ports: the serial ports of this machine, and which one a board may hang on. */
#include <libserialport.h>
#include <stdio.h>
#include <string.h>

#include "link_options.h"
#include "texts.h"

static const char EXAMPLES[] = "  limber ports\n"
                               "  limber ports --json\n"
                               "  limber info --port serial:/dev/ttyACM0\n\n"
                               "A board hangs on a USB port; if there is exactly one of these, no "
                               "command needs --port.\n";

/* Boards and the usual adapters come by USB; built-in ports have nothing to say for themselves. */
static bool may_be_board(const struct sp_port *port)
{
    return sp_get_port_transport(port) == SP_TRANSPORT_USB;
}

static const char *or_empty(const char *text)
{
    return text == NULL ? "" : text;
}

static cJSON *describe(const struct sp_port *port)
{
    cJSON *json = cJSON_CreateObject();
    char name[PORT_PATH_BYTES];
    int vendor = 0, product = 0;
    snprintf(name, sizeof name, "serial:%s", sp_get_port_name(port));
    cJSON_AddStringToObject(json, "port", name);
    cJSON_AddBoolToObject(json, "may_be_board", may_be_board(port));
    cJSON_AddStringToObject(json, "description", or_empty(sp_get_port_description(port)));
    if (may_be_board(port)) {
        cJSON_AddStringToObject(json, "manufacturer", or_empty(sp_get_port_usb_manufacturer(port)));
        cJSON_AddStringToObject(json, "product", or_empty(sp_get_port_usb_product(port)));
        cJSON_AddStringToObject(json, "serial", or_empty(sp_get_port_usb_serial(port)));
        if (sp_get_port_usb_vid_pid(port, &vendor, &product) == SP_OK) {
            cJSON_AddNumberToObject(json, "vendor_id", vendor);
            cJSON_AddNumberToObject(json, "product_id", product);
        }
    }
    return json;
}

static void print_ports(struct sp_port **ports)
{
    int n = 0;
    for (; ports[n] != NULL; n++) {
        int vendor = 0, product = 0;
        printf("serial:%-14s  %s", sp_get_port_name(ports[n]),
               or_empty(sp_get_port_description(ports[n])));
        if (may_be_board(ports[n]) &&
            sp_get_port_usb_vid_pid(ports[n], &vendor, &product) == SP_OK) {
            printf("  USB %04x:%04x %s", (unsigned)vendor, (unsigned)product,
                   or_empty(sp_get_port_usb_serial(ports[n])));
        }
        printf("%s\n", may_be_board(ports[n]) ? "  <- may be a board" : "");
    }
    if (n == 0) {
        printf("no serial port; is the board plugged in? A simulated one: limber-sim device --pty "
               "build/rod\n");
    }
}

static int list(bool json)
{
    struct sp_port **ports = NULL;
    if (sp_list_ports(&ports) != SP_OK) {
        return sim_give_up("the serial ports cannot be listed: error %d", sp_last_error_code());
    }
    if (json) {
        cJSON *all = cJSON_CreateArray();
        for (int i = 0; ports[i] != NULL; i++) {
            cJSON_AddItemToArray(all, describe(ports[i]));
        }
        texts_print_json(all);
    } else {
        print_ports(ports);
    }
    sp_free_port_list(ports);
    return SIM_OK;
}

int port_choose(char *name)
{
    struct sp_port **ports = NULL;
    char found[300] = "";
    int boards_n = 0;
    if (sp_list_ports(&ports) == SP_OK) {
        for (int i = 0; ports[i] != NULL; i++) {
            if (may_be_board(ports[i])) {
                const size_t used = strlen(found);
                snprintf(found + used, sizeof found - used, "%sserial:%s", used == 0 ? "" : ", ",
                         sp_get_port_name(ports[i]));
                boards_n++;
            }
        }
        sp_free_port_list(ports);
    }
    if (boards_n == 1 && strlen(found) < PORT_PATH_BYTES) {
        snprintf(name, PORT_PATH_BYTES, "%.*s", PORT_PATH_BYTES - 1, found);
        return SIM_OK;
    }
    if (boards_n == 0) {
        return limber_refuse("no USB serial port is there; plug the board in, or give --port: "
                             "pty:build/rod for limber-sim device --pty build/rod, or one of "
                             "limber ports");
    }
    return limber_refuse("there are %d ports that may be a board: %s; give one with --port",
                         boards_n, found);
}

int limber_ports_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {LINK_JSON_OPTION(&link), OPTIONS_END};
    bool help;
    argv[0] = "limber ports"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    int result = link_take_options(context, "ports", EXAMPLES, &help);
    if (result == SIM_OK && !help) {
        result = link_no_more_arguments(context, "ports");
    }
    if (result == SIM_OK && !help) {
        result = list(link.json != 0);
    }
    poptFreeContext(context);
    return result;
}
