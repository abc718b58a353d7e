#include "src/arm/wall.h"
#include "src/base/sincos.h"
#include "src/base/plain_math.h"

#include <assert.h>
#include <math.h>

void wall_init(wall_model *w, const parameters *p)
{
    assert(w != NULL && p != NULL);
    *w = (wall_model){.kind = (wall_kind)p->wall.kind,
                      .cosine = inline_cos(p->wall.angle),
                      .sine = inline_sin(p->wall.angle),
                      .restitution = p->wall.restitution,
                      .rest_speed = p->method.rest_speed,
                      .law = (wall_law)p->wall.contact,
                      .stiffness = p->wall.stiffness,
                      .damping = p->wall.damping,
                      .exponent = p->wall.contact == WALL_HUNT_CROSSLEY ? p->wall.exponent : 1};
    w->x = p->arm.length * w->cosine;
    w->y = p->arm.length * w->sine;
}

double wall_restitution(const wall_model *w, double approach_speed)
{
    assert(w != NULL);
    return approach_speed < w->rest_speed ? 0 : w->restitution;
}

double wall_force_slope(const wall_model *w, double depth, double rate, double acceleration)
{
    assert(w != NULL);
    if (w->law == WALL_KELVIN_VOIGT) {
        return w->stiffness * rate + w->damping * acceleration;
    }
    if (depth <= 0) {
        return 0;
    }
    double power = wall_power(w, depth);
    return power * (w->exponent / depth * rate * (w->stiffness + w->damping * rate) +
                    w->damping * acceleration);
}

double wall_stored_energy(const wall_model *w, double depth)
{
    assert(w != NULL);
    return depth > 0 ? wall_spring_force(w, depth) * depth / (w->exponent + 1) : 0;
}

double wall_rate(const wall_model *w, double compliance, double depth, double rate)
{
    assert(w != NULL && compliance > 0);
    // without its damper the wall stops the mass at the deepest point
    double n = w->exponent, energy = 0.5 * rate * rate / compliance;
    energy = (rate > 0 ? energy : 0) + wall_stored_energy(w, depth);
    double deepest = plain_pow((n + 1) * energy / w->stiffness, 1 / (n + 1));
    double stiffness = n == 1 ? w->stiffness : n * w->stiffness * plain_pow(deepest, n - 1);
    double damping = w->law == WALL_KELVIN_VOIGT ? w->damping : w->damping * plain_pow(deepest, n);
    return fmax(sqrt(stiffness * compliance), damping * compliance);
}
