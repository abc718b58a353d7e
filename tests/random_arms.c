// Random arms with two to five features at once, by an engine, and by a reference: the
// same contacts at the same instants with the same momenta, forces and losses, or the
// engine is wrong.
//
//     random_arms [NAME=VALUE]...
//
// The names with their defaults:
//
//     count=200     how many arms there are
//     first=0       the number of the first one
//     least=1       the least number of links
//     most=8        the largest number of links
//     engine=auto   the engine under test, a value of method.engine
//     by=explicit   the reference: explicit; implicit, for arms of 24 links at most
//                   that are not tilted and whose wall does not move; fine, the same
//                   engine at a hundredth of its tolerance; or a value of method.engine
//     contacts=10   contacts after which the runs end: 2 compares them up to the first
//                   contact again
//     gate=a        limits: a 1e-9 s, 1e-7 of the momentum, 1e-6 of the peak;
//                   b 1e-11 s, 1e-9 and 1e-8
//     damping=1     the largest damping ratio
//     tolerance=0   tolerance of the engine's steps, with which the ledgers close to
//                   1e-10 of what was put in; 0 stands for its own
//     place=near    near: links soon meet a wall at 0.1 rad; whole: half of the arms have
//                   one link, walls differ by powers of ten, are at any angle and are met
//                   from both sides
//     moves=0       1: walls that move, arms in tilted planes, or both, beside one to
//                   three features
//     tight=0       1: half of the arms have one link, walls have a restitution up to 1,
//                   most currents are limited, down to 1e-4 A
//     cost=0        1: prints the processor time of both, and their ratio
//
// Arm i is drawn with the seed i. Bounces amplify what is different at the start. So a
// limit is the larger one of two: the one stated above, and ten times what changes in the
// reference when the arm has 1e-12 more of mass and starts a few roundings away. Limits
// of the momentum are shares of the momentum that the wall took, and at least of a
// thousandth of the most that the arm can have. Where the reference does not agree with
// itself at another tolerance, the arm counts as unsure. An arm that starts behind its
// wall must be refused, and no other for where it starts.
#include <time.h>

#include "src/base/clock.h"
#include "tests/explicit_stepper.h"
#include "tests/force_means.h"
#include "tests/random_arm.h"
#include "tests/reference/implicit_arm.h"

#define AFTER_CONTACT 0.0501
#define DURATION      0.15
// of the explicit formula: its fastest rate times its time step
#define SUBSTEPS      20
#define FASTEST       3e6   // beyond which the explicit formula takes too long [1/s]
#define FASTEST_WHOLE 1e6   // the same with wall and motor
#define LOSSES        1e-5  // what may be of each loss, as a share of what was put in
#define NEXT_TO_NONE  1e-12 // share of the mass
#define NEXT_TO       1e-3  // of that, as an angle: some roundings of one [rad]
#define LEAST_SHARE   1e-3  // of the arm's own momentum, of which shares are taken
#define IMPLICIT_MOST 24    // links
#define LEAST_FORCE   1e-3  // of which shares are taken: 1e-6 of it counts as tension [N]
#define ROUNDED_FORCE 1e-12 // [N]
#define LEAST_GAP     2e-12 // what the engines take for a touch, twice [m]
// of what was put in: half of that with which a run is inaccurate
#define OPEN_LEDGER 5e-7
#define LEAST_WORK  1e-9 // the same of what was put in [J]
#define PEAK_TIME   1e-5 // what the instant of the largest force may be off by [s]

enum { LONGEST_LIST = 20 };

// What the command line asks for; its names are explained above.
typedef struct options {
    int count, first, least, most, contacts;
    char engine[32], by[32];
    bool strict, cost, whole, moves, tight; // strict: gate=b; whole: place=whole
    double damping, tolerance;
} options;

// By how much two outcomes may differ.
typedef struct limits {
    double time;           // of contacts [s]
    double momentum, peak; // shares
} limits;

static bool chance(random_generator *g, double share)
{
    return random_uniform(g) < share;
}

