/* scene_text.c - see scene_text.h: files and lines, heads, keys and values. */
#include "scene_text.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "ini_lines.h"
#include "scene_draft.h"
#include "sim.h"

/* --- heads and values ----------------------------------------------------------------------------- */

/* "sphere ball": a kind, and the name that goes with it. */
static int begin(scene_draft *d, const char *origin, const char *kind, const char *name)
{
    *d = (scene_draft){.kind = SCENE_NONE};
    snprintf(d->origin, sizeof d->origin, "%s", origin);
    for (int i = SCENE_NONE + 1; i < SCENE_KINDS_N; i++) {
        if (strcmp(kind, scene_kinds[i]) == 0) {
            d->kind = i;
        }
    }
    if (d->kind == SCENE_NONE) {
        return sim_complain("%s: '%.40s' is no kind of object; there are plane, sphere, capsule "
                            "and box",
                            origin, kind);
    }
    if (strlen(name) >= sizeof d->name) {
        return sim_complain("%s: the name '%.40s...' is longer than %d characters", origin, name,
                            SCENE_NAME_MAX - 1);
    }
    if (strpbrk(name, " \t=,\"") != NULL) {
        return sim_complain("%s: the name '%.40s' must be one word, without = , and quotes", origin,
                            name);
    }
    snprintf(d->name, sizeof d->name, "%s", *name == '\0' ? kind : name);
    return SIM_OK;
}

static int find_key(const scene_draft *d, const char *origin, const char *name)
{
    char names[160] = "";
    for (int i = 0; i < SCENE_KEYS_N; i++) {
        if (!scene_key_is_of(i, d->kind)) {
            continue;
        }
        if (strcmp(scene_keys[i].name, name) == 0) {
            return i;
        }
        strcat(strcat(names, *names == '\0' ? "" : ", "), scene_keys[i].name);
    }
    (void)sim_complain("%s: '%.40s' is no key of a %s; there are %s", origin, name,
                       scene_kinds[d->kind], names);
    return -1;
}

static int take_word(scene_draft *d, const char *origin, int key, const char *word)
{
    const scene_key *const k = &scene_keys[key];
    const double min = k->min, max = k->max;
    char *end;
    const double number = strtod(word, &end);
    if (end == word || *end != '\0') {
        return sim_complain("%s: %s = %.40s: not a number", origin, k->name, word);
    }
    if (!(number >= min && number <= max)) {
        return sim_complain("%s: %s = %.40s: out of bounds, must be %g ... %g%s%s", origin, k->name,
                            word, min, max, *k->unit == '\0' ? "" : " ", k->unit);
    }
    if (d->values_n[key] == k->values_n) {
        return sim_complain("%s: %s takes %d value%s, and there are more", origin, k->name,
                            k->values_n, k->values_n == 1 ? "" : "s");
    }
    d->values[key][d->values_n[key]++] = number;
    return SIM_OK;
}

/* Values separated by commas or blanks; `more` where they go on from the line above. */
static int take_values(scene_draft *d, const char *origin, int key, const char *text, bool more)
{
    if (!more) {
        d->written[key] = true;
        d->values_n[key] = 0;
        snprintf(d->origins[key], sizeof d->origins[key], "%s", origin);
    }
    char *const copy = strdup(text);
    char *rest = copy;
    int result = copy == NULL ? sim_give_up("out of memory") : SIM_OK;
    for (char *word; result == SIM_OK && (word = strsep(&rest, ", \t")) != NULL;) {
        result = *word == '\0' ? SIM_OK : take_word(d, origin, key, word);
    }
    free(copy);
    return result;
}

static int take(scene_draft *d, const char *origin, const char *name, const char *text, bool more)
{
    const int key = find_key(d, origin, name);
    return key < 0 ? SIM_BAD_INPUT : take_values(d, origin, key, text, more);
}

/* --- files and lines ------------------------------------------------------------------------------ */

