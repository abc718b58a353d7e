#include "src/run/row_grid.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

// A row within this share of the grid's interval from an instant of the grid lies at it,
// as the rows of a run do (arm_run_rows.c).
#define GRID_TOLERANCE 1e-9

status row_grid_begin(row_grid *g, double every, int angle_count, row_taker *take,
                      void *context)
{
    assert(every > 0 && angle_count >= 0);
    *g = (row_grid){.every = every,
                    .angle_count = angle_count,
                    .take = take,
                    .context = context};

    // two rows of angles, of which an arm has one at least
    g->angles = calloc(2 * (size_t)angle_count + 1, sizeof *g->angles);
    if (g->angles == NULL) {
        return STATUS_NO_MEMORY;
    }
    return STATUS_OK;
}

void row_grid_finish(row_grid *g)
{
    free(g->angles);
    g->angles = NULL;
}

// The grid's next instant [s].
static double next_instant(const row_grid *g)
{
    return (double)g->next * g->every;
}

// Whether a row's time [s] is the grid's instant.
static bool lies_at(const row_grid *g, double time, double instant)
{
    return fabs(time - instant) <=
           larger(instant_tolerance(instant), GRID_TOLERANCE * g->every);
}

// Hands on the latest row as that of the grid's next instant.
static status take_last(row_grid *g)
{
    sample row = g->last;
    row.time = next_instant(g);
    g->next++;
    return g->take(g->context, &row, g->angles);
}

// Hands on what the run was at the grid's next instant, between the latest row and the
// one behind it.
static status take_between(row_grid *g, const sample *row, const double *angles)
{
    const double instant = next_instant(g);
    const sample between = trace_between(&g->last, row, instant);

    // the angles are straight, too
    double *to = g->angles + g->angle_count;
    const double share = (instant - g->last.time) / (row->time - g->last.time);
    for (int i = 0; i < g->angle_count; i++) {
        to[i] = g->angles[i] + share * (angles[i] - g->angles[i]);
    }

    g->next++;
    return g->take(g->context, &between, to);
}

status row_grid_add(row_grid *g, const sample *row, const double *angles)
{
    // instants up to here, but for that of this row, which another one may follow
    while (g->any && next_instant(g) < row->time &&
           !lies_at(g, row->time, next_instant(g))) {
        if (lies_at(g, g->last.time, next_instant(g))) {
            TRY(take_last(g));
        } else {
            TRY(take_between(g, row, angles));
        }
    }

    g->last = *row;
    memcpy(g->angles, angles, (size_t)g->angle_count * sizeof *angles);
    g->any = true;
    return STATUS_OK;
}

status row_grid_taker(void *grid, const sample *row, const double *angles)
{
    return row_grid_add(grid, row, angles);
}

status row_grid_end(row_grid *g)
{
    if (g->any && lies_at(g, g->last.time, next_instant(g))) {
        return take_last(g);
    }
    return STATUS_OK;
}

status row_grid_of_trace(const trace *t, double every, row_taker *take, void *context)
{
    SCOPED(row_grid_finish) row_grid g;
    TRY(row_grid_begin(&g, every, t->angle_count, take, context));
    for (size_t r = 0; r < t->row_count; r++) {
        TRY(row_grid_add(&g, &t->rows[r], t->angles + r * (size_t)t->angle_count));
    }
    return row_grid_end(&g);
}
