// Random arms of many links that hit a wall, by the engine that a run takes, and by the explicit
// formula at strides so short that it is exact: none may be wrong with a ledger that closes.
//
//     random_chains [COUNT [FIRST [LEAST [MOST [modes]]]]]     default: 200 0 6 20
//
// LEAST to MOST links. With `modes` the straight chain's modes are compared with power series
// alone, which costs a hundredth of the formula, for arms that modes are used for: not those that
// bounce undamped.
//
// Run i is made of its own number. Compared are first contact (1 us), its impulse (1e-4), the
// momentum after 1 and up to 50 ms (1e-3) and what a 1 ms sensor reads (5e-3, root mean square).
// Where the explicit formula does not agree with itself at other strides, or the series with
// themselves at a mass of 1e-12 more, the motion is chaotic and nothing is said.
#include <stdarg.h>
#include <stdlib.h>

#include "src/base/random.h"
#include "tests/arm_fixture.h"
#include "tests/chain_outcome.h"

#define AFTER_CONTACT 0.0501
#define DURATION      0.1
#define SUBSTEPS      20    // of the explicit formula: its fastest rate times its time step
#define EXPLICIT_MASS 1e-18 // at the tip [kg]: neither modes nor series take it
#define FASTEST       3e6   // beyond which the explicit formula takes too long [1/s]
#define FASTEST_MODES 1.5e5 // the same of the series, of which there are to be many
#define NEXT_TO_NONE  1e-12 // share of the mass

enum { MOST_SETTINGS = 12 };

// A random arm in front of its wall.
typedef struct random_chain {
    parameters parameters;
    double angle, velocity;
    char settings[MOST_SETTINGS][64];
    int count;
} random_chain;

static chain_outcome simulate(const random_chain *c, const parameters *p, const engine *by)
{
    return chain_outcome_of(&(chain_start){p, c->angle, c->velocity, DURATION, AFTER_CONTACT, by});
}

// By the explicit formula.
static chain_outcome by_formula(const random_chain *c, double step)
{
    parameters p = c->parameters;
    p.method.step = step;
    p.arm.tip_mass = EXPLICIT_MASS;
    return simulate(c, &p, NULL);
}

// By power series alone, of an arm that is heavier by a share.
static chain_outcome by_series(const random_chain *c, double heavier)
{
    parameters p = c->parameters;
    p.arm.mass *= 1 + heavier;
    return simulate(c, &p, &series_engine);
}

// Largest difference of two outcomes, as a multiple of what may be.
static double distance(const chain_outcome *truth, const chain_outcome *o)
{
    const int samples = truth->samples < o->samples ? truth->samples : o->samples;
    const int last = samples - 1, early = last < OUTCOME_FIRST_MS ? last : OUTCOME_FIRST_MS;
    double worst = fabs(o->first_contact - truth->first_contact) / 1e-6;
    worst = fmax(worst, fabs(o->first_impulse / truth->first_impulse - 1) / 1e-4);
    worst = fmax(worst, fabs(o->momentum[early] / truth->momentum[early] - 1) / 1e-3);
    worst = fmax(worst, fabs(o->momentum[last] / truth->momentum[last] - 1) / 1e-3);
    return fmax(worst, chain_outcome_sensor_difference(truth, o) / 5e-3);
}

static double between(random_generator *g, double from, double to)
{
    return from * exp(random_uniform(g) * log(to / from));
}

static __attribute__((format(printf, 2, 3))) void set(random_chain *c, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(c->settings[c->count], sizeof c->settings[0], format, values);
    va_end(values);
    c->count++;
}

