/* params_write.c - see params_text.h: a rod as an INI file, with what each key means to its model. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "params_text.h"

/* What rod_fields says of a field holds for contour; these are something else to the elastic model. */
static const struct {
    const char *name, *unit, *what;
} IN_ELASTIC[] = {
    {"drag", "N s/m", "resists each node's motion in the world, like air"},
    {"limit", "rad",
     "how far the joint's servo can follow, either side; the rod itself has no stop"},
    {"mass", "kg", "of the node at each link's far end"},
    {"gravity", "m/s^2", "along the world's -z; 0 switches it off"},
};

static int in_elastic(const rod_field *field, int32_t model)
{
    const int n = (int)(sizeof IN_ELASTIC / sizeof IN_ELASTIC[0]);
    for (int i = 0; model == ROD_MODEL_ELASTIC && i < n; i++) {
        if (strcmp(IN_ELASTIC[i].name, field->name) == 0) {
            return i;
        }
    }
    return -1;
}

const char *params_text_unit(const rod_field *field, int32_t model)
{
    const int i = in_elastic(field, model);
    return i < 0 ? field->unit : IN_ELASTIC[i].unit;
}

static const char *what_is(const rod_field *field, int32_t model)
{
    const int i = in_elastic(field, model);
    return i < 0 ? field->what : IN_ELASTIC[i].what;
}

/* The shortest decimal that reads back to the same float. */
static void write_number(float value, FILE *out)
{
    char text[32];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        const float back = strtof(text, NULL);
        if (!(back < value || back > value)) {
            break;
        }
    }
    fputs(text, out);
}

static void write_field(const rod_field *field, const rod_params *params, FILE *out)
{
    const char *const unit = params_text_unit(field, params->model);
    fprintf(out, "\n# %s", what_is(field, params->model));
    if (*field->symbol != '\0') {
        fprintf(out, " (%s%s)", params->model == ROD_MODEL_CONTOUR ? "paper: " : "", field->symbol);
    }
    fprintf(out, "\n");
    if (field->kind == ROD_FIELD_CHOICE) {
        fprintf(out, "# one of:");
        for (int i = 0; i <= (int)field->max; i++) {
            fprintf(out, " %s", field->choices[i]);
        }
        fprintf(out, "\n%s = %s\n", field->name,
                field->choices[(int)rod_field_get(field, params, 0)]);
        return;
    }
    fprintf(out, "# %g ... %g%s%s%s\n%s =", (double)field->min, (double)field->max,
            *unit == '\0' ? "" : " ", unit,
            field->kind == ROD_FIELD_PER_JOINT ? ", one value or one per joint" : "", field->name);
    int values_n = field->kind == ROD_FIELD_PER_JOINT ? params->links_n : 1;
    bool same = true;
    for (int joint = 1; joint < values_n; joint++) {
        same =
            same &&
            !(fabsf(rod_field_get(field, params, joint) - rod_field_get(field, params, 0)) > 0.0f);
    }
    values_n = same ? 1 : values_n;
    for (int joint = 0; joint < values_n; joint++) {
        const bool wrap = joint > 0 && joint % 8 == 0; /* the reader's lines are short */
        fputs(wrap ? "\n    " : " ", out);
        write_number(rod_field_get(field, params, joint), out);
    }
    fprintf(out, "\n");
}

void params_text_write_ini(const rod_params *params, const char *title, FILE *out)
{
    fprintf(out, "# %s\n# Read by: limber-sim replay TRACK --params THIS_FILE\n\n[rod]\n", title);
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        if (params_key_is_settable(i) && rod_field_is_read(&rod_fields[i], params->model)) {
            write_field(&rod_fields[i], params, out);
        }
    }
}
