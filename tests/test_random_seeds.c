// Runs that random_runs once found wrong: each comes to its end now with a closed ledger, or ends
// where the model does.

#include "src/run/run.h"
#include "tests/arm_fixture.h"

// A fast bounce at a position one truncation error behind the wall.
static const char *const *const bounced = SETTINGS(
    "wall.kind=point", "arm.hub_joint=rigid", "motor.voltage=7.3624601908433931",
    "motor.amplifier_gain=8.9902797532526701", "motor.torque_constant=0.48270590708722927",
    "motor.back_emf=0", "motor.viscous_friction=0", "motor.stiction=0.70949566156492572",
    "wall.angle=-0.058876146053460587", "wall.restitution=1", "arm.length=0.71577119300778325",
    "arm.mass=0.035027178090743044", "arm.hub_inertia=0.0016973633624598463",
    "arm.k2=0.42683428006921265", "arm.damping_ratio=0", "initial.angle=-0.31252081318290958",
    "initial.velocity=4.7072186055817422");

// A stuck hub with a link that swings so far that its sine needs higher orders than its velocity.
static const char *const *const swung =
    SETTINGS("wall.kind=plane", "arm.hub_joint=rigid", "motor.voltage=1.5723574791556594",
             "motor.amplifier_gain=3.5633144777693193", "motor.torque_constant=0.52914640170410843",
             "motor.back_emf=0", "motor.viscous_friction=0", "motor.stiction=0.2083535248321986",
             "wall.angle=-1.2979903407760596", "wall.restitution=1",
             "arm.mass=0.021412955434791433", "arm.hub_inertia=0.026441001325556369",
             "arm.k2=0.088287400729351456", "arm.damping_ratio=0.001600751403942513",
             "initial.angle=-2.3138095162855059", "initial.velocity=3.4473836375613836");

// A hub on a stiff spring that breaks away again and again in no time.
static const char *const *const broke_away =
    SETTINGS("wall.kind=plane", "arm.hub_joint=spring", "motor.voltage=7.8616633048956466",
             "motor.amplifier_gain=1.2161957581200313", "motor.torque_constant=3.2034403573797228",
             "motor.back_emf=0.039542482532608912", "motor.resistance=4.4304877882132878",
             "motor.viscous_friction=0.35338470965139318", "wall.angle=0.32026106661836051",
             "wall.restitution=0.84165404374525177", "arm.length=0.22066926519018759",
             "arm.mass=0.42223357184361698", "arm.hub_inertia=0.00011259278634964185",
             "arm.k1=8738.6745800420013", "arm.k2=17.737641046122626",
             "initial.angle=-0.98466858192806406", "initial.velocity=3.7931958766092073");

// A release that rounding in a stiff spring takes back.
static const char *const *const let_go =
    SETTINGS("wall.kind=point", "arm.hub_joint=spring", "motor.voltage=-1.9768743413650149",
             "motor.amplifier_gain=11.851235553121795", "motor.torque_constant=0.29410972446189715",
             "motor.back_emf=0.046188856706749562", "motor.resistance=4.5978605120540212",
             "motor.stiction=0", "wall.angle=-1.2075879084802406", "arm.length=1.271463985995744",
             "arm.hub_inertia=0.0050819994182993182", "arm.k1=50232.130598215772",
             "arm.k2=4.1088365789119283", "initial.angle=-2.2989462138385468",
             "initial.velocity=-1.6291145627024184");

// The same at 120 rad/s.
static const char *const *const let_go_fast =
    SETTINGS("wall.kind=point", "arm.hub_joint=spring", "motor.voltage=3.8573970306479204",
             "motor.amplifier_gain=11.146218201548116", "motor.torque_constant=2.6986066679690039",
             "motor.back_emf=0", "motor.resistance=3.6706804241669562",
             "motor.viscous_friction=0.00024240317969145454", "motor.stiction=0",
             "wall.angle=-0.21487423762876823", "wall.restitution=0.2179205452748364",
             "arm.length=0.42193272654453556", "arm.mass=0.11068382206550233",
             "arm.hub_inertia=0.00057945978438589776", "arm.k1=26377.448470638956",
             "arm.k2=1.0232856054044419", "initial.angle=-1.658630168534875",
             "initial.velocity=2.6352725431145618");

