/* texts.h - what devices say, in words and in JSON. */
#ifndef LIMBER_TEXTS_H
#define LIMBER_TEXTS_H

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

#include "message_values.h"
#include "messages.h"
#include "port.h"

/* A NACK as one sentence with name, value, bounds, and what to do where there is something to do. */
void texts_refusal(const message_nack *nack, port_why text);

/* Names of all bits that are set, "nodes, settings"; "none". */
void texts_flags(const message_values *values, uint32_t flags, char *text, size_t room);
cJSON *texts_flags_json(const message_values *values, uint32_t flags);

/* The shortest decimal that reads back to the same float. */
void texts_float(float value, char text[32]);

/* As JSON: what is not finite becomes null; a float is written as short as it can be. */
cJSON *texts_float_json(float value);

/* Prints and frees it. */
void texts_print_json(cJSON *json);

#endif