typedef enum feature {
    UNEVEN_LINKS,
    UNEVEN_JOINTS,
    TIP_MASS,
    STIFFENING,
    MODAL_DAMPING,
    AIR,
    INDUCTANCE,
    CURRENT_LIMIT,
    SOFT_WALL,
    RESTITUTION,
    DAMPING,
    FEATURES
} feature;

static void set_wall(random_arm *r, random_generator *g, const options *o)
{
    const double which = random_uniform(g);
    const bool hertz = which<0.35, face = which> 0.75;
    const double least = o->whole ? 1e-3 : hertz ? 1e2 : 1, most = hertz ? 1e6 : 300;
    set(r, "wall.contact=%s", hertz ? "hunt-crossley" : "kelvin-voigt");
    set(r, "wall.stiffness=%.17g",
        between(g, o->whole ? 1 : 1e2, hertz || o->whole ? 1e8 : 1e6));
    set(r, "wall.damping=%.17g",
        chance(g, 0.3) ? 0 : between(g, least, o->whole ? 1e6 : most));
    if (hertz) {
        set(r, "wall.exponent=%.17g",
            chance(g, 0.7) ? 1.5 : between(g, 1, o->whole ? 5 : 3));
    }
    if (face) { // which is met by an impact
        set(r, "wall.mass=%.17g", between(g, o->whole ? 1e-6 : 1e-3, o->whole ? 1e3 : 1));
        set(r, "wall.restitution=%.17g", chance(g, 0.5) ? 0 : 0.95 * random_uniform(g));
    }
}

// One feature of the arm.
static void add_feature(random_arm *r, random_generator *g, feature f, int links,
                        bool rigid, double k2, const options *o)
{
    const int joints = links - (rigid ? 1 : 0);
    switch (f) {
    case UNEVEN_LINKS:
        set_list(r, g, "arm.link_lengths", links, 1.0 / links, 1.5);
        break;
    case UNEVEN_JOINTS:
        if (joints > 0) {
            set_list(r, g, "arm.joint_stiffness", joints, k2 * links / 2, 2);
        }
        break;
    case TIP_MASS:
        set(r, "arm.tip_mass=%.17g", between(g, 1e-3, 0.5));
        break;
    case STIFFENING:
        set(r, "arm.stiffening=%.17g", between(g, 0.1, 30));
        break;
    case MODAL_DAMPING:
        if (joints > 0) {
            set_list(r, g, "arm.modal_ratios", joints < 4 ? joints : 4, 0.01, 8);
        }
        break;
    case AIR:
        set(r, "arm.air_drag=%.17g", between(g, 1e-2, 5));
        break;
    case INDUCTANCE:
        set(r, "motor.inductance=%.17g", between(g, 1e-4, 2));
        break;
    case CURRENT_LIMIT:
        set(r, "motor.current_limit=%.17g", between(g, o->tight ? 1e-4 : 0.1, 5));
        break;
    case SOFT_WALL:
        set_wall(r, g, o);
        break;
    case RESTITUTION:
        set(r, "wall.restitution=%.17g",
            o->tight && chance(g, 0.3) ? 1 : (o->tight ? 1 : 0.95) * random_uniform(g));
        break;
    case DAMPING:
        set(r, "arm.damping_ratio=%.17g", between(g, 1e-4, o->damping));
        break;
    case FEATURES:
        break;
    }
}

// Puts the arm in front of a wall at any angle, soon to meet it from one side or the
// other, on it, or anywhere, which may be behind it.
static void place_anywhere(random_arm *r, random_generator *g)
{
    const double wall = 6 * random_uniform(g) - 3, where = random_uniform(g);
    const double apart = fabs(r->velocity) * between(g, 2e-3, 2e-2);
    r->angle = wall - apart;
    if (where < 0.3) {
        r->angle = wall - M_PI + apart;
        r->velocity = -r->velocity;
    } else if (where < 0.4) {
        r->angle = wall;
        r->velocity = chance(g, 0.5) ? 0 : r->velocity;
    } else if (where < 0.55) {
        r->angle = 6 * random_uniform(g) - 3;
    }
    r->angle = fmax(-3, fmin(r->angle, 3));
    set(r, "wall.angle=%.17g", wall);
    set(r, "initial.angle=%.17g", r->angle);
}

