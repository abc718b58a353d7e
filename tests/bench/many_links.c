// The cost of many links, for docs/explanation/methods.md: chains that strike a plane
// wall, from contact on, and chains from rest, in processor time.
//
//   many_links [DAMPING LINKS...]     share of critical damping, 0.01 or 0; the usual
//   rows without

#include "src/base/clock.h"
#include "src/contact/contact_machine.h"
#include "tests/arm_fixture.h"

enum { TRIES = 3 }; // of which the quickest counts

typedef struct passage {
    double took; // of the processor [s]
    int impacts;
    double momentum; // that the wall took [N s]
    double open;     // share of the energy put in that the ledger lacks
} passage;

static void give_up(const char *what)
{
    fprintf(stderr, "many_links: %s\n", what);
    exit(1);
}

// Moves an arm from an angle and a velocity of all links on [rad], [rad/s], until so long
// after first contact, or for so long [s].
static passage pass(const parameters *p, double angle, double velocity,
                    double after_contact, double duration)
{
    const double began = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    passage o = {0};
    arm a = arm_of(p);
    motion *m = motion_create(&a, &p->method);
    if (m == NULL) {
        give_up("out of memory");
    }
    motion_start(&a, m, angle, velocity);
    double put_in = m->record.start_energy;
    while (m->state[SLOT_TIME] < duration) {
        motion_report r;
        const double work = m->state[SLOT_MOTOR_WORK];
        const status code = motion_step(&a, m, duration, p->method.step, &r);
        if (code != STATUS_OK) {
            give_up(status_text(code));
        }

        // ledger and momentum
        put_in += fabs(m->state[SLOT_MOTOR_WORK] - work);
        o.open = fmax(o.open, fabs(motion_energy_residual(&a, m, m->state)));
        if (r.event != MOTION_REACHED) {
            motion_apply(&a, m, &r);
        }
        if (r.event == MOTION_IMPACT) {
            o.momentum += r.impulse;
            duration = o.impacts++ == 0
                           ? fmin(duration, m->state[SLOT_TIME] + after_contact)
                           : duration;
        }
    }
    o.momentum += state_quadratures(m, m->state)[QUADRATURE_FORCE];
    o.open /= put_in;
    motion_destroy(m);
    o.took = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - began;
    return o;
}

// The quickest of some.
static passage best_pass(const parameters *p, double angle, double velocity,
                         double after_contact, double duration)
{
    passage best = pass(p, angle, velocity, after_contact, duration);
    for (int i = 1; i < TRIES; i++) {
        best.took =
            fmin(best.took, pass(p, angle, velocity, after_contact, duration).took);
    }
    return best;
}

static parameters chain_of(int links, double damping)
{
    return resolved(
        formatted("arm.links=%d arm.damping_ratio=%g arm.hub_joint=beam wall.kind=plane",
                  links, damping));
}

// The first 50 ms after the tip meets the wall at 0.7 m/s: what they take beyond the way
// to it.
static void print_struck(int links, double damping)
{
    const double in_contact = 0.05;
    const parameters p = chain_of(links, damping);
    const passage way = best_pass(&p, 0.095, 0.7, 1e-12, 1);
    const passage whole = best_pass(&p, 0.095, 0.7, in_contact, 1);
    printf("| %d | %g %% | %d | %.4f | %.1e | %.2f |\n", links, 100 * damping,
           whole.impacts, 1e3 * whole.momentum, whole.open,
           1e6 * (whole.took - way.took) / (1e3 * in_contact * links));
    fflush(stdout);
}

// From rest under 1 V.
static void print_from_rest(int links, double damping, double duration)
{
    const parameters p = chain_of(links, damping);
    const passage o = best_pass(&p, 0, 0, HUGE_VAL, duration);
    printf("| %d | %g %% | %g s | %d | %.1e | %.2f |\n", links, 100 * damping, duration,
           o.impacts, o.open, 1e6 * o.took / (1e3 * duration * links));
    fflush(stdout);
}

int main(int argc, char **argv)
{
    static const int damped[] = {8, 16, 32, 64, 128, 256, 1024},
                     undamped[] = {8, 16, 32, 64, 128};
    printf("| links | damping | impacts | momentum of 50 ms [mN s] | residual, share "
           "of energy put in | us x N per ms |\n|---|---|---|---|---|---|\n");
    for (int i = 2; i < argc; i++) {
        print_struck(atoi(argv[i]), atof(argv[1]));
    }
    for (size_t i = 0; i < sizeof damped / sizeof damped[0] && argc < 2; i++) {
        print_struck(damped[i], 0.01);
    }
    for (size_t i = 0; i < sizeof undamped / sizeof undamped[0] && argc < 2; i++) {
        print_struck(undamped[i], 0);
    }

    // from rest
    printf("\n| links | damping | from rest | impacts | residual | us x N per ms |\n"
           "|---|---|---|---|---|---|\n");
    for (int i = 2; i < argc; i++) {
        print_from_rest(atoi(argv[i]), atof(argv[1]), 0.29);
    }
    if (argc < 2) {
        print_from_rest(128, 0.01, 0.29);
        print_from_rest(128, 0, 0.29);
        print_from_rest(128, 0.01, 1);
    }
    return 0;
}
