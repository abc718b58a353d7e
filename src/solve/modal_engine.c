// Chains of many links by exponential collocation on the modes of the straight chain
// (modal_stride.h): a dense engine. What happens within a stride is found as modal_watch.h says.
//
// A stride is LONGEST at most, and so short that its points show all vibrations but those that have
// next to no energy (modal_stride_shown). It is halved where Picard's sweeps do not converge or its
// ledger does not close.
#include <math.h>
#include <string.h>

#include "src/solve/locate.h"
#include "src/solve/modal_state.h"
#include "src/solve/modal_stride.h"
#include "src/solve/modal_watch.h"
#include "src/solve/motion.h"

#define LONGEST    4.5e-3 // [s]
#define SHORTEST   1e-10  // [s]
#define SETTLED    1e-7   // change of the last sweep that is let pass
#define OPEN       1e-8   // share of the energy that a stride's ledger may lack
#define FAINT      1e-8   // share of it that vibrations may have to be left out of the points
#define GROWTH     16     // from stride to stride
#define FIRST_TURN 3      // of the fastest vibration in the stride after an event [rad]
#define TURN       0.05   // of the fastest link in a stride [rad]

// Turn up to which a stride's points show a vibration [rad]: a stride is then exact to 1e-7 of the
// velocities, with the second one to 1e-10. An arm that bounces passes on what is lost a thousand
// times enlarged, and more.
#define SHOWN          8
#define SHOWN_BOUNCING 4

#define SEEN_TURN                                                                                  \
    0.5 // of the fastest vibration or decay in a stride whose points show it well [rad]

enum { MOST_TRIES = 24, FEW_SWEEPS = 5 };

typedef struct modal_memory {
    modal_stride *stride;
    modal_function contact, hub; // gap or force; hub's velocity or friction
    bool fitted;                 // `contact` is that of the stride
} modal_memory;

static size_t memory_for(const arm *a)
{
    return sizeof(modal_memory) + modal_stride_size(a) +
           2 * modal_function_size(a->dof) * sizeof(double);
}

static void open_memory(const arm *a, motion *m)
{
    modal_memory *memory = m->memory;
    double *arrays = (double *)(memory + 1);
    memset(memory, 0, sizeof *memory);
    modal_function_place(&memory->contact, a->dof, arrays);
    modal_function_place(&memory->hub, a->dof, arrays + modal_function_size(a->dof));
    memory->stride = (modal_stride *)(arrays + 2 * modal_function_size(a->dof));
    modal_stride_place(memory->stride, a);
}

static modal_stride *stride_of(const motion *m)
{
    return ((modal_memory *)m->memory)->stride;
}

// The greatest power of two that is not beyond x > 0.
static double power_of_two(double x)
{
    int exponent;
    (void)frexp(x, &exponent);
    return ldexp(1, exponent - 1);
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    (void)step;
    modal_memory *memory = m->memory;
    modal_stride *s = memory->stride;
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    memory->fitted = false;
    s->start_energy = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q);
    s->shown_turn = a->wall.restitution > 0 ? SHOWN_BOUNCING : SHOWN;
    if (modal_stride_start(s, a, m->links, contact_state_of(m->state), q, w) != STATUS_OK) {
        return 0;
    }

    double longest = m->state[SLOT_STRIDE] > 0 ? m->state[SLOT_STRIDE] : LONGEST;
    longest = fmin(longest, TURN / fmax(fabs(w[0]), 1e-9));
    if (m->state[SLOT_JUMPED] != 0) {
        longest = fmin(longest, FIRST_TURN / modal_stride_fastest(s));
    }

    longest = fmin(longest, s->shown_turn / modal_stride_shown(s, FAINT * s->start_energy));

    // powers of two, whose responses are kept; beyond what remains the last one is of no interest
    double h = power_of_two(fmin(longest, 2 * remaining));
    const double energy = s->start_energy + fabs(a->motor.torque) * TURN / 10;
    const double least = SEEN_TURN / modal_stride_quickest(s);
    for (int i = 0; i < MOST_TRIES && h > SHORTEST; i++) {
        modal_fit fit = modal_stride_fit(s, a, m->links, q, h);
        double open = HUGE_VAL;
        bool closed = false;
        if (fit.change < SETTLED) {
            memcpy(m->between, m->state, SLOT_COUNT * sizeof *m->between);
            open = fabs(modal_state_at(s, a, m, h, m->between));
            closed = open < OPEN * energy;
        }

        // shorter, until the ledger closes; one that does not where all is seen is left open
        if (closed || (open < HUGE_VAL && h < least)) {
            const double growth = fit.sweeps <= FEW_SWEEPS ? GROWTH : 2;
            s->next = i == 0 ? fmin(fmax(longest, growth * h), LONGEST) : h;
            return fmin(h, remaining);
        }
        h /= 2;
    }
    return 0;
}

static status state_at(const arm *a, motion *m, double h)
{
    modal_stride *s = stride_of(m);
    double *trial = m->trial;
    (void)modal_state_at(s, a, m, h, trial);
    trial[SLOT_STRIDE] = s->next;
    memcpy(state_algorithmic(m, trial), state_accelerations(m, trial),
           (size_t)m->dof * sizeof(double));
    return STATUS_OK;
}

// The gap's or the force's function on the stride.
static modal_function *contact_function(const arm *a, motion *m)
{
    modal_memory *memory = m->memory;
    if (!memory->fitted) {
        watch kind = m->state[SLOT_CONTACT] != 0 ? WATCH_FORCE : WATCH_GAP;
        modal_function_fit(&memory->contact, kind, memory->stride, a, m);
        memory->fitted = true;
    }
    return &memory->contact;
}

static void first_event(const arm *a, motion *m, double *h, watch *first, bool *any)
{
    modal_memory *memory = m->memory;
    *any = false;
    *first = WATCH_GAP;

    // each finds only what comes before the events found so far
    for (watch w = WATCH_GAP; w <= WATCH_STICTION; w++) {
        if (!watch_active(a, m, w)) {
            continue;
        }
        modal_function *f = &memory->hub;
        if (w == WATCH_GAP || w == WATCH_FORCE) {
            f = contact_function(a, m);
        } else {
            modal_function_fit(f, w, memory->stride, a, m);
        }
        if (modal_function_falls(f, memory->stride, a, m, h)) {
            *any = true;
            *first = w;
        }
    }
}

static void peak(const arm *a, motion *m, double h)
{
    modal_function_peak(contact_function(a, m), a, m, h);
}

static glance force_at(const arm *a, const motion *m, double h)
{
    modal_memory *memory = m->memory;
    return memory->fitted ? modal_function_at(&memory->contact, a, h) : (glance){0, 0};
}

const engine modal_engine = {.name = "modes of the straight chain",
                             .begin = begin,
                             .state_at = state_at,
                             .first_event = first_event,
                             .peak = peak,
                             .force_at = force_at,
                             .memory_for = memory_for,
                             .open = open_memory};