// A wall that moves, from which the arm starts as far as from its place, a tilted plane,
// or both.
static void set_moving(random_arm *r, random_generator *g)
{
    for (int i = 0; i < r->count; i++) {
        if (strncmp(r->settings[i], "wall.mass=", strlen("wall.mass=")) == 0) {
            set(r, "wall.kind=plane"); // as a face must be
        }
    }
    const bool moves = chance(g, 0.8);
    if (moves) {
        const double amplitude = between(g, 1e-6, 3e-3) * (chance(g, 0.5) ? 1 : -1);
        set(r, "wall.motion=%s", chance(g, 0.5) ? "sine" : "step");
        set(r, "wall.motion_amplitude=%.17g", amplitude);
        set(r, "wall.motion_frequency=%.17g", between(g, 1, 300));
        set(r, "wall.motion_time=%.17g", 0.1 * random_uniform(g));
        r->angle -=
            copysign(1.01 * amplitude, r->velocity); // away from the side it comes to
    }
    if (!moves || chance(g, 0.5)) {
        set(r, "arm.tilt=%.17g", (chance(g, 0.5) ? 1 : -1) * between(g, 1e-3, 1.5));
    }
}

// Whether a feature can be had beside those that there are, with so many links and
// joints.
static bool goes_with(const bool *has, feature f, int links, int joints)
{
    static const feature clashes[][2] = {{MODAL_DAMPING, DAMPING},
                                         {STIFFENING, UNEVEN_LINKS},
                                         {STIFFENING, UNEVEN_JOINTS},
                                         {RESTITUTION, SOFT_WALL}};
    for (EACH(c, clashes)) {
        if ((f == (*c)[0] && has[(*c)[1]]) || (f == (*c)[1] && has[(*c)[0]])) {
            return false;
        }
    }
    const bool list = f == UNEVEN_LINKS || f == UNEVEN_JOINTS;
    return (!list || links <= LONGEST_LIST) &&
           (joints > 0 || (f != UNEVEN_JOINTS && f != MODAL_DAMPING));
}

static void make_arm(random_arm *r, int number, const options *o)
{
    random_generator g = seeded((uint64_t)number * 7919 + 17);
    r->count = 0;
    const int drawn = o->least + (int)((o->most - o->least + 1) * random_uniform(&g) *
                                       random_uniform(&g));
    const int links = (o->whole || o->tight) && chance(&g, 0.5) ? 1 : drawn;
    const bool rigid = chance(&g, 0.4), beam = !rigid && chance(&g, 0.7);
    set(r, "arm.links=%d", links);
    set(r, "arm.hub_joint=%s", rigid ? "rigid" : beam ? "beam" : "spring");
    set(r, "wall.kind=%s", chance(&g, 0.5) ? "plane" : "point");
    set(r, "motor.voltage=%.17g", (chance(&g, 0.1) ? -1 : 1) * between(&g, 0.3, 10));
    const double k2 = between(&g, 1, 50);
    set(r, "arm.mass=%.17g", between(&g, 0.1, 2));
    set(r, "arm.hub_inertia=%.17g", between(&g, 1e-3, 5e-2));
    set(r, "motor.stiction=%.17g", chance(&g, 0.5) ? 0.045 : between(&g, 1e-3, 0.5));
    r->velocity = between(&g, 0.05, 5);
    r->angle = 0.1 - r->velocity * between(&g, 2e-3, 2e-2);
    if (o->whole) {
        place_anywhere(r, &g);
    }

    // two to five different features that go together
    bool has[FEATURES] = {[CURRENT_LIMIT] = o->tight && chance(&g, 0.7),
                          [RESTITUTION] = o->tight && chance(&g, 0.7)};
    const int most =
        o->moves ? 1 + (int)random_below(&g, 3) : 2 + (int)random_below(&g, 4);
    for (int wanted = most; wanted > 0;) {
        const feature f = (feature)random_below(&g, FEATURES);
        if (!has[f]) {
            has[f] = goes_with(has, f, links, links - (beam ? 0 : 1));
            wanted--;
        }
    }
    if (!has[UNEVEN_JOINTS]) {
        set(r, "arm.k2=%.17g", k2);
    }
    for (int f = 0; f < FEATURES; f++) {
        if (has[f]) {
            add_feature(r, &g, (feature)f, links, !beam, k2, o);
        }
    }
    if (o->moves) {
        set_moving(r, &g);
    }
    if (o->tolerance > 0) {
        set(r, "method.tolerance=%.17g", o->tolerance);
    }
}

