#include "src/solve/modal_state.h"

#include <math.h>
#include <string.h>

#define FAINT  1e-7 // share of all energy that a vibration must have to be counted
#define LITTLE 0.02 // share of a vibration's velocity whose restoring is little
#define MUCH   0.5  // and is not done

// Angles and velocities at h; returns the impulse of the contact force until then.
static double move_to(modal_stride *s, const arm *a, motion *m, double h, double *q, double *w)
{
    double impulse;
    modal_stride_state(s, a, m->links, h, state_angles(m, m->state), q, w, &impulse);
    if (s->mode.friction == HUB_STICK) {
        q[0] = state_angles(m, m->state)[0];
        w[0] = 0;
    }
    return impulse;
}

// Changes the velocities along the fast vibrations so that the kinetic energy grows by what the
// ledger lacks; restores nothing where that would be much.
static void restore(modal_stride *s, const arm *a, motion *m, const double *q, double *w,
                    modal_ledger *ledger)
{
    double *along = m->scratch + m->dof, *sum = along + m->dof;
    if (!modal_stride_vibration(s, a, m->links, q, along)) {
        return;
    }

    // vibrations that hardly are have nothing to give
    const double c = chain_kinetic_energy(a, q, along);
    if (c < FAINT * s->start_energy) {
        return;
    }

    // T(w + x along) = T(w) + b x + c x^2
    for (int i = 0; i < m->dof; i++) {
        sum[i] = w[i] + along[i];
    }
    const double b = chain_kinetic_energy(a, q, sum) - chain_kinetic_energy(a, q, w) - c;
    const double lacking = -ledger->open, root = b * b + 4 * c * lacking;
    const double x = root > 0 ? 2 * lacking / (b + copysign(sqrt(root), b)) : HUGE_VAL;
    if (fabs(x) < MUCH) {
        for (int i = 0; i < m->dof; i++) {
            w[i] += x * along[i];
        }
        ledger->restored = lacking;
    }
    ledger->restorable = LITTLE * fabs(b) - LITTLE * LITTLE * c;
}

modal_ledger modal_state_at(modal_stride *s, const arm *a, motion *m, double h, double *state)
{
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    const double *before = state_quadratures(m, m->state), *q0 = state_angles(m, m->state);
    double *after = state_quadratures(m, state);
    after[QUADRATURE_FORCE] = before[QUADRATURE_FORCE] + move_to(s, a, m, h, q, w);

    // losses come from the modes' motion until h, which is the one last asked for
    modal_losses lost = modal_stride_losses(s, a, h);
    after[QUADRATURE_VISCOUS] = before[QUADRATURE_VISCOUS] + lost.viscous;
    after[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING] + lost.damping;
    motion_evaluate(a, m, state);
    if (state[SLOT_CONTACT] != 0) {
        motion_project(a, m, state);
    }

    // the ledger
    const double torque = a->motor.torque - s->mode.friction * a->motor.stiction;
    const double energy = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q);
    modal_ledger ledger = {.open = energy - s->start_energy + lost.viscous + lost.damping -
                                   torque * (q[0] - q0[0])};
    restore(s, a, m, q, w, &ledger);
    if (ledger.restored != 0) {
        motion_evaluate(a, m, state);
    }
    return ledger;
}

double modal_gap_at(modal_stride *s, const arm *a, motion *m, double h)
{
    double *q = state_angles(m, m->between), *w = state_velocities(m, m->between), penetration;
    (void)move_to(s, a, m, h, q, w);
    chain_penetration(a, q, w, &penetration, NULL);
    return -penetration;
}
