// Random arms of many links that hit a wall, by the engine that a run takes, and by the explicit
// formula at strides so short that it is exact: none may be wrong with a ledger that closes.
//
//     random_chains [COUNT [FIRST [LEAST [MOST [KIND]]]]]     default: 200 0 6 20 plain
//
// LEAST to MOST links. KIND: `plain`, equal bare links; `uneven`, links and joints given one by
// one, or a mass at the tip; `loaded`, joints that stiffen, damping by mode, air; `electric`, a
// motor with inductance or a limit of its current.
//
// Run i is made of its own number. Compared are first contact (1 us), its impulse (1e-4), the
// momentum after 1 and up to 50 ms (1e-3) and what a 1 ms sensor reads (5e-3, root mean square); of
// arms that are not plain also the largest force (1e-5), when it is (1e-5 s), and each loss (1e-6
// of what was put in). Where the explicit formula does not agree with itself at finer strides,
// the motion is chaotic and nothing is said.

#include "tests/chain_outcome.h"
#include "tests/explicit_stepper.h"
#include "tests/random_arm.h"

#define AFTER_CONTACT 0.0501
#define DURATION      0.1
#define SUBSTEPS      20  // of the explicit formula: its fastest rate times its time step
#define FASTEST       3e6 // beyond which the explicit formula takes too long [1/s]
#define FINER         0.2 // its strides, where a bounce that two long ones miss would be seen

// What is compared.
typedef enum chain_kind {
    KIND_PLAIN,
    KIND_UNEVEN,
    KIND_LOADED,
    KIND_ELECTRIC,
    KIND_SOFT,
    KIND_HERTZ,
    KIND_FACE,
    KINDS
} chain_kind;
static const char *const kind_names[KINDS] = {"plain", "uneven", "loaded", "electric",
                                              "soft",  "hertz",  "face"};

static chain_outcome simulate(const random_arm *c, const parameters *p, const engine *by)
{
    return chain_outcome_of(&(chain_start){p, c->angle, c->velocity, DURATION, AFTER_CONTACT, by});
}

// By the explicit formula.
static chain_outcome by_formula(const random_arm *c, double step)
{
    parameters p = c->parameters;
    p.method.step = step;
    return simulate(c, &p, &explicit_engine);
}

// Whether forces and losses are compared too.
static bool is_close(chain_kind kind)
{
    return kind != KIND_PLAIN;
}

// Largest difference of two outcomes, as a multiple of what may be.
static double distance(const chain_outcome *truth, const chain_outcome *o, bool closely)
{
    const int samples = truth->samples < o->samples ? truth->samples : o->samples;
    const int last = samples - 1, early = last < OUTCOME_FIRST_MS ? last : OUTCOME_FIRST_MS;
    double worst = fabs(o->first_contact - truth->first_contact) / 1e-6;
    if (truth->first_impulse > 0) { // none of a wall that gives
        worst = fmax(worst, fabs(o->first_impulse / truth->first_impulse - 1) / 1e-4);
    }
    worst = fmax(worst, fabs(o->momentum[early] / truth->momentum[early] - 1) / 1e-3);
    worst = fmax(worst, fabs(o->momentum[last] / truth->momentum[last] - 1) / 1e-3);
    for (size_t i = 0; i < sizeof o->lost / sizeof *o->lost && closely; i++) {
        worst = fmax(worst, fabs(o->lost[i] - truth->lost[i]) / (1e-6 * truth->put_in));
    }
    if (closely) {
        worst = fmax(worst, fabs(o->peak / truth->peak - 1) / 1e-5);
        worst = fmax(worst, fabs(o->peak_time - truth->peak_time) / 1e-5);
    }
    return fmax(worst, chain_outcome_sensor_difference(truth, o) / 5e-3);
}

// Links and joints given one by one, a mass at the tip, or both.
static void make_uneven(random_arm *c, random_generator *g, int links, bool rigid, double k2)
{
    const int joints = links - (rigid ? 1 : 0);
    const double which = random_uniform(g);
    if (which < 0.7 && joints > 0) {
        set_list(c, g, "arm.joint_stiffness", joints, k2 * links / 2, 2);
    } else {
        set(c, "arm.k2=%.17g", k2);
    }
    if (which < 0.5) {
        set_list(c, g, "arm.link_lengths", links, 1.0 / links, 1.5);
    }
    if (which > 0.3) {
        set(c, "arm.tip_mass=%.17g", between(g, 1e-3, 0.5));
    }
}

