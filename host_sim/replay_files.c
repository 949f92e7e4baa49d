/* replay_files.c - see replay_files.h. */
#include "replay_files.h"

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

int replay_write_capsule(const replay *r, const char *path)
{
    output out;
    const int result = output_open(&out, path);
    if (out.file == NULL) {
        return result;
    }
    const capsule_header header = {CAPSULE_MAGIC, (uint32_t)r->ticks_n, r->params};
    fwrite(&header, sizeof header, 1, out.file);
    for (long n = 0; n < r->ticks_n; n++) {
        const capsule_tick tick = {r->ticks[n].restart, r->ticks[n].base};
        fwrite(&tick, sizeof tick, 1, out.file);
    }
    return output_close(&out, true);
}