// Parameters of the arm; false if they are refused.
static bool resolve_arm(random_arm *r)
{
    fault f;
    parameters_defaults(&r->parameters, ARM_CORRECTED);
    for (int i = 0; i < r->count; i++) {
        const char *equals = strchr(r->settings[i], '=');
        const char *path =
            formatted("%.*s", (int)(equals - r->settings[i]), r->settings[i]);
        if (parameter_set_text(&r->parameters, parameter_find(path), equals + 1, &f) !=
            STATUS_OK) {
            return false;
        }
    }
    return parameters_resolve(&r->parameters, &f) == STATUS_OK;
}

// A run by the method's own engine, with what `setting` says of it.
static chain_outcome by_setting(const random_arm *r, const options *o,
                                const parameters *p, const char *path, const char *value)
{
    parameters with = *p;
    fault f;
    if (parameter_find(path) >= 0 &&
        (parameter_set_text(&with, parameter_find(path), value, &f) != STATUS_OK ||
         parameters_resolve(&with, &f) != STATUS_OK)) {
        fprintf(stderr, "random_arms: %s\n", f.text);
        exit(2);
    }
    return chain_outcome_of(&(chain_start){&with, r->angle, r->velocity, DURATION,
                                           AFTER_CONTACT, NULL, o->contacts});
}

// What is taken for right, coarser or finer, of an arm heavier by a share.
static chain_outcome by_reference(const random_arm *r, const options *o, double heavier,
                                  double finer)
{
    parameters p = r->parameters;
    p.arm.mass *= 1 + heavier;
    const engine *formula = finer > 1 ? &explicit_fine_engine : &explicit_engine;
    const chain_start start = {&p,
                               r->angle - NEXT_TO * heavier,
                               r->velocity,
                               DURATION,
                               AFTER_CONTACT,
                               formula,
                               o->contacts};
    if (strcmp(o->by, "explicit") == 0) {
        arm a = arm_of(&p);
        p.method.step = fmin(1e-5, SUBSTEPS / a.fastest_rate) / finer;
        return chain_outcome_of(&start);
    }
    if (strcmp(o->by, "implicit") == 0) {
        return implicit_outcome_of(&start, 1e-8 / finer);
    }
    if (strcmp(o->by, "fine") == 0) {
        const int tolerance = parameter_find("method.tolerance");
        parameters with = p;
        fault f;
        parameter_set_text(&with, parameter_find("method.engine"), o->engine, &f);
        return by_setting(r, o, &with, "method.tolerance",
                          formatted("%.17g", parameter_get(&p, tolerance) / 100 / finer));
    }
    return by_setting(r, o, &p, "method.engine", o->by);
}

// How fast the explicit formula must follow arm, motor and wall [1/s].
static double rate_of(const random_arm *r)
{
    static chain_link work[PARAMETER_LINKS_MOST];
    static double q[PARAMETER_LINKS_MOST + 1], response[PARAMETER_LINKS_MOST + 1];
    const parameters *p = &r->parameters;
    const double speed = (fabs(r->velocity) + 1) * p->arm.length;
    arm a = arm_of(p);
    double rate = a.fastest_rate;
    if (p->motor.inductance > 0) {
        rate = fmax(rate, p->motor.resistance / p->motor.inductance);
    }
    if (!wall_gives(&a.wall)) {
        return rate;
    }

    // with the wall, straight and at the speed at which it may come; the face on its own
    for (int i = 0; i < a.dof; i++) {
        q[i] = r->angle;
    }
    double compliance = chain_contact_response(&a, work, q, false, response);
    compliance /= 1 + a.wall.face_mass * compliance;
    rate = fmax(rate, wall_rate(&a.wall, compliance, 0, speed));
    return wall_has_face(&a.wall) ? fmax(rate, wall_face_rate(&a.wall, (wall_face){0, 1}))
                                  : rate;
}

