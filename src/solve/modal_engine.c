// Chains of many links by exponential collocation on the modes of the straight chain
// (modal_stride.h): a dense engine. What happens within a stride is found as modal_watch.h says.
//
// A stride is LONGEST at most and half as long as the one before where Picard's sweeps do not
// converge or the ledger of the stride does not close.
#include <math.h>
#include <string.h>

#include "src/solve/locate.h"
#include "src/solve/modal_stride.h"
#include "src/solve/modal_watch.h"
#include "src/solve/motion.h"

#define LONGEST  1.25e-3 // [s]
#define SHORTEST 1e-9    // [s]
#define SETTLED  1e-7    // change of the last sweep that is let pass
#define GAIN     1.5     // of halving a stride, below which it is not worth while
#define OPEN     1e-8    // share of the energy that a stride's ledger may lack
#define TURN     0.05    // of the fastest link in a stride [rad]

enum { MOST_TRIES = 24, LEDGER_TRIES = 8, MANY_LINKS = 64, LEDGER_TRIES_MANY = 1 };

typedef struct modal_memory {
    modal_stride *stride;
    modal_function contact, hub; // gap or force; hub's velocity or friction
    bool fitted;                 // `contact` is that of the stride
} modal_memory;

static size_t memory_for(const arm *a)
{
    return sizeof(modal_memory) + modal_stride_size(a) + 4 * (size_t)a->dof * sizeof(double);
}

static void open_memory(const arm *a, motion *m)
{
    modal_memory *memory = m->memory;
    double *arrays = (double *)(memory + 1);
    memset(memory, 0, sizeof *memory);
    memory->contact.place = arrays;
    memory->contact.speed = arrays + a->dof;
    memory->hub.place = arrays + 2 * a->dof;
    memory->hub.speed = arrays + 3 * a->dof;
    memory->stride = (modal_stride *)(arrays + 4 * a->dof);
    modal_stride_place(memory->stride, a);
}

static modal_stride *stride_of(const motion *m)
{
    return ((modal_memory *)m->memory)->stride;
}

// Energy that the ledger of the stride lacks at its end.
static double open_energy(const arm *a, motion *m, double h)
{
    modal_stride *s = stride_of(m);
    double impulse, *q = m->between + SLOT_COUNT, *w = q + m->dof;
    const double *q0 = state_angles(m, m->state), *w0 = state_velocities(m, m->state);
    modal_stride_state(s, a, m->links, h, q0, q, w, &impulse);
    modal_losses lost = modal_stride_losses(s, a, h);
    double torque = a->motor.torque - s->mode.friction * a->motor.stiction;
    return chain_kinetic_energy(a, q, w) - chain_kinetic_energy(a, q0, w0) +
           chain_strain_energy(a, q) - chain_strain_energy(a, q0) + lost.viscous + lost.damping -
           torque * (q[0] - q0[0]);
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    (void)step;
    modal_memory *memory = m->memory;
    modal_stride *s = memory->stride;
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    memory->fitted = false;
    if (modal_stride_start(s, a, m->links, contact_state_of(m->state), q, w) != STATUS_OK) {
        return 0;
    }

    double longest = m->state[SLOT_STRIDE] > 0 ? m->state[SLOT_STRIDE] : LONGEST;
    longest = fmin(longest, TURN / fmax(fabs(w[0]), 1e-9));
    double h = remaining / ceil(remaining / longest * (1 - 1e-9));
    const double energy = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q) +
                          fabs(a->motor.torque) * TURN / 10;
    const int tries = a->links <= MANY_LINKS ? LEDGER_TRIES : LEDGER_TRIES_MANY;
    double last = HUGE_VAL;
    for (int i = 0; i < MOST_TRIES && h > SHORTEST; i++) {
        modal_fit fit = modal_stride_fit(s, a, m->links, q, h);
        double open = fit.change < SETTLED ? fabs(open_energy(a, m, h)) : HUGE_VAL;

        // a ledger that closes, or that a shorter stride does not close much better
        bool closed = open < OPEN * energy;
        if (closed || (open < HUGE_VAL && i >= tries) || open > last / GAIN) {
            s->next = i == 0 ? fmin(fmax(longest, 2 * h), LONGEST) : h;
            return h;
        }
        last = open < HUGE_VAL ? open : last;
        h /= 2;
    }
    return 0;
}

static status state_at(const arm *a, motion *m, double h)
{
    modal_stride *s = stride_of(m);
    double *trial = m->trial, impulse;
    modal_stride_state(s, a, m->links, h, state_angles(m, m->state), state_angles(m, trial),
                       state_velocities(m, trial), &impulse);
    if (s->mode.friction == HUB_STICK) {
        state_angles(m, trial)[0] = state_angles(m, m->state)[0];
        state_velocities(m, trial)[0] = 0;
    }
    const double *before = state_quadratures(m, m->state);
    double *after = state_quadratures(m, trial);
    modal_losses lost = modal_stride_losses(s, a, h);
    after[QUADRATURE_VISCOUS] = before[QUADRATURE_VISCOUS] + lost.viscous;
    after[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING] + lost.damping;
    after[QUADRATURE_FORCE] = before[QUADRATURE_FORCE] + impulse;
    trial[SLOT_STRIDE] = s->next;

    motion_evaluate(a, m, trial);
    if (trial[SLOT_CONTACT] != 0) {
        motion_project(a, m, trial);
    }
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
    modal_function_peak(contact_function(a, m), stride_of(m), a, m, h);
}

static glance force_at(const arm *a, const motion *m, double h)
{
    modal_memory *memory = m->memory;
    return memory->fitted ? modal_function_at(&memory->contact, memory->stride, a, h)
                          : (glance){0, 0};
}

const engine modal_engine = {.name = "modes of the straight chain",
                             .begin = begin,
                             .state_at = state_at,
                             .first_event = first_event,
                             .peak = peak,
                             .force_at = force_at,
                             .memory_for = memory_for,
                             .open = open_memory};
