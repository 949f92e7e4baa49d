/* report.c - see report.h: puts the data into the page of report_page/. */
#include "report.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "params_text.h"
#include "report_parts.h"
#include "sim.h"
#include "summary.h"

/* report_page/report_page.S */
extern const char report_page_html[], report_page_html_end[];
extern const char report_style_css[], report_style_css_end[];
extern const char report_script_js[], report_script_js_end[];
extern const char report_chart_js[], report_chart_js_end[];

static const long FRAMES_MAX = 3000;

static void append_angles(float_list *list, const replay *r, long tick)
{
    const float *angles = replay_angles(r, tick);
    for (int i = 0; i < 2 * r->params.links_n; i++) {
        float_list_append(list, angles[i]);
    }
}

static void append_nodes(float_list *list, const replay *r, long tick)
{
    double nodes_m[ROD_MAX_LINKS + 1][3];
    replay_nodes(r, tick, nodes_m);
    for (int i = 0; i <= r->params.links_n; i++) {
        for (int axis = 0; axis < 3; axis++) {
            float_list_append(list, (float)nodes_m[i][axis]);
        }
    }
}

static void append_attitude(float_list *list, const replay *r, long tick)
{
    const quat q = r->ticks[tick].base.orientation;
    float_list_append(list, q.x);
    float_list_append(list, q.y);
    float_list_append(list, q.z);
    float_list_append(list, q.w);
}

static void add_frames(cJSON *page, const char *name, const replay *r, long frame_step,
                       int values_n, void (*append_frame)(float_list *, const replay *, long))
{
    const size_t frames_n = (size_t)((r->ticks_n - 1) / frame_step + 1);
    float_list list = float_list_for(frames_n * (size_t)values_n);
    for (long tick = 0; tick < r->ticks_n; tick += frame_step) {
        append_frame(&list, r, tick);
    }
    float_list_add_to(page, name, &list);
}

static void add_parameters(cJSON *page, const rod_params *params)
{
    cJSON *list = cJSON_AddArrayToObject(page, "parameters");
    for (int i = 0; i < ROD_FIELDS_N; i++) {
        const rod_field *field = &rod_fields[i];
        if (!rod_field_is_read(field, params->model)) {
            continue;
        }
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddItemToArray(list, entry);
        cJSON_AddStringToObject(entry, "name", field->name);
        cJSON_AddStringToObject(entry, "symbol", field->symbol);
        cJSON_AddStringToObject(entry, "unit", params_text_unit(field, params->model));
        cJSON *values = cJSON_AddArrayToObject(entry, "values");
        const int values_n = field->kind == ROD_FIELD_PER_JOINT ? params->links_n : 1;
        for (int joint = 0; joint < values_n; joint++) {
            const float value = rod_field_get(field, params, joint);
            cJSON_AddItemToArray(values, field->kind == ROD_FIELD_CHOICE
                                             ? cJSON_CreateString(field->choices[(int)value])
                                             : cJSON_CreateNumber((double)value));
        }
    }
}

static void add_summary(cJSON *page, const replay *r, const char *preset)
{
    summary s;
    summary_make(r, preset, &s);
    cJSON *rows = cJSON_AddArrayToObject(page, "summary");
    for (int i = 0; i < s.rows_n; i++) {
        const char *row[] = {s.labels[i], s.values[i]};
        cJSON_AddItemToArray(rows, cJSON_CreateStringArray(row, 2));
    }
    cJSON *warnings = cJSON_AddArrayToObject(page, "warnings");
    for (int i = 0; i < s.warnings_n; i++) {
        cJSON_AddItemToArray(warnings, cJSON_CreateString(s.warnings[i]));
    }
}

static void add_joints(cJSON *page, const replay *r)
{
    cJSON *list = cJSON_AddArrayToObject(page, "joints");
    for (int i = 0; i < r->params.links_n; i++) {
        const replay_joint *j = &r->joints[i];
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddItemToArray(list, entry);
        cJSON_AddNumberToObject(entry, "peak_theta_rad", j->peak_rad[0]);
        cJSON_AddNumberToObject(entry, "peak_phi_rad", j->peak_rad[1]);
        cJSON_AddNumberToObject(entry, "rms_theta_rad", j->rms_rad[0]);
        cJSON_AddNumberToObject(entry, "rms_phi_rad", j->rms_rad[1]);
        cJSON_AddItemToObject(entry, "lag_deg",
                              j->lag_known ? cJSON_CreateNumber(j->lag_deg) : cJSON_CreateNull());
        cJSON_AddNumberToObject(entry, "limit_share", j->limit_share);
    }
}

