// Motions followed to an instant: how many steps and events they took, what the wall
// took, and how well the energy ledger closes.
#pragma once

#include "tests/arm_fixture.h"

// What became of a motion.
typedef struct passage {
    int steps, impacts, touches;
    double momentum; // that the wall took [N s]
    double open;     // share of the energy put in that the ledger lacks
} passage;

// Moves on until an instant [s], in at most so many steps.
static inline passage move_on(const arm *a, motion *m, double until, int most_steps)
{
    passage p = {0};
    double put_in = m->record.start_energy;
    const double force = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    while (m->state[SLOT_TIME] < until) {
        motion_report r;
        const double work = m->state[SLOT_MOTOR_WORK],
                     pushed = m->state[SLOT_EXTERNAL_WORK];
        const double moved = state_quadratures(m, m->state)[QUADRATURE_PUSHED];
        assert_int_equal(motion_step(a, m, until, 1e-3, &r), STATUS_OK);
        assert_true(++p.steps <= most_steps);
        put_in += fabs(m->state[SLOT_MOTOR_WORK] - work) + fabs(pushed);
        p.open = fmax(p.open, fabs(motion_energy_residual(a, m, m->state)));
        if (r.event == MOTION_IMPACT || r.event == MOTION_TOUCH) {
            check_close(m->state[SLOT_GAP], 0, 1e-9);
        }
        motion_apply(a, m, &r);
        put_in += fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED] - moved);
        p.impacts += r.event == MOTION_IMPACT;
        p.touches += r.event == MOTION_TOUCH;
        p.momentum += r.event == MOTION_IMPACT ? r.impulse : 0;
    }
    p.momentum += state_quadratures(m, m->state)[QUADRATURE_FORCE] - force;
    p.open /= put_in;
    return p;
}

// By the engine of the arm's own, or a chosen one.
static inline passage passage_by(const parameters *p, const engine *by, double angle,
                                 double velocity, double until, int most_steps)
{
    STARTED(a, m, p, by, angle, velocity);
    return move_on(&a, m, until, most_steps);
}

static inline passage passage_of(const parameters *p, double angle, double velocity,
                                 double until, int most_steps)
{
    return passage_by(p, NULL, angle, velocity, until, most_steps);
}
