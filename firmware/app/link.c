/* link.c - see link.h. */
#include "link.h"

#include <string.h>

/* How much of the line must stay free, in eighths, for each class to be sent at all. */
static const uint8_t KEEP_FREE_EIGHTHS[] = {
    [MESSAGE_DROP_LOGS] = 6,   [MESSAGE_DROP_TELEMETRY] = 4, [MESSAGE_DROP_NODES] = 3,
    [MESSAGE_DROP_ANGLES] = 1, [MESSAGE_DROP_KEPT] = 0,
};

void link_init(device_link *l, const hal *hal)
{
    memset(l, 0, sizeof *l);
    l->hal = hal;
    frame_decoder_init(&l->decoder);
}

/* Whole frames only: a reader never sees half of one because the line was full. */
static void send_waiting(device_link *l)
{
    size_t sent = 0;
    while (sent < l->queue_n) {
        const uint8_t *next = l->queue + sent;
        /* a frame ends with the second of its two zeros */
        const uint8_t *end = memchr(next + 1, 0, l->queue_n - sent - 1);
        const size_t frame_n = (size_t)(end - next) + 1;
        if (!l->hal->line_write(l->hal->context, next, frame_n)) {
            break;
        }
        sent += frame_n;
    }
    memmove(l->queue, l->queue + sent, l->queue_n - sent);
    l->queue_n -= sent;
}

void link_begin_tick(device_link *l)
{
    const size_t free_n = l->hal->line_free(l->hal->context);
    l->line_room = free_n > l->line_room ? free_n : l->line_room;
    send_waiting(l);
    l->in_n = l->hal->line_read(l->hal->context, l->in, sizeof l->in);
    l->in_next = 0;
}

bool link_receive(device_link *l, message *m, frame *header)
{
    while (l->in_next < l->in_n) {
        if (!frame_decoder_push(&l->decoder, l->in[l->in_next++], header)) {
            continue;
        }
        const messages_error error = messages_unpack(header, m);
        if (error == MESSAGES_OK) {
            return true;
        }
        l->counts.unknown += error == MESSAGES_E_TYPE;
        l->counts.length += error != MESSAGES_E_TYPE;
    }
    return false;
}

static bool enqueue(device_link *l, const uint8_t *wire, size_t wire_n)
{
    if (l->queue_n + wire_n > sizeof l->queue) {
        l->counts.answers_lost++;
        return false;
    }
    memcpy(l->queue + l->queue_n, wire, wire_n);
    l->queue_n += wire_n;
    return true;
}

bool link_send(device_link *l, const message *m, uint32_t t_us)
{
    uint8_t wire[FRAME_WIRE_MAX];
    const message_info *info = messages_info(m->type);
    const size_t wire_n = messages_encode(m, l->session, l->seq[m->type], t_us, wire, sizeof wire);
    if (info == NULL || wire_n == 0) {
        return false;
    }
    const size_t keep_free = l->line_room * KEEP_FREE_EIGHTHS[info->drop] / 8;
    bool sent = false;
    if (info->drop == MESSAGE_DROP_KEPT) {
        sent = enqueue(l, wire, wire_n);
        send_waiting(l);
    } else if (l->queue_n == 0 && l->hal->line_free(l->hal->context) >= wire_n + keep_free) {
        sent = l->hal->line_write(l->hal->context, wire, wire_n);
    }
    if (sent) {
        l->seq[m->type]++;
    } else if (info->drop != MESSAGE_DROP_KEPT) {
        l->counts.dropped[info->drop]++;
    }
    return sent;
}

void link_text(char *field, size_t room, const char *text)
{
    const size_t length = strlen(text);
    const size_t n = length < room ? length : room - 1;
    memcpy(field, text, n);
    field[n] = '\0';
}

void link_text_add(char *field, size_t room, const char *text)
{
    const size_t used = strlen(field);
    link_text(field + used, room - used, text);
}

void link_text_add_number(char *field, size_t room, uint32_t number)
{
    char digits[11] = "";
    int at = 10;
    do {
        digits[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0);
    link_text_add(field, room, digits + at);
}
