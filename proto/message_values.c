/* message_values.c - see message_values.h. */
#include "message_values.h"

#include <stddef.h>

#define ROW(prefix, name, value, meaning) {value, #name, meaning},
#define ROWS(list, member, flags, title) static const message_value ROWS_##member[] = {list(ROW)};
MESSAGE_VALUES(ROWS)

#define TABLE(list, member, flags, title)                                                          \
    const message_values message_values_##member = {                                               \
        title, flags, (int)(sizeof ROWS_##member / sizeof ROWS_##member[0]), ROWS_##member};
MESSAGE_VALUES(TABLE)

static const message_value *find(const message_values *of, uint8_t value)
{
    for (int i = 0; i < of->values_n; i++) {
        if (of->values[i].value == value) {
            return &of->values[i];
        }
    }
    return NULL;
}

const char *message_value_name(const message_values *of, uint8_t value)
{
    const message_value *const found = find(of, value);
    return found != NULL ? found->name : "?";
}

const char *message_value_meaning(const message_values *of, uint8_t value)
{
    const message_value *const found = find(of, value);
    return found != NULL ? found->meaning : "?";
}
