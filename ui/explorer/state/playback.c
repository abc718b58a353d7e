#include "ui/explorer/state/playback.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "render/scene/film.h"

#define APART 0.05 // of the run, between impacts that are slowed down each for itself

double playback_slowness(const playback *p, const trace *t, double duration, double time)
{
    assert(duration > 0);
    double most = 1, last = -duration;
    for (size_t i = 0; i < t->event_count && p->slow > 1; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT) {
            continue;
        }
        const film_clock c = film_clock_round(0, duration, e->time, p->slow);
        const double here = e->time - last > APART * duration ? film_clock_slowness(&c, time) : 1;
        most = here > most ? here : most;
        last = e->time;
    }
    return most;
}

double playback_next_speed(const playback *p, int direction)
{
    static const double speeds[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2,
                                    0.5,   1,     2,     5,    10,   20,   50,  100};
    const int count = sizeof speeds / sizeof speeds[0];
    double wanted = p->speed;

    // from the far end, so that the nearest one beyond the present speed stays
    for (int i = 0; i < count; i++) {
        double faster = speeds[count - 1 - i], slower = speeds[i];
        if (direction > 0 && faster > p->speed * 1.001) {
            wanted = faster;
        } else if (direction < 0 && slower < p->speed * 0.999) {
            wanted = slower;
        }
    }
    return wanted;
}

// --- the tip that is pulled -------------------------------------------------------------------

plane_vector stage_place(const arm_stage *g, int x, int y)
{
    assert(g->width > 0 && g->across > 0 && g->up > 0);
    return (plane_vector){g->left + (x - g->x + 0.5) / g->across,
                          g->bottom + (g->y + g->height - y - 0.5) / g->up};
}

void stage_cell(const arm_stage *g, plane_vector place, int *x, int *y)
{
    assert(g->width > 0);
    *x = g->x + (int)floor((place.x - g->left) * g->across);
    *y = g->y + g->height - 1 - (int)floor((place.y - g->bottom) * g->up);
}

void recorded_tip(const trace *t, const arm_parameters *beam, size_t row, plane_vector *tip,
                  plane_vector *across)
{
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(beam, lengths);
    assert(row < t->row_count);
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
    return PULL_STIFFNESS * ((p->x - tip.x) * across.x + (p->y - tip.y) * across.y);
}
