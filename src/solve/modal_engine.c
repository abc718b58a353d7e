// Chains of many links by exponential collocation on the modes of the straight chain
// (modal_stride.h), and, where those have no advantage, by power series (series_engine.h): a dense
// engine.
//
// A stride of the modes is LONGEST at most, and so short that its points show all vibrations but
// those that have next to no energy (modal_stride_shown). Its defect (modal_fit) decides whether
// the stride is accepted, and how long the next attempt or the next stride is. The stride is halved
// where the collocation sweeps do not converge, the energy balance does not close, or the first
// event found is not one of the exact functions. Where the stride becomes shorter than ADVANTAGE
// strides of the series, which are exact and cost a fraction, the series take over, and the modes
// are tried again after PATIENCE of their strides. What happens within a stride is found as
// modal_watch.h or dense_location.h says.
#include <math.h>
#include <string.h>

#include "src/solve/dense_location.h"
#include "src/solve/locate.h"
#include "src/solve/modal_state.h"
#include "src/solve/modal_stride.h"
#include "src/solve/modal_watch.h"
#include "src/solve/series_engine.h"

#define LONGEST    1.8e-2 // [s]
#define ADVANTAGE  8.0    // strides of the series that one of the modes has to replace
#define SETTLED    1e-7   // change by further sweeps that is let pass
#define OPEN       1e-8   // share of the energy that a stride's ledger may lack
#define FAINT      1e-8   // share of it that vibrations may have to be left out of the points
#define GROWTH     4      // from stride to stride
#define FIRST_TURN 3      // of the fastest vibration in the first stride of contact or bounce [rad]
#define TURN       0.05   // of the fastest link in a stride [rad]
#define LAST_TERMS 1e-9   // of the series between the modes' strides

// Phase up to which a stride's points resolve a vibration [rad], and the largest defect (modal_fit)
// of an accepted stride. Bounces amplify errors a thousandfold and more.
#define SHOWN           12
#define SHOWN_BOUNCING  6
#define DEFECT          3e-7
#define DEFECT_BOUNCING 1e-7
#define SAFE            0.85 // of a length that would just pass

#define TRUSTED_GAP     1e-10 // [m]
#define TRUSTED_RATE    1e-8  // [rad/s], and share of the fastest link's

enum { MOST_TRIES = 24, FEW_SWEEPS = 5, PATIENCE = 16 };

typedef struct modal_memory {
    bool by_series;              // the stride in hand is one of the series,
    bool brief;                  // for a brief flight
    series_stride *series;       // that one
    modal_stride *stride;        // or that of the modes
    modal_function contact, hub; // gap or force; hub's velocity or friction
    bool fitted;                 // `contact` is that of the stride
    bool any;                    // an event ends it,
    watch first;                 // this one,
    double event;                // then [s]

    // the state at its end, slots and what follows up to the accelerations
    double *end;
    double length; // to there [s]
} modal_memory;

// Doubles of a state up to its accelerations.
static size_t state_size(const arm *a)
{
    return (size_t)(SLOT_COUNT + 3 * a->dof + QUADRATURE_COUNT);
}

// Bytes of the modes' part, to a whole number of doubles.
static size_t modes_size(const arm *a)
{
    const size_t size = sizeof(modal_memory) + modal_stride_size(a) +
                        (2 * modal_function_size(a->dof) + state_size(a)) * sizeof(double);
    return (size + sizeof(double) - 1) / sizeof(double) * sizeof(double);
}

static size_t memory_for(const arm *a)
{
    return modes_size(a) + series_stride_size(a);
}

static void open_memory(const arm *a, motion *m)
{
    modal_memory *memory = m->memory;
    double *arrays = (double *)(memory + 1);
    memset(memory, 0, sizeof *memory);
    modal_function_place(&memory->contact, a->dof, arrays);
    modal_function_place(&memory->hub, a->dof, arrays + modal_function_size(a->dof));
    memory->end = arrays + 2 * modal_function_size(a->dof);
    memory->stride = (modal_stride *)(memory->end + state_size(a));
    modal_stride_place(memory->stride, a);
    memory->series = (series_stride *)((char *)m->memory + modes_size(a));
    series_stride_place(memory->series, a);
}

static modal_stride *stride_of(const motion *m)
{
    return ((modal_memory *)m->memory)->stride;
}

