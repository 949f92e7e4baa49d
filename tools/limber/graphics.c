/* graphics.c - see graphics.h. */
#include "graphics.h"

#include <math.h>
#include <netdb.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

#include "limber.h"
#include "live_source.h"

int graphics_open(graphics *g, const char *name)
{
    char text[LIVE_NAME_BYTES], *host;
    const char *port = NULL;
    *g = (graphics){.name = name};
    if (strncmp(name, "osc:", 4) != 0 || strlen(name) >= sizeof text ||
        !live_source_split(strcpy(text, name + 4), &host, &port) || port == NULL || *host == '\0') {
        return sim_complain("--graphics %.100s: must be osc:HOST:PORT", name);
    }
    struct addrinfo *found = NULL;
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_DGRAM};
    const int failed = getaddrinfo(host, port, &hints, &found);
    if (failed != 0) {
        return sim_complain("--graphics %.100s: %s", name, gai_strerror(failed));
    }
    freeaddrinfo(found); /* liblo looks it up again */
    g->to = lo_address_new(host, port);
    return g->to == NULL ? sim_give_up("out of memory") : SIM_OK;
}

void graphics_close(graphics *g)
{
    if (g->to != NULL) {
        lo_address_free(g->to);
    }
    g->to = NULL;
}

static void send_off(graphics *g, const char *address, lo_message m, uint64_t *sent_n)
{
    if (lo_send_message(g->to, address, m) < 0) {
        g->unsent_n++;
    } else {
        (*sent_n)++;
    }
    lo_message_free(m);
}

void graphics_angles(graphics *g, const message_angles *angles)
{
    lo_message m = g == NULL ? NULL : lo_message_new();
    if (m == NULL) {
        return;
    }
    lo_message_add_int32(m, (int32_t)angles->tick);
    lo_message_add_int32(m, angles->state);
    for (int joint = 0; joint < angles->angles_n; joint++) {
        for (int i = 0; i < 2; i++) {
            const int tenth_mrad = angles->angles_tenth_mrad[joint][i];
            lo_message_add_float(
                m, tenth_mrad == MESSAGES_ANGLE_INVALID ? NAN : (float)tenth_mrad * 1e-4f);
        }
    }
    send_off(g, "/limber/angles", m, &g->angles_n);
}

void graphics_nodes(graphics *g, const message_nodes *nodes)
{
    lo_message m = g == NULL ? NULL : lo_message_new();
    if (m == NULL) {
        return;
    }
    lo_message_add_int32(m, (int32_t)nodes->tick);
    lo_message_add_int32(m, nodes->first_node);
    lo_message_add_int32(m, nodes->rod_nodes_n);
    for (int node = 0; node < nodes->nodes_n; node++) {
        for (int axis = 0; axis < 3; axis++) {
            lo_message_add_float(m, nodes->nodes_m[node][axis]);
        }
    }
    send_off(g, "/limber/nodes", m, &g->nodes_n);
}
