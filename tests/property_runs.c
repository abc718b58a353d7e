// Random runs beyond the two-link arm of random_runs.c: chains of 3 to 16 links, the rig
// under every built-in law, walls that give. What must hold of each:
//
// - it comes to its end with a closed ledger, or says in a sentence why it did not;
// - it takes less than MOST_SECONDS of a processor for a simulated second;
// - a tenth of the step gives the same first contact and the same impulse of it;
// - its events tell what is in contact and what sticks;
// - no mean of its force is beyond what the force was;
// - computed again, and resumed from a checkpoint with a change at any instant, it has
// the same bytes.
//
//     property_runs [COUNT [FIRST [chain|rig|soft]]]
//
// Run i is made of its own number, so one that failed is made again by `property_runs 1
// i`. The last line says how many runs were made, compared, resumed and found wrong.
#include "src/run/resume.h"
#include "tests/force_means.h"
#include "tests/random_settings.h"
#include "tests/shipped_scenario.h"
#include "tests/told_events.h"

#define MOST_SECONDS 20.0 // of the processor for one simulated second
#define SAME_CONTACT 1e-7 // [s], between the step and a tenth of it
#define SAME_IMPULSE 1e-4 // a share
enum { ROWS = 30000 };

typedef enum run_kind { CHAIN, RIG, SOFT, KINDS } run_kind;
static const char *const kind_names[KINDS] = {"chain", "rig", "soft"};

// The ranges: bit k of `kinds` is set where kind k takes them.
static const struct {
    const char *path;
    double from, to;
    spread spread;
    int kinds;
} ranges[] = {
    {"motor.voltage", -8, 8, EVEN, 1 << CHAIN | 1 << SOFT},
    {"motor.viscous_friction", 1e-4, 0.5, OR_ZERO, 7},
    {"motor.stiction", 1e-4, 0.5, OR_ZERO, 7},
    {"wall.restitution", 0, 0.9, EVEN, 1 << CHAIN},
    {"wall.stiffness", 1e2, 1e6, LOGARITHMIC, 1 << SOFT},
    {"wall.damping", 0.1, 100, LOGARITHMIC, 1 << SOFT},
    {"wall.exponent", 1, 2, EVEN, 1 << SOFT},
    {"arm.length", 0.3, 2, LOGARITHMIC, 7},
    {"arm.mass", 0.05, 2, LOGARITHMIC, 7},
    {"arm.k2", 0.5, 100, LOGARITHMIC, 7},
    {"arm.damping_ratio", 1e-3, 0.1, OR_ZERO, 7},
    {"arm.tip_mass", 1e-3, 0.2, OR_ZERO, 7},
    {"method.step", 1e-4, 1e-3, LOGARITHMIC, 7},
    {"initial.velocity", -2, 2, EVEN, 1 << CHAIN | 1 << SOFT},
    {"control.force", 0.1, 6, LOGARITHMIC, 1 << RIG},
    {"control.rate", 50, 2000, LOGARITHMIC, 1 << RIG},
    {"control.delay", 1e-4, 0.01, OR_ZERO, 1 << RIG},
    {"control.jitter", 1e-4, 0.002, OR_ZERO, 1 << RIG},
    {"control.approach_voltage", 0.3, 5, LOGARITHMIC, 1 << RIG},
    {"control.seed", 0, 1000, EVEN, 1 << RIG},
    {"belief.k2_factor", 0.7, 1.4, LOGARITHMIC, 1 << RIG},
    {"sensor.fsr_noise", 1e-3, 0.2, OR_ZERO, 1 << RIG},
    {"sensor.tachometer_noise", 1e-3, 0.2, OR_ZERO, 1 << RIG},
    {"motor.inductance", 1e-3, 0.3, OR_ZERO, 1 << RIG},
    {"motor.current_limit", 0.05, 5, OR_ZERO, 1 << RIG},
};
enum { RANGES = sizeof ranges / sizeof ranges[0] };

