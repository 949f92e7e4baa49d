/* osc.c - a UDP port that tracker poses are sent to as OSC: [ADDRESS:]PORT[#SERIAL].
 *
 * A pose was captured when its packet arrived: the kernel notes that moment, however late we come to read it.
 * osc_wire.h has the messages.
 */
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "limber.h"
#include "live_source.h"
#include "osc_wire.h"

typedef struct {
    osc_wire wire;
} osc;

/* --- the port -------------------------------------------------------------------------------------- */

static bool is_loopback(const struct sockaddr *address)
{
    if (address->sa_family == AF_INET) {
        const struct sockaddr_in *const v4 = (const struct sockaddr_in *)(const void *)address;
        return ntohl(v4->sin_addr.s_addr) >> 24 == 127;
    }
    return IN6_IS_ADDR_LOOPBACK(&((const struct sockaddr_in6 *)(const void *)address)->sin6_addr);
}

static int listen_at(live_source *s, const struct addrinfo *address)
{
    const int on = 1;
    s->fd = socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (s->fd < 0 || bind(s->fd, address->ai_addr, address->ai_addrlen) != 0) {
        return sim_complain("%.100s: cannot listen there: %s", s->name, strerror(errno));
    }
    setsockopt(s->fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    if (!is_loopback(address->ai_addr)) {
        limber_note("%s: whoever reaches this port from the network can move the rod", s->name);
    }
    return SIM_OK;
}

static int open_osc(live_source *s, const char *where)
{
    char text[LIVE_NAME_BYTES];
    osc *const o = calloc(1, sizeof *o);
    s->state = o;
    if (o == NULL) {
        return sim_give_up("out of memory");
    }
    snprintf(text, sizeof text, "%s%s", strpbrk(where, ":") == NULL ? "127.0.0.1:" : "", where);
    char *const hash = strchr(text, '#'), *host;
    if (hash != NULL) {
        *hash = '\0';
        snprintf(o->wire.serial, sizeof o->wire.serial, "%s", hash + 1);
    }
    const char *port = NULL;
    if (strlen(where) + sizeof "127.0.0.1:" > sizeof text ||
        !live_source_split(text, &host, &port) || port == NULL || *host == '\0' ||
        (hash != NULL && o->wire.serial[0] == '\0')) {
        return sim_complain("%.100s: must be osc:[ADDRESS:]PORT[#SERIAL]", s->name);
    }
    struct addrinfo *found = NULL;
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_DGRAM};
    const int failed = getaddrinfo(host, port, &hints, &found);
    if (failed != 0) {
        return sim_complain("%.100s: %s", s->name, gai_strerror(failed));
    }
    const int result = listen_at(s, found);
    freeaddrinfo(found);
    return result;
}

/* --- packets --------------------------------------------------------------------------------------- */

/* The kernel's moment is on the wall clock: what has passed since then is not. */
static uint64_t arrival_us(const struct msghdr *m)
{
    const uint64_t now_us = limber_now_us();
    struct timespec now, then;
    const struct cmsghdr *const note = CMSG_FIRSTHDR(m);
    if (note == NULL || note->cmsg_level != SOL_SOCKET || note->cmsg_type != SCM_TIMESTAMPNS) {
        return now_us;
    }
    memcpy(&then, CMSG_DATA(note), sizeof then);
    clock_gettime(CLOCK_REALTIME, &now);
    const int64_t ago_us =
        (int64_t)(now.tv_sec - then.tv_sec) * 1000000 + (now.tv_nsec - then.tv_nsec) / 1000;
    return ago_us > 0 && ago_us < 1000000 ? now_us - (uint64_t)ago_us : now_us;
}

static void read_osc(live_source *s, bool readable)
{
    osc *const o = s->state;
    if (!readable) {
        return;
    }
    _Alignas(struct cmsghdr) char notes[CMSG_SPACE(sizeof(struct timespec))];
    struct iovec part = {o->wire.bytes, sizeof o->wire.bytes};
    struct msghdr m = {
        .msg_iov = &part, .msg_iovlen = 1, .msg_control = notes, .msg_controllen = sizeof notes};
    const ssize_t n = recvmsg(s->fd, &m, 0);
    osc_wire_came(&o->wire, n > 0 ? (size_t)n : 0);
    s->counts.unreadable += n == 0; /* a packet of nothing */
    if (n > 0) {
        s->arrived_us = arrival_us(&m);
    }
}

static bool next_osc(live_source *s, track_sample *sample)
{
    osc *const o = s->state;
    const long unreadable = o->wire.unreadable, others = o->wire.others;
    const bool chosen = o->wire.serial[0] != '\0';
    const bool came = osc_wire_next(&o->wire, sample);
    s->counts.unreadable += o->wire.unreadable - unreadable;
    s->counts.others += o->wire.others - others;
    if (came) {
        sample->t_s = (double)s->arrived_us * 1e-6;
    }
    if (came && !chosen) {
        limber_note("%s: following tracker '%s', the first one heard; #SERIAL chooses another",
                    s->name, o->wire.serial);
    }
    return came;
}

static void close_osc(live_source *s)
{
    if (s->fd >= 0) {
        close(s->fd);
    }
}

const live_kind live_osc_kind = {"osc:",           .unity = true,    .open = open_osc,
                                 .read = read_osc, .next = next_osc, .close = close_osc};
