// Arms for tests: parameters given as "path=value" strings.
#pragma once

#include "src/arm/modes.h"
#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"
#include "tests/given_parameters.h"
#include "tests/shipped_scenario.h"

// Parameters of the corrected arm with the given settings; the list ends with NULL. The
// stiff engine has two digits more than by default, since tests compare its arms with
// calculations that are as exact.
static inline parameters unresolved_parameters(const char *const *settings)
{
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "method.tolerance", "1e-10");
    give_list(&p, settings);
    return p;
}

// The same resolved.
static inline parameters fixture_parameters(const char *const *settings)
{
    parameters p = unresolved_parameters(settings);
    DONE(parameters_resolve(&p, &f));
    return p;
}

#define SETTINGS(...) ((const char *const[]){__VA_ARGS__, NULL})

// The same of one text with numbers in it, settings between blanks: given("arm.links=%d
// wall.angle=%g", links, angle).
#define given(...)           words_of(formatted(__VA_ARGS__))

#define parameters_with(...) fixture_parameters(given(__VA_ARGS__))

static inline run_result run_arm(parameters p, bool rows)
{
    const scenario s = {.name = (char *)"test", .parameters = p};
    return run_done(&s, rows);
}

// A run of these settings, with its rows; RUN(r, "arm.links=1", ...): until its block is
// left.
#define RUN_OF(...) run_arm(fixture_parameters(SETTINGS(__VA_ARGS__)), true)
#define RUN(r, ...) KEPT_RUN(r) = RUN_OF(__VA_ARGS__)

static inline arm arm_of(const parameters *p)
{
    arm a;
    arm_init(&a, p);
    return a;
}

static inline arm arm_with(const char *const *settings)
{
    const parameters p = fixture_parameters(settings);
    return arm_of(&p);
}

GIVEN_BACK(motion, motion_destroy)

// An arm `a` of parameters and its motion `m`, by an engine (NULL: the arm's own),
// started at an angle and a velocity: until their block is left.
#define STARTED(a, m, p, by, angle, velocity)                                            \
    arm a = arm_of(p);                                                                   \
    KEPT_MOTION(m) = motion_create_by(&a, &(p)->method, by);                             \
    assert_non_null(m);                                                                  \
    motion_start(&a, m, angle, velocity)

// A step of at most `step` [s] towards `until` [s], and the event that ends it.
static inline motion_report step_on(const arm *a, motion *m, double until, double step)
{
    motion_report r;
    assert_int_equal(motion_step(a, m, until, step, &r), STATUS_OK);
    motion_apply(a, m, &r);
    return r;
}

// Steps until `until` [s] or the first event, which is not applied.
static inline status motion_advance(const arm *a, motion *m, double until, double step,
                                    motion_report *report)
{
    status s = STATUS_OK;
    *report = (motion_report){.event = MOTION_REACHED};
    while (s == STATUS_OK && report->event == MOTION_REACHED &&
           m->state[SLOT_TIME] < until) {
        s = motion_step(a, m, until, step, report);
    }
    return s;
}

// An arm's modes, of up to this many bodies.
enum { MODES_MOST = 129 };
typedef struct arm_modes {
    int count;
    double w[MODES_MOST],
        shapes[MODES_MOST * MODES_MOST]; // frequencies [rad/s], a shape a row
} arm_modes;

static inline arm_modes modes_of(const arm *a, hub_end hub, tip_end tip)
{
    arm_modes m;
    assert_in_range(a->dof, 1, MODES_MOST);
    assert_int_equal(modes_compute(a, hub, tip, &m.count, m.w, m.shapes), STATUS_OK);
    return m;
}

// x' K y of equal joints, by the bends: no digit of a slow mode is lost in differences.
static inline double bend_product(const arm *a, const double *x, const double *y)
{
    double sum = 0;
    for (int k = 0; k + 1 < a->dof; k++) {
        const double s = k + 1 == a->first ? a->hub_stiffness : a->joint_stiffness;
        sum += s * (x[k + 1] - x[k]) * (y[k + 1] - y[k]);
    }
    return sum;
}
