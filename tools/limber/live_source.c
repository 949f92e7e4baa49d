/* live_source.c - see live_source.h. */
#include "live_source.h"

#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "limber.h"

enum {
    CLOCK_WINDOW_US = 5000000,
    CLOCK_JUMP_US = 1000000,
    POSE_COSTS_US = 1000000 / LIVE_POSES_MAX_HZ,
    CREDIT_MAX_US = 50 * POSE_COSTS_US,
    SKIP_READS_MAX = 1000,
};

/* Beyond this a number of seconds or metres is none, and could overflow what it is turned into. */
static const double NUMBER_MAX = 1e12;

const live_kind *live_source_kind(const char *name)
{
    static const live_kind *const KINDS[] = {&live_vrpn_kind, &live_osc_kind};
    for (size_t i = 0; i < sizeof KINDS / sizeof KINDS[0]; i++) {
        if (strncmp(name, KINDS[i]->prefix, strlen(KINDS[i]->prefix)) == 0) {
            return KINDS[i];
        }
    }
    return NULL;
}

int live_source_open(live_source *s, const live_kind *kind, const char *name)
{
    *s = (live_source){.kind = kind, .name = name, .fd = -1, .credit_us = CREDIT_MAX_US};
    s->pace = malloc(sizeof *s->pace);
    if (s->pace == NULL) {
        return sim_give_up("out of memory");
    }
    live_pace_start(s->pace, limber_now_us());
    return kind->open(s, name + strlen(kind->prefix));
}

void live_source_close(live_source *s)
{
    if (s->state != NULL) {
        s->kind->close(s);
    }
    free(s->state);
    free(s->pace);
    *s = (live_source){.fd = -1};
}

void live_source_read(live_source *s, bool readable)
{
    s->kind->read(s, readable);
}

/* --- the clock ------------------------------------------------------------------------------------- */

static uint64_t to_ours(live_source *s, double t_s)
{
    live_clock *const c = &s->clock;
    const int64_t its_us = llround(t_s * 1e6), seen_us = (int64_t)s->arrived_us - its_us;
    const bool jumped = c->begun && llabs(seen_us - c->offset_us[0]) > CLOCK_JUMP_US;
    const bool stands = c->begun && its_us == c->last_us;
    s->counts.clock_restarts += jumped;
    c->last_us = its_us;
    if (!c->begun || jumped) {
        c->begun = true;
        c->window_us = s->arrived_us;
        c->offset_us[0] = c->offset_us[1] = seen_us;
    } else if (s->arrived_us - c->window_us > CLOCK_WINDOW_US) {
        c->window_us = s->arrived_us;
        c->offset_us[1] = c->offset_us[0];
        c->offset_us[0] = seen_us;
    }
    if (stands) {
        return s->arrived_us; /* a source that does not fill in its times */
    }
    c->offset_us[0] = seen_us < c->offset_us[0] ? seen_us : c->offset_us[0];
    const int64_t least_us = c->offset_us[0] < c->offset_us[1] ? c->offset_us[0] : c->offset_us[1];
    return (uint64_t)(its_us + least_us);
}

/* --- poses ----------------------------------------------------------------------------------------- */

static bool is_sane(const track_sample *sample)
{
    bool sane = fabs(sample->t_s) <= NUMBER_MAX;
    for (int i = 0; i < 3; i++) {
        sane = sane && fabs(sample->position_m[i]) <= NUMBER_MAX;
    }
    for (int i = 0; i < 4; i++) {
        sane = sane && isfinite(sample->orientation[i]);
    }
    return sane;
}

/* A flood must not fill the line to the device: poses beyond what it can take cost credit that is not there. */
static bool is_affordable(live_source *s)
{
    const uint64_t now_us = limber_now_us();
    s->credit_us += now_us - s->credited_us;
    s->credit_us = s->credit_us < CREDIT_MAX_US ? s->credit_us : CREDIT_MAX_US;
    s->credited_us = now_us;
    if (s->credit_us < POSE_COSTS_US) {
        return false;
    }
    s->credit_us -= POSE_COSTS_US;
    return true;
}

static void tell_silence(const live_source *s)
{
    if (s->pace->poses_n == 0) {
        limber_note("%s: no pose yet; waiting", s->name);
    } else {
        limber_note("%s: silent for %.2f s; the device holds until it is back", s->name,
                    (double)(limber_now_us() - s->pace->arrived_us) * 1e-6);
    }
}

static bool is_blind(const track_sample *sample)
{
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        largest = fmax(largest, fabs(sample->orientation[i]));
    }
    return !(largest > 0.0);
}

bool live_source_next(live_source *s, track_sample *sample, uint64_t *captured_us)
{
    while (s->kind->next(s, sample)) {
        uint64_t silence_us;
        if (!is_sane(sample)) {
            s->counts.unreadable++;
            continue;
        }
        if (is_blind(sample)) {
            s->counts.blind++;
            continue;
        }
        if (!s->kind->waits && !is_affordable(s)) {
            s->counts.too_many++;
            continue;
        }
        *captured_us = s->kind->timed ? to_ours(s, sample->t_s) : s->arrived_us;
        const bool first = s->pace->poses_n == 0;
        if (live_pace_add(s->pace, *captured_us, s->arrived_us, &silence_us)) {
            limber_note("%s: %s after %.2f s", s->name, first ? "its first pose came" : "back",
                        (double)silence_us * 1e-6);
        }
        return true;
    }
    if (!s->ended && live_pace_check(s->pace, limber_now_us())) {
        tell_silence(s);
    }
    return false;
}

long live_source_skip(live_source *s)
{
    track_sample sample;
    struct pollfd file = {.fd = s->fd, .events = POLLIN};
    long skipped_n = 0;
    for (int i = 0; i < SKIP_READS_MAX && !s->ended && poll(&file, 1, 0) > 0; i++) {
        s->kind->read(s, true);
        while (s->kind->next(s, &sample)) {
            skipped_n++;
        }
        file.fd = s->fd;
    }
    live_pace_forget(s->pace, limber_now_us());
    return skipped_n;
}

bool live_source_is_silent(const live_source *s)
{
    return s->pace->poses_n == 0 || s->pace->silent;
}

bool live_source_split(char *text, char **host, const char **port)
{
    char *colon = strrchr(text, ':');
    char *const bracket = *text == '[' ? strchr(text, ']') : NULL;
    *host = text;
    if (bracket != NULL) {
        *host = text + 1;
        *bracket = '\0';
        colon = bracket[1] == ':' ? bracket + 1 : NULL;
        if (colon == NULL && bracket[1] != '\0') {
            return false;
        }
    }
    if (colon == NULL) {
        return true;
    }
    *colon = '\0';
    *port = colon + 1;
    char *end;
    const long number = strtol(*port, &end, 10);
    return end != *port && *end == '\0' && **port >= '0' && **port <= '9' && number >= 1 &&
           number <= 65535;
}
