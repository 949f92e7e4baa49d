/* answers.c - see answers.h. */
#include "answers.h"

/* Sends ACK or NACK (reason 0 is an ACK), and keeps it for when the request comes again. */
static void answer(device *d, const message_nack *nack)
{
    message m = {.type = MESSAGE_NACK, .nack = *nack};
    if (nack->reason == 0) {
        m = (message){.type = MESSAGE_ACK, .ack = {nack->request_id, nack->answered}};
    }
    (void)link_send(&d->link, &m, d->now_us);
}

static void keep_answer(device *d, const message_nack *nack)
{
    d->answers[d->answers_next] = *nack;
    d->answers_next = (d->answers_next + 1) % DEVICE_ANSWERS_KEPT_N;
}

void answers_acknowledge(device *d, uint16_t request_id, uint8_t type)
{
    const message_nack ack = {.request_id = request_id, .answered = type};
    keep_answer(d, &ack);
    d->commands_done++;
    answer(d, &ack);
}

void answers_refuse(device *d, uint16_t request_id, uint8_t type, const params_refusal *why)
{
    message_nack nack = {.request_id = request_id,
                         .answered = type,
                         .reason = why->reason,
                         .entry = (int16_t)why->entry,
                         .value = why->value,
                         .minimum = why->min,
                         .maximum = why->max};
    link_text(nack.field, sizeof nack.field, why->field != NULL ? why->field : "");
    link_text(nack.text, sizeof nack.text,
              why->text != NULL ? why->text
                                : message_value_meaning(&message_values_reasons, why->reason));
    keep_answer(d, &nack);
    d->commands_refused++;
    answer(d, &nack);
}

bool answers_repeat(device *d, uint16_t request_id, uint8_t type)
{
    for (int i = 0; i < DEVICE_ANSWERS_KEPT_N; i++) {
        const message_nack *before = &d->answers[i];
        if (before->request_id == request_id && before->answered == type && request_id != 0) {
            d->commands_repeated++;
            answer(d, before);
            return true;
        }
    }
    return false;
}

void answers_refuse_for(device *d, uint16_t request_id, uint8_t type, uint8_t reason,
                        const char *text)
{
    const params_refusal why = {.reason = reason, .entry = -1, .field = "", .text = text};
    answers_refuse(d, request_id, type, &why);
}
