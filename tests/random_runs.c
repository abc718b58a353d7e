// Random runs over declared ranges of motor, wall, arm and restitution: each comes to its
// end with a closed ledger, or says in a sentence why it did not.
//
//     random_runs [COUNT [FIRST [KIND]]]
//
// Run i is made of its own number, so one that failed is made again by `random_runs 1 i
// KIND`. KIND is "wide" (two links, all ranges at once), "near" (two links, the defaults
// with some of them changed) or "whole": one link and more, walls of all kinds by
// decades, starts at any angle on both sides of the wall. By default each number is a
// wide or near run, in turns, and a whole one.
//
// Of a whole run is looked at besides: that it is refused where it starts behind the
// wall, and only there; that the limit it fails by stands in docs/explanation/trust.md;
// that no arm is inside a rigid wall.
#include "tests/force_means.h"
#include "tests/listed_limits.h"
#include "tests/random_settings.h"

#define MOST_SECONDS       1.0   // of processor time for one run
#define MOST_SECONDS_WHOLE 20.0  // of a whole one
#define IN_FRONT           1e-12 // sine of the angle to the wall, less is rounding
#define DEEPEST            1e-9  // inside a rigid wall [m]

typedef enum run_kind { NEAR, WIDE, WHOLE, KINDS } run_kind;
static const char *const kind_names[KINDS] = {"near", "wide", "whole"};

// The hub's own spring is damped where it is soft, and less than the rest: the creep of a
// stiff one that is overdamped is followed in strides as brief as it is, for seconds of
// computing time.
#define STIFFEST_DAMPED 500.0 // [N m/rad]
#define SPRING_DAMPING  0.1   // share of the range of arm.damping_ratio

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

// Further ranges of whole runs, and the walls for whose contact they are: one bit for
// each.
enum {
    RIGID = 1 << WALL_RIGID,
    SPRING = 1 << WALL_KELVIN_VOIGT,
    HERTZ = 1 << WALL_HUNT_CROSSLEY
};
static const struct {
    const char *path;
    double from, to;
    spread spread;
    int contact;
} whole_ranges[] = {
    {"run.duration", 0.1, 1, LOGARITHMIC, RIGID | SPRING | HERTZ},
    {"motor.inductance", 1e-4, 10, OR_ZERO, RIGID | SPRING | HERTZ},
    {"motor.current_limit", 0.1, 10, OR_ZERO, RIGID | SPRING | HERTZ},
    {"wall.stiffness", 1, 1e12, LOGARITHMIC, SPRING | HERTZ},
    {"wall.damping", 1e-3, 1e9, OR_ZERO, SPRING | HERTZ},
    {"wall.mass", 1e-9, 1e3, OR_ZERO, SPRING},
    {"wall.exponent", 1, 5, EVEN, HERTZ},
    {"arm.tip_mass", 1e-4, 1, OR_ZERO, RIGID | SPRING | HERTZ},
    {"arm.air_drag", 1e-2, 5, OR_ZERO, RIGID | SPRING | HERTZ},
    {"arm.stiffening", 1e-1, 30, OR_ZERO, RIGID | SPRING | HERTZ},
    {"method.rest_speed", 1e-9, 1, OR_ZERO, RIGID | SPRING},
    {"wall.angle", -3, 3, EVEN, RIGID | SPRING | HERTZ},
    {"initial.angle", -3, 3, EVEN, RIGID | SPRING | HERTZ},
};

enum { WHOLE_RANGES = sizeof whole_ranges / sizeof whole_ranges[0] };

// Wide and whole runs differ from the defaults in nearly everything, near ones in a few
// numbers.

