/* bench.c - what a step and a solve cost here, beside the paper's table and what a user would pick
 * instead. Prints tables for people; asserts no times, only that all solutions agree. */
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "motions.h"
#include "rod.h"
#include "solvers.h"

enum { SIZES_N = 4, POSES_MAX = 1024 };
enum { BLOCK_NS = 5000, TURN_N = 25, ROUND_N = 250, SAMPLES_N = 5000, QUICK_SAMPLES_N = 100 };
static const int SIZES[SIZES_N] = {4, 10, 20, 50};

/* Table 1 of the paper (Symmetry 2018, 10(3), 57): a step's mean, µs, on an Intel i5-3570. */
static const double PAPER_US[MOTIONS_N][SIZES_N] = {{194, 389, 769, 2463},
                                                    {201, 396, 789, 2493},
                                                    {194, 403, 787, 2495},
                                                    {199, 403, 789, 2496},
                                                    {193, 398, 785, 2493}};

/* What is timed. Steps: each motion as the paper has it, then with smoothing, then with the elastic model; then the
 * circle with two held joints, and a hand still for a minute. Solves: each solver, then each in a chain. */
enum { SMOOTHED = MOTIONS_N, ELASTIC = 2 * MOTIONS_N, HOLD_2 = 3 * MOTIONS_N, STILL, STEPS_N };
enum { CHAINED = STEPS_N + SOLVERS_N, ALL_N = CHAINED + SOLVERS_N };

static struct {
    rod rod;
    rod_pose poses[POSES_MAX]; /* it goes through them again and again */
    int poses_n, next;
} rides[STEPS_N];

static struct {
    double median_ns, p99_ns; /* of one call */
} cost[ALL_N][SIZES_N];

static int refused_n;                /* steps */
static double checksum;              /* depends on all results: nothing can have been left out */
static double difference[SOLVERS_N]; /* largest one from our solution, in parts of the largest x */

static void call(int which, int times)
{
    if (which >= STEPS_N) {
        const bool chained = which >= CHAINED;
        solvers[which - (chained ? CHAINED : STEPS_N)].run(times, chained ? 1e-6f : 0.0f);
        return;
    }
    for (int i = 0; i < times; i++) {
        refused_n += rod_step(&rides[which].rod, &rides[which].poses[rides[which].next]) != ROD_OK;
        rides[which].next = (rides[which].next + 1) % rides[which].poses_n;
    }
}

static bool is_there(int which)
{
    return which < STEPS_N || solvers[(which - STEPS_N) % SOLVERS_N].run != NULL;
}

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static double block_ns(int which, int times)
{
    const double start = now_ns();
    call(which, times);
    return now_ns() - start;
}

