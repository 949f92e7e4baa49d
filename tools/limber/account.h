/* account.h - where every pose went: sent = accepted + rejected, by cause, + lost.
 *
 * From the device's counters before and after. Poses that it rejects are counted there by cause: every counter
 * of STATS whose name begins with poses_, but for those accepted, lost and doubled. Poses that
 * never came it sees as gaps of seq. Of the first and last poses of a session it cannot see that they are
 * missing: what is left over is called lost too, but only as far as no ANGLES has echoed those poses.
 * Anything else left over is unaccounted for, and means a bug somewhere.
 */
#ifndef LIMBER_ACCOUNT_H
#define LIMBER_ACCOUNT_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "messages.h"

enum { ACCOUNT_FIELDS_MAX = 64 }; /* of STATS */

typedef struct {
    uint64_t sent, accepted, rejected[ACCOUNT_FIELDS_MAX], lost;
    uint64_t doubled; /* came twice: not one more of those sent */
    int64_t unaccounted;
    bool unknown; /* some of them were sent to a device that was lost, or forgot its counters */
} account;

/* A session's poses, and how many of them may be missing unseen (pose_delays_unseen). Returns what they
 * leave unaccounted; with `final` false nothing is booked yet. */
int64_t account_session(account *a, uint64_t sent_n, const message_stats *before,
                        const message_stats *after, uint64_t unseen_n, bool final);

/* A session without counters after it. */
void account_unknown(account *a, uint64_t sent_n);

bool account_balances(const account *a);
uint64_t account_rejected(const account *a);
void account_print(const account *a, FILE *out);
cJSON *account_json(const account *a);

#endif
