/* texts.c - see texts.h. */
#include "texts.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a person can do about it; "" where the reason says it all. */
static const char *advice(uint8_t reason)
{
    switch (reason) {
    case REASON_STATE:
        return "; limber info tells the state";
    case REASON_LATCHED:
        return "; limber clear";
    case REASON_ESTOP_OPEN:
        return "; release the e-stop, then limber clear";
    case REASON_NO_POSES:
        return "; limber stream sends poses and arms by itself";
    case REASON_POSES_TOO_SLOW:
        return "; limber stream TRACK --resample 100";
    case REASON_NAME:
        return "; limber params list, or limber preset, tells the names";
    case REASON_DISARMED_ONLY:
        return "; limber disarm";
    case REASON_VERSION:
        return "";
    case REASON_SERVO:
        return "; look at the servos' power and bus";
    default:
        return "";
    }
}

static void append(char *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(char *text, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, PORT_WHY_BYTES - used, format, arguments);
    va_end(arguments);
}

void texts_refusal(const message_nack *nack, port_why text)
{
    const char *const meaning = message_value_meaning(&message_values_reasons, nack->reason);
    char value[32], minimum[32], maximum[32];
    *text = '\0';
    append(text, "the device refuses %s", messages_name(nack->answered));
    if (nack->field[0] != '\0') {
        append(text, ": %s", nack->field);
        if (nack->entry >= 0) {
            append(text, "[%d]", nack->entry + 1);
        }
    }
    if (nack->reason == REASON_BOUNDS || nack->reason == REASON_COMBINATION) {
        texts_float(nack->value, value);
        texts_float(nack->minimum, minimum);
        texts_float(nack->maximum, maximum);
        append(text, " = %s, allowed %s ... %s", value, minimum, maximum);
    }
    if (strcmp(meaning, "?") == 0) {
        append(text, ": reason %d, which this limber does not know", nack->reason);
    } else {
        append(text, ": %s", meaning);
    }
    if (nack->text[0] != '\0' && strcmp(nack->text, meaning) != 0) {
        append(text, " (%s)", nack->text);
    }
    append(text, "%s", advice(nack->reason));
}

void texts_flags(const message_values *values, uint32_t flags, char *text, size_t room)
{
    *text = '\0';
    for (int i = 0; i < values->values_n; i++) {
        if ((flags & values->values[i].value) != 0) {
            const size_t used = strlen(text);
            snprintf(text + used, room - used, "%s%s", used == 0 ? "" : ", ",
                     values->values[i].name);
        }
    }
    for (char *c = text; *c != '\0'; c++) {
        *c = (char)(*c == '_' ? ' ' : tolower((unsigned char)*c));
    }
    if (*text == '\0') {
        snprintf(text, room, "none");
    }
}

cJSON *texts_flags_json(const message_values *values, uint32_t flags)
{
    cJSON *list = cJSON_CreateArray();
    for (int i = 0; i < values->values_n; i++) {
        if ((flags & values->values[i].value) != 0) {
            cJSON_AddItemToArray(list, cJSON_CreateString(values->values[i].name));
        }
    }
    return list;
}

void texts_float(float value, char text[32])
{
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, 32, "%.*g", digits, (double)value);
        const float back = strtof(text, NULL);
        if (!(back < value || back > value)) {
            break;
        }
    }
}

cJSON *texts_float_json(float value)
{
    char text[32];
    texts_float(value, text);
    return isfinite(value) ? cJSON_CreateRaw(text) : cJSON_CreateNull();
}

void texts_print_json(cJSON *json)
{
    char *text = cJSON_Print(json);
    if (text != NULL) {
        puts(text);
    }
    cJSON_free(text);
    cJSON_Delete(json);
}
