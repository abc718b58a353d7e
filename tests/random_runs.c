// Random runs of the two-link arm over declared ranges of motor, wall, arm and restitution: each
// comes to its end with a closed ledger or says in a sentence why it did not.
//
//     random_runs [COUNT [FIRST [KIND]]]
//
// Run i is made of its own number, so one that failed is made again by `random_runs 1 i`. KIND is
// "wide" (all ranges at once) or "near" (the defaults with some of them changed); both by default.
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "src/base/random.h"
#include "src/run/run.h"

#define MOST_SECONDS 1.0 // of processor time for one run

// The hub's own spring is damped where it is soft, and less than the rest: the creep of a stiff one
// that is overdamped is followed in strides as brief as it is, for seconds of computing time.
#define STIFFEST_DAMPED 500.0 // [N m/rad]
#define SPRING_DAMPING  0.1   // share of the range of arm.damping_ratio

// How a number is spread over its range.
typedef enum spread {
    EVEN,        // evenly
    LOGARITHMIC, // its logarithm evenly
    OR_ZERO,     // half of the time zero, else its logarithm evenly
    ENDS,        // a quarter of the time each end, else evenly
} spread;

// The declared ranges; with a wall the arm starts on this side of it.
static const struct {
    const char *path;
    double from, to;
    spread spread;
} ranges[] = {
    {"motor.voltage", -10, 10, EVEN},
    {"motor.amplifier_gain", 1, 20, LOGARITHMIC},
    {"motor.torque_constant", 0.2, 20, LOGARITHMIC},
    {"motor.back_emf", 1e-2, 20, OR_ZERO},
    {"motor.resistance", 3, 300, LOGARITHMIC},
    {"motor.viscous_friction", 1e-4, 1, OR_ZERO},
    {"motor.stiction", 1e-4, 1, OR_ZERO},
    {"wall.angle", -1.5, 1.5, EVEN},
    {"wall.restitution", 0, 1, ENDS},
    {"arm.length", 0.2, 5, LOGARITHMIC},
    {"arm.mass", 0.02, 10, LOGARITHMIC},
    {"arm.hub_inertia", 1e-4, 0.5, LOGARITHMIC},
    {"arm.k1", 5, 2e5, LOGARITHMIC},
    {"arm.k2", 0.05, 500, LOGARITHMIC},
    {"arm.damping_ratio", 1e-4, 1, OR_ZERO},
    {"initial.angle", -1.5, 1.5, EVEN},
    {"initial.velocity", -5, 5, EVEN},
};

enum { RANGES = sizeof ranges / sizeof ranges[0] };

// What a run is made of: wide ones differ from the defaults in nearly everything, near ones in a
// few numbers. The settings are kept as options of the command line, too.
typedef struct random_run {
    random_generator chance;
    parameters parameters;
    char options[2048];
} random_run;

static double number_within(random_generator *g, double from, double to, spread how)
{
    const double first = random_uniform(g), second = random_uniform(g);
    switch (how) {
    case EVEN:
        return from + (to - from) * second;
    case LOGARITHMIC:
        return from * exp(second * log(to / from));
    case OR_ZERO:
        return first < 0.5 ? 0 : from * exp(second * log(to / from));
    case ENDS:
        return first < 0.25 ? from : first < 0.5 ? to : from + (to - from) * second;
    }
    return from;
}

static void set(random_run *r, const char *path, const char *value)
{
    const size_t length = strlen(r->options);
    parameter_set_text(&r->parameters, parameter_index(path), value, NULL);
    snprintf(r->options + length, sizeof r->options - length, " --set %s=%s", path, value);
}

static void make_run(random_run *r, uint64_t i, bool wide)
{
    static const char *const walls[] = {"point", "plane", "none"};
    static const char *const hubs[] = {"rigid", "rigid", "spring", "beam"};
    random_generator *g = &r->chance;
    random_seed(g, i);
    parameters_defaults(&r->parameters, ARM_CORRECTED);
    r->options[0] = '\0';

    // kinds
    const char *wall = walls[random_uniform(g) < 0.05 ? 2 : random_below(g, 2)];
    const char *hub = hubs[wide ? random_below(g, 4) : 0];
    set(r, "wall.kind", wall);
    set(r, "arm.hub_joint", hub);

    // numbers, some of which go with a kind only; an arm with a wall starts on this side of it
    for (int k = 0; k < RANGES; k++) {
        const char *path = ranges[k].path;
        bool taken = random_uniform(g) < (wide ? 0.9 : 0.25);
        double value = number_within(g, ranges[k].from, ranges[k].to, ranges[k].spread);
        if (strcmp(path, "initial.angle") == 0 && strcmp(wall, "none") != 0) {
            value = r->parameters.wall.angle - fabs(value);
            taken = taken || r->parameters.wall.angle < 0;
        }
        if (strcmp(path, "arm.k1") == 0) {
            taken = taken && strcmp(hub, "spring") == 0;
        }
        if (strcmp(path, "arm.damping_ratio") == 0 && strcmp(hub, "spring") == 0) {
            value *= SPRING_DAMPING;
            taken = taken && r->parameters.arm.k1 < STIFFEST_DAMPED;
        }
        if (taken) {
            char text[32];
            snprintf(text, sizeof text, "%.17g", value);
            set(r, path, text);
        }
    }
}