// Joints that stiffen, damping by mode, air, a mass at the tip: one or two of them.
static void make_loaded(random_arm *c, random_generator *g, int links, bool rigid, double k2)
{
    const int modes = links - (rigid ? 1 : 0);
    const int kind = (int)random_below(g, 4);
    set(c, "arm.k2=%.17g", k2);
    if (kind == 0 || kind == 3) {
        set(c, "arm.stiffening=%.17g", between(g, 0.1, 30));
    }
    if ((kind == 1 || kind == 3) && modes > 0) {
        set(c, "arm.damping_ratio=0");
        set_list(c, g, "arm.modal_ratios", modes < 4 ? modes : 4, 0.01, 8);
    }
    if (kind == 2 || random_uniform(g) < 0.3) {
        set(c, "arm.air_drag=%.17g", between(g, 1e-2, 5));
    }
    if (random_uniform(g) < 0.3) {
        set(c, "arm.tip_mass=%.17g", between(g, 1e-3, 0.5));
    }
}

// A motor whose current follows through an inductance, or that has a limit, or both.
static void make_electric(random_arm *c, random_generator *g, double k2)
{
    const int kind = (int)random_below(g, 3);
    set(c, "arm.k2=%.17g", k2);
    if (kind != 0) {
        set(c, "motor.inductance=%.17g", between(g, 1e-4, 0.1));
    }
    if (kind != 1) {
        set(c, "motor.current_limit=%.17g", between(g, 0.1, 5));
    }
}

// A wall that gives: spring and damper, the same with a face in front, Hunt and Crossley's law.
static void make_soft(random_arm *c, random_generator *g, chain_kind kind, double k2)
{
    const bool hertz = kind == KIND_HERTZ;
    set(c, "arm.k2=%.17g", k2);
    set(c, "wall.contact=%s", hertz ? "hunt-crossley" : "kelvin-voigt");
    set(c, "wall.stiffness=%.17g", between(g, 1e3, hertz ? 1e7 : 1e5));
    if (hertz) {
        set(c, "wall.damping=%.17g", random_uniform(g) < 0.3 ? 0 : between(g, 1e2, 1e6));
        set(c, "wall.exponent=%.17g", random_uniform(g) < 0.7 ? 1.5 : between(g, 1, 3));
    } else {
        set(c, "wall.damping=%.17g", random_uniform(g) < 0.3 ? 0 : between(g, 1, 100));
    }
    if (kind == KIND_FACE) {
        set(c, "wall.mass=%.17g", between(g, 1e-3, 1));
    }
    if (random_uniform(g) < 0.3) {
        set(c, "arm.tip_mass=%.17g", between(g, 1e-3, 0.5));
    }
}

static void make_chain(random_arm *c, int number, int least, int most, chain_kind kind)
{
    random_generator g;
    random_seed(&g, (uint64_t)number * 7919 + 13);
    c->count = 0;

    // kinds
    const int links = least + (int)random_below(&g, (uint64_t)(most - least + 1));
    const bool rigid = random_uniform(&g) < 0.5, beam = !rigid && random_uniform(&g) < 0.7;
    set(c, "arm.links=%d", links);
    set(c, "arm.hub_joint=%s", rigid ? "rigid" : beam ? "beam" : "spring");
    set(c, "wall.kind=%s", random_uniform(&g) < 0.5 ? "plane" : "point");
    const double restitution = random_uniform(&g) < 0.5 ? 0 : random_uniform(&g) * 0.9;
    if (kind != KIND_SOFT && kind != KIND_HERTZ) {
        set(c, "wall.restitution=%.17g", restitution);
    }
    set(c, "arm.damping_ratio=%.17g", random_uniform(&g) < 0.5 ? 0 : between(&g, 1e-4, 0.05));

    // numbers
    set(c, "motor.voltage=%.17g", between(&g, 0.3, 10));
    const double k2 = between(&g, 1, 50);
    set(c, "arm.mass=%.17g", between(&g, 0.1, 2));
    set(c, "arm.hub_inertia=%.17g", between(&g, 1e-3, 5e-2));
    set(c, "motor.stiction=%.17g", random_uniform(&g) < 0.5 ? 0.045 : between(&g, 1e-3, 0.5));
    c->velocity = between(&g, 0.05, 5);
    c->angle = 0.1 - c->velocity * between(&g, 2e-3, 2e-2);
    if (kind == KIND_UNEVEN) {
        make_uneven(c, &g, links, !beam, k2);
    } else if (kind == KIND_LOADED) {
        make_loaded(c, &g, links, rigid, k2);
    } else if (kind >= KIND_SOFT) {
        make_soft(c, &g, kind, k2);
    } else if (kind == KIND_ELECTRIC) {
        make_electric(c, &g, k2);
    } else {
        set(c, "arm.k2=%.17g", k2);
    }
    const char *list[MOST_SETTINGS + 1] = {NULL};
    for (int i = 0; i < c->count; i++) {
        list[i] = c->settings[i];
    }
    c->parameters = fixture_parameters(list);
}

