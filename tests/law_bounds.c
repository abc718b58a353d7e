// Why a law is out of bounds on drawn cases (law_cases.h), and whether any command is within them.
//
//     law_bounds [SEED [COUNT [LAW [TRIALS [CAUSES [FOUND]]]]]]
//
// Of every run that is out of bounds a line tells: which error of the case, were it not there,
// would bring the law within them; and the best of all commands tried by somebody who knows arm,
// wall, delay and push and tries as often as wanted. That command is fixed before the run: two
// voltages to the touch, two from there, one that presses, and with a push two more against that.
// A search found within the bounds proves that the case is no matter of physics; one that found
// none proves nothing, since a law sees what happens. Last, the classes and how many are in each.
// Exit status 1 if fewer than CAUSES runs have such an error or fewer than FOUND such a command.
#include <unistd.h>

#include "src/arm/motor.h"
#include "tests/law_cases.h"

// A command in pieces: voltages, and the times for which they last but the last one.
enum { BEFORE_PUSH = 5, PIECES = 8, NUMBERS = 2 * PIECES };
typedef struct fixed_command {
    double x[NUMBERS]; // voltage and duration in turns [V], [s]
    int pieces;
} fixed_command;

static char command_file[] = "/tmp/law_bounds-XXXXXX";

static void write_command(const fixed_command *f, double push_time)
{
    FILE *file = fopen(command_file, "w");
    if (file == NULL) {
        perror(command_file);
        exit(2);
    }
    fputs("t,command\n", file);
    double time = 0;
    for (int i = 0; i < f->pieces; i++) {
        time = i == BEFORE_PUSH ? fmax(time, push_time) : time;
        fprintf(file, "%.9g,%.9g\n", time, f->x[2 * i]);
        time += fmax(1e-3, f->x[2 * i + 1]);
    }
    fclose(file);
}

// How far out of bounds a run is: 1 is at the nearest bound, NaN nowhere.
static double excess(const verdict *v)
{
    const double settling = isnan(v->settling) ? 4 : v->settling / (v->lost > 0 ? 0.6 : 0.3);
    const double worst =
        fmax(fmax(v->over / 30, fabs(v->error) / 5), fmax(settling, v->late / 1.5));
    return isnan(worst) ? 1e3 : fmin(worst, 1e3) + (v->within ? 0 : 1e-6);
}

static double tried(const law_case *c, const fixed_command *f, double command, double open_loop,
                    verdict *v)
{
    write_command(f, c->push_time);
    *v = judge(c, "playback", command, open_loop);
    return excess(v);
}

// Voltage that presses with a force at rest, on the arm of the defaults [V].
static double volts_pressing(double force)
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    return force * p.arm.length / motor_torque_per_volt(&p.motor);
}

// Tries commands round the best so far; steps grow with every success and shrink with failures.
static double search(const law_case *known, double command, double open_loop, int trials,
                     verdict *best)
{
    // the true arm played to: the file takes the place of a law
    law_case c = *known;
    add(&c, "control.playback_file=%s", command_file);
    add(&c, "control.playback_column=command");
    random_generator chance = {0};
    random_seed(&chance, 1);

    const double pressing = volts_pressing(command);
    static const double speeds[] = {0.3, 0.5, 0.8}; // [V] to the touch
    enum { STARTS = sizeof speeds / sizeof speeds[0] };
    double least = HUGE_VAL;
    for (int s = 0; s < STARTS && least > 1; s++) {
        fixed_command at = {.x = {1, open_loop / 2, speeds[s], open_loop / 2, pressing, 0.03,
                                  pressing, 0.03, pressing, 0.1, pressing, 0.03, pressing, 0.03,
                                  pressing, 0.1},
                            .pieces = known->push != 0 ? PIECES : BEFORE_PUSH};
        verdict v = {0};
        double here = tried(&c, &at, command, open_loop, &v), step = 0.3;
        if (here < least) {
            least = here;
            *best = v;
        }
        for (int i = 0; i < trials / STARTS && least > 1; i++) {
            fixed_command next = at;
            for (int j = 0; j < 2 * at.pieces; j++) {
                const double scale = j % 2 == 0 ? fmax(0.3, pressing) : 0.06;
                next.x[j] += random_below(&chance, 3) == 0
                                 ? step * scale * (2 * random_uniform(&chance) - 1)
                                 : 0;
            }
            const double there = tried(&c, &next, command, open_loop, &v);
            step = there < here ? fmin(1, 1.5 * step) : fmax(0.005, 0.95 * step);
            if (there < here) {
                here = there;
                at = next;
            }
            if (there < least) {
                least = there;
                *best = v;
            }
        }
    }
    return least;
}

