#include "src/arm/impact.h"

impact_result impact_velocity_increments(const arm *a, chain_link *work, const double *q,
                                         const double *w, double restitution, double *increment)
{
    impact_result result;
    double compliance;
    chain_contact_response(a, work, q, false, increment, &compliance);
    result.speed = chain_penetration_rate(a, q, w);
    result.impulse = (1 + restitution) * result.speed / compliance;
    result.loss = 0.5 * result.impulse * (1 - restitution) * result.speed;
    for (int i = 0; i < a->dof; i++) {
        increment[i] *= result.impulse;
    }
    return result;
}