typedef struct {
    scene_text text;
    bool begun; /* the draft is of a section */
    scene_draft draft;
} file_reading;

static int end_object(file_reading *r)
{
    if (!r->begun) {
        return SIM_OK;
    }
    r->begun = false;
    return scene_draft_finish(&r->draft, &r->text.objects[r->text.objects_n++]);
}

static int begin_object(file_reading *r, const ini_piece *piece)
{
    char head[200];
    snprintf(head, sizeof head, "%s", piece->section);
    char *name = head;
    const char *const kind = strsep(&name, " \t");
    if (r->text.objects_n == SCENE_OBJECTS_MAX) {
        return sim_complain("%s: a scene has at most %d objects, and this is one more",
                            piece->origin, SCENE_OBJECTS_MAX);
    }
    const int result =
        begin(&r->draft, piece->origin, kind, name == NULL ? "" : name + strspn(name, " \t"));
    for (int i = 0; result == SIM_OK && i < r->text.objects_n; i++) {
        if (strcmp(r->text.objects[i].name, r->draft.name) == 0) {
            return sim_complain("%s: there is a '%s' already; give each object a name of its own, "
                                "as in [%s left]",
                                piece->origin, r->draft.name, kind);
        }
    }
    r->begun = result == SIM_OK;
    return result;
}

static int take_piece(void *context, const ini_piece *piece)
{
    file_reading *r = context;
    if (piece->key == NULL) {
        const int result = end_object(r);
        return result == SIM_OK ? begin_object(r, piece) : result;
    }
    if (!r->begun) {
        return sim_complain("%s: '%.40s' stands before any object; begin one, as in [sphere ball]",
                            piece->origin, piece->key);
    }
    return take(&r->draft, piece->origin, piece->key, piece->value, piece->continued);
}

int scene_text_read_ini(const char *path, scene_text *text)
{
    file_reading r = {.begun = false};
    long lines_n;
    int result = ini_lines_read(path, take_piece, &r, &lines_n);
    if (result == SIM_OK) {
        result = end_object(&r);
    }
    if (result == SIM_OK) {
        *text = r.text;
    }
    return result;
}

/* The words of a line that is cut up meanwhile. */
static char *next_word(char **rest)
{
    char *word;
    while ((word = strsep(rest, " \t")) != NULL && *word == '\0') {
    }
    return word;
}

static int read_words(const char *origin, char *words, scene_text_object *object)
{
    scene_draft d;
    const char *const kind = next_word(&words);
    char *word = next_word(&words);
    const bool named = word != NULL && strchr(word, '=') == NULL;
    int result = begin(&d, origin, kind == NULL ? "" : kind, named ? word : "");
    if (named) {
        word = next_word(&words);
    }
    for (; result == SIM_OK && word != NULL; word = next_word(&words)) {
        char *value = word;
        const char *const key = strsep(&value, "=");
        result = value == NULL
                     ? sim_complain("%s: '%.40s': must be key=value, without blanks", origin, word)
                     : take(&d, origin, key, value, false);
    }
    return result == SIM_OK ? scene_draft_finish(&d, object) : result;
}

int scene_text_read_line(const char *origin, const char *line, scene_text_object *object)
{
    char *const words = strdup(line);
    const int result =
        words == NULL ? sim_give_up("out of memory") : read_words(origin, words, object);
    free(words);
    return result;
}

int scene_text_read_place(const char *origin, const char *text, vec3 *place_m)
{
    scene_draft d = {.kind = SCENE_SPHERE};
    int result = take_values(&d, origin, KEY_CENTRE, text, false);
    if (result == SIM_OK && d.values_n[KEY_CENTRE] < 3) {
        result = sim_complain("%s %.40s: must be x,y,z in m", origin, text);
    }
    if (result == SIM_OK) {
        *place_m = scene_vector(d.values[KEY_CENTRE]);
    }
    return result;
}