// The greatest length that is not beyond x > 0 of those whose responses are likely to be kept: four
// from one power of two to the next.
static double round_length(double x)
{
    int exponent;
    const double share = frexp(x, &exponent);
    return ldexp(floor(8 * share), exponent - 3);
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

// How far the exact gap [m] or hub's velocity [rad/s] may be from where the functions have it at an
// event, or beyond its edge where they have none. Force and friction are judged anew at their
// events anyway.
static double trusted(const motion *m, watch w)
{
    const double *rate = state_velocities(m, m->state);
    double fastest = 0;
    for (int i = 0; i < m->dof; i++) {
        fastest = fmax(fastest, fabs(rate[i]));
    }
    return w == WATCH_GAP ? TRUSTED_GAP : w == WATCH_HUB ? TRUSTED_RATE * (1 + fastest) : HUGE_VAL;
}

// Looks for the first event in the stride in hand, up to h. False where the exact functions
// contradict the result: then the modes do not represent this stride.
static bool find_event(const arm *a, motion *m, double h)
{
    modal_memory *memory = m->memory;
    memory->any = memory->fitted = false;
    memory->event = h;

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
        const bool falls = modal_function_falls(f, memory->stride, a, m, &memory->event);
        if (falls) {
            memory->any = true;
            memory->first = w;
        }

        const double limit = trusted(m, w);
        double exact = 0;
        if (limit < HUGE_VAL && memory->event == memory->length) {
            exact = modal_function_of(f, memory->stride, a, m, memory->end);
        } else if (limit < HUGE_VAL) {
            exact = modal_function_exact(f, memory->stride, a, m, memory->event);
        }
        if (!(exact >= -limit) || (falls && exact > limit)) {
            return false;
        }
    }
    return true;
}

// A stride of the modes, or 0 where the series are better: their strides are `series` [s].
static double begin_modes(const arm *a, motion *m, double remaining, double series)
{
    modal_stride *s = stride_of(m);
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    s->start_energy = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q);
    const bool bounces = a->wall.restitution > 0;
    s->shown_turn = bounces ? SHOWN_BOUNCING : SHOWN;
    if (modal_stride_start(s, a, m->links, contact_state_of(m->state), q, w) != STATUS_OK) {
        return 0;
    }

    // as proposed, and no longer than turning, events and vibrations allow
    double longest = m->state[SLOT_STRIDE] > 0 ? m->state[SLOT_STRIDE] : LONGEST;
    longest = fmin(longest, TURN / fmax(fabs(w[0]), 1e-9));
    if (m->state[SLOT_JUMPED] != 0 && (bounces || m->state[SLOT_CONTACT] != 0)) {
        longest = fmin(longest, FIRST_TURN / modal_stride_fastest(s));
    }
    longest = fmin(longest, s->shown_turn / modal_stride_shown(s, FAINT * s->start_energy));

    // a stride beyond what remains is not needed, and says little about the next one
    const double most_defect = bounces ? DEFECT_BOUNCING : DEFECT;
    const double least_next = 2 * remaining < longest ? longest : 0;
    double h = round_length(fmin(longest, 2 * remaining));
    const double energy = s->start_energy + fabs(a->motor.torque) * TURN / 10;
    for (int i = 0; i < MOST_TRIES && h > ADVANTAGE * series; i++) {
        modal_fit fit = modal_stride_fit(s, a, q, h);
        const double fitting = SAFE * sqrt(sqrt(most_defect / (fit.defect + 1e-300)));
        if (fit.left < SETTLED && fit.defect > most_defect) {
            h = round_length(h * fmax(fitting, 0.25));
            continue;
        }
        if (fit.left < SETTLED) {
            modal_memory *memory = m->memory;
            memcpy(memory->end, m->state, SLOT_COUNT * sizeof *memory->end);
            memory->length = h;
            const double open = fabs(modal_state_at(s, a, m, h, memory->end));
            if (open < OPEN * energy && find_event(a, m, fmin(h, remaining))) {
                const double growth = fit.sweeps <= FEW_SWEEPS ? GROWTH : 2;
                s->next = fmin(h * fmin(fitting, i == 0 ? growth : 1), LONGEST);
                s->next = i == 0 ? fmax(s->next, least_next) : s->next;
                return fmin(h, remaining);
            }
        }
        h /= 2;
    }
    return 0;
}

// A stride of the series from next to the wall for a flight that ends within it, or 0 where the
// flight is longer: the series' strides are `series` [s]. Such flights are as low as 1e-22 m, which
// is less than the rounding of what the modes add up.
static double begin_brief_flight(const arm *a, motion *m, double remaining, double series)
{
    const double *state = m->state;
    if (state[SLOT_CONTACT] != 0 || fabs(state[SLOT_GAP]) > MODAL_ON_WALL ||
        2 * state[SLOT_GAP_VELOCITY] >= -state[SLOT_GAP_ACCELERATION] * series) {
        return 0;
    }
    series_stride *s = ((modal_memory *)m->memory)->series;
    const double h = series_stride_begin(s, a, m, remaining, SERIES_EXACT);
    return series_stride_look(s, WATCH_GAP, h).value < 0 ? h : 0;
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    (void)step;
    modal_memory *memory = m->memory;
    const double series = SERIES_REACH / chain_series_rate(a, state_angles(m, m->state),
                                                           state_velocities(m, m->state));
    memory->fitted = false;
    memory->by_series = true;

    const double flight = begin_brief_flight(a, m, remaining, series);
    memory->brief = flight > 0;
    if (memory->brief) {
        return flight;
    }

    // strides of the series in a row are counted below zero
    if (remaining > ADVANTAGE * series && !(m->state[SLOT_STRIDE] < 0)) {
        const double h = begin_modes(a, m, remaining, series);
        memory->by_series = !(h > 0);
        if (h > 0) {
            return h;
        }
    }
    return series_stride_begin(memory->series, a, m, remaining, LAST_TERMS);
}

