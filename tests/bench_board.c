// The bench that MuJoCo simulates, as somebody meets it who has a lab of his own: it is
// recorded by a logger that knows nothing of impactlab, and a law that was exported
// drives it.
//
//     bench_board record VOLTS SEED        a trace, to and fro in the air, as the logger
//                                          writes it
//     bench_board drive FIRST COUNT        COUNT starts and walls under the law, judged
//
// The second is there where it was compiled with a law's law.c and -DHAS_LAW. A run is
// within the bounds if the mean of the force over 5 ms exceeds the command by at most 30
// % from 20 ms after first contact on, stays within 5 % of its last value from 0.3 s
// after first contact on, 0.6 s where contact was lost, that value is within 5 % of the
// command, and first contact comes at most 1.5 times as late as under a constant volt.
// Exit status 1 with more than a fifth of the runs out of them.
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench_sensors.h"

#ifdef HAS_LAW
#include "law.h"
#endif

enum {
    BOARD_RATE = 200,                // samples a second
    WITHIN = 20,                     // instants of a sample, at which force is kept
    RECORDED = 3 * BOARD_RATE / 2,   // samples of a trace
    DRIVEN = 2 * BOARD_RATE * WITHIN // instants of a run under the law
};

// The numbers of the bench, which nobody tells the lab: 32 rods, play and lags.
static bench_arm bench(void)
{
    return (bench_arm){.links = BENCH_LINKS,
                       .length = 1,
                       .mass = 0.42,
                       .rotor_inertia = 5.7e-3,
                       .joint_stiffness = 5.3 * BENCH_LINKS / 2,
                       .torque_per_volt = 0.46,
                       .damping = 0.19,
                       .stiction = 0.05,
                       .wall_stiffness = 2e4,
                       .wall_damping = 20,
                       .start = -1.5,
                       .amplifier_lag = 2e-3,
                       .play = 1e-3,
                       .coupling = 300,
                       .joint_damping = 0.0023 * 5.3 * BENCH_LINKS / 2,
                       .force_lag = 7e-4};
}

// --- a recording -----------------------------------------------------------------------

// Volts to and fro.
static double swing(void *volts, int k, const bench_sample *to)
{
    (void)to;
    const double most = *(const double *)volts;
    return k / 80 % 2 == 0 ? most : -most;
}

// A number with a decimal comma and what stands behind it.
static void write_number(double value, int digits, const char *behind)
{
    char text[64];
    snprintf(text, sizeof text, "%.*f", digits, value);
    char *point = strchr(text, '.');
    if (point != NULL) {
        *point = ',';
    }
    printf("%s%s", text, behind);
}

// Records a trace as a logger writes it: its own words, semicolons, decimal commas,
// milliseconds since it was switched on, degrees, a missing reading now and then.
static bool record(double volts, uint64_t seed)
{
    static bench_sample read[RECORDED];
    random_generator random;
    const bench_arm a = bench();
    random_seed(&random, seed);
    if (!bench_arm_run_mujoco(&a, swing, &volts, RECORDED, BOARD_RATE, read)) {
        return false;
    }
    printf("# DataLogger 3, 4 channels\r\nZeit [ms];Ausgang [V];Drehgeber [deg];Tacho "
           "[rad/s];Kraft [N]\r\n");
    for (int k = 0; k < RECORDED; k++) {
        const bench_reading shown = bench_read(&read[k], &random);
        write_number(71234.5 + 1e3 * k / BOARD_RATE, 1, ";");
        write_number(swing(&volts, k, read), 3, ";");
        write_number(shown.angle * 180 / 3.14159265358979323846, 4, ";");
        if (k % 97 != 50) {
            write_number(shown.velocity, 5, "");
        }
        printf(";");
        write_number(shown.force, 4, "\r\n");
    }
    return true;
}

// --- under the law ---------------------------------------------------------------------

#ifdef HAS_LAW
#define COMMAND_FORCE 1.0 // [N]

// A start and a wall. The law takes the wall to be at 0; the encoder's zero is off.
typedef struct place {
    double start, off;         // [rad]
    double stiffness, damping; // of the wall [N/m], [N s/m]
} place;

typedef struct board {
    random_generator random;
    double off; // of the encoder's zero [rad]
    double command;
} board;

// A volt until the tip touches the wall.
static double volt_to_the_wall(void *context, int k, const bench_sample *to)
{
    (void)context;
    return to[k].pressed > 0 ? (double)NAN : 1;
}