// And with an arm of 30 g.
static const char *const *const came_back =
    SETTINGS("wall.kind=plane", "arm.hub_joint=spring", "motor.voltage=-5.5737155909324887",
             "motor.amplifier_gain=2.4726066350646123", "motor.torque_constant=19.952682974789454",
             "motor.back_emf=0.087192693296029092", "motor.resistance=70.635963479064998",
             "motor.viscous_friction=0", "motor.stiction=0", "wall.angle=-0.93927037094654975",
             "wall.restitution=0.36606539907880009", "arm.length=1.5629847646382611",
             "arm.mass=0.02978291683201471", "arm.hub_inertia=0.0020731549166709828",
             "arm.k2=28.063939184279072", "initial.angle=-2.3500528114513877",
             "initial.velocity=-1.0167315338419591");

// A point behind the hub that the arm sweeps over: a touch with an acceleration close to rounding.
static const char *const *const swept_over = SETTINGS(
    "wall.kind=point", "arm.hub_joint=spring", "motor.voltage=-2.4528515077463986",
    "motor.torque_constant=12.425609375789591", "motor.resistance=8.200308490053235",
    "motor.viscous_friction=0.015180949269274758", "motor.stiction=0.027108299999621114",
    "wall.angle=-1.2786786909264061", "wall.restitution=0", "arm.length=0.35435342553686888",
    "arm.mass=0.084212806907397866", "arm.hub_inertia=0.00031672022306158433",
    "arm.k1=66279.214005312242", "arm.k2=38.251713922716498", "initial.angle=-1.6337701878814963",
    "initial.velocity=3.1122561770814841");

// A hub that comes to rest with a torque equal to friction's limit to rounding.
static const char *const *const came_to_rest =
    SETTINGS("wall.kind=plane", "arm.hub_joint=spring", "motor.voltage=-1.0448212998938189",
             "motor.amplifier_gain=13.269647147420386", "motor.torque_constant=11.987453114429988",
             "motor.resistance=17.827084026420238", "motor.stiction=0.24481793328311974",
             "wall.angle=-0.9088457802154164", "wall.restitution=0.1878727903381151",
             "arm.length=0.5665252074976912", "arm.mass=0.039887821091463167",
             "arm.hub_inertia=0.00065010477188868153", "arm.k1=157811.38575973807",
             "arm.k2=34.45062209145302", "initial.angle=-1.8543484232783054");

// A light hub that its motor brakes with 5e5 1/s, in fast rotation.
static const char *const *const spun = SETTINGS(
    "wall.kind=point", "arm.hub_joint=beam", "motor.voltage=-7.4496752248724825",
    "motor.torque_constant=10.322410847758455", "motor.back_emf=17.837703213025179",
    "motor.resistance=3.5671540043350509", "motor.viscous_friction=0.17745084082087847",
    "motor.stiction=0.36796164717472457", "wall.angle=-0.91273846733037911", "wall.restitution=1",
    "arm.mass=0.17792530335853379", "arm.hub_inertia=0.00011178115888277645",
    "arm.k2=2.0395296601095732", "arm.damping_ratio=0", "initial.angle=-1.6935095618531402",
    "initial.velocity=-1.6808487213046144");

static void run_with(const char *const *settings, bool keep_trace, run_result *result)
{
    char name[] = "random", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    s.parameters = fixture_parameters(settings);
    run_scenario(&s, keep_trace, result);
}

TEST(test_runs_that_failed_come_to_their_end)
{
    const char *const *const runs[] = {bounced,   broke_away, let_go,       let_go_fast,
                                       came_back, swept_over, came_to_rest, swung};
    for (EACH(c, runs)) {
        SCOPED(run_finish) run_result r;
        run_with(*c, false, &r);
        assert_int_equal(r.summary.status, STATUS_OK);
        assert_false(r.summary.inaccurate);
        assert_true(r.summary.energy_residual_J < 1e-9);
        assert_true(isfinite(r.summary.first_contact_s));
    }
}

