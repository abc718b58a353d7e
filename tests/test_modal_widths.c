// Chains by the straight chain's modes give the same bits in vectors of every width.
#include <string.h>

#include "src/solve/contact_machine.h"
#include "src/solve/engine.h"
#include "src/solve/taylor_lanes.h"
#include "tests/arm_fixture.h"

#define DURATION 0.02 // [s]

enum { MOST_NUMBERS = 512 };

// An arm in front of its wall, which it meets in mid-run.
typedef struct modal_case {
    const char *links, *hub, *wall, *damping, *restitution;
    double angle, velocity; // [rad], [rad/s]
} modal_case;

// State, quadratures and accelerations at the end; returns how many numbers that is.
static size_t final_state(const modal_case *c, int width, double *state)
{
    parameters p = fixture_parameters(
        SETTINGS(c->links, c->hub, c->wall, c->damping, c->restitution, "motor.voltage=2"));
    arm a;
    arm_init(&a, &p);
    (void)taylor_limit_width(width);
    motion *m = motion_create_by(&a, &p.method, &modal_engine);
    assert_non_null(m);
    motion_start(&a, m, c->angle, c->velocity);
    while (m->state[SLOT_TIME] < DURATION) {
        motion_report r;
        assert_int_equal(motion_step(&a, m, DURATION, DURATION, &r), STATUS_OK);
        if (r.event != MOTION_REACHED) {
            motion_apply(&a, m, &r);
        }
    }
    const size_t size = (size_t)m->size;
    assert_in_range(size, 1, MOST_NUMBERS);
    memcpy(state, m->state, size * sizeof *state);
    motion_destroy(m);
    (void)taylor_limit_width(0);
    return size;
}

static void all_widths_give_the_same_bits(void **test)
{
    (void)test;
    static const modal_case cases[] = {
        {"arm.links=24", "arm.hub_joint=beam", "wall.kind=plane", "arm.damping_ratio=0.01",
         "wall.restitution=0", 0.095, 0.7},
        {"arm.links=21", "arm.hub_joint=rigid", "wall.kind=point", "arm.damping_ratio=0.02",
         "wall.restitution=0.5", 0.095, 0.7},
        {"arm.links=45", "arm.hub_joint=spring", "wall.kind=none", "arm.damping_ratio=0",
         "wall.restitution=0", 0, 0.2},
        // angles for which sine and cosine need a reduction, and those for which it is not exact
        {"arm.links=24", "arm.hub_joint=rigid", "wall.kind=none", "arm.damping_ratio=0.01",
         "wall.restitution=0", 2.5, 0.7},
        {"arm.links=24", "arm.hub_joint=rigid", "wall.kind=none", "arm.damping_ratio=0.01",
         "wall.restitution=0", 2e5, 0.7},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double widest[MOST_NUMBERS], state[MOST_NUMBERS];
        const size_t size = final_state(&cases[i], 0, widest);
        for (int width = 1; width <= 4; width *= 2) {
            assert_int_equal(final_state(&cases[i], width, state), size);
            assert_memory_equal(state, widest, size * sizeof *state);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_widths_give_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
