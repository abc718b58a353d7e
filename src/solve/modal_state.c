#include "src/solve/modal_state.h"

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

double modal_state_at(modal_stride *s, const arm *a, motion *m, double h, double *state)
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
    return energy - s->start_energy + lost.viscous + lost.damping - torque * (q[0] - q0[0]);
}

double modal_gap_change(modal_stride *s, const arm *a, motion *m, double h)
{
    double *q = state_angles(m, m->between), *w = state_velocities(m, m->between);
    (void)move_to(s, a, m, h, q, w);
    return -chain_penetration_change(a, state_angles(m, m->state), s->more_columns);
}
