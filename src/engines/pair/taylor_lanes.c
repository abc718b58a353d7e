#include <assert.h>
#include <stdatomic.h>

#include "src/engines/pair/taylor_lanes.h"

static atomic_int limit; // 0: none

static int widest(void)
{
#if defined __x86_64__ && !defined ONE_WIDTH
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
        return 8;
    }
    return __builtin_cpu_supports("avx2") ? 4 : 2;
#else
    return 1;
#endif
}

int taylor_width(void)
{
    const int most = widest(),
              wanted = atomic_load_explicit(&limit, memory_order_relaxed);
    return wanted > 0 && wanted < most ? wanted : most;
}

int taylor_limit_width(int width)
{
    assert(width == 0 || width == 1 || width == 2 || width == 4 || width == 8);
    atomic_store(&limit, width);
    return taylor_width();
}

// The loops of so many lanes.
static const taylor_loops *loops_of(int width)
{
#if defined __x86_64__ && !defined ONE_WIDTH
    if (width == 8) {
        return &taylor_loops_8;
    }
    if (width == 4) {
        return &taylor_loops_4;
    }
    if (width == 2) {
        return &taylor_loops_2;
    }
    return taylor_width() >= 4 ? &taylor_loops_1_avx2 : &taylor_loops_1;
#else
    (void)width;
    return &taylor_loops_1;
#endif
}

void taylor_compute_one(taylor_lane *lane)
{
    lane->group = NULL;
    lane->end = -1;
    lane->pieces = 0;
    lane->form.order = loops_of(1)->series(lane->block, lane->form);
}

void taylor_compute(taylor_group *group, taylor_lane *const *lanes, int count)
{
    assert(count >= 1 && count <= taylor_width());
    if (count == 1) {
        taylor_compute_one(lanes[0]);
        return;
    }

    group->width = taylor_width();
    group->form = lanes[0]->form;

    // lanes left over repeat the first arm, and nobody reads what comes of them
    const double *own[TAYLOR_WIDEST];
    for (int i = 0; i < group->width; i++) {
        own[i] = lanes[i < count ? i : 0]->block;
    }
    const taylor_loops *loops = loops_of(group->width);
    loops->gather(group->block, own);
    group->form.order = loops->series(group->block, group->form);

    // each knows where its own are, and what its step leaves
    for (int i = 0; i < count; i++) {
        lanes[i]->group = group;
        lanes[i]->form.order = group->form.order;
        lanes[i]->number = i;
        lanes[i]->end = -1;
        lanes[i]->pieces = 0;
        lanes[i]->fetched = 0;
        for (int place = AT_ALLOWED; place <= AT_FORCE_MOST; place++) {
            lanes[i]->block[place] = group->block[place * group->width + i];
        }
    }
}

void taylor_finish(taylor_group *group, taylor_lane *const *lanes, const taylor_end *ends,
                   int count)
{
    assert(count >= 1);
    if (lanes[0]->group != group) {
        return; // it is alone
    }

    // the states
    for (int i = 0; i < group->width; i++) {
        group->ends.time[i] = ends[i < count ? i : 0].time;
    }
    loops_of(group->width)->ends(group->block, group->form, &group->ends);

    // the force on the way there
    int most = 0;
    for (int i = 0; i < group->width; i++) {
        const taylor_end *end = &ends[i < count ? i : 0];
        const int pieces = end->pieces <= TAYLOR_PIECES ? end->pieces : 0;
        group->pieces.width[i] = end->time / (pieces > 0 ? pieces : 1);
        most = pieces > most ? pieces : most;
        if (i < count) {
            lanes[i]->end = end->time;
            lanes[i]->pieces = pieces;
        }
    }
    if (group->form.contact && most > 1) {
        loops_of(group->width)
            ->pieces(group->block, group->form.order, most, &group->pieces);
    }
}

const double *taylor_terms(taylor_lane *lane, int place, int count)
{
    // arrays are nowhere shorter, and little longer
    const unsigned bit = 1u << (place - AT_ANGLE_0) / TAYLOR_MOST;
    if (lane->group != NULL && !(lane->fetched & bit)) {
        const int width = lane->group->width;
        const double *from = taylor_term(lane, place);
        for (int n = 0; n < count; n++) {
            lane->block[place + n] = from[n * width];
        }
        lane->fetched |= bit;
    }
    return lane->block + place;
}

// What evaluating the series takes of a group.
static void fetch_motion(taylor_lane *lane)
{
    const taylor_form form = lane->form;
    for (int body = form.hub_spring ? 0 : 1; body < 3; body++) {
        taylor_terms(lane, AT_ANGLE_0 + body * (TAYLOR_MOST + 2), form.order + 2);
    }
    taylor_terms(lane, AT_HOLD, form.order);
    taylor_terms(lane, AT_HUB_SQUARE, form.order);
    if (form.contact) {
        taylor_terms(lane, AT_FORCE, form.order);
    }
    if (form.damped) {
        taylor_terms(lane, AT_DISSIPATION, form.order);
    }
}

void taylor_fetch(taylor_lane *lane)
{
    const taylor_form form = lane->form;
    fetch_motion(lane);
    if (!form.contact) {
        taylor_terms(lane, AT_GAP, form.order + 2);
    }
    taylor_terms(lane, form.hub_spring ? AT_RATE_0 : AT_RATE_1, form.order + 1);
}

void taylor_values(const double *terms, int count, const double *times, double *values,
                   double *slopes)
{
    loops_of(taylor_width())->values(terms, count, times, values, slopes);
}

void taylor_evaluate(taylor_lane *lane, int count, taylor_instants *at)
{
    const taylor_form form = lane->form;
    const int width = count == 1 ? 1 : taylor_width();
    assert(count >= 1 && count <= width);
    for (int i = count; i < width; i++) {
        at->time[i] = at->time[0];
    }

    // what it takes of the series of a group
    if (lane->group != NULL) {
        fetch_motion(lane);
    }
    loops_of(width)->instants(lane->block, form, at);
}
