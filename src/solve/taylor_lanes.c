#include <assert.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

#include "src/solve/taylor_engine.h"

static atomic_int limit; // 0: none

static int widest(void)
{
#if defined __x86_64__
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
    const int most = widest(), wanted = atomic_load_explicit(&limit, memory_order_relaxed);
    return wanted > 0 && wanted < most ? wanted : most;
}

int taylor_limit_width(int width)
{
    assert(width == 0 || width == 1 || width == 2 || width == 4 || width == 8);
    atomic_store(&limit, width);
    return taylor_width();
}

void taylor_compute_one(double *block, taylor_form form)
{
#if defined __x86_64__
    if (taylor_width() >= 4) {
        taylor_series_1_avx2(block, form);
        return;
    }
#endif
    taylor_series_1(block, form);
}

void taylor_evaluate(const arm *a, const double *block, taylor_form form, int count,
                     taylor_instants *at)
{
    const int width = taylor_width();
    assert(a != NULL && block != NULL && at != NULL && count >= 1 && count <= width);
    for (int i = count; i < width; i++) {
        at->time[i] = at->time[0];
    }

    switch (width) {
#if defined __x86_64__
    case 8:
        taylor_instants_8(a, block, form, at);
        break;
    case 4:
        taylor_instants_4(a, block, form, at);
        break;
    case 2:
        taylor_instants_2(a, block, form, at);
        break;
#endif
    default:
        taylor_instants_1(a, block, form, at);
        break;
    }
}

static void compute_block(double *block, int width, taylor_form form)
{
    switch (width) {
#if defined __x86_64__
    case 8:
        taylor_series_8(block, form);
        break;
    case 4:
        taylor_series_4(block, form);
        break;
    case 2:
        taylor_series_2(block, form);
        break;
#endif

    // what every processor can do
    default:
        taylor_series_1(block, form);
        break;
    }
}

// Copies `count` places of the blocks' lanes from the one after `place` on to the arms' own blocks.
static inline __attribute__((always_inline)) void
spread_places(double *const *to, const double *block, int width, int place, int count)
{
    for (int n = place; n < place + count; n++) {
        for (int lane = 0; lane < width; lane++) {
            to[lane][n] = block[n * width + lane];
        }
    }
}

// What the series of a form have come to, as far as their order goes.
static inline __attribute__((always_inline)) void
spread_results(double *const *to, const double *block, int width, taylor_form form)
{
    const int links[] = {AT_ANGLE_1, AT_ANGLE_2};
    spread_places(to, block, width, AT_ALLOWED, 1);
    for (int i = 0; i < 2; i++) {
        spread_places(to, block, width, links[i], form.order + 2);
    }
    if (form.hub_spring) {
        spread_places(to, block, width, AT_ANGLE_0, form.order + 2);
    }
    spread_places(to, block, width, form.hub_spring ? AT_RATE_0 : AT_RATE_1, form.order + 1);

    // reactions and losses
    if (form.contact) {
        spread_places(to, block, width, AT_FORCE, form.order);
    } else {
        spread_places(to, block, width, AT_GAP, form.order + 2);
    }
    spread_places(to, block, width, AT_HOLD, form.order);
    spread_places(to, block, width, AT_HUB_SQUARE, form.order);
    if (form.damped) {
        spread_places(to, block, width, AT_DISSIPATION, form.order);
    }
}

void taylor_compute(const taylor_request *requests, int count)
{
    const int width = count == 1 ? 1 : taylor_width();

    const taylor_form form = requests[0].form;
    assert(count >= 1 && count <= taylor_width());

    if (width == 1) {
        taylor_compute_one(requests[0].block, form);
        return;
    }

    // arms into lanes; those left over repeat the first, and nobody reads what comes of them
    _Alignas(64) double block[TAYLOR_PLACES * TAYLOR_WIDEST], unread[TAYLOR_PLACES];
    double *to[TAYLOR_WIDEST];
    for (int lane = 0; lane < width; lane++) {
        const double *from = requests[lane < count ? lane : 0].block;
        to[lane] = lane < count ? requests[lane].block : unread;
        for (int place = 0; place < AT_INPUTS; place++) {
            block[place * width + lane] = from[place];
        }
    }
    compute_block(block, width, form);

    // and back
    if (width == 8) {
        spread_results(to, block, 8, form);
    } else if (width == 4) {
        spread_results(to, block, 4, form);
    } else {
        spread_results(to, block, 2, form);
    }
}
