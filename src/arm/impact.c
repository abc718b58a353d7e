#include "src/arm/impact.h"

impact_result impact_velocity_increments(const arm *a, chain_link *work, const double *q,
                                         const double *w, double face, double restitution,
                                         double *increment)
{
    // the speed that a unit impulse takes from the approach of arm and face
    impact_result result;
    double compliance = chain_contact_response(a, work, q, false, increment);
    if (wall_has_face(&a->wall)) {
        compliance += 1 / a->wall.face_mass;
    }

    // the speed of approach, of which a moving wall has the part `wall_speed`
    result.speed = chain_penetration(a, q, w).rate;
    const double wall_speed = result.speed - chain_penetration_rate(a, q, w);
    result.speed -= face;

    // impulse and loss by the restitution; a moving wall works on the arm, unless a face
    // keeps it away from the impact
    result.impulse = (1 + restitution) * result.speed / compliance;
    result.loss = 0.5 * result.impulse * (1 - restitution) * result.speed;
    if (wall_has_face(&a->wall)) {
        result.work = 0;
    } else {
        result.work = result.impulse * wall_speed;
    }

    // the response to a unit impulse, times the impulse
    for (int i = 0; i < a->dof; i++) {
        increment[i] *= result.impulse;
    }
    return result;
}