static bool can_follow(const random_arm *r, const options *o)
{
    if (strcmp(o->by, "explicit") == 0 && o->whole) {
        return rate_of(r) <= FASTEST_WHOLE;
    }
    if (strcmp(o->by, "explicit") == 0) {
        arm a;
        arm_init(&a, &r->parameters);
        return a.fastest_rate <= FASTEST;
    }
    return strcmp(o->by, "implicit") != 0 ||
           (!o->moves && r->parameters.arm.links <= IMPLICIT_MOST);
}

// By how much two outcomes differ. The instant of a contact counts by the share of its
// speed in that of the first one; momentum, peak and losses are shares.
typedef struct distances {
    double time[OUTCOME_CONTACTS], momentum, peak, peak_time, lost;
    int contacts; // that both have
    bool same;    // both have as many contacts
} distances;

// Width of the interval in which the model determines the force on a wall that holds the
// whole arm together with stiction [N].
static double undetermined_force(const parameters *p)
{
    const bool held = p->arm.links == 1 && p->arm.hub_joint == HUB_RIGID &&
                      p->wall.contact == WALL_RIGID;
    return held ? 2 * p->motor.stiction / p->arm.length : 0;
}

static distances distances_of(const random_arm *r, const chain_outcome *a,
                              const chain_outcome *b)
{
    distances d = {.same = a->contacts == b->contacts};
    d.contacts = a->contacts < b->contacts ? a->contacts : b->contacts;
    d.contacts = d.contacts < OUTCOME_CONTACTS ? d.contacts : OUTCOME_CONTACTS;
    for (int i = 0; i < d.contacts; i++) {
        // a contact that grazes the wall has an instant as uncertain as its speed is
        // small
        const double graze =
            fmin(1, a->contact_speeds[i] / fmax(a->contact_speeds[0], 1e-300));
        const double apart = fabs(a->contact_times[i] - b->contact_times[i]);
        d.time[i] = apart * a->contact_speeds[i] < LEAST_GAP ? 0 : apart * graze;
    }

    // the momentum that the wall has taken by each sample
    const int samples = a->samples < b->samples ? a->samples : b->samples;
    for (int i = 0; i < samples; i++) {
        const double apart = fabs(a->momentum[i] - b->momentum[i]);
        d.momentum = fmax(d.momentum, apart - i * REFERENCE_INTERVAL *
                                                  undetermined_force(&r->parameters));
    }
    if (samples > 0) {
        const double mass = r->parameters.arm.mass + r->parameters.arm.tip_mass;
        const double own = LEAST_SHARE * sqrt(2 * mass * fmax(a->put_in, LEAST_WORK));
        d.momentum /= fmax(fabs(a->momentum[samples - 1]), own);
    }

    // the largest force and, of one that is more than rounding, its instant; a wall that
    // swings makes several equal ones
    if (a->peak > 0) {
        d.peak = fabs(a->peak - fmax(b->peak, 0)) / fmax(a->peak, LEAST_FORCE);
    }
    if (r->parameters.wall.motion == MOTION_NONE && a->peak > ROUNDED_FORCE) {
        d.peak_time = fabs(a->peak_time - b->peak_time);
    }

    // work and losses
    const double put_in = fmax(fmax(a->put_in, b->put_in), LEAST_WORK);
    d.lost = fabs(a->motor_work - b->motor_work) / put_in;
    for (size_t i = 0; i < sizeof a->lost / sizeof *a->lost; i++) {
        d.lost = fmax(d.lost, fabs(a->lost[i] - b->lost[i]) / put_in);
    }
    return d;
}

// The largest of the distances as a multiple of its limit. `change` has the distances
// between two references that differ by next to nothing.
static double worst_of(const distances *d, const distances *change, const limits *may)
{
    double worst = 0;
    for (int i = 0; i < d->contacts; i++) {
        worst = fmax(worst, d->time[i] / fmax(may->time, 10 * change->time[i]));
    }
    worst = fmax(worst, d->momentum / fmax(may->momentum, 10 * change->momentum));
    worst = fmax(worst, d->lost / fmax(LOSSES, 10 * change->lost));
    worst = fmax(worst, d->peak_time / fmax(PEAK_TIME, 10 * change->peak_time));
    return fmax(worst, d->peak / fmax(may->peak, 10 * change->peak));
}

