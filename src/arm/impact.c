#include "src/arm/impact.h"

impact_result impact_velocity_increments(const arm *a, chain_link *work, const double *q,
                                         const double *w, double face, double restitution,
                                         double *increment)
{
    impact_result result;
    double compliance = chain_contact_response(a, work, q, false, increment);
    if (wall_has_face(&a->wall)) {
        compliance += 1 / a->wall.face_mass;
    }
    result.speed = chain_penetration(a, q, w).rate;
    const double comes = result.speed - chain_penetration_rate(a, q, w);
    result.speed -= face;
    result.impulse = (1 + restitution) * result.speed / compliance;
    result.loss = 0.5 * result.impulse * (1 - restitution) * result.speed;
    if (wall_has_face(&a->wall)) {
        result.work = 0;
    } else {
        result.work = result.impulse * comes;
    } // its foundation is far
    for (int i = 0; i < a->dof; i++) {
        increment[i] *= result.impulse;
    }
    return result;
}
