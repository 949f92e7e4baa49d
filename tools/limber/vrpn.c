/* vrpn.c - a VRPN server as a live source: TRACKER@HOST[:PORT][#SENSOR], the connection kept up.
 *
 * Straight to the server's TCP port (VRPN's tcp:// mode); no port is opened here. While there is no connection it is
 * tried again after 0.25 s, then twice as long, up to 2 s. A server that has vanished without a word is
 * noticed by TCP's own probes within 5 s. vrpn_wire.h has the protocol.
 */
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "limber.h"
#include "live_source.h"
#include "vrpn_wire.h"

enum {
    RETRY_FIRST_US = 250000,
    RETRY_MAX_US = 2000000,
    CONNECT_MAX_US = 2000000,
    GREETING_MAX_US = 2000000,
    NAMES_US = 1000000, /* after that the server has told what it has */
};

typedef struct {
    struct sockaddr_storage address;
    socklen_t address_n;
    uint64_t since_us, retry_us, wait_us; /* this try began; the next one begins; after so long */
    bool connected, welcomed, proven; /* our cookie is sent; the server's has come; a pose has */
    bool told_down, told_missing, told_sensor;
    vrpn_wire wire;
} vrpn;

/* --- the name -------------------------------------------------------------------------------------- */

static bool parse(char *text, vrpn *v, char **host, const char **port)
{
    char *const at = strchr(text, '@'), *const hash = at != NULL ? strchr(at, '#') : NULL;
    if (at == NULL || at == text || (size_t)(at - text) >= sizeof v->wire.tracker) {
        return false;
    }
    *at = '\0';
    strcpy(v->wire.tracker, text);
    if (hash != NULL) {
        char *end;
        *hash = '\0';
        const long sensor = strtol(hash + 1, &end, 10);
        if (end == hash + 1 || *end != '\0' || sensor < 0 || sensor > INT32_MAX) {
            return false;
        }
        v->wire.sensor = (int32_t)sensor;
    }
    return live_source_split(at + 1, host, port) && **host != '\0';
}

static int look_up(live_source *s, vrpn *v, const char *host, const char *port)
{
    struct addrinfo *found = NULL;
    const struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    const int failed = getaddrinfo(host, port, &hints, &found);
    if (failed != 0) {
        return sim_complain("%.100s: %s", s->name, gai_strerror(failed));
    }
    const struct addrinfo *best = found; /* VRPN's own servers know IPv4 only */
    for (const struct addrinfo *a = found; a != NULL; a = a->ai_next) {
        best = best->ai_family != AF_INET && a->ai_family == AF_INET ? a : best;
    }
    memcpy(&v->address, best->ai_addr, best->ai_addrlen);
    v->address_n = best->ai_addrlen;
    freeaddrinfo(found);
    return SIM_OK;
}

static int open_vrpn(live_source *s, const char *where)
{
    char text[LIVE_NAME_BYTES], *host;
    const char *port = "3883";
    vrpn *const v = calloc(1, sizeof *v);
    s->state = v;
    if (v == NULL) {
        return sim_give_up("out of memory");
    }
    v->wait_us = RETRY_FIRST_US;
    if (strlen(where) >= sizeof text || !parse(strcpy(text, where), v, &host, &port)) {
        return sim_complain("%.100s: must be vrpn:TRACKER@HOST[:PORT][#SENSOR]", s->name);
    }
    return look_up(s, v, host, port);
}

/* --- the connection -------------------------------------------------------------------------------- */

static void probe_often(int fd)
{
    const int on = 1, idle_s = 2, every_s = 1, probes_n = 3;
    setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
    setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &every_s, sizeof every_s);
    setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &probes_n, sizeof probes_n);
}

/* The connection is gone, or never came to be: said once, tried again later. */
static void lose(live_source *s, const char *why)
{
    vrpn *const v = s->state;
    if (!v->told_down) {
        limber_note("%s: %s%s; trying again", s->name,
                    v->connected ? "lost the server: " : "cannot reach the server: ", why);
    }
    v->told_down = true;
    if (s->fd >= 0) {
        close(s->fd);
    }
    s->fd = -1;
    v->retry_us = limber_now_us() + v->wait_us;
    v->wait_us = v->wait_us * 2 < RETRY_MAX_US ? v->wait_us * 2 : RETRY_MAX_US;
}

