/* port_hints.c - what usually is wrong with a port, found out and said. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limber.h"
#include "port.h"

bool port_lock(int fd)
{
    if (flock(fd, LOCK_EX | LOCK_NB) == 0) {
        return true;
    }
    errno = errno == EWOULDBLOCK ? EBUSY : errno;
    return errno != EBUSY; /* where locks are unknown, go without */
}

static bool process_has_open(const char *pid, const struct stat *wanted)
{
    char folder[300];
    bool found = false;
    snprintf(folder, sizeof folder, "/proc/%.20s/fd", pid);
    DIR *const files = opendir(folder);
    if (files == NULL) {
        return false; /* somebody else's */
    }
    // cppcheck-suppress readdirCalled ; one thread
    for (const struct dirent *entry; !found && (entry = readdir(files)) != NULL;) {
        struct stat status;
        found = fstatat(dirfd(files), entry->d_name, &status, 0) == 0 &&
                status.st_rdev == wanted->st_rdev && S_ISCHR(status.st_mode);
    }
    closedir(files);
    return found;
}

/* " (minicom, process 1234)", or "" where no process that may be looked at has it open. */
static void name_holder(const char *path, char holder[80])
{
    struct stat wanted;
    *holder = '\0';
    DIR *const processes = stat(path, &wanted) == 0 ? opendir("/proc") : NULL;
    if (processes == NULL) {
        return;
    }
    // cppcheck-suppress readdirCalled ; one thread
    for (const struct dirent *entry; *holder == '\0' && (entry = readdir(processes)) != NULL;) {
        if (isdigit((unsigned char)entry->d_name[0]) && atol(entry->d_name) != (long)getpid() &&
            process_has_open(entry->d_name, &wanted)) {
            char place[300], name[32] = "?";
            snprintf(place, sizeof place, "/proc/%.20s/comm", entry->d_name);
            FILE *const file = fopen(place, "r");
            if (file != NULL) {
                (void)fscanf(file, "%31[^\n]", name);
                fclose(file);
            }
            snprintf(holder, 80, " (%s, process %.20s)", name, entry->d_name);
        }
    }
    closedir(processes);
}

void port_explain(const char *path, int error, port_why why)
{
    char holder[80];
    switch (error) {
    case EACCES:
    case EPERM:
        snprintf(why, PORT_WHY_BYTES,
                 "%.200s: permission denied; serial ports belong to a group: "
                 "sudo usermod -a -G dialout $USER, then log out and in again",
                 path);
        return;
    case EBUSY:
        name_holder(path, holder);
        snprintf(why, PORT_WHY_BYTES,
                 "%.200s: in use by another program%s; close it. If it is ModemManager: "
                 "sudo systemctl stop ModemManager",
                 path, holder);
        return;
    case ENOENT:
    case ENXIO:
    case ENODEV:
    case EIO:
        snprintf(why, PORT_WHY_BYTES,
                 "%.200s: there is no such port now; is the board plugged in, is the simulator "
                 "running? limber ports lists the serial ones",
                 path);
        return;
    case ENOTTY:
    case EINVAL:
        snprintf(why, PORT_WHY_BYTES, "%.200s: is no serial port; limber ports lists them", path);
        return;
    default:
        snprintf(why, PORT_WHY_BYTES, "%.200s: %s; limber ports lists the serial ports", path,
                 strerror(error));
    }
}

void port_warn_of_latency_timer(const port *p)
{
    char place[PORT_PATH_BYTES + 64];
    const char *const slash = strrchr(p->path, '/');
    int ms = 0;
    if (p->kind != &port_serial || slash == NULL) {
        return;
    }
    snprintf(place, sizeof place, "/sys/bus/usb-serial/devices/%s/latency_timer", slash + 1);
    FILE *const file = fopen(place, "r");
    if (file == NULL) {
        return; /* no FTDI adapter */
    }
    if (fscanf(file, "%d", &ms) == 1 && ms > 2) {
        limber_note("%s: this FTDI adapter gathers bytes for %d ms before it hands them on, which "
                    "is most of the latency; echo 1 | sudo tee %s",
                    p->path, ms, place);
    }
    fclose(file);
}
