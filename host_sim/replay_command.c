/* replay_command.c - limber-sim replay: a track in, summary and files out. */
#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

#include "body_log.h"
#include "output.h"
#include "picture.h"
#include "replay.h"
#include "replay_files.h"
#include "replay_options.h"
#include "report.h"
#include "shape_text.h"
#include "sim.h"
#include "summary.h"

static int write_files(const replay_choices *c, const replay *r)
{
    int result = SIM_OK;
    if (c->angles_path != NULL) {
        result = replay_write_angles(r, c->angles_path);
    }
    if (result == SIM_OK && c->nodes_path != NULL) {
        result = replay_write_nodes(r, c->nodes_path);
    }
    if (result == SIM_OK && c->contacts_path != NULL) {
        result = replay_write_contacts(r, c->contacts_path);
    }
    if (result == SIM_OK && c->capsule_path != NULL) {
        result = replay_write_capsule(r, c->capsule_path);
    }
    if (result == SIM_OK && c->picture_path != NULL) {
        result = picture_write(r, c->picture_path);
    }
    if (result == SIM_OK && c->report_path != NULL) {
        const char *preset = c->params.preset != NULL ? c->params.preset->name : NULL;
        result = report_write(r, preset, c->report_path);
    }
    return result;
}

/* An output that is an input itself would destroy it: a recording, a scene. */
static int spare(const char *input, const char *what, const replay_choices *c)
{
    const char *outputs[] = {c->angles_path, c->nodes_path,   c->contacts_path,
                             c->report_path, c->picture_path, c->capsule_path};
    struct stat of_input, of_output;
    if (input == NULL || stat(input, &of_input) != 0 || !S_ISREG(of_input.st_mode)) {
        return SIM_OK;
    }
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
        if (outputs[i] != NULL && stat(outputs[i], &of_output) == 0 &&
            of_input.st_ino == of_output.st_ino && of_input.st_dev == of_output.st_dev) {
            return sim_complain("%s: is the %s itself; name another file for the output",
                                outputs[i], what);
        }
    }
    return SIM_OK;
}

static int hold_to_hash(const replay_choices *c, uint64_t hash)
{
    if (!c->expect || hash == c->expected_hash) {
        return SIM_OK;
    }
    fprintf(stderr, "limber-sim: the hash differs: %016" PRIx64 ", expected %016" PRIx64 "\n", hash,
            c->expected_hash);
    return SIM_HASH_DIFFERS;
}

static int replay_per_tick(const replay_choices *c)
{
    uint64_t hash;
    const int result = body_log_replay(c->per_tick_path, c->angles_path, &hash);
    return result == SIM_OK ? hold_to_hash(c, hash) : result;
}

/* Everything that stands in files beside the track. */
typedef struct {
    rod_params params;
    scene_text objects;
    rod_joint shape_rad[ROD_MAX_LINKS];
    replay_surroundings around;
} replay_inputs;

static int read_inputs(const replay_choices *c, replay_inputs *in)
{
    *in = (replay_inputs){.around = {.scene_path = c->scene_path,
                                     .shape_name = c->shape,
                                     .shape_strength_nm = (float)c->shape_strength_nm,
                                     .shape_blend_s = (float)c->shape_blend_s}};
    int result = params_text_resolve(&c->params, c->rate_hz, &in->params);
    if (result == SIM_OK && c->scene_path != NULL) {
        result = scene_text_read_ini(c->scene_path, &in->objects);
        in->around.objects = &in->objects;
    }
    if (result == SIM_OK && c->shape != NULL && in->params.model == ROD_MODEL_CONTOUR &&
        in->params.scheme == ROD_SCHEME_PAPER) {
        result = sim_complain("--shape: the paper's scheme takes no shape; leave out scheme=paper");
    }
    if (result == SIM_OK && c->shape != NULL) {
        result = shape_text_read(c->shape, in->params.links_n, in->shape_rad);
        in->around.shape_rad = (const rod_joint *)in->shape_rad;
    }
    return result;
}

static int write_all(const replay_choices *c, const replay *r)
{
    /* files before the summary: what is printed is only what all went well */
    const int result = outputs_finish(write_files(c, r));
    if (result != SIM_OK) {
        return result;
    }
    summary_print(r, c->params.preset != NULL ? c->params.preset->name : NULL, stdout);
    if (c->report_path != NULL) {
        printf("report     %s\n", c->report_path);
    }
    return hold_to_hash(c, r->hash);
}

static int replay_track(const replay_choices *c)
{
    replay_inputs in;
    track source;
    replay r;
    int result = read_inputs(c, &in);
    if (result == SIM_OK) {
        result = spare(c->track_path, "track", c);
    }
    if (result == SIM_OK) {
        result = spare(c->scene_path, "scene", c);
    }
    if (result == SIM_OK) {
        result = spare(c->shape, "shape", c);
    }
    if (result == SIM_OK) {
        result = track_read(c->track_path, &c->track, &source);
    }
    if (result != SIM_OK) {
        return result;
    }
    result = replay_run(&source, &in.params, c->rate_hz, &in.around, &r);
    if (result == SIM_OK) {
        result = write_all(c, &r);
        replay_free(&r);
    }
    track_free(&source);
    return result;
}

int sim_replay_command(int argc, const char **argv)
{
    replay_choices c;
    bool help;
    int result = replay_options_take(argc, argv, &c, &help);
    if (result == SIM_OK && !help) {
        result = c.per_tick_path != NULL ? replay_per_tick(&c) : replay_track(&c);
    }
    replay_options_free(&c);
    return result;
}