// Soft springs let the arm fold over the hub's axis, with its tip sliding on the flat wall. On the
// way there the wall's reaction grows as 1/lever, and where the lever is nothing the run ends: with
// the ledger closed, the links opposite to each other and the tip at the axis.
TEST(test_an_arm_folded_over_the_hub_ends_the_run)
{
    const char *const *const arms[] = {
        SETTINGS("wall.kind=plane", "motor.voltage=8.238", "motor.resistance=3.68",
                 "wall.angle=-0.541", "arm.k2=0.09", "initial.angle=-1.977"),
        SETTINGS("wall.kind=plane", "motor.voltage=-3.753", "motor.back_emf=0", "arm.mass=0.539",
                 "arm.k2=0.0817"),
        SETTINGS("wall.kind=plane", "motor.voltage=-8.97", "motor.back_emf=0", "arm.k2=0.1",
                 "wall.angle=0.94", "initial.angle=0.71", "arm.hub_joint=spring", "arm.k1=500"),
        // what could go through the fold in one stride, the velocities being smooth there
        SETTINGS("wall.kind=plane", "wall.angle=0.0018", "wall.restitution=0.08",
                 "motor.voltage=8.2", "arm.mass=1.5", "arm.length=0.3", "arm.hub_inertia=0.00036",
                 "arm.k2=0.27"),
    };
    for (EACH(c, arms)) {
        SCOPED(run_finish) run_result r;
        run_with(*c, true, &r);
        const trace *t = &r.trace;
        assert_int_equal(r.summary.status, STATUS_FOLDED);
        assert_true(r.summary.message[0] != '\0');
        assert_true(r.summary.energy_residual_J < 1e-9);

        // the last rows: ever more force on ever less lever
        assert_true(t->row_count > 10);
        const sample *last = &t->rows[t->row_count - 1];
        const double bend = fabs(remainder(last->last_angle - last->first_angle, 2 * M_PI));
        assert_true(bend > 2);
        assert_true(isfinite(r.summary.peak_force_N) && r.summary.peak_force_N < 1e6);
    }
}

// On its way to a fold and back the force has a pole nearby, of which the velocities know nothing:
// it is what the stiff engine makes of it, which a tip mass of next to nothing takes.
TEST(test_the_force_near_a_fold_is_that_of_another_engine)
{
    const char *const *const near[] = {
        SETTINGS("wall.kind=plane", "arm.mass=0.659275", "arm.length=0.888161",
                 "arm.hub_inertia=0.000270442", "arm.k2=0.075065", "wall.angle=0.190554",
                 "motor.voltage=4.96717", "run.duration=0.4", "motor.back_emf=1",
                 "arm.hub_joint=rigid", "arm.k1=50"),
        SETTINGS("wall.kind=plane", "arm.mass=0.659275", "arm.length=0.888161",
                 "arm.hub_inertia=0.000270442", "arm.k2=0.075065", "wall.angle=0.190554",
                 "motor.voltage=4.96717", "run.duration=0.4", "motor.back_emf=1",
                 "arm.hub_joint=rigid", "arm.k1=50", "arm.tip_mass=1e-15", "method.step=1e-4"),
    };
    double peak[2];
    for (int i = 0; i < 2; i++) {
        SCOPED(run_finish) run_result r;
        run_with(near[i], false, &r);
        assert_int_equal(r.summary.status, STATUS_OK);
        peak[i] = r.summary.peak_force_N;
    }
    check_relative(peak[0], peak[1], 1e-4);
}

// Neither do the strides of chains lead through a fold, nor to a release in it.
TEST(test_no_step_leads_through_a_fold)
{
    const char *const voltages[] = {"motor.voltage=8.6", "motor.voltage=8.8", "motor.voltage=9.8"};
    for (EACH(c, voltages)) {
        SCOPED(run_finish) run_result r;
        run_with(SETTINGS("wall.kind=plane", "wall.angle=0.0018", "wall.restitution=0.08",
                          "arm.mass=1.5", "arm.length=0.3", "arm.hub_inertia=0.00036",
                          "arm.k2=0.27", "arm.tip_mass=1e-15", "run.duration=0.3", *c),
                 false, &r);
        assert_int_equal(r.summary.status, STATUS_FOLDED);
    }
}

// A decay that strides are only as brief as is no reason to leave the series of two links.
TEST(test_a_braked_pair_stays_with_its_series)
{
    SCOPED(run_finish) run_result r;
    SCOPED(run_finish) run_result usual;
    run_with(spun, false, &r);
    run_with(SETTINGS("motor.voltage=1"), false, &usual);
    assert_int_equal(r.summary.status, STATUS_OK);
    assert_true(r.summary.energy_residual_J < 1e-9);
    assert_string_equal(r.summary.method, usual.summary.method);
}