// The case without one of its errors.
static law_case without(const law_case *c, int error)
{
    law_case less = *c;
    less.count = 0;
    for (int i = 0; i < c->count; i++) {
        if (c->of[i] != error) {
            memcpy(less.settings[less.count], c->settings[i], sizeof c->settings[i]);
            less.of[less.count++] = c->of[i];
        }
    }
    if (errors[error].draw == push) {
        less.push = 0;
    }
    return less;
}

static bool has(const law_case *c, int error)
{
    bool there = errors[error].draw == push && c->push != 0;
    for (int i = 0; i < c->count; i++) {
        there = there || c->of[i] == error;
    }
    return there;
}

typedef struct tally {
    const char *law;
    int trials;
    int out, lost, slow, high, wrong, late; // runs out of bounds, and by which of them
    int found;                              // of which some command is within them
    int by[ERRORS], several;                // an error without which the run is within; none is
} tally;

static void count_bounds(tally *t, const verdict *v)
{
    t->out++;
    t->lost += v->lost > 0;
    t->slow += !(v->settling <= (v->lost > 0 ? 0.6 : 0.3));
    t->high += v->over > 30;
    t->wrong += fabs(v->error) > 5;
    t->late += v->late > 1.5;
}

static void print_tally(const tally *t)
{
    printf("%d runs out of bounds: %d lose contact; %d slow, %d over, %d wrong, %d late\n", t->out,
           t->lost, t->slow, t->high, t->wrong, t->late);
    printf("some command within the bounds found for %d; none for %d\n", t->found,
           t->out - t->found);
    for (int e = 0; e < ERRORS; e++) {
        if (t->by[e] > 0) {
            printf("%4d within the bounds without: %s\n", t->by[e], errors[e].name);
        }
    }
    printf("%4d out of them whichever one error is missing\n", t->several);
}

// Prints which error of a run brings it within the bounds when it is missing, and counts it.
static void print_causes(tally *t, const law_case *c, double command)
{
    bool alone = false;
    for (int e = 0; e < ERRORS; e++) {
        if (!has(c, e)) {
            continue;
        }
        const law_case less = without(c, e);
        const double open_loop = run_case(&less, "open-loop", 1).first_contact_s;
        const bool cause = judge(&less, t->law, command, open_loop).within;
        t->by[e > 0 && errors[e].draw == errors[e - 1].draw ? e - 1 : e] += cause;
        alone = alone || cause;
        printf(" %s%s", errors[e].name, cause ? " (cause)," : ",");
    }
    t->several += !alone;
}

static void explain_case(void *to, int number, const law_case *c, int command, double open_loop,
                         const verdict *v)
{
    tally *t = to;
    if (v->within) {
        return;
    }
    count_bounds(t, v);
    printf("case %2d at %g N: over %.3g %%, %.3g s, %.2g %%, lost %g;", number, commands[command],
           v->over, v->settling, v->error, v->lost);
    print_causes(t, c, commands[command]);

    // and who knows all
    if (t->trials > 0) {
        verdict best = {0};
        const double least = search(c, commands[command], open_loop, t->trials, &best);
        t->found += best.within;
        printf(" best %.2f: over %.3g %%, %.3g s, lost %g%s", least, best.over, best.settling,
               best.lost, best.within ? ", not physics" : "");
    }
    putchar('\n');
    fflush(stdout);
}

int main(int count, char **words)
{
    const int seed = count > 1 ? atoi(words[1]) : 1, cases = count > 2 ? atoi(words[2]) : 40;
    const int causes = count > 5 ? atoi(words[5]) : 0, found = count > 6 ? atoi(words[6]) : 0;
    tally t = {.law = count > 3 ? words[3] : "observer",
               .trials = count > 4 ? atoi(words[4]) : 900};
    const int file = mkstemp(command_file);
    if (file < 0) {
        perror(command_file);
        return 2;
    }
    close(file);
    judge_cases(seed, cases, t.law, explain_case, &t);
    remove(command_file);
    print_tally(&t);
    return t.out - t.several < causes || t.found < found;
}