static void begin(live_source *s, uint64_t now_us)
{
    vrpn *const v = s->state;
    v->connected = v->welcomed = v->proven = false;
    v->since_us = now_us;
    vrpn_wire_start(&v->wire);
    s->fd = socket(v->address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (s->fd < 0 || (connect(s->fd, (const struct sockaddr *)&v->address, v->address_n) != 0 &&
                      errno != EINPROGRESS)) {
        lose(s, strerror(errno));
    } else {
        probe_often(s->fd);
    }
}

/* The cookie can be sent as soon as the connection stands. */
static void greet(live_source *s, uint64_t now_us)
{
    vrpn *const v = s->state;
    const ssize_t n = send(s->fd, vrpn_wire_cookie, VRPN_COOKIE_BYTES, MSG_NOSIGNAL);
    if (n == VRPN_COOKIE_BYTES) {
        v->connected = true;
        v->since_us = now_us;
    } else if (n >= 0 || (errno != EAGAIN && errno != ENOTCONN && errno != EINTR)) {
        lose(s, n >= 0 ? "it takes no bytes" : strerror(errno));
    } else if (now_us - v->since_us > CONNECT_MAX_US) {
        lose(s, "no answer");
    }
}

static void take(live_source *s)
{
    vrpn *const v = s->state;
    size_t room;
    uint8_t *const to = vrpn_wire_room(&v->wire, &room);
    errno = 0;
    const ssize_t n = recv(s->fd, to, room, 0);
    s->arrived_us = limber_now_us();
    if (n > 0) {
        vrpn_wire_came(&v->wire, (size_t)n);
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        lose(s, n == 0 ? "it closed the connection" : strerror(errno));
    }
}

/* --- what the server has --------------------------------------------------------------------------- */

static void tell_what_is_missing(live_source *s, uint64_t now_us)
{
    vrpn *const v = s->state;
    if (!v->welcomed || now_us - v->since_us < NAMES_US) {
        return;
    }
    if (!v->wire.sender_known && !v->told_missing) {
        v->told_missing = true;
        limber_note("%s: the server has no tracker '%s'; it has: %s", s->name, v->wire.tracker,
                    v->wire.others_text[0] == '\0' ? "none" : v->wire.others_text);
    } else if (v->wire.sender_known && s->pace->poses_n == 0 && v->wire.others > 0 &&
               !v->told_sensor) {
        v->told_sensor = true;
        limber_note("%s: nothing from sensor %ld of it; others send, see #SENSOR", s->name,
                    (long)v->wire.sensor);
    }
}

static void read_vrpn(live_source *s, bool readable)
{
    vrpn *const v = s->state;
    const uint64_t now_us = limber_now_us();
    if (s->fd < 0) {
        if (now_us >= v->retry_us) {
            begin(s, now_us);
        }
        return;
    }
    if (!v->connected) {
        greet(s, now_us);
    } else if (readable) {
        take(s);
    } else if (!v->welcomed && now_us - v->since_us > GREETING_MAX_US) {
        lose(s, "it does not greet as VRPN 07 does");
    }
    tell_what_is_missing(s, now_us);
}

/* A server counts as found when it sends a pose: one that only greets, or greets and sends rubbish, is not told of
 * over and over, nor asked more and more often. */
static void prove(live_source *s)
{
    vrpn *const v = s->state;
    if (v->told_down && !v->proven) {
        limber_note("%s: connected", s->name);
    }
    v->proven = true;
    v->told_down = false;
    v->wait_us = RETRY_FIRST_US;
}

static bool next_vrpn(live_source *s, track_sample *sample)
{
    vrpn *const v = s->state;
    const long unreadable = v->wire.unreadable, others = v->wire.others;
    const bool came = vrpn_wire_next(&v->wire, sample);
    s->counts.unreadable += v->wire.unreadable - unreadable;
    s->counts.others += v->wire.others - others;
    if (v->wire.greeted && !v->welcomed) {
        v->welcomed = true;
        s->clock.begun = false; /* it may be another machine, or set anew */
        s->counts.connections++;
    }
    if (came) {
        prove(s);
    } else if (v->wire.broken != NULL && s->fd >= 0) {
        lose(s, v->wire.broken);
    }
    return came;
}

static void close_vrpn(live_source *s)
{
    if (s->fd >= 0) {
        close(s->fd);
    }
}

const live_kind live_vrpn_kind = {"vrpn:",           .timed = true,     .open = open_vrpn,
                                  .read = read_vrpn, .next = next_vrpn, .close = close_vrpn};
