/* replay_files.c - see replay_files.h. */
#include "replay_files.h"

#include <string.h>

#include "capsule.h"
#include "output.h"

int replay_write_angles(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    fprintf(out.file, "t");
    for (int joint = 1; joint <= r->params.links_n; joint++) {
        fprintf(out.file, ",theta%d,phi%d", joint, joint);
    }
    for (long n = 0; n < r->ticks_n; n++) {
        const float *angles = replay_angles(r, n);
        fprintf(out.file, "\n%.9g", (double)n / r->rate_hz);
        for (int i = 0; i < 2 * r->params.links_n; i++) {
            fprintf(out.file, ",%.9g", (double)angles[i]);
        }
    }
    fprintf(out.file, "\n");
    return output_close(&out, true);
}

int replay_write_nodes(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    fprintf(out.file, "t");
    for (int node = 0; node <= r->params.links_n; node++) {
        fprintf(out.file, ",x%d,y%d,z%d", node, node, node);
    }
    for (long n = 0; n < r->ticks_n; n++) {
        double nodes_m[ROD_MAX_LINKS + 1][3];
        replay_nodes(r, n, nodes_m);
        fprintf(out.file, "\n%.9g", (double)n / r->rate_hz);
        for (int node = 0; node <= r->params.links_n; node++) {
            fprintf(out.file, ",%.9g,%.9g,%.9g", nodes_m[node][0], nodes_m[node][1],
                    nodes_m[node][2]);
        }
    }
    fprintf(out.file, "\n");
    return output_close(&out, true);
}

int replay_write_contacts(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    fprintf(out.file, "t,node,object,name,fx,fy,fz\n");
    for (long n = 0; n < r->ticks_n; n++) {
        int contacts_n;
        const touch_contact *const contacts = replay_contacts(r, n, &contacts_n);
        for (int i = 0; i < contacts_n; i++) {
            const vec3 force = contacts[i].force_newton;
            fprintf(out.file, "%.9g,%d,%d,%s,%.9g,%.9g,%.9g\n", (double)n / r->rate_hz,
                    contacts[i].node, contacts[i].object + 1,
                    r->around.objects->objects[contacts[i].object].name, (double)force.x,
                    (double)force.y, (double)force.z);
        }
    }
    return output_close(&out, true);
}

int replay_write_capsule(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    capsule_header header = {.magic = CAPSULE_MAGIC,
                             .ticks_n = (uint32_t)r->ticks_n,
                             .params = r->params,
                             .shape_strength_nm = r->around.shape_strength_nm,
                             .shape_blend_s = r->around.shape_blend_s};
    for (int i = 0; r->around.objects != NULL && i < r->around.objects->objects_n; i++) {
        header.object[i] =
            r->around.objects->objects[i].object; /* not turned to unit length twice */
        header.object[i].place_m = r->objects.body[i].object.place_m;
    }
    if (r->around.shape_rad != NULL) {
        memcpy(header.shape_rad, r->around.shape_rad,
               (size_t)r->params.links_n * sizeof *header.shape_rad);
    }
    fwrite(&header, sizeof header, 1, out.file);
    for (long n = 0; n < r->ticks_n; n++) {
        const capsule_tick tick = {r->ticks[n].restart, r->ticks[n].base};
        fwrite(&tick, sizeof tick, 1, out.file);
    }
    return output_close(&out, true);
}