// --- a run that takes too long ----------------------------------------------------------------

static run_monitor monitor;

// Asks the run to end, and gives up if it does not even hear that.
static void time_is_up(int signal_number)
{
    (void)signal_number;
    if (atomic_exchange(&monitor.stop, true)) {
        static const char sentence[] = "a run does not end, not even when it is asked to\n";
        ssize_t ignored = write(STDOUT_FILENO, sentence, sizeof sentence - 1);
        (void)ignored;
        _exit(2);
    }
}

static void set_alarm(double seconds)
{
    const struct timeval after = {.tv_sec = (time_t)seconds};
    setitimer(ITIMER_PROF, &(struct itimerval){.it_interval = after, .it_value = after}, NULL);
}

// What is wrong with a run; NULL if nothing is. It may end where the model does.
static const char *complaint(const summary *of)
{
    if (of->status == STATUS_STOPPED || of->cpu_time_s > MOST_SECONDS) {
        return "took too long";
    }
    if (of->status != STATUS_OK && of->message[0] == '\0') {
        return "failed without a sentence";
    }
    if (of->status != STATUS_OK) {
        return of->status == STATUS_FOLDED ? NULL : "failed";
    }
    const bool finite = isfinite(of->motor_work_J) && isfinite(of->energy_residual_J) &&
                        isfinite(of->contact_impulse_Ns) == isfinite(of->first_contact_s);
    return of->inaccurate ? "inaccurate" : finite ? NULL : "a number is not finite";
}

// What the runs came to.
typedef struct tally {
    long wrong, folded;
    double longest, total; // computing time of a run, of all [s]
    double residual;       // the largest [J]
    double force;          // the largest of a run that came to its end [N]
} tally;

static void count_in(tally *t, const summary *of)
{
    t->longest = fmax(t->longest, of->cpu_time_s);
    t->total += of->cpu_time_s;
    t->residual = fmax(t->residual, of->energy_residual_J);
    t->folded += of->status == STATUS_FOLDED;
    if (of->status == STATUS_OK) {
        t->force = fmax(t->force, of->peak_force_N);
    }
}

static void report(uint64_t i, const char *what, const summary *of, const random_run *made)
{
    printf("%" PRIu64 ": %s: %s (residual %.3g J, peak %.4g N, %.3g s)\n", i, what, of->message,
           of->energy_residual_J, of->peak_force_N, of->cpu_time_s);
    printf("    impactlab run corrected/first-impact%s\n", made->options);
    fflush(stdout);
}

// One run; false if its settings are refused.
static bool run_one(uint64_t i, bool wide, bool always_said, tally *t)
{
    const run_options options = {.monitor = &monitor};
    char name[] = "random", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    random_run made;
    run_result r;
    fault f = {.text = ""};

    // its settings, which are to be good ones
    make_run(&made, i, wide);
    s.parameters = made.parameters;
    if (parameters_resolve(&s.parameters, &f) != STATUS_OK) {
        printf("%" PRIu64 ": %s\n   %s\n", i, f.text, made.options);
        return false;
    }

    atomic_store(&monitor.stop, false);
    set_alarm(2 * MOST_SECONDS);
    run_scenario_with(&s, &options, &r);
    const char *what = complaint(&r.summary);
    count_in(t, &r.summary);
    t->wrong += what != NULL;
    if (what != NULL || always_said) {
        report(i, what != NULL ? what : "fine", &r.summary, &made);
    }
    run_finish(&r);
    return true;
}

// Wide runs that were found wrong.
static const uint64_t once_wrong[] = {46,     57,     63,     321,    446,    523,    862,   1524,
                                      1726,   2011,   2404,   2949,   10962,  12852,  17099, 17671,
                                      33177,  48363,  52431,  56521,  57075,  76751,  94705, 97571,
                                      114341, 179733, 225449, 270765, 742155, 273903, 423927};

int main(int argc, char **argv)
{
    const uint64_t count = argc > 1 ? strtoull(argv[1], NULL, 10) : 2000;
    const uint64_t from = argc > 2 ? strtoull(argv[2], NULL, 10) : 0;
    const char *kind = argc > 3 ? argv[3] : "";
    tally t = {0};
    signal(SIGPROF, time_is_up);

    // the old acquaintances first, but where one run is asked for
    for (size_t i = 0; count > 1 && i < sizeof once_wrong / sizeof once_wrong[0]; i++) {
        t.wrong += !run_one(once_wrong[i], true, false, &t);
    }
    for (uint64_t i = from; i < from + count; i++) {
        const bool wide = *kind != '\0' ? strcmp(kind, "wide") == 0 : i % 2 == 1;
        t.wrong += !run_one(i, wide, count == 1, &t);
    }

    printf("%" PRIu64 " runs, %ld wrong, %ld folded over the hub; longest %.3g s, mean %.3g us, "
           "largest residual %.3g J, largest force %.4g N\n",
           count, t.wrong, t.folded, t.longest, 1e6 * t.total / (double)count, t.residual, t.force);
    return t.wrong > 0;
}