// Takes "NAME=VALUE"; false if it is none of the options.
static bool take_option(options *o, const char *text)
{
    char name[16], value[32];
    if (sscanf(text, "%15[^=]=%31s", name, value) != 2) {
        return false;
    }

    // whole numbers
    const struct {
        const char *name;
        int *number;
    } numbers[] = {{"count", &o->count},
                   {"first", &o->first},
                   {"least", &o->least},
                   {"most", &o->most},
                   {"contacts", &o->contacts}};
    for (EACH(c, numbers)) {
        if (strcmp(name, c->name) == 0) {
            *c->number = atoi(value);
            return true;
        }
    }

    // others
    if (strcmp(name, "engine") == 0) {
        strcpy(o->engine, value);
    } else if (strcmp(name, "by") == 0) {
        strcpy(o->by, value);
    } else if (strcmp(name, "gate") == 0) {
        o->strict = value[0] == 'b';
    } else if (strcmp(name, "place") == 0) {
        o->whole = strcmp(value, "whole") == 0;
    } else if (strcmp(name, "cost") == 0) {
        o->cost = value[0] == '1';
    } else if (strcmp(name, "tight") == 0) {
        o->tight = value[0] == '1';
    } else if (strcmp(name, "moves") == 0) {
        o->moves = value[0] == '1';
    } else if (strcmp(name, "damping") == 0) {
        o->damping = atof(value);
    } else if (strcmp(name, "tolerance") == 0) {
        o->tolerance = atof(value);
    } else {
        return false;
    }
    return true;
}

// What came of the arms.
typedef struct tally {
    int compared, wrong;
    int said;            // the run itself says that it failed or is inaccurate
    int unsure;          // the reference is
    int behind, refused; // started behind its wall; cannot be computed
    double largest;      // distance, as a multiple of its limit
    double most_cost, open;
} tally;

// Whether the implicit reference finds what the run did: the explicit one takes a touch
// to 1e-12 m, which is much on a stiff wall, and may miss a bounce of that height.
static bool implicit_agrees(const random_arm *r, const options *o,
                            const chain_outcome *mine, const limits *may)
{
    options other = *o;
    strcpy(other.by, "implicit");
    if (!can_follow(r, &other)) {
        return false;
    }
    const chain_outcome finer = by_reference(r, &other, 0, 2);
    const chain_outcome heavier = by_reference(r, &other, NEXT_TO_NONE, 2);
    const distances d = distances_of(r, &finer, mine),
                    change = distances_of(r, &finer, &heavier);
    return finer.status == STATUS_OK && d.same && worst_of(&d, &change, may) <= 1;
}

// Whether the mean force between two samples of the momentum is one that the force had.
static bool means_are_possible(const chain_outcome *o)
{
    for (int i = 1; i < o->samples; i++) {
        const double mean = (o->momentum[i] - o->momentum[i - 1]) / REFERENCE_INTERVAL;
        if (!mean_is_within(mean, fmax(o->peak, 0), o->impulses, REFERENCE_INTERVAL)) {
            return false;
        }
    }
    return true;
}

