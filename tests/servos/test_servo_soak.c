/* test_servo_soak.c - everything at once: any call at any time, servos that miss, garble, refuse and break, noise on
 * the line, ticks that come late. What must hold all the while: no servo ever gets torque with a goal other than its
 * place, no supply where there should be none, and every undertaking ends. */
#include "servo_wire_hal.h"

void setUp(void) {}
void tearDown(void) {}

enum { SERVOS_N = 6, FAULT_EVERY = 150 };

/* Ticks from one call to the next, on average: so that every state is left, but not before it has come to something. */
static const int CALL_EVERY[] = {
    [SERVOS_OFF] = 30,    [SERVOS_PREPARING] = 5000, [SERVOS_PREPARED] = 10,
    [SERVOS_FAILED] = 30, [SERVOS_ON] = 100,         [SERVOS_SERVICE] = 600};
static uint32_t seed;

static bool chance(int of)
{
    return random_below(&seed, of) == 0;
}

static void some_fault(void)
{
    wire_servo *s = &w.servo[random_below(&seed, SERVOS_N)];
    switch (random_below(&seed, 8)) {
    case 0:
        s->deaf_n = 1 + random_below(&seed, 4);
        break;
    case 1:
        s->mute_n = 1 + random_below(&seed, 4);
        break;
    case 2:
        s->garbled_n = 1 + random_below(&seed, 4);
        break;
    case 3:
        s->late_us = (uint32_t)random_below(&seed, 3000);
        break;
    case 4:
        s->error = (uint8_t)(chance(3) ? random_below(&seed, 8) : 0);
        break;
    case 5:
        s->table[HARDWARE] = (uint8_t)(chance(3) ? 1 << random_below(&seed, 6) : 0);
        break;
    case 6:
        s->late_us = 0;
        s->stuck_at = (uint8_t)(chance(4) ? (chance(2) ? GOAL : TORQUE) : 0);
        break;
    default:
        w.echo = !w.echo;
        for (int i = 0; i < SERVOS_N; i++) { /* all is well again */
            w.servo[i].late_us = w.servo[i].error = w.servo[i].table[HARDWARE] =
                w.servo[i].stuck_at = 0;
        }
    }
}

static void some_noise(void)
{
    static const uint8_t KINDS[] = {0xFF, 0xFF, 0xFD, 0x00, 0x55, 0x01};
    uint8_t noise[24];
    for (size_t i = 0; i < sizeof noise; i++) {
        noise[i] =
            chance(2) ? (uint8_t)random_bits(&seed) : KINDS[random_below(&seed, sizeof KINDS)];
    }
    wire_come(noise, (size_t)random_below(&seed, sizeof noise), w.now_us);
}

static void some_goals(void)
{
    for (int i = 0; i < SERVOS_N; i++) {
        goals_rad[i] = (float)random_between(&seed, -1.0, 1.0);
    }
    servos_goals(&subject, goals_rad);
}

static void some_request(void)
{
    const servo_request request = {
        .kind = (uint8_t)(chance(2) ? SERVO_REQUEST_PING : SERVO_REQUEST_TEST),
        .id = (uint8_t)random_below(&seed, SERVOS_N + 2),
        .turn_rad = (float)random_between(&seed, -1.0, 1.0),
    };
    servos_request(&subject, &request, w.now_us);
}

static void some_call(void)
{
    switch (random_below(&seed, 8)) {
    case 0:
        servos_off(&subject);
        break;
    case 1:
        some_request();
        break;
    case 2:
    case 3:
        servos_prepare(&subject, w.now_us);
        break;
    case 4:
    case 5:
        servos_torque(&subject, goals_rad, w.now_us);
        break;
    default:
        some_goals();
    }
}

static void what_must_hold(void)
{
    const servos_state state = subject.state;
    TEST_ASSERT_EQUAL_INT(state != SERVOS_OFF && state != SERVOS_FAILED, w.supply);
    TEST_ASSERT_TRUE(state != SERVOS_FAILED || subject.trouble.kind != SERVO_TROUBLE_NONE);
    TEST_ASSERT_TRUE(servos_healthy(&subject) || subject.trouble.kind != SERVO_TROUBLE_NONE);
    for (int i = 0; i < SERVOS_N; i++) {
        TEST_ASSERT_EQUAL_INT32(0, w.servo[i].jump);
    }
}

static void hours_of_everything(void)
{
    int reached[SERVOS_SERVICE + 1] = {0}, in_state_ms = 0;
    servos_state before = SERVOS_OFF;
    const servos_config config = wire_fresh(SERVOS_N);
    configured(&config);
    seed = 77;
    for (int ms = 0; ms < HOST_OR_BOARD(1000000, 20000); ms++) {
        if (chance(FAULT_EVERY)) {
            some_fault();
        }
        if (chance(200)) {
            some_noise();
        }
        if (chance(CALL_EVERY[subject.state])) {
            some_call();
        }
        wire_until(w.now_us + (chance(50) ? 10000u : 1000u));
        servos_tick(&subject, w.now_us);
        what_must_hold();
        w.log_n = 0;
        in_state_ms = subject.state == before ? in_state_ms + 1 : 0;
        TEST_ASSERT_TRUE(before != SERVOS_PREPARING || in_state_ms < 2000);
        before = subject.state;
        reached[before]++;
    }
    for (int state = 0; state <= SERVOS_SERVICE; state++) {
        TEST_ASSERT_TRUE(reached[state] >
                         HOST_OR_BOARD(1000, 10)); /* the test is about all of them */
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(hours_of_everything);
    return UNITY_END();
}
