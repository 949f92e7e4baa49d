/* params_keys.c - see params_keys.h. */
#include "params_keys.h"

#include <string.h>

#include "params_material.h"

params_key params_key_at(int index)
{
    if (index == PARAMS_KEY_MATERIAL) {
        return (params_key){"material", "",    0.0f,          (float)(MATERIALS_N - 1),
                            1,          false, material_names};
    }
    if (index >= PARAMS_KEY_BLANK) {
        const rod_blank_field *of = &rod_blank_fields[index - PARAMS_KEY_BLANK];
        return (params_key){of->name, of->unit, of->min, of->max, of->values_n, false, NULL};
    }
    const rod_field *of = &rod_fields[index];
    return (params_key){of->name,
                        of->unit,
                        of->min,
                        of->max,
                        of->kind == ROD_FIELD_PER_JOINT ? ROD_MAX_LINKS : 1,
                        of->kind == ROD_FIELD_COUNT_OF,
                        of->kind == ROD_FIELD_CHOICE ? of->choices : NULL};
}

bool params_key_is_settable(int index)
{
    return strcmp(params_key_at(index).name, "tick") != 0;
}

int params_key_find(const char *name)
{
    for (int i = 0; i < PARAMS_KEYS_N; i++) {
        if (params_key_is_settable(i) && strcmp(params_key_at(i).name, name) == 0) {
            return i;
        }
    }
    return -1;
}