// Two links on a rigid wall, in front of it.
static void make_two_links(random_run *r)
{
    static const char *const walls[] = {"point", "plane", "none"};
    static const char *const hubs[] = {"rigid", "rigid", "spring", "beam"};
    random_generator *g = &r->chance;
    const bool wide = r->kind == WIDE;

    // kinds
    const char *wall = walls[random_uniform(g) < 0.05 ? 2 : random_below(g, 2)];
    const char *hub = hubs[wide ? random_below(g, 4) : 0];
    set(r, "wall.kind", wall);
    set(r, "arm.hub_joint", hub);

    // numbers, some of which go with a kind only; an arm with a wall starts on this side
    // of it
    for (int k = 0; k < RANGES; k++) {
        const char *path = ranges[k].path;
        bool taken = random_uniform(g) < (wide ? 0.9 : 0.25);
        double value = number_within(g, ranges[k].from, ranges[k].to, ranges[k].spread);
        if (strcmp(path, "initial.angle") == 0 && strcmp(wall, "none") != 0) {
            value = r->scenario.parameters.wall.angle - fabs(value);
            taken = taken || r->scenario.parameters.wall.angle < 0;
        }
        if (strcmp(path, "arm.k1") == 0) {
            taken = taken && strcmp(hub, "spring") == 0;
        }
        if (strcmp(path, "arm.damping_ratio") == 0 && strcmp(hub, "spring") == 0) {
            value *= SPRING_DAMPING;
            taken = taken && r->scenario.parameters.arm.k1 < STIFFEST_DAMPED;
        }
        if (taken) {
            set_number(r, path, value);
        }
    }
}

// Whether a number goes with the hub and wall that were drawn. Many strides are left out:
// those of a damped hub spring that is stiff.
static bool goes_with(const random_run *r, const char *path)
{
    const parameters *p = &r->scenario.parameters;
    const bool gives = p->wall.contact != WALL_RIGID,
               spring = p->arm.hub_joint == HUB_SPRING;
    return strcmp(path, "arm.k1") == 0 ? spring
           : strcmp(path, "arm.damping_ratio") == 0
               ? !spring || p->arm.k1 < STIFFEST_DAMPED
           : strcmp(path, "wall.restitution") == 0  ? !gives || p->wall.mass > 0
           : strcmp(path, "method.rest_speed") == 0 ? !gives || p->wall.mass > 0
                                                    : true;
}

// Any number of links, half of the time one; any wall.
static void make_whole(random_run *r)
{
    static const char *const walls[] = {"point", "plane", "none"};
    static const char *const hubs[] = {"rigid", "rigid", "spring", "beam"};
    static const char *const contacts[] = {"rigid", "kelvin-voigt", "hunt-crossley"};
    random_generator *g = &r->chance;
    const parameters *p = &r->scenario.parameters;

    // kinds
    const double much = random_uniform(g);
    set_number(r, "arm.links",
               much < 0.5 ? 1 : (double)(1 + random_below(g, much < 0.9 ? 4 : 16)));
    set(r, "arm.hub_joint", hubs[random_below(g, 4)]);
    set(r, "wall.kind", walls[random_uniform(g) < 0.03 ? 2 : random_below(g, 2)]);
    set(r, "wall.contact", contacts[random_below(g, 3)]);

    // numbers
    for (int k = 0; k < WHOLE_RANGES; k++) {
        const double value = number_within(g, whole_ranges[k].from, whole_ranges[k].to,
                                           whole_ranges[k].spread);
        const bool fits = (whole_ranges[k].contact >> p->wall.contact & 1) != 0 &&
                          goes_with(r, whole_ranges[k].path);
        const bool always = k == 0 || strstr(whole_ranges[k].path, "angle") != NULL;
        if (fits && (always || random_uniform(g) < 0.3)) {
            set_number(r, whole_ranges[k].path, value);
        }
    }
    for (int k = 0; k < RANGES; k++) {
        double value = number_within(g, ranges[k].from, ranges[k].to, ranges[k].spread);
        const bool taken =
            random_uniform(g) < 0.5 && strstr(ranges[k].path, "angle") == NULL;
        if (strcmp(ranges[k].path, "arm.damping_ratio") == 0 && p->arm.links > 2) {
            value *= SPRING_DAMPING; // whose decays are no faster than its vibrations
        }
        if (taken && goes_with(r, ranges[k].path)) {
            set_number(r, ranges[k].path, value);
        }
    }

    // some start on one side of the wall or the other, or next to it
    const double where = random_uniform(g), near = exp(-20 * random_uniform(g));
    if (where < 0.2) {
        const double side = random_uniform(g) < 0.5 ? 0 : M_PI;
        set_number(r, "initial.angle", p->wall.angle - side + (side > 0 ? near : -near));
    } else if (where < 0.25) {
        set_number(r, "initial.angle", p->wall.angle);
    }
}