typedef struct tally {
    long made, wrong, refused, compared, resumed;
    double slowest;          // seconds of the processor for a simulated second
    double contact, impulse; // largest differences between the steps
} tally;

// --- what is run -----------------------------------------------------------------------

// Kinds of wall, joint and law, then the numbers; the arm starts on this side of the
// wall.
static bool make_run(random_run *r, uint64_t number, run_kind kind, fault *f)
{
    static const char *const walls[] = {"point", "plane"};
    static const char *const soft[] = {"kelvin-voigt", "hunt-crossley"};
    begin_run(r, (int)kind, number, number);
    r->must_fit = true;
    random_generator *g = &r->chance;

    set(r, "run.duration", kind == RIG ? "1.5" : "0.5");
    set_number(r, "arm.links",
               kind == CHAIN ? 3 + (double)random_below(g, 14)
                             : 2 + (double)random_below(g, kind == SOFT ? 5 : 3));
    set(r, "wall.kind", walls[random_below(g, 2)]);
    if (kind == SOFT) {
        set(r, "wall.contact", soft[random_below(g, 2)]);
    } else if (kind == CHAIN && random_uniform(g) < 0.3) {
        set(r, "arm.hub_joint", "beam");
    } else if (kind == RIG) {
        const int law = LAW_NONE + 1 + (int)random_below(g, LAW_PLUGIN - LAW_NONE - 1);
        set(r, "control.law", control_law_table[law].word);
        set(r, "sensor.ideal", random_uniform(g) < 0.5 ? "true" : "false");
    }

    for (int i = 0; i < RANGES; i++) {
        const double value =
            number_within(g, ranges[i].from, ranges[i].to, ranges[i].spread);
        if ((ranges[i].kinds >> kind & 1) != 0 && random_uniform(g) < 0.5) {
            set_number(r, ranges[i].path, value);
        }
    }
    set_number(r, "initial.angle",
               r->scenario.parameters.wall.angle -
                   number_within(g, 0.01, 0.5, LOGARITHMIC));
    return parameters_resolve(&r->scenario.parameters, f) == STATUS_OK;
}

// --- what is looked at -----------------------------------------------------------------

static void complain(tally *t, const random_run *r, const char *what, const char *more)
{
    t->wrong++;
    printf("%s %" PRIu64 ": %s: %s\n    impactlab run corrected/first-impact%s\n",
           kind_names[r->kind], r->number, what, more, r->options);
    fflush(stdout);
}

static bool same_rows(const run_result *a, const run_result *b)
{
    return a->trace.row_count == b->trace.row_count &&
           a->trace.event_count == b->trace.event_count &&
           memcmp(a->trace.rows, b->trace.rows, a->trace.row_count * sizeof(sample)) == 0;
}

// A tenth of the step: the same first contact, and the same impulse there.
static void check_step(tally *t, const random_run *r, const summary *of)
{
    scenario fine = r->scenario;
    run_result result;
    fine.parameters.method.step /= 10;
    run_scenario(&fine, false, &result);
    const summary *s = &result.summary;
    if (s->status == STATUS_OK && !s->inaccurate && !isnan(of->first_contact_s)) {
        char text[200];
        const double late = fabs(s->first_contact_s - of->first_contact_s);
        const double off = fabs(s->contact_impulse_Ns - of->contact_impulse_Ns) /
                           fmax(fabs(of->contact_impulse_Ns), 1e-6);
        t->compared++;
        t->contact = fmax(t->contact, late);
        t->impulse = fmax(t->impulse, isnan(off) ? 0 : off);
        snprintf(text, sizeof text, "first contact %.3g s off, impulse %.3g of it", late,
                 off);
        if (!(late <= SAME_CONTACT) || off > SAME_IMPULSE) {
            complain(t, r, "another step, another result", text);
        }
    }
    run_finish(&result);
}

