/* serial_shim.c - LD_PRELOAD: makes a PTY look like a serial port to libserialport, and a few of its places in
 * /sys as a test wants them. Only the C library's doors that libserialport goes through.
 *
 *   look-up       /sys/class/tty/NAME of a PTY is there and leads to a device
 *   modem lines   ioctls that a PTY does not know are answered
 *   LIMBER_SHIM_LATENCY_TIMER=16   an FTDI adapter's latency timer
 *   LIMBER_SHIM_OPEN_ERRNO=13      opening the port fails like that
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

static const char CLASS[] = "/sys/class/tty/";

/* libserialport knows a port by the last part of its path: 7 for /dev/pts/7. */
static int is_pty(const char *path)
{
    return strncmp(path, CLASS, sizeof CLASS - 1) == 0 && path[sizeof CLASS - 1] >= '0' &&
           path[sizeof CLASS - 1] <= '9';
}

static int is_pty_path(const char *path)
{
    return strncmp(path, "/dev/pts/", 9) == 0;
}

static int say_link(struct stat *status)
{
    memset(status, 0, sizeof *status);
    status->st_mode = S_IFLNK | 0777;
    return 0;
}

int lstat(const char *path, struct stat *status)
{
    int (*next)(const char *, struct stat *) = dlsym(RTLD_NEXT, "lstat");
    return is_pty(path) || strstr(path, "tty/pts/") != NULL ? say_link(status) : next(path, status);
}

int __lxstat(int version, const char *path, struct stat *status);
int __lxstat(int version, const char *path, struct stat *status)
{
    int (*next)(int, const char *, struct stat *) = dlsym(RTLD_NEXT, "__lxstat");
    return is_pty(path) || strstr(path, "tty/pts/") != NULL ? say_link(status)
                                                            : next(version, path, status);
}

ssize_t readlink(const char *path, char *target, size_t room)
{
    ssize_t (*next)(const char *, char *, size_t) = dlsym(RTLD_NEXT, "readlink");
    if (is_pty(path) || strstr(path, "tty/pts/") != NULL) {
        const char place[] = "../../devices/pci/usb1/1-1/1-1:1.0/ttyUSB0/tty/ttyUSB0";
        const size_t n = sizeof place - 1 < room ? sizeof place - 1 : room;
        memcpy(target, place, n);
        return (ssize_t)n;
    }
    return next(path, target, room);
}

ssize_t __readlink_chk(const char *path, char *target, size_t room, size_t size);
ssize_t __readlink_chk(const char *path, char *target, size_t room, size_t size)
{
    (void)size;
    return readlink(path, target, room);
}

int ioctl(int fd, unsigned long request, ...)
{
    int (*next)(int, unsigned long, ...) = dlsym(RTLD_NEXT, "ioctl");
    va_list arguments;
    va_start(arguments, request);
    void *argument = va_arg(arguments, void *);
    va_end(arguments);
    switch (request) {
    case TIOCMGET:
        *(int *)argument = TIOCM_DTR | TIOCM_RTS;
        return 0;
    case TIOCMSET:
    case TIOCMBIS:
    case TIOCMBIC:
        return 0;
    default:
        return next(fd, request, argument);
    }
}

int open(const char *path, int flags, ...)
{
    int (*next)(const char *, int, ...) = dlsym(RTLD_NEXT, "open");
    const char *const failure = getenv("LIMBER_SHIM_OPEN_ERRNO");
    va_list arguments;
    va_start(arguments, flags);
    const unsigned mode = (flags & O_CREAT) != 0 ? va_arg(arguments, unsigned) : 0;
    va_end(arguments);
    if (failure != NULL && is_pty_path(path)) {
        errno = atoi(failure);
        return -1;
    }
    return next(path, flags, mode);
}

int __open_2(const char *path, int flags);
int __open_2(const char *path, int flags)
{
    return open(path, flags);
}

FILE *fopen(const char *path, const char *mode)
{
    FILE *(*next)(const char *, const char *) = dlsym(RTLD_NEXT, "fopen");
    const char *const ms = getenv("LIMBER_SHIM_LATENCY_TIMER");
    if (ms != NULL && strstr(path, "latency_timer") != NULL) {
        return fmemopen((void *)ms, strlen(ms), mode);
    }
    return next(path, mode);
}
