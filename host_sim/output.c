/* output.c - see output.h. */
#include "output.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sim.h"

enum { OUTPUTS_MAX_N = 16 };

/* The files under way. */
typedef struct output_waiting {
    char *volatile partial; /* NULL: this entry is free */
    char *target;
} waiting_file;

static waiting_file waiting[OUTPUTS_MAX_N];

static void remove_partials(int signal_number)
{
    for (int i = 0; i < OUTPUTS_MAX_N; i++) {
        if (waiting[i].partial != NULL) {
            unlink(waiting[i].partial);
        }
    }
    _exit(128 + signal_number);
}

static void tidy_up_when_interrupted(void)
{
    static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP};
    for (int i = 0; i < 3; i++) {
        if (signal(SIGNALS[i], remove_partials) == SIG_IGN) {
            signal(SIGNALS[i], SIG_IGN); /* nohup, or a shell's background */
        }
    }
}

static void forget(waiting_file *entry, bool and_remove)
{
    char *const partial = entry->partial;
    if (and_remove) {
        unlink(partial);
    }
    entry->partial = NULL; /* before its memory goes: an interrupt may look */
    free(partial);
    free(entry->target);
}

/* An entry for this path, or NULL after complaining with *result. */
static waiting_file *remember(const char *path, int *result)
{
    char *target = realpath(path, NULL); /* what a link points to is replaced, not the link */
    char *partial = NULL;
    waiting_file *entry = NULL;
    *result = SIM_OK;
    if (target == NULL) {
        target = strdup(path);
    }
    if (target == NULL || asprintf(&partial, "%s.partial.%ld", target, (long)getpid()) < 0) {
        *result = sim_give_up("out of memory");
    }
    for (int i = 0; i < OUTPUTS_MAX_N && *result == SIM_OK; i++) {
        if (waiting[i].partial == NULL) {
            entry = &waiting[i];
        } else if (strcmp(waiting[i].partial, partial) == 0) {
            *result = sim_complain("%s: is to be written twice; give two names", path);
        }
    }
    if (*result == SIM_OK && entry == NULL) {
        *result = sim_give_up("%s: more than %d files at once", path, OUTPUTS_MAX_N);
    }
    if (*result != SIM_OK) {
        free(target);
        free(partial);
        return NULL;
    }
    tidy_up_when_interrupted();
    entry->target = target;
    entry->partial = partial;
    return entry;
}

/* The number of a stream that is open already and has a name as a file, or -1. */
static int stream_of(const char *path)
{
    int stream = -1, end = 0;
    if (strcmp(path, "/dev/stdout") == 0) {
        return STDOUT_FILENO;
    }
    if (strcmp(path, "/dev/stderr") == 0) {
        return STDERR_FILENO;
    }
    const bool named = (sscanf(path, "/dev/fd/%d%n", &stream, &end) == 1 ||
                        sscanf(path, "/proc/self/fd/%d%n", &stream, &end) == 1) &&
                       path[end] == '\0';
    return named ? stream : -1;
}

int output_open(output *out, const char *path)
{
    struct stat status;
    *out = (output){.path = path};
    const int stream = stream_of(path);
    if (stream >= 0) {
        fflush(stdout);
        const int copy = dup(stream); /* opened by name it would begin anew at its start */
        out->file = copy < 0 ? NULL : fdopen(copy, "wb");
    } else if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        out->file = fopen(path, "wb"); /* a pipe, a device: nothing to rename */
    } else {
        int result;
        out->waiting = remember(path, &result);
        if (out->waiting == NULL) {
            return result;
        }
        out->file = fopen(out->waiting->partial, "wb");
    }
    if (out->file == NULL) {
        const int result = sim_complain("%s: cannot be written: %s", path, strerror(errno));
        if (out->waiting != NULL) {
            forget(out->waiting, false);
        }
        *out = (output){0};
        return result;
    }
    return SIM_OK;
}

int output_close(output *out, bool keep)
{
    if (out->file == NULL) {
        return SIM_OK;
    }
    errno = 0;
    bool written = fflush(out->file) == 0 && !ferror(out->file);
    written = fclose(out->file) == 0 && written;
    const int result = keep && !written ? sim_complain("%s: cannot be written: %s", out->path,
                                                       errno == 0 ? "write error" : strerror(errno))
                                        : SIM_OK;
    if (out->waiting != NULL && !(keep && written)) {
        forget(out->waiting, true);
    }
    *out = (output){0};
    return result;
}

int outputs_finish(int result)
{
    for (int i = 0; i < OUTPUTS_MAX_N; i++) {
        waiting_file *entry = &waiting[i];
        if (entry->partial == NULL) {
            continue;
        }
        if (result == SIM_OK && rename(entry->partial, entry->target) != 0) {
            result = sim_complain("%s: cannot be written: %s", entry->target, strerror(errno));
        }
        forget(entry, result != SIM_OK);
    }
    return result;
}