static void make_run(random_run *r, uint64_t i, run_kind kind)
{
    begin_run(r, (int)kind, i, kind == WHOLE ? ~i : i);
    (kind == WHOLE ? make_whole : make_two_links)(r);
}

// --- a run that takes too long ---------------------------------------------------------

static run_monitor monitor;

// Asks the run to end, and gives up if it does not even hear that.
static void time_is_up(int signal_number)
{
    (void)signal_number;
    if (atomic_exchange(&monitor.stop, true)) {
        end_with("a run does not end, not even when it is asked to\n");
    }
}

static void set_alarm(double seconds)
{
    const struct timeval after = {.tv_sec = (time_t)seconds};
    setitimer(ITIMER_PROF, &(struct itimerval){.it_interval = after, .it_value = after},
              NULL);
}

// Whether a row that was recorded shows the arm inside a rigid wall.
static bool is_inside(const run_result *r)
{
    bool inside = false;
    for (size_t i = 0; i < r->trace.row_count; i++) {
        inside = inside || r->trace.rows[i].gap < -DEEPEST;
    }
    return inside;
}

static listed_limits limits;

// What is wrong with a whole run; NULL if nothing is.
static const char *complaint_of_whole(const random_run *made, const run_result *r)
{
    const summary *of = &r->summary;
    const wall_parameters *wall = &made->scenario.parameters.wall;
    if (of->status != STATUS_OK) {
        return listed_limits_find(&limits, of->message) >= 0
                   ? NULL
                   : "failed by no listed limit";
    }
    const bool rigid = wall->kind != WALL_NONE && wall->contact == WALL_RIGID;
    return rigid && !of->inaccurate && is_inside(r) ? "is inside the wall" : NULL;
}

// What is wrong with a run; NULL if nothing is. It may end where the model does.
static const char *complaint(const random_run *made, const run_result *r)
{
    const summary *of = &r->summary;
    const bool whole = made->kind == WHOLE;
    if (of->status == STATUS_STOPPED ||
        of->cpu_time_s > (whole ? MOST_SECONDS_WHOLE : MOST_SECONDS)) {
        return "took too long";
    }
    if (of->status != STATUS_OK && of->message[0] == '\0') {
        return "failed without a sentence";
    }
    if (of->status != STATUS_OK && !whole) {
        return of->status == STATUS_FOLDED ? NULL : "failed";
    }
    const bool finite = isfinite(of->motor_work_J) && isfinite(of->energy_residual_J) &&
                        isfinite(of->contact_impulse_Ns) == isfinite(of->first_contact_s);
    if (of->status == STATUS_OK && !finite) {
        return "a number is not finite";
    }
    const char *beyond = impossible_mean(r);
    if (beyond != NULL) {
        return beyond;
    }
    return whole ? complaint_of_whole(made, r) : of->inaccurate ? "inaccurate" : NULL;
}

// What the runs came to.
typedef struct tally {
    long runs, wrong, folded, refused, inaccurate;
    long by_limit[MOST_LIMITS]; // whole runs that failed
    double longest, total;      // computing time of a run, of all [s]
    double residual;            // the largest [J]
    double force;               // the largest of a run that came to its end [N]
} tally;

static void count_in(tally *t, const summary *of)
{
    const int limit = listed_limits_find(&limits, of->message);
    t->runs++;
    t->longest = fmax(t->longest, of->cpu_time_s);
    t->total += of->cpu_time_s;
    t->folded += of->status == STATUS_FOLDED;
    if (of->status == STATUS_OK) {
        t->residual = fmax(t->residual, of->energy_residual_J);
        t->force = fmax(t->force, of->peak_force_N);
        t->inaccurate += of->inaccurate;
    } else if (limit >= 0) {
        t->by_limit[limit]++;
    }
}

static void report(uint64_t i, const char *what, const summary *of,
                   const random_run *made)
{
    printf("%s %" PRIu64 ": %s: %s (residual %.3g J, peak %.4g N, %.3g s)\n",
           kind_names[made->kind], i, what, of->message, of->energy_residual_J,
           of->peak_force_N, of->cpu_time_s);
    printf("    impactlab run corrected/first-impact%s\n", made->options);
    fflush(stdout);
}