/* The fewest calls, to a power of two, whose fastest block is long enough. */
static int calls_in_a_block(int which)
{
    for (int times = 1;; times *= 2) {
        double fastest = block_ns(which, times);
        for (int i = 0; i < 10; i++) {
            fastest = fmin(fastest, block_ns(which, times));
        }
        if (fastest >= BLOCK_NS) {
            return times;
        }
    }
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double samples[ALL_N][SIZES_N][SAMPLES_N];

/* Takes the samples of one size from `done` on, a few of each at a time. */
static void measure(int size, int done, int round_n)
{
    static int times[ALL_N][SIZES_N];
    for (int which = 0; which < ALL_N && done == 0; which++) {
        times[which][size] = is_there(which) ? calls_in_a_block(which) : 0;
    }
    for (const int end = done + round_n; done < end; done += TURN_N) {
        for (int which = 0; which < ALL_N; which++) {
            const int n = times[which][size];
            if (n > 0) {
                (void)block_ns(which, n); /* its code and data back into the caches */
                for (int i = 0; i < TURN_N; i++) {
                    samples[which][size][done + i] = block_ns(which, n) / n;
                }
            }
        }
    }
}

static void sum_up(int samples_n)
{
    for (int which = 0; which < ALL_N; which++) {
        for (int size = 0; size < SIZES_N; size++) {
            double *sorted = samples[which][size];
            qsort(sorted, (size_t)samples_n, sizeof *sorted, by_size);
            cost[which][size].median_ns = sorted[samples_n / 2];
            cost[which][size].p99_ns = sorted[samples_n * 99 / 100];
        }
    }
}

/* 0.6 m, 0.2 kg, 0.6 N m^2: a supple rod, the same for any number of links. */
static void make_elastic(rod_params *params)
{
    const float links = (float)params->links_n;
    params->model = ROD_MODEL_ELASTIC;
    params->tick_s = 1e-3f; /* a longer tick is several steps */
    for (int i = 0; i < params->links_n; i++) {
        params->length_m[i] = 0.6f / links;
        params->mass_kg[i] = 0.2f / links;
        params->spring[i] = links;
        params->damper[i] = 0.002f * links;
    }
}

static void set_up_steps(int links_n)
{
    for (int which = 0; which < STEPS_N; which++) {
        const motion *m = &motions[which % MOTIONS_N];
        rod_params params;
        rod_params_defaults(&params);
        params.links_n = links_n;
        params.hold_n = which == HOLD_2 ? 2 : 1;
        params.tick_s = 1.0f / (float)MOTION_RATE_HZ;
        for (int i = 0; i < links_n; i++) {
            params.smoothing[i] = which >= SMOOTHED && which < ELASTIC ? 50.0f : 0.0f;
        }
        if (which >= ELASTIC && which < HOLD_2) {
            make_elastic(&params);
        }
        refused_n += rod_init(&rides[which].rod, &params, NULL) != ROD_OK;
        rides[which].next = 0;
        rides[which].poses_n = m->samples_n < POSES_MAX ? m->samples_n : POSES_MAX;
        for (int i = 0; i < rides[which].poses_n; i++) {
            rides[which].poses[i] = m->pose(i);
        }
    }
    call(STILL, rides[STILL].poses_n / 2); /* and stop there */
    rides[STILL].next = 0;
    rides[STILL].poses_n = 1;
    call(STILL, 60 * MOTION_RATE_HZ);
}

static void set_up_solves(int rows_n)
{
    static bench_system system;
    bench_system_make(&system, rows_n);
    double x[2 * ROWS_MAX], largest = 0.0;
    for (int i = 0; i < SOLVERS_N; i++) {
        if (solvers[i].prepare == NULL) {
            continue;
        }
        solvers[i].prepare(&system);
        solvers[i].run(1, 0.0f);
        for (int k = 0; k < 2 * rows_n; k++) {
            const double found = (double)solvers[i].x(k / 2, k % 2);
            if (i == 0) {
                x[k] = found;
                largest = fmax(largest, fabs(found));
            }
            const double apart = fabs(found - x[k]) / largest;
            difference[i] =
                apart <= difference[i] ? difference[i] : apart; /* a NaN comes through */
        }
    }
}

static void add_to_checksum(int size)
{
    for (int which = 0; which < STEPS_N; which++) {
        checksum += (double)rod_angles(&rides[which].rod)[SIZES[size] - 1][ROD_THETA];
    }
    for (int i = 0; i < SOLVERS_N; i++) {
        checksum += solvers[i].x != NULL ? (double)solvers[i].x(SIZES[size] - 1, 0) : 0.0;
    }
}

static void print_sizes(const char *head)
{
    printf("%-22s", head);
    for (int size = 0; size < SIZES_N; size++) {
        printf("%17s%2d", "N = ", SIZES[size]);
    }
    printf("\n");
}

static void print_steps(void)
{
    print_sizes("STEP, microseconds");
    for (int which = 0; which < STEPS_N; which++) {
        char name[40];
        snprintf(name, sizeof name, "%s%s", motions[which % MOTIONS_N].name,
                 which < SMOOTHED  ? ""
                 : which < ELASTIC ? ", eta 50"
                 : which < HOLD_2  ? ", elastic"
                                   : ", hold 2");
        printf("  %-20s", which == STILL ? "still for a minute" : name);
        for (int size = 0; size < SIZES_N; size++) {
            printf("%11.3f %7.3f", cost[which][size].median_ns / 1e3,
                   cost[which][size].p99_ns / 1e3);
        }
        printf("\n");
    }
    printf(
        "\nThe paper's Table 1: means on an Intel i5-3570, and how many times our median. Another\n"
        "machine and another program: read the order of magnitude.\n");
    for (int m = 0; m < MOTIONS_N; m++) {
        printf("  %-20s", motions[m].name);
        for (int size = 0; size < SIZES_N; size++) {
            printf("%11.0f %6.0fx", PAPER_US[m][size],
                   1e3 * PAPER_US[m][size] / cost[m][size].median_ns);
        }
        printf("\n");
    }
}

/* Time = fixed + each N, by least squares through the circle's medians. */
static void print_findings(void)
{
    double n1 = 0.0, n2 = 0.0, t1 = 0.0, nt = 0.0, worst = 0.0;
    for (int size = 0; size < SIZES_N; size++) {
        const double n = SIZES[size], t = cost[0][size].median_ns;
        n1 += n;
        n2 += n * n;
        t1 += t;
        nt += n * t;
    }
    const double each = (SIZES_N * nt - n1 * t1) / (SIZES_N * n2 - n1 * n1);
    const double fixed = (t1 - each * n1) / SIZES_N;
    for (int size = 0; size < SIZES_N; size++) {
        const double t = cost[0][size].median_ns;
        worst = fmax(worst, fabs(fixed + each * SIZES[size] - t) / t);
    }
    printf("\nLinear in N: the circle takes %.0f ns and %.2f ns a link, to %.1f %% of each median "
           "above. The\n"
           "slowest motion takes so many times the fastest; the solve (in a chain) so much of the "
           "circle's:\n",
           fixed, each, 100.0 * worst);
    printf("  %-20s", "slowest / fastest");
    for (int size = 0; size < SIZES_N; size++) {
        double least = HUGE_VAL, most = 0.0;
        for (int m = 0; m < MOTIONS_N; m++) {
            least = fmin(least, cost[m][size].median_ns);
            most = fmax(most, cost[m][size].median_ns);
        }
        printf("%18.2fx", most / least);
    }
    printf("\n  %-20s", "share of the solve");
    for (int size = 0; size < SIZES_N; size++) {
        printf("%17.0f %%", 100.0 * cost[CHAINED][size].median_ns / cost[0][size].median_ns);
    }
    printf("\n");
}

static void print_solves(const char *head, int first)
{
    print_sizes(head);
    for (int i = 0; i < SOLVERS_N; i++) {
        printf("  %-20s", solvers[i].name);
        for (int size = 0; size < SIZES_N && solvers[i].run != NULL; size++) {
            printf("%6.0f %5.0f %5.1fx", cost[first + i][size].median_ns,
                   cost[first + i][size].p99_ns,
                   cost[first + i][size].median_ns / cost[first][size].median_ns);
        }
        printf("%s\n", solvers[i].run == NULL ? " not installed" : "");
    }
}

static void print_machine(int core)
{
    char line[256], model[80] = "an unknown processor", pinned[40] = "NOT on one core";
    FILE *f = fopen("/proc/cpuinfo", "r");
    while (f != NULL && fgets(line, sizeof line, f) != NULL) {
        if (sscanf(line, "model name : %79[^\n]", model) == 1) {
            break;
        }
    }
    if (f != NULL) {
        fclose(f);
    }
    if (core >= 0) {
        snprintf(pinned, sizeof pinned, "core %d alone", core);
    }
#ifndef __OPTIMIZE__
    printf("NOT OPTIMISED, so these times mean nothing: build with the preset `host`.\n");
#endif
    const char *gcc = strstr(__VERSION__, "lang") == NULL ? "gcc " : ""; /* clang names itself */
    printf("limber bench: %s, %s; %s%s %s\nLAPACK: %s; Eigen: %s\n", model, pinned, gcc,
           __VERSION__, FLAGS, LAPACK_FROM, EIGEN_FROM);
}

/* Stays on the core it is on; returns that, or -1. */
static int pin(void)
{
    const int core = sched_getcpu();
    cpu_set_t only;
    CPU_ZERO(&only);
    if (core >= 0) {
        CPU_SET((size_t)core, &only);
    }
    return sched_setaffinity(0, sizeof only, &only) == 0 ? core : -1;
}

static const char HELP[] =
    "usage: bench [--quick]\n\n"
    "Times a step of the rod and its solver for N = 4, 10, 20 and 50 links, beside the paper's\n"
    "table and beside LAPACK, Eigen and a dense inverse. Takes a few seconds and stays on the "
    "core\n"
    "it is started on; `taskset -c 1 bench` chooses one.\n\n"
    "  --quick   few samples: does it run, and do all solutions agree?\n\n"
    "Exit status: 0 fine, 1 solutions differ or a step was refused, 2 bad option.\n";

int main(int argc, char **argv)
{
    const bool quick = argc == 2 && strcmp(argv[1], "--quick") == 0;
    const int samples_n = quick ? QUICK_SAMPLES_N : SAMPLES_N;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        printf("%s", HELP);
        return 0;
    }
    if (argc > 1 && !quick) {
        fprintf(stderr, "%s", HELP);
        return 2;
    }

    print_machine(pin());
    /* everything in turns, so that a slow moment of the machine hits all alike */
    const int round_n = quick ? QUICK_SAMPLES_N : ROUND_N;
    for (int done = 0; done < samples_n; done += round_n) {
        for (int size = 0; size < SIZES_N; size++) {
            set_up_steps(SIZES[size]);
            set_up_solves(SIZES[size]);
            measure(size, done, round_n);
            add_to_checksum(size);
        }
    }
    sum_up(samples_n);

    printf("Median and p99 of %d samples, all in turns; a sample is the mean of a block of calls "
           "of at\n"
           "least %d µs. All in float32.\n\n",
           samples_n, BLOCK_NS / 1000);
    printf(
        "A step is rod_step: a pose in, the angles of N joints out; 100 Hz, MODEL.md's defaults;\n"
        "elastic: 0.6 m, 0.2 kg, 0.6 N m^2, 1 kHz.\n"
        "A hand that stays still leaves subnormal numbers, at which many desktop cores are "
        "slow.\n");
    print_steps();
    print_findings();
    printf("\nA solve is M x = b: five bands, two right-hand sides, M factored beforehand. Every b "
           "is a\n"
           "fresh copy, so solves may overlap in the processor; in a chain b needs the last x, and "
           "none\n"
           "can. Median, p99, and how many times our median.\n");
    print_solves("SOLVE, nanoseconds", STEPS_N);
    print_solves("  in a chain", CHAINED);

    printf("\nLargest difference from our solution, in parts of its largest entry (must be below "
           "1e-3):\n");
    bool agree = true;
    for (int i = 1; i < SOLVERS_N; i++) {
        if (solvers[i].run != NULL) {
            printf("  %s %.1e", solvers[i].name, difference[i]);
            agree = agree && difference[i] < 1e-3;
        }
    }
    printf("\nChecksum of all results: %.6g\n", checksum);
    if (!agree || refused_n > 0) {
        printf("FAILED: %s\n", agree ? "a step was refused" : "the solutions differ");
        return 1;
    }
    return 0;
}
