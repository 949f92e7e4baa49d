/* tracks_command.c - limber-sim tracks: the motions as files, whole and damaged. */
#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>

#include "motions.h"
#include "options.h"
#include "output.h"
#include "sim.h"

/* What real recordings do to a track; all of it is mended and counted by the reader. */
typedef enum { WHOLE, GAPS, DUPLICATES, FLIPS, STOPS, ZEROS, EUROC } damage;

static const struct {
    const motion *motion;
    damage damage;
    const char *file, *what;
} TRACKS[] = {
    {&motions[0], WHOLE, "circular.txt", NULL},
    {&motions[1], WHOLE, "linear.txt", NULL},
    {&motions[2], WHOLE, "rectangular.txt", NULL},
    {&motions[3], WHOLE, "shaking.txt", NULL},
    {&motions[4], WHOLE, "star.txt", NULL},
    {&motions[3], GAPS, "shaking-gaps.txt", "0.1 s missing at 1.5 s, 0.5 s missing at 3 s"},
    {&motions[3], DUPLICATES, "shaking-duplicates.txt", "every 25th time stamp is repeated"},
    {&motions[3], FLIPS, "shaking-flips.txt", "every 10th quaternion has the other sign"},
    {&motions[4], STOPS, "star-stops.txt", "the hand stops for 0.4 s on every leg"},
    {&motions[4], ZEROS, "star-zeros.txt", "every 20th quaternion is all zeros"},
    {&motions[2], EUROC, "rectangular-euroc.csv", "EuRoC's header: nanoseconds, w before x y z"},
    {&motion_pressing, WHOLE, "pressing.txt", NULL},
};
enum { TRACKS_N = sizeof TRACKS / sizeof TRACKS[0] };

static void write_row(FILE *file, long time_ms, const rod_pose *pose, float sign)
{
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    fprintf(file, "%ld.%03ld %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", time_ms / 1000, time_ms % 1000,
            (double)p.x, (double)p.y, (double)p.z, (double)(sign * q.x), (double)(sign * q.y),
            (double)(sign * q.z), (double)(sign * q.w));
}

static void write_euroc_row(FILE *file, long time_ms, const rod_pose *pose)
{
    const vec3 p = pose->position_m;
    const quat q = pose->orientation;
    fprintf(file, "%lld,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n",
            1400000000000000000LL + 1000000LL * time_ms, (double)p.x, (double)p.y, (double)p.z,
            (double)q.w, (double)q.x, (double)q.y, (double)q.z);
}

static void write_track(FILE *file, const motion *m, damage damage, const char *what)
{
    if (damage == EUROC) {
        fprintf(file, "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
                      "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n");
    } else {
        fprintf(file,
                "# %s: %s%s%s\n# made by limber-sim tracks\n"
                "# timestamp[s] tx ty tz [m] qx qy qz qw (Hamilton, body to world)\n",
                m->name, m->what, what == NULL ? "" : "; ", what == NULL ? "" : what);
    }
    long time_ms = 0;
    for (int i = 0; i < m->samples_n; i++, time_ms += 1000 / MOTION_RATE_HZ) {
        const rod_pose pose = m->pose(i);
        const float sign = damage == FLIPS && i % 10 == 9 ? -1.0f : 1.0f;
        const bool missing = damage == GAPS && ((i > 150 && i < 160) || (i > 300 && i < 350));
        const int leg_n = m->samples_n / 5;
        if (damage == EUROC) {
            write_euroc_row(file, time_ms, &pose);
        } else if (damage == ZEROS && i % 20 == 19) {
            write_row(file, time_ms, &pose, 0.0f);
        } else if (!missing) {
            write_row(file, time_ms, &pose, sign);
        }
        if (damage == DUPLICATES && i % 25 == 24) {
            write_row(file, time_ms, &pose, sign);
        }
        for (int k = 0; damage == STOPS && i % leg_n == leg_n / 2 && k < 40; k++) {
            time_ms += 1000 / MOTION_RATE_HZ;
            write_row(file, time_ms, &pose, sign);
        }
    }
}

static int write_tracks(const char *folder)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return sim_complain("%s: %s", folder, strerror(errno));
    }
    int result = SIM_OK;
    for (int i = 0; i < TRACKS_N && result == SIM_OK; i++) {
        char path[4096];
        if (snprintf(path, sizeof path, "%s/%s", folder, TRACKS[i].file) >= (int)sizeof path) {
            result = sim_complain("%.60s...: the path is too long", folder);
            break;
        }
        output out;
        result = output_open(&out, path);
        if (result == SIM_OK) {
            write_track(out.file, TRACKS[i].motion, TRACKS[i].damage, TRACKS[i].what);
            result = output_close(&out, true);
        }
    }
    result = outputs_finish(result);
    for (int i = 0; i < TRACKS_N && result == SIM_OK; i++) {
        const char *what = TRACKS[i].what == NULL ? TRACKS[i].motion->what : TRACKS[i].what;
        printf("%-28s %s\n", TRACKS[i].file, what);
    }
    return result;
}

static const char EXAMPLES[] = "  limber-sim tracks build/tracks\n"
                               "  limber-sim replay build/tracks/shaking.txt --preset whip\n";

int sim_tracks_command(int argc, const char **argv)
{
    const struct poptOption table[] = {OPTIONS_END};
    argv[0] = "limber-sim tracks"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "FOLDER");
    const int option = options_next(context, "tracks", EXAMPLES);
    int result = option == OPTION_HELP ? SIM_OK : SIM_BAD_INPUT;
    if (option == 0) {
        const char *folder = options_one_argument(context, "tracks", "folder");
        result = folder == NULL ? SIM_BAD_INPUT : write_tracks(folder);
    }
    poptFreeContext(context);
    return result;
}