// Whether a whole arm starts where it may not: on the far side of the wall, or a turn
// further.
static bool starts_behind(const parameters *p)
{
    const double ahead = sin(p->wall.angle - p->initial.angle);
    return p->wall.kind != WALL_NONE &&
           (ahead < -IN_FRONT || p->initial.angle > p->wall.angle);
}

// Whether a run's settings are taken; counts a start that is refused as it should be, and
// complains of others.
static bool is_taken(uint64_t i, random_run *made, parameters *resolved, tally *t)
{
    fault f = {.text = "", .path = ""};
    const bool behind = made->kind == WHOLE && starts_behind(&made->scenario.parameters);
    const bool taken = parameters_resolve(resolved, &f) == STATUS_OK;
    const bool blamed = strstr(f.path, "angle") != NULL;
    const bool fits = taken ? !behind : behind && blamed;
    t->refused += !taken && fits;
    t->wrong += !fits;
    if (!fits) {
        printf("%s %" PRIu64 ": %s: %s\n   %s\n", kind_names[made->kind], i,
               taken ? "starts behind the wall" : "is refused", f.text, made->options);
    }
    return taken && fits;
}

// One run.
static void run_one(uint64_t i, run_kind kind, bool always_said, tally *t)
{
    const run_options options = {.monitor = &monitor, .keep_trace = kind == WHOLE};
    random_run made;
    run_result r;

    // its settings, which are to be good ones
    make_run(&made, i, kind);
    scenario s = made.scenario;
    if (!is_taken(i, &made, &s.parameters, t)) {
        return;
    }

    atomic_store(&monitor.stop, false);
    set_alarm(2 * (kind == WHOLE ? MOST_SECONDS_WHOLE : MOST_SECONDS));
    run_scenario_with(&s, &options, &r);
    const char *what = complaint(&made, &r);
    count_in(t, &r.summary);
    t->wrong += what != NULL;
    if (what != NULL || always_said) {
        report(i, what != NULL ? what : "fine", &r.summary, &made);
    }
    run_finish(&r);
}

// Wide runs that were found wrong.
static const uint64_t once_wrong[] = {46,     57,     63,     321,    446,    523,
                                      862,    1524,   1726,   2011,   2404,   2949,
                                      10962,  12852,  17099,  17671,  33177,  48363,
                                      52431,  56521,  57075,  76751,  94705,  97571,
                                      114341, 179733, 225449, 270765, 742155, 273903,
                                      423927};

int main(int argc, char **argv)
{
    const uint64_t count = argc > 1 ? strtoull(argv[1], NULL, 10) : 2000;
    const uint64_t from = argc > 2 ? strtoull(argv[2], NULL, 10) : 0;
    const char *kind = argc > 3 ? argv[3] : "";
    tally t = {0};
    listed_limits_read(&limits);
    signal(SIGPROF, time_is_up);

    // the old acquaintances first, but where one run is asked for
    for (size_t i = 0; count > 1 && i < sizeof once_wrong / sizeof once_wrong[0]; i++) {
        run_one(once_wrong[i], WIDE, false, &t);
    }
    for (uint64_t i = from; i < from + count; i++) {
        for (run_kind k = NEAR; k < KINDS; k++) {
            const bool in_turn = k == WHOLE || (k == WIDE) == (i % 2 == 1);
            if (*kind != '\0' ? strcmp(kind, kind_names[k]) == 0 : in_turn) {
                run_one(i, k, count == 1, &t);
            }
        }
    }

    printf("%ld runs, %ld wrong, %ld folded over the hub, %ld inaccurate, %ld "
           "more refused for where they start; longest %.3g s, mean %.3g us, "
           "largest residual %.3g J, largest force %.4g N\n",
           t.runs, t.wrong, t.folded, t.inaccurate, t.refused, t.longest,
           1e6 * t.total / (double)t.runs, t.residual, t.force);
    for (int k = 0; k < limits.count; k++) {
        if (t.by_limit[k] > 0) {
            printf("    %ld failed: %s\n", t.by_limit[k], limits.words[k]);
        }
    }
    return t.wrong > 0;
}
