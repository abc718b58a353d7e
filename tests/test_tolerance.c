// What method.tolerance promises of the stiff engine, up to the first contact again: by
// its default every contact to 1e-9 s, momenta to 1e-7 and the largest force to 1e-6 of
// what a hundredth of it gives. Random arms: tests/random_arms.c by=fine contacts=2.

#include "tests/chain_outcome.h"
#include "tests/arm_fixture.h"

#define DURATION 0.06 // [s]

// An arm that is soon at its wall, as the reference chains are (test_reference_chain.c),
// at a share of the default tolerance, until its second contact.
static chain_outcome outcome_at(const char *settings, double share)
{
    parameters p = resolved(settings);
    p.method.tolerance *= share;
    const chain_start start = {.parameters = &p,
                               .angle = 0.095,
                               .velocity = 0.7,
                               .duration = DURATION,
                               .after_contact = DURATION,
                               .by = &stiff_engine,
                               .most_contacts = 2};
    const chain_outcome o = chain_outcome_of(&start);
    fail_if(o.status != STATUS_OK, "%s: %s", settings, status_text(o.status));
    return o;
}

// Largest distances of two outcomes: of a contact's instant [s], of the momentum and of
// the largest force as shares.
typedef struct distances {
    double time, momentum, peak;
} distances;

static distances distances_of(const chain_outcome *a, const chain_outcome *b)
{
    distances d = {.peak = fabs(a->peak - b->peak) / fmax(b->peak, 1e-3)};
    for (int i = 0; i < b->contacts; i++) {
        d.time = fmax(d.time, fabs(a->contact_times[i] - b->contact_times[i]));
    }
    const int samples = a->samples < b->samples ? a->samples : b->samples;
    for (int i = 0; i < samples; i++) {
        d.momentum = fmax(d.momentum, fabs(a->momentum[i] - b->momentum[i]));
    }
    assert_in_range(samples, 1, REFERENCE_SAMPLES);
    d.momentum /= fabs(b->momentum[samples - 1]);
    return d;
}

static distances error_of(const char *settings, double share)
{
    const chain_outcome coarse = outcome_at(settings, share),
                        fine = outcome_at(settings, share / 100);
    check_close(coarse.contacts, fine.contacts, 0);
    assert_true(fine.contacts > 0);
    return distances_of(&coarse, &fine);
}

static void check_promise(const char *settings)
{
    const distances d = error_of(settings, 1);
    fail_if(!(d.time <= 1e-9 && d.momentum <= 1e-7 && d.peak <= 1e-6),
            "%s: %.2g s, momentum %.2g, peak %.2g", settings, d.time, d.momentum, d.peak);
}

TEST(the_reference_chains_keep_it)
{
    static const char *const hubs[] = {"rigid", "beam"}, *const walls[] = {"point",
                                                                           "plane"};
    for (EACH_OF(double, links, 2, 3, 8, 16, 32, 64)) {
        for (int kind = 0; kind < 16; kind++) {
            check_promise(formatted("arm.links=%g arm.hub_joint=%s wall.kind=%s "
                                    "wall.restitution=%g arm.damping_ratio=%g "
                                    "motor.voltage=1",
                                    *links, hubs[kind & 1], walls[kind >> 1 & 1],
                                    kind & 4 ? 0.5 : 0, kind & 8 ? 0.01 : 0));
        }
    }
}

TEST(walls_that_give_or_move_keep_it)
{
    for (EACH_TEXT(
             wall, "wall.contact=kelvin-voigt", "wall.contact=hunt-crossley",
             "wall.contact=kelvin-voigt wall.mass=0.05",
             "wall.motion=sine wall.motion_amplitude=1e-4 wall.motion_frequency=30")) {
        for (EACH_OF(double, damping, 0, 0.01)) {
            check_promise(formatted("arm.links=8 arm.hub_joint=beam wall.kind=plane "
                                    "arm.damping_ratio=%g motor.voltage=1 %s",
                                    *damping, *wall));
        }
    }
}

// The tolerance is what errors follow: ten thousand times as much of it is seen.
TEST(errors_follow_it)
{
    const char *settings =
        "arm.links=8 arm.hub_joint=beam wall.kind=plane motor.voltage=1";
    const distances own = error_of(settings, 1), coarse = error_of(settings, 1e4);
    assert_true(coarse.momentum > 10 * own.momentum);
    assert_true(coarse.peak > 10 * own.peak);
}

// Arms at rest on their walls, whose hub breaks away or slides from the start: the force
// begins smaller than the error of an ordinary step. Each comes to the end of its run.
TEST(arms_at_rest_on_their_walls_go_on)
{
    static const char *const arms[] = {
        "arm.links=5 arm.hub_joint=spring arm.k2=3.934 arm.mass=0.1405 "
        "arm.hub_inertia=0.04294 arm.tip_mass=0.1154 arm.air_drag=0.04069 "
        "arm.damping_ratio=0.1278 motor.voltage=6.05 motor.stiction=0.3327 "
        "wall.contact=kelvin-voigt wall.stiffness=2346609.7 wall.damping=0",
        "arm.links=3 arm.hub_joint=spring arm.mass=1.6568 arm.hub_inertia=0.030676 "
        "arm.link_lengths=0.35,0.37,0.45 arm.joint_stiffness=37,43 "
        "arm.damping_ratio=0.0037915 motor.voltage=-0.8476 motor.stiction=0.11484 "
        "motor.inductance=0.12122",
        "arm.links=1 arm.hub_joint=spring arm.k2=1.68157 arm.mass=0.58468 "
        "arm.hub_inertia=0.0085073 arm.link_lengths=0.9 motor.voltage=3.3472 "
        "motor.stiction=0.016728 motor.inductance=0.0002519 motor.current_limit=1.5057 "
        "wall.kind=plane wall.contact=kelvin-voigt wall.stiffness=492.79 "
        "wall.damping=0.001007"};
    for (EACH_OF(double, tolerance, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)) {
        for (EACH(settings, arms)) {
            const parameters p =
                resolved(formatted("%s wall.angle=-1 initial.angle=-1 run.duration=0.15 "
                                   "method.tolerance=%g",
                                   *settings, *tolerance));
            KEPT_RUN(r) = run_arm(p, false);
            assert_string_equal(summary_status(&r.summary), "ok");
        }
    }
}
