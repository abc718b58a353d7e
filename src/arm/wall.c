#include "src/arm/wall.h"
#include "src/base/sincos.h"

#include <assert.h>
#include <math.h>

void wall_init(wall_model *w, const parameters *p)
{
    assert(w != NULL && p != NULL);
    *w = (wall_model){.kind = (wall_kind)p->wall.kind,
                      .cosine = inline_cos(p->wall.angle),
                      .sine = inline_sin(p->wall.angle),
                      .restitution = p->wall.restitution,
                      .rest_speed = p->method.rest_speed};
    w->x = p->arm.length * w->cosine;
    w->y = p->arm.length * w->sine;
}

double wall_restitution(const wall_model *w, double approach_speed)
{
    assert(w != NULL);
    return approach_speed < w->rest_speed ? 0 : w->restitution;
}
