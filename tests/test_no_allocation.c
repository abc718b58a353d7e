// No step, event or push allocates memory: runs in real time, or a million of them, rely
// on it. The linker puts the counting functions below in the place of the allocator's
// (-Wl,--wrap=malloc and so on, see meson.build).

#include "src/predict/linearised.h"
#include "tests/arm_fixture.h"

static long allocations;

#define COUNTED(name, parameters, arguments)                                             \
    void *__real_##name parameters;                                                      \
    void *__wrap_##name parameters;                                                      \
    void *__wrap_##name parameters                                                       \
    {                                                                                    \
        allocations++;                                                                   \
        return __real_##name arguments;                                                  \
    }
COUNTED(malloc, (size_t size), (size))
COUNTED(calloc, (size_t count, size_t size), (count, size))
COUNTED(realloc, (void *old, size_t size), (old, size))
COUNTED(aligned_alloc, (size_t alignment, size_t size), (alignment, size))

typedef struct passage {
    long strides, allocations;
    int events[MOTION_SLIP + 1];
} passage;

// Goes through a whole run of the arm, with a push half way, and counts.
static passage go_through(const char *const *settings)
{
    parameters p = fixture_parameters(settings);
    passage seen = {0};
    motion_report report;
    STARTED(a, m, &p, NULL, p.initial.angle, p.initial.velocity);
    long before = allocations;
    bool pushed = false;
    while (m->state[SLOT_TIME] < p.run.duration) {
        double until = pushed ? p.run.duration : 0.5 * p.run.duration;
        assert_int_equal(motion_step(&a, m, until, p.method.step, &report), STATUS_OK);
        seen.strides++;
        seen.events[report.event]++;
        double middle = 0.5 * (m->trial[SLOT_TIME] + m->state[SLOT_TIME]);
        assert_non_null(motion_between(&a, m, middle, STATE_WHOLE));
        if (report.event != MOTION_REACHED) {
            motion_apply(&a, m, &report);
        }
        if (!pushed && m->state[SLOT_TIME] >= until) {
            pushed = true;
            motion_push(&a, m, 0.01, &report);
        }
    }
    seen.allocations = allocations - before;
    return seen;
}

// That goes through so many events of a kind and allocates nothing.
static void nothing_is_allocated(const char *const *settings, motion_event kind,
                                 int least)
{
    const passage seen = go_through(settings);
    assert_int_equal(seen.allocations, 0);
    assert_true(seen.events[kind] >= least);
}

TEST(the_counter_counts)
{
    long before = allocations;
    parameters p = fixture_parameters(NULL);
    arm a = arm_of(&p);
    motion_destroy(motion_create(&a, &p.method));
    assert_true(allocations > before);
}

TEST(a_run_through_impacts_allocates_nothing)
{
    passage seen = go_through(NULL);
    assert_int_equal(seen.allocations, 0);
    assert_true(seen.events[MOTION_IMPACT] >= 2);
    assert_true(seen.events[MOTION_RELEASE] >= 1);
    assert_true(seen.events[MOTION_STICK] >= 1);
    nothing_is_allocated(
        given("arm.links=5 wall.kind=plane wall.restitution=0.5 arm.damping_ratio=0.02"),
        MOTION_IMPACT, 5);

    // by the modes of a stiff chain, and on a wall that gives
    nothing_is_allocated(
        given("arm.links=64 wall.kind=plane arm.damping_ratio=0.01 run.duration=0.32"),
        MOTION_IMPACT, 1);
    nothing_is_allocated(given("wall.contact=hunt-crossley motor.inductance=0.01"),
                         MOTION_RELEASE, 1);
}

TEST(implicit_runs_through_impacts_allocate_nothing)
{
    nothing_is_allocated(given("method.name=newmark"), MOTION_IMPACT, 2);
    nothing_is_allocated(given("method.name=generalized-alpha arm.links=6"),
                         MOTION_IMPACT, 1);
}

TEST(a_hub_spring_allocates_nothing)
{
    nothing_is_allocated(given("arm.hub_joint=spring run.duration=0.4"), MOTION_IMPACT,
                         1);
}

// The predictor of two links is asked in free flight at every sample.
TEST(a_prediction_allocates_nothing)
{
    parameters p = fixture_parameters(NULL);
    const double q[] = {0.1, 0.1}, w[] = {0.6, 0.9};
    prediction out;
    arm a = arm_of(&p);
    long before = allocations;
    assert_int_equal(predict_linearised(&a, &p.method, q, w, &out), STATUS_OK);
    assert_int_equal(allocations - before, 0);
}