// Runs an arm by the engine and by the reference, and counts what comes of it.
static void try_arm(random_arm *r, int number, const options *o, tally *t)
{
    const limits may =
        o->strict ? (limits){1e-11, 1e-9, 1e-8} : (limits){1e-9, 1e-7, 1e-6};

    // an arm behind its wall must be refused
    const bool resolved = resolve_arm(r);
    const parameters *p = &r->parameters;
    const bool behind =
        p->initial.angle > p->wall.angle || p->initial.angle < p->wall.angle - M_PI;
    if (behind) {
        t->behind++;
        if (resolved) {
            t->wrong++;
        }
        return;
    }
    if (!resolved || !can_follow(r, o)) {
        t->refused++;
        return;
    }

    // both outcomes, and what they cost
    double before = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    const chain_outcome mine =
        by_setting(r, o, &r->parameters, "method.engine", o->engine);
    const double cost = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
    before = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    const chain_outcome truth = by_reference(r, o, 0, 1);
    const double reference_cost = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
    if (truth.status != STATUS_OK) {
        t->unsure++;
        return;
    }

    // a run that failed, or whose ledger is open, says so itself. No progress is no limit
    // of these arms
    char what[300];
    t->compared++;
    const double least = o->tolerance > 0 ? 1e-10 : o->strict ? 1e-9 : OPEN_LEDGER;
    const bool closes = mine.residual <= least * fmax(mine.put_in, LEAST_WORK);
    if (mine.status != STATUS_OK || mine.residual > r->parameters.method.residual_bound *
                                                        fmax(mine.put_in, LEAST_WORK)) {
        t->said++;
        if (mine.status == STATUS_NO_PROGRESS) {
            t->wrong++;
        }
        snprintf(what, sizeof what, "%s, ledger %.3g of %.3g J", status_text(mine.status),
                 mine.residual, mine.put_in);
        describe(r, number, what);
        return;
    }
    if (!means_are_possible(&mine)) {
        describe(r, number, "WRONG: a mean that the force never was");
        t->wrong++;
        return;
    }

    // where the two differ by too much, the reference is asked again: at a finer
    // tolerance and with next to nothing of mass more
    distances d = distances_of(r, &truth, &mine);
    const distances none = {0};
    double worst = worst_of(&d, &none, &may);
    if (!d.same || worst > 1 || !closes) {
        const chain_outcome again = by_reference(r, o, 0, 2);
        const chain_outcome heavier = by_reference(r, o, NEXT_TO_NONE, 1);
        const distances own = distances_of(r, &truth, &again);
        const distances change = distances_of(r, &truth, &heavier);

        // judged by the finer one, if that came to the end
        const bool ends = again.status == STATUS_OK;
        d = ends ? distances_of(r, &again, &mine) : d;
        worst = worst_of(&d, &change, &may);
        bool sure =
            ends && own.same && change.same && worst_of(&own, &change, &may) < 0.3;
        if (sure && strcmp(o->by, "explicit") == 0) {
            sure = !implicit_agrees(r, o, &mine, &may);
        }
        if (!d.same || worst > 1 || !closes) {
            int at = 0;
            while (at < d.contacts - 1 && d.time[at] <= may.time) {
                at++;
            }
            snprintf(what, sizeof what,
                     "%s (%.2g times what may be; contacts %d for %d, the %d-th %.1e s, "
                     "momentum %.1e, peak %.1e, losses %.1e, ledger %.1e)",
                     sure ? "WRONG" : "unsure", worst, mine.contacts, truth.contacts,
                     at + 1, d.contacts > 0 ? d.time[at] : 0, d.momentum, d.peak, d.lost,
                     mine.residual / mine.put_in);
            describe(r, number, what);
            if (sure) {
                t->wrong++;
            } else {
                t->unsure++;
            }
            return;
        }
    }
    t->largest = fmax(t->largest, worst);
    t->open = fmax(t->open, mine.residual / fmax(mine.put_in, LEAST_WORK));
    if (o->cost) {
        printf("%d: %d links, %.1f us, %.1f us, ratio %.3g\n", number,
               r->parameters.arm.links, 1e6 * cost, 1e6 * reference_cost,
               cost / reference_cost);
    }
}

int main(int argc, char **argv)
{
    options o = {200, 0, 1, 8, OUTCOME_CONTACTS, "auto", "explicit", .damping = 1};
    for (int i = 1; i < argc; i++) {
        if (!take_option(&o, argv[i])) {
            fprintf(stderr, "random_arms: %s is no option\n", argv[i]);
            return 2;
        }
    }
    tally t = {0};
    for (int i = o.first; i < o.first + o.count; i++) {
        static random_arm r;
        make_arm(&r, i, &o);
        try_arm(&r, i, &o, &t);
    }
    printf("%d compared, %d wrong, %d with an open ledger or failed, %d of which the "
           "reference is not sure, %d not tried, %d refused behind their wall; of the "
           "rest at most %.2g of what may be, ledgers to %.1e\n",
           t.compared, t.wrong, t.said, t.unsure, t.refused, t.behind, t.largest, t.open);
    return t.wrong > 0 || t.compared == 0 || (o.whole && t.compared < t.refused);
}