// Keeps what the next stride needs from this one.
static double proposal(const motion *m)
{
    const modal_memory *memory = m->memory;
    if (!memory->by_series) {
        return memory->stride->next;
    }
    const double waiting = m->state[SLOT_STRIDE];
    return memory->brief ? waiting : waiting < 0 ? waiting + 1 : 1 - PATIENCE;
}

// The stride's end into m->trial, which has the slots that no evaluation gives.
static void take_end(const arm *a, motion *m)
{
    static const int evaluated[] = {SLOT_FORCE,         SLOT_FRICTION_TORQUE, SLOT_GAP_ACCELERATION,
                                    SLOT_GAP,           SLOT_GAP_VELOCITY,    SLOT_VISCOUS_POWER,
                                    SLOT_DAMPING_POWER, SLOT_MOTOR_TORQUE,    SLOT_WALL_POWER};
    const double *end = ((const modal_memory *)m->memory)->end;
    for (size_t i = 0; i < sizeof evaluated / sizeof *evaluated; i++) {
        m->trial[evaluated[i]] = end[evaluated[i]];
    }
    memcpy(m->trial + SLOT_COUNT, end + SLOT_COUNT,
           (state_size(a) - SLOT_COUNT) * sizeof *m->trial);
}

static status state_at(const arm *a, motion *m, double h)
{
    const modal_memory *memory = m->memory;
    double *trial = m->trial;
    trial[SLOT_STRIDE] = proposal(m);
    if (memory->by_series) {
        return series_stride_state(memory->series, a, m, h);
    }
    if (h == memory->length) {
        take_end(a, m);
    } else {
        (void)modal_state_at(memory->stride, a, m, h, trial);
    }
    memcpy(state_algorithmic(m, trial), state_accelerations(m, trial),
           (size_t)m->dof * sizeof(double));
    return STATUS_OK;
}

static void first_event(const arm *a, motion *m, double *h, watch *first, bool *any)
{
    modal_memory *memory = m->memory;
    if (memory->by_series) {
        dense_search_event(a, m, h, first, any);
        return;
    }
    // found when the stride was begun
    *any = memory->any && memory->event <= *h;
    *first = *any ? memory->first : WATCH_GAP;
    *h = *any ? memory->event : *h;
}

static void peak(const arm *a, motion *m, double h)
{
    const modal_memory *memory = m->memory;
    if (memory->by_series) {
        dense_search_peak(a, m, h);
    } else {
        modal_function_peak(contact_function(a, m), a, m, h);
    }
}

static glance force_at(const arm *a, const motion *m, double h)
{
    modal_memory *memory = m->memory;
    return memory->by_series ? series_stride_force(memory->series, h)
           : memory->fitted  ? modal_function_at(&memory->contact, a, h)
                             : (glance){0, 0};
}

// Called for strides of the series only.
static glance look(const arm *a, const motion *m, watch w, double h)
{
    const modal_memory *memory = m->memory;
    (void)a;
    return series_stride_look(memory->series, w, h);
}

static double bend(const arm *a, const motion *m, watch w, double from, double to)
{
    const modal_memory *memory = m->memory;
    (void)a, (void)from;
    return series_stride_bend(memory->series, w, to);
}

static bool clear(const arm *a, motion *m, watch w, double h)
{
    const modal_memory *memory = m->memory;
    (void)a;
    return series_stride_clear(memory->series, w, h);
}

static bool bounded(const arm *a, motion *m, double h, double most)
{
    const modal_memory *memory = m->memory;
    (void)a;
    return series_stride_bounded(memory->series, h, most);
}

const engine modal_engine = {.name = "modes of the straight chain",
                             .begin = begin,
                             .state_at = state_at,
                             .look = look,
                             .bend = bend,
                             .clear = clear,
                             .bounded = bounded,
                             .first_event = first_event,
                             .peak = peak,
                             .force_at = force_at,
                             .memory_for = memory_for,
                             .open = open_memory};