static cJSON *make_page(const replay *r, const char *preset)
{
    const rod_params *p = &r->params;
    const long frame_step = (r->ticks_n - 1) / FRAMES_MAX + 1;
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, r->hash);

    cJSON *page = cJSON_CreateObject();
    cJSON_AddStringToObject(page, "program", "limber-sim " SIM_VERSION);
    cJSON_AddStringToObject(page, "track", r->source->path);
    cJSON_AddStringToObject(page, "model", rod_field_find("model")->choices[p->model]);
    if (p->model == ROD_MODEL_ELASTIC) {
        cJSON_AddNumberToObject(page, "first_mode_hz", (double)rod_params_first_mode_hz(p));
    } else {
        cJSON_AddStringToObject(page, "scheme", rod_field_find("scheme")->choices[p->scheme]);
    }
    cJSON_AddItemToObject(page, "preset",
                          preset != NULL ? cJSON_CreateString(preset) : cJSON_CreateNull());
    cJSON_AddNumberToObject(page, "rate_hz", r->rate_hz);
    cJSON_AddNumberToObject(page, "steps", (double)r->ticks_n);
    cJSON_AddNumberToObject(page, "links", p->links_n);
    cJSON_AddStringToObject(page, "hash", hash);
    add_parameters(page, p);
    add_summary(page, r, preset);
    add_joints(page, r);
    cJSON_AddNumberToObject(page, "frame_step", (double)frame_step);
    cJSON_AddNumberToObject(page, "frames", (double)((r->ticks_n - 1) / frame_step + 1));
    cJSON_AddNumberToObject(page, "frame_dt_s", (double)frame_step / r->rate_hz);
    cJSON_AddStringToObject(page, "up", "z");
    add_frames(page, "angles", r, frame_step, 2 * p->links_n, append_angles);
    add_frames(page, "nodes", r, frame_step, 3 * (p->links_n + 1), append_nodes);
    add_frames(page, "base_q", r, frame_step, 4, append_attitude);
    if (r->around.objects != NULL) {
        report_add_touch(page, r, frame_step);
    }
    return page;
}

/* JSON inside a <script> must not close it: every '<' goes out as an escape. */
static void write_json(const char *json, FILE *file)
{
    for (const char *c = json; *c != '\0'; c++) {
        if (*c == '<') {
            fputs("\\u003c", file);
        } else {
            putc(*c, file);
        }
    }
}

/* The page with each of its @MARKERS@ replaced by what it names; any other '@' is the page's own. */
static void write_page(const char *json, FILE *file)
{
    const struct {
        const char *marker, *begin, *end;
    } parts[] = {
        {"@STYLE@", report_style_css, report_style_css_end},
        {"@SCRIPT@", report_script_js, report_script_js_end},
        {"@CHART_JS@", report_chart_js, report_chart_js_end},
        {"@DATA@", NULL, NULL},
    };
    const char *c = report_page_html;
    // cppcheck-suppress comparePointers ; the assembler puts one behind the other
    while (c < report_page_html_end) {
        size_t i = 0;
        while (i < 4 && strncmp(c, parts[i].marker, strlen(parts[i].marker)) != 0) {
            i++;
        }
        if (i == 4) {
            putc(*c++, file);
            continue;
        }
        if (parts[i].begin == NULL) {
            write_json(json, file);
        } else {
            fwrite(parts[i].begin, 1, (size_t)(parts[i].end - parts[i].begin), file);
        }
        c += strlen(parts[i].marker);
    }
}

int report_write(const replay *r, const char *preset, const char *path)
{
    cJSON *page = make_page(r, preset);
    char *json = cJSON_PrintUnformatted(page);
    cJSON_Delete(page);
    if (json == NULL) {
        return sim_give_up("%s: out of memory", path);
    }
    output out;
    int result = output_open(&out, path);
    if (result == SIM_OK) {
        write_page(json, out.file);
        result = output_close(&out, true);
    }
    cJSON_free(json);
    return result;
}
