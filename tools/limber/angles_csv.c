/* angles_csv.c - see angles_csv.h. */
#include "angles_csv.h"

#include <math.h>

#include "limber.h"

int angles_csv_open(angles_csv *csv, const char *path, double tick_hz)
{
    *csv = (angles_csv){.tick_hz = tick_hz > 0.0 ? tick_hz : 1000.0};
    return path == NULL ? SIM_OK : output_open(&csv->out, path);
}

static void write_header(const angles_csv *csv)
{
    fprintf(csv->out.file, "t");
    for (int joint = 1; joint <= csv->joints_n; joint++) {
        fprintf(csv->out.file, ",theta%d,phi%d", joint, joint);
    }
    fprintf(csv->out.file, "\n");
}

void angles_csv_add(angles_csv *csv, const message_angles *angles)
{
    if (csv->out.file == NULL) {
        return;
    }
    if (!csv->begun) {
        csv->begun = true;
        csv->first_tick = angles->tick;
        csv->joints_n = angles->angles_n;
        write_header(csv);
    }
    if (angles->angles_n != csv->joints_n) {
        if (csv->left_out_n++ == 0) {
            limber_note("%s: the rod has %d joints now, it had %d: the rest is left out",
                        csv->out.path, angles->angles_n, csv->joints_n);
        }
        return;
    }
    fprintf(csv->out.file, "%.9g", (double)(angles->tick - csv->first_tick) / csv->tick_hz);
    for (int joint = 0; joint < csv->joints_n; joint++) {
        for (int i = 0; i < 2; i++) {
            const int tenth_mrad = angles->angles_tenth_mrad[joint][i];
            fprintf(csv->out.file, ",%.9g",
                    tenth_mrad == MESSAGES_ANGLE_INVALID ? (double)NAN : tenth_mrad * 1e-4);
        }
    }
    fprintf(csv->out.file, "\n");
    csv->rows_n++;
}

int angles_csv_close(angles_csv *csv, int result)
{
    if (csv->out.file == NULL) {
        return result;
    }
    const int closed = output_close(&csv->out, csv->rows_n > 0);
    const int finished = outputs_finish(closed);
    return result == SIM_OK ? finished : result;
}
