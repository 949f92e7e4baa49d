/* output.c - see output.h. */
#include "output.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sim.h"

enum { OPEN_MAX_N = 8 };
static char *volatile partials[OPEN_MAX_N];

static void remove_partials(int signal_number)
{
    for (int i = 0; i < OPEN_MAX_N; i++) {
        if (partials[i] != NULL) {
            unlink(partials[i]);
        }
    }
    _exit(128 + signal_number);
}

static void remember(char *partial)
{
    signal(SIGINT, remove_partials);
    signal(SIGTERM, remove_partials);
    for (int i = 0; i < OPEN_MAX_N; i++) {
        if (partials[i] == NULL) {
            partials[i] = partial;
            return;
        }
    }
}

static void forget(const char *partial)
{
    for (int i = 0; i < OPEN_MAX_N; i++) {
        if (partials[i] == partial) {
            partials[i] = NULL;
        }
    }
}

int output_open(output *out, const char *path)
{
    struct stat status;
    *out = (output){.path = path};
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        out->file = fopen(path, "wb"); /* /dev/stdout, a pipe: nothing to rename */
    } else {
        const size_t room = strlen(path) + 32;
        out->partial = malloc(room);
        if (out->partial == NULL) {
            return sim_give_up("out of memory");
        }
        snprintf(out->partial, room, "%s.partial.%ld", path, (long)getpid());
        out->file = fopen(out->partial, "wb");
    }
    if (out->file == NULL) {
        const int result = sim_complain("%s: cannot be written: %s", path, strerror(errno));
        free(out->partial);
        *out = (output){0};
        return result;
    }
    if (out->partial != NULL) {
        remember(out->partial);
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
    if (out->partial != NULL) {
        if (keep && written) {
            written = rename(out->partial, out->path) == 0;
        }
        if (!keep || !written) {
            unlink(out->partial);
        }
        forget(out->partial);
        free(out->partial);
    }
    const int result = keep && !written ? sim_complain("%s: cannot be written: %s", out->path,
                                                       errno == 0 ? "write error" : strerror(errno))
                                        : SIM_OK;
    *out = (output){0};
    return result;
}
