// An arm that dies away comes to rest: velocities, bends and accelerations become exactly
// zero instead of fading through denormal numbers, on which processors compute slowly.
#include "tests/arm_fixture.h"

#include <float.h>

#define LEAST                                                                            \
    1.5e-154 // what is nonzero is larger, so that its square is a normal number; what an
             // engine keeps of a step has powers, which are such squares already

// Goes on until `until` [s], through all events; now and then nothing of the state is
// smaller than it may be.
static void go(const arm *a, motion *m, double until)
{
    while (m->state[SLOT_TIME] < until) {
        motion_report report;
        double next = fmin(m->state[SLOT_TIME] + 0.25, until);
        assert_int_equal(motion_advance(a, m, next, 1e-3, &report), STATUS_OK);
        if (report.event != MOTION_REACHED) {
            motion_apply(a, m, &report);
            continue;
        }
        for (int i = SLOT_COUNT; i < m->size; i++) {
            const double least = i < m->head_size ? LEAST : DBL_MIN;
            fail_if(m->state[i] != 0 && fabs(m->state[i]) < least,
                    "entry %d of the state is %g at %g s", i, m->state[i], next);
        }
    }
}

static motion *fading_motion(arm *a, const char *links, const char *method,
                             const char *stiction)
{
    parameters p =
        fixture_parameters(SETTINGS(links, method, stiction, "wall.kind=none",
                                    "motor.voltage=0", "arm.damping_ratio=0.3"));
    arm_init(a, &p);
    return motion_create(a, &p.method);
}

// Without Coulomb friction only back EMF and damping end the motion, exponentially:
// exactly by the series, to what its tolerance leaves by the stiff engine.
TEST(an_arm_that_coasts_comes_to_rest)
{
    for (EACH_TEXT(c, "arm.links=1", "arm.links=2")) {
        arm a;
        KEPT_MOTION(m) = fading_motion(&a, *c, "method.name=event", "motor.stiction=0");
        motion_start(&a, m, 0, 1);
        go(&a, m, 100);
        assert_true(fabs(state_velocities(m, m->state)[0]) > 1e-70);
        go(&a, m, 400);
        double turned = state_angles(m, m->state)[0];
        const double left = m->engine == &stiff_engine ? 1e-18 : 0;
        for (int i = 0; i < m->dof; i++) {
            check_close(state_velocities(m, m->state)[i], 0, left);
            check_close(state_accelerations(m, m->state)[i], 0, left);
        }
        go(&a, m, 500);
        check_close(state_angles(m, m->state)[0], turned, 0);
    }
}

// A bent beam is let go while its hub sticks: the vibration fades around the straight
// shape.
TEST(a_beam_that_vibrated_is_exactly_straight)
{
    arm a;
    KEPT_MOTION(m) =
        fading_motion(&a, "arm.links=2", "method.name=event", "motor.stiction=1");
    motion_start(&a, m, 0, 0);
    state_angles(m, m->state)[1] = 1e-3;
    motion_rebind(&a, &a, m);
    go(&a, m, 1);
    assert_true(fabs(state_angles(m, m->state)[1]) > 1e-9);
    go(&a, m, 400);
    for (int i = SLOT_COUNT; i < SLOT_COUNT + 2 * m->dof; i++) {
        check_close(m->state[i], 0, 0);
    }
}

// The implicit methods end in the rounding of their angles, single links beyond it.
TEST(the_implicit_methods_keep_nothing_that_faded)
{
    static const char *const methods[] = {"method.name=newmark",
                                          "method.name=generalized-alpha"};
    static const char *const frictions[] = {"motor.stiction=0", "motor.stiction=0.01"};
    for (int k = 0; k < 4; k++) {
        arm a;
        KEPT_MOTION(m) = fading_motion(&a, k % 2 ? "arm.links=8" : "arm.links=2",
                                       methods[k / 2], frictions[k % 2]);
        motion_start(&a, m, 0, 1);
        go(&a, m, 250);
        for (int i = 0; i < m->dof; i++) {
            check_below(fabs(state_velocities(m, m->state)[i]), 1e-9);
        }
    }
}
