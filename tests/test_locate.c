// Where an engine steps, the instants of events are found by stepping again from the
// step's start: they are those that an engine finds which needs no steps, and few steps
// lead there.
#include "tests/arm_fixture.h"
#include "tests/explicit_stepper.h"

static const engine *counted;
static int steps_tried;

static status count_step(const arm *a, motion *m, double h, state_extent extent)
{
    steps_tried++;
    return counted->state_at(a, m, h, extent);
}

typedef struct found {
    motion_event event;
    double time; // [s]
    int looks;   // steps tried in that step
    double peak; // of the force so far [N]
    double deep; // largest penetration so far [m]
} found;

enum { MOST = 400 };

// Events of a run in their order: by an engine, or by the method's own; returns how many.
static int events_of(const char *const *settings, const engine *by, double step,
                     double until, found *events)
{
    parameters p = fixture_parameters(settings);
    arm a = arm_of(&p);
    KEPT_MOTION(m) = motion_create_by(&a, &p.method, by);
    assert_non_null(m);

    // its engine, counted
    counted = m->engine;
    engine counting = *counted;
    counting.state_at = count_step;
    m->engine = &counting;
    motion_start(&a, m, p.initial.angle, p.initial.velocity);
    int count = 0;
    while (m->state[SLOT_TIME] < until && count < MOST) {
        motion_report report;
        steps_tried = 0;
        assert_int_equal(motion_step(&a, m, until, step, &report), STATUS_OK);
        if (report.event != MOTION_REACHED) {
            events[count++] =
                (found){report.event, m->state[SLOT_TIME], steps_tried,
                        m->record.pulse_peak, m->record.largest_penetration};
        }
        motion_apply(&a, m, &report);
    }
    return count;
}

static const struct {
    const char *settings[8];
    double until;
} runs[] = {
    {{"arm.links=1", "wall.restitution=0.7", NULL}, 1},
    {{"arm.links=2", NULL}, 0.5},
    {{"arm.links=3", "wall.restitution=0.5", "wall.kind=plane", NULL}, 0.4},
    {{"arm.links=2", "wall.contact=kelvin-voigt", "wall.stiffness=2000", NULL}, 0.5},
    {{"arm.links=1", "motor.voltage=0", "initial.velocity=0.5", "wall.angle=2", NULL}, 1},
    {{"arm.links=2", "motor.voltage=0", "motor.stiction=0.2", "initial.velocity=3",
      "wall.angle=2", NULL},
     1.5},
};

TEST(steps_find_what_series_find)
{
    int of[MOTION_SLIP + 1] = {0}, far[MOTION_SLIP + 1] = {0},
                         total[MOTION_SLIP + 1] = {0};
    for (EACH(c, runs)) {
        static found exact[MOST], stepped[MOST];
        const int count = events_of(c->settings, NULL, 1e-3, c->until, exact);
        assert_true(count > 0 && count < MOST);
        for (int k = 0; k < 3; k++) {
            const double step = (double[]){2e-4, 5e-4, 7e-4}[k];
            assert_int_equal(events_of(c->settings, &explicit_engine, step, c->until,
                                       stepped),
                             count);
            for (int e = 0; e < count; e++) {
                assert_int_equal(stepped[e].event, exact[e].event);
                check_close(stepped[e].time, exact[e].time, 1e-11);
                check_close(stepped[e].peak, exact[e].peak, 1e-9);
                check_close(stepped[e].deep, exact[e].deep, 1e-9 * exact[e].deep + 1e-14);
                of[stepped[e].event]++;

                // superlinear, if the function does not begin very close to zero
                const double since =
                    e > 0 ? exact[e].time - exact[e - 1].time : exact[e].time;
                check_below(stepped[e].looks, since > 3 * step ? 30 : 80);
                far[stepped[e].event] += since > 3 * step;
                total[stepped[e].event] += since > 3 * step ? stepped[e].looks : 0;
            }
        }
    }

    // of every kind there were some, and few looks on the average; where a hub breaks
    // away the slopes are not known, which the first guess otherwise goes by
    for (int kind = MOTION_IMPACT; kind <= MOTION_SLIP; kind++) {
        assert_true(of[kind] > 0);
        check_below(total[kind], (kind == MOTION_SLIP ? 9 : 7.5) * far[kind]);
    }
}

// A rod that is pulled back reaches the wall and would be in front of it again when the
// step ends.
TEST(a_touch_between_the_ends_of_a_step_is_found)
{
    const double wall = 0.1, reach[] = {0.5, 0.9, 0.99};
    for (int i = 0; i < 3; i++) {
        // it turns back after 2 ms, when `reach` of its way leads to the wall
        parameters p = parameters_with("arm.links=1 motor.voltage=-2 motor.stiction=0");
        STARTED(a, m, &p, &explicit_engine, 0, 0);
        const double turn = 2e-3, pull = -state_accelerations(m, m->state)[0];
        const double way = pull * turn * turn / 2,
                     touch = turn * (1 - sqrt(1 - reach[i]));
        motion_start(&a, m, wall - reach[i] * way, pull * turn);
        assert_int_equal(step_on(&a, m, 0.1, 2 * turn).event, MOTION_IMPACT);
        check_relative(m->state[SLOT_TIME], touch, 0.01); // but for the friction
        check_close(m->state[SLOT_GAP], 0, 1e-15);
    }
}