// A step at which the explicit formula is exact.
static double formula_step(const arm *a, chain_kind kind)
{
    return fmin(is_close(kind) ? 1e-5 : 1e-4, SUBSTEPS / a->fastest_rate);
}

// What is taken for right, and the same at other strides or a mass that differs by next to nothing;
// false if it would take too long, or there is no contact.
static bool find_truth(const random_arm *c, chain_kind kind, chain_outcome *truth)
{
    arm a;
    arm_init(&a, &c->parameters);
    if (a.fastest_rate > FASTEST) {
        return false;
    }
    *truth = by_formula(c, formula_step(&a, kind));
    return truth->status == STATUS_OK && truth->samples >= 2;
}

// Whether that is worth anything.
static bool is_sure(const random_arm *c, chain_kind kind, const chain_outcome *truth)
{
    arm a;
    arm_init(&a, &c->parameters);
    const chain_outcome again = by_formula(c, FINER * formula_step(&a, kind));
    return distance(truth, &again, is_close(kind)) < 0.1;
}

static const char *how(const char *what, double worst)
{
    static char text[128];
    snprintf(text, sizeof text, "%s (%.2g times what may be)", what, worst);
    return text;
}

int main(int argc, char **argv)
{
    const int count = argc > 1 ? atoi(argv[1]) : 200, first = argc > 2 ? atoi(argv[2]) : 0;
    const int least = argc > 3 ? atoi(argv[3]) : 6, most = argc > 4 ? atoi(argv[4]) : 20;
    chain_kind kind = KIND_PLAIN;
    while (argc > 5 && kind < KINDS && strcmp(argv[5], kind_names[kind]) != 0) {
        kind++;
    }
    if (kind == KINDS) {
        fprintf(stderr, "random_chains: %s is no kind of arm\n", argv[5]);
        return 2;
    }
    int compared = 0, wrong = 0, said = 0, chaotic = 0;
    double largest = 0;
    for (int i = first; i < first + count; i++) {
        random_arm c;
        chain_outcome truth;
        make_chain(&c, i, least, most, kind);
        if (!find_truth(&c, kind, &truth)) {
            continue;
        }

        // wrong: said to be, or not
        const double bound = c.parameters.method.residual_bound;
        compared++;
        const chain_outcome o = simulate(&c, &c.parameters, NULL);
        const bool ok = o.status == STATUS_OK && o.residual <= bound * o.put_in;
        const double worst = o.samples > 0 ? distance(&truth, &o, is_close(kind)) : HUGE_VAL;
        said += !ok;
        if (!ok) {
            describe(&c, i, how(status_text(o.status), worst));
        } else if (worst <= 1) {
            largest = fmax(largest, worst);
        } else {
            const bool sure = is_sure(&c, kind, &truth);
            wrong += sure;
            chaotic += !sure;
            describe(&c, i, how(sure ? "WRONG" : "chaotic", worst));
        }
    }
    printf("%d compared, %d wrong with a closed ledger, %d with an open one or failed, %d chaotic; "
           "of the rest at most %.2g of what may be\n",
           compared, wrong, said, chaotic, largest);
    return wrong > 0 || compared == 0;
}