static void make_chain(random_chain *c, int number, int least, int most)
{
    random_generator g;
    random_seed(&g, (uint64_t)number * 7919 + 13);
    c->count = 0;

    // kinds
    set(c, "arm.links=%d", least + (int)random_below(&g, (uint64_t)(most - least + 1)));
    set(c, "arm.hub_joint=%s",
        random_uniform(&g) < 0.5   ? "rigid"
        : random_uniform(&g) < 0.7 ? "beam"
                                   : "spring");
    set(c, "wall.kind=%s", random_uniform(&g) < 0.5 ? "plane" : "point");
    set(c, "wall.restitution=%.17g", random_uniform(&g) < 0.5 ? 0 : random_uniform(&g) * 0.9);
    set(c, "arm.damping_ratio=%.17g", random_uniform(&g) < 0.5 ? 0 : between(&g, 1e-4, 0.05));

    // numbers
    set(c, "motor.voltage=%.17g", between(&g, 0.3, 10));
    set(c, "arm.k2=%.17g", between(&g, 1, 50));
    set(c, "arm.mass=%.17g", between(&g, 0.1, 2));
    set(c, "arm.hub_inertia=%.17g", between(&g, 1e-3, 5e-2));
    set(c, "motor.stiction=%.17g", random_uniform(&g) < 0.5 ? 0.045 : between(&g, 1e-3, 0.5));
    c->velocity = between(&g, 0.05, 5);
    c->angle = 0.1 - c->velocity * between(&g, 2e-3, 2e-2);
    const char *list[MOST_SETTINGS + 1] = {NULL};
    for (int i = 0; i < c->count; i++) {
        list[i] = c->settings[i];
    }
    c->parameters = fixture_parameters(list);
}

static void describe(const random_chain *c, int number, const char *what, double worst)
{
    printf("%d: %s (%.2g times what may be), %g rad, %g rad/s:", number, what, worst, c->angle,
           c->velocity);
    for (int i = 0; i < c->count; i++) {
        printf(" %s", c->settings[i]);
    }
    printf("\n");
    fflush(stdout);
}

// What is taken for right, and the same at other strides or a mass that differs by next to nothing;
// false if it would take too long, or there is no contact.
static bool find_truth(const random_chain *c, bool modes, chain_outcome *truth)
{
    arm a;
    arm_init(&a, &c->parameters);
    if (modes) {
        const bool bounces =
            c->parameters.wall.restitution > 0 && a.fastest_decay <= a.highest_frequency;
        if (bounces || a.fastest_rate > FASTEST_MODES) {
            return false;
        }
        *truth = by_series(c, 0);
    } else {
        if (a.fastest_rate > FASTEST) {
            return false;
        }
        *truth = by_formula(c, fmin(1e-4, SUBSTEPS / a.fastest_rate));
    }
    return truth->status == STATUS_OK && truth->samples >= 2;
}

// Whether that is worth anything.
static bool is_sure(const random_chain *c, bool modes, const chain_outcome *truth)
{
    arm a;
    arm_init(&a, &c->parameters);
    const chain_outcome again = modes ? by_series(c, NEXT_TO_NONE)
                                      : by_formula(c, 0.61 * fmin(1e-4, SUBSTEPS / a.fastest_rate));
    return distance(truth, &again) < 0.1;
}

int main(int argc, char **argv)
{
    const int count = argc > 1 ? atoi(argv[1]) : 200, first = argc > 2 ? atoi(argv[2]) : 0;
    const int least = argc > 3 ? atoi(argv[3]) : 6, most = argc > 4 ? atoi(argv[4]) : 20;
    const bool modes = argc > 5;
    int compared = 0, wrong = 0, said = 0, chaotic = 0;
    double largest = 0;
    for (int i = first; i < first + count; i++) {
        random_chain c;
        chain_outcome truth;
        make_chain(&c, i, least, most);
        if (!find_truth(&c, modes, &truth)) {
            continue;
        }

        // wrong: said to be, or not
        const double bound = c.parameters.method.residual_bound;
        compared++;
        const chain_outcome o = simulate(&c, &c.parameters, modes ? &modal_engine : NULL);
        const bool ok = o.status == STATUS_OK && o.residual <= bound * o.put_in;
        const double worst = o.samples > 0 ? distance(&truth, &o) : HUGE_VAL;
        said += !ok;
        if (!ok) {
            describe(&c, i, status_text(o.status), worst);
        } else if (worst <= 1) {
            largest = fmax(largest, worst);
        } else {
            const bool sure = is_sure(&c, modes, &truth);
            wrong += sure;
            chaotic += !sure;
            describe(&c, i, sure ? "WRONG" : "chaotic", worst);
        }
    }
    printf("%d compared, %d wrong with a closed ledger, %d with an open one or failed, %d chaotic; "
           "of the rest at most %.2g of what may be\n",
           compared, wrong, said, chaotic, largest);
    return wrong > 0 || compared == 0;
}