// The board: reads the sensors at each sample and asks the law.
static double law_answers(void *context, int k, const bench_sample *to)
{
    board *b = context;
    if (k % WITHIN == 0) {
        const bench_reading shown = bench_read(&to[k], &b->random);
        const controller_input in = {.time = (float)k / (BOARD_RATE * WITHIN),
                                     .encoder = (float)(shown.angle + b->off),
                                     .tachometer = (float)shown.velocity,
                                     .force = (float)shown.force,
                                     .voltage = (float)b->command,
                                     .piezo_force = NAN,
                                     .film = NAN,
                                     .accelerometer = NAN,
                                     .wanted_mode = -1,
                                     .predicted_force = NAN};
        controller_output out;
        law_sample(&in, &out);
        b->command = fmax(-10, fmin((double)out.command, 10));
    }
    return b->command;
}

// The first instant at which the wall is pressed, DRIVEN if it never is.
static int first_contact(const bench_sample *run)
{
    int k = 0;
    while (k < DRIVEN && !(run[k].pressed > 0)) {
        k++;
    }
    return k;
}

// Mean force over the 5 ms before an instant, over a sample [N].
static double smoothed(const bench_sample *run, int k)
{
    double sum = 0;
    for (int i = k - WITHIN + 1; i <= k; i++) {
        sum += run[i].pressed;
    }
    return sum / WITHIN;
}

// Judges a run by the bounds, and prints what it came to.
static bool judge(const bench_sample *run, int contact, int open_loop, const place *at)
{
    double over = -COMMAND_FORCE, last = 0;
    int settled = contact, lost = 0;
    for (int k = DRIVEN - 20 * WITHIN; k < DRIVEN; k++) {
        last += run[k].pressed / (20 * WITHIN);
    }
    for (int k = contact + WITHIN; k < DRIVEN; k++) {
        const double force = smoothed(run, k);
        if (k >= contact + 4 * WITHIN) {
            over = fmax(over, force - COMMAND_FORCE);
        }
        if (fabs(force - last) > 0.05 * last) {
            settled = k;
        }
        lost += run[k].pressed == 0 && run[k - 1].pressed > 0;
    }
    const double settling = (double)(settled - contact) / (BOARD_RATE * WITHIN);
    const double late = (double)contact / open_loop, error = last / COMMAND_FORCE - 1;
    const bool good = contact < DRIVEN && over <= 0.3 * COMMAND_FORCE &&
                      settling <= (lost > 0 ? 0.6 : 0.3) && fabs(error) <= 0.05 &&
                      late <= 1.5;
    printf(
        "%s start %.3f rad, wall %.0f N/m believed %+.3f rad off: %.0f %% over, "
        "settled in %.3f s, error %.1f %%, lost %d times, contact %.2f times as late\n",
        good ? "within" : "OUT   ", at->start, at->stiffness, at->off, 100 * over,
        settling, 100 * error, lost, late);
    fflush(stdout);
    return good;
}

static bool drive(int first, int count)
{
    static bench_sample read[DRIVEN];
    int good = 0;
    for (int i = first; i < first + count; i++) {
        bench_arm a = bench();
        random_generator random;
        random_seed(&random, (uint64_t)i);
        place at;
        at.start = -0.08 - 0.32 * random_uniform(&random);
        at.off = 0.02 * (2 * random_uniform(&random) - 1);
        at.stiffness = 1e3 * pow(100, random_uniform(&random));
        at.damping = 40 * random_uniform(&random);
        a.start = at.start;
        a.wall_stiffness = at.stiffness;
        a.wall_damping = at.damping;
        if (!bench_arm_run_mujoco(&a, volt_to_the_wall, NULL, DRIVEN, BOARD_RATE * WITHIN,
                                  read)) {
            return false;
        }
        const int open_loop = first_contact(read);

        board b = {.off = at.off};
        random_seed(&b.random, (uint64_t)i + 1000);
        const char *refusal = law_start();
        if (refusal != NULL) {
            fprintf(stderr, "the law refuses: %s\n", refusal);
            return false;
        }
        bench_arm_run_mujoco(&a, law_answers, &b, DRIVEN, BOARD_RATE * WITHIN, read);
        good += judge(read, first_contact(read), open_loop, &at);
    }
    printf("%d of %d within the bounds\n", good, count);
    return 5 * good >= 4 * count;
}
#endif

int main(int count, char **words)
{
    if (count == 4 && strcmp(words[1], "record") == 0) {
        return !record(strtod(words[2], NULL), strtoull(words[3], NULL, 10));
    }
#ifdef HAS_LAW
    if (count == 4 && strcmp(words[1], "drive") == 0) {
        return !drive(atoi(words[2]), atoi(words[3]));
    }
#endif
    fprintf(stderr, "usage: bench_board record VOLTS SEED | drive FIRST COUNT\n");
    return 2;
}
