#include "ui/explorer/state/pull.h"

#include <assert.h>
#include <math.h>

plane_vector stage_place(const arm_stage *g, int x, int y)
{
    assert(g != NULL && g->width > 0 && g->across > 0 && g->up > 0);
    return (plane_vector){g->left + (x - g->x + 0.5) / g->across,
                          g->bottom + (g->y + g->height - y - 0.5) / g->up};
}

void stage_cell(const arm_stage *g, plane_vector place, int *x, int *y)
{
    assert(g != NULL && g->width > 0 && x != NULL && y != NULL);
    *x = g->x + (int)floor((place.x - g->left) * g->across);
    *y = g->y + g->height - 1 - (int)floor((place.y - g->bottom) * g->up);
}

void recorded_tip(const trace *t, const arm_parameters *beam, size_t row, plane_vector *tip,
                  plane_vector *across)
{
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(beam, lengths);
    assert(t != NULL && beam != NULL && row < t->row_count && tip != NULL && across != NULL);
    const size_t links = (size_t)beam->links;
    const double *angles = t->angles + (row + 1) * (size_t)t->angle_count - links;
    *tip = (plane_vector){0};
    for (size_t i = 0; i < links; i++) {
        tip->x += lengths[i] * cos(angles[i]);
        tip->y += lengths[i] * sin(angles[i]);
    }
    *across = (plane_vector){-sin(angles[links - 1]), cos(angles[links - 1])};
}

double pull_force(const tip_pull *p, plane_vector tip, plane_vector across)
{
    assert(p != NULL);
    return PULL_STIFFNESS * ((p->x - tip.x) * across.x + (p->y - tip.y) * across.y);
}