// A change at any instant: resumed from the run without it, and from the start.
static void check_resumed(tally *t, random_run *r, const run_result *from)
{
    const double duration = r->scenario.parameters.run.duration;
    action change = SETS(duration * random_uniform(&r->chance), motor.voltage, 0.5);
    scenario later = r->scenario;
    later.actions = &change;
    later.action_count = 1;
    run_options options = {.keep_trace = true, .rows_expected = ROWS};
    run_result whole, resumed;
    run_scenario_with(&later, &options, &whole);

    options.resume = true;
    if (run_resume(from, &r->scenario, &later, ROWS, &resumed)) {
        run_scenario_with(&later, &options, &resumed);
        t->resumed++;
        if (!same_rows(&whole, &resumed)) {
            complain(t, r, "resumed, other bytes", "");
        }
    }
    run_finish(&resumed);
    run_finish(&whole);
}

static void time_is_up(int signal_number)
{
    (void)signal_number;
    end_with("a run does not end\n");
}

static void run_one(tally *t, uint64_t number, run_kind kind)
{
    const run_options options = {.keep_trace = true, .rows_expected = ROWS};
    random_run r;
    run_result result, again;
    fault f = {0};
    if (!make_run(&r, number, kind, &f)) {
        // values that do not go together are refused with a sentence
        t->refused++;
        return;
    }

    // the run itself, which may take ten times as long before it is given up
    const struct timeval limit = {.tv_sec = (time_t)(10 * MOST_SECONDS)};
    setitimer(ITIMER_PROF, &(struct itimerval){.it_value = limit}, NULL);
    run_scenario_with(&r.scenario, &options, &result);
    const summary *s = &result.summary;
    const double cost = s->cpu_time_s / r.scenario.parameters.run.duration;
    t->made++;
    t->slowest = fmax(t->slowest, cost);

    // its end
    if (s->status != STATUS_OK) {
        t->refused++;
        if (s->message[0] == '\0') {
            complain(t, &r, "failed without a sentence", "");
        }
    } else if (s->inaccurate) {
        complain(t, &r, "inaccurate", s->message);
    }
    if (cost > MOST_SECONDS) {
        complain(t, &r, "took too long", "");
    }

    const event *wrong = result.trace.row_count > 0 ? contradicting_event(&result) : NULL;
    if (wrong != NULL) {
        char text[80];
        snprintf(text, sizeof text, "%s at %.9g s", event_name(wrong->kind), wrong->time);
        complain(t, &r, "an event contradicts others", text);
    }
    const char *beyond = impossible_mean(&result);
    if (beyond != NULL) {
        complain(t, &r, beyond, "");
    }

    // the same again, in other ways
    if (s->status == STATUS_OK) {
        run_scenario_with(&r.scenario, &options, &again);
        if (!same_rows(&result, &again)) {
            complain(t, &r, "computed again, other bytes", "");
        }
        run_finish(&again);
        check_step(t, &r, s);
        if (kind != RIG) {
            check_resumed(t, &r, &result);
        }
    }
    run_finish(&result);
}

int main(int argc, char **argv)
{
    const uint64_t count = argc > 1 ? strtoull(argv[1], NULL, 10) : 100;
    const uint64_t from = argc > 2 ? strtoull(argv[2], NULL, 10) : 0;
    tally t = {0};
    signal(SIGPROF, time_is_up);

    for (uint64_t i = from; i < from + count; i++) {
        run_kind kind = (run_kind)(i % KINDS);
        for (int k = 0; argc > 3 && k < KINDS; k++) {
            kind = strcmp(argv[3], kind_names[k]) == 0 ? (run_kind)k : kind;
        }
        run_one(&t, i, kind);
    }
    printf("%ld runs, %ld ended by the model or refused, %ld compared with a "
           "tenth of the step (contact within %.2g s, impulse %.2g), %ld "
           "resumed, slowest %.3g s a second, %ld wrong\n",
           t.made, t.refused, t.compared, t.contact, t.impulse, t.resumed, t.slowest,
           t.wrong);
    return t.wrong > 0;
}
