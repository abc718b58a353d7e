// The stiff engine gives the motion of the explicit formula, of every arm and wall, and
// the same bits in vectors of any width, however a run is cut, and from a copy of its
// state.

#include "src/engines/pair/taylor_lanes.h"
#include "tests/arm_fixture.h"
#include "tests/chain_outcome.h"
#include "tests/explicit_stepper.h"

#define START_ANGLE 0.09
#define DURATION    0.06

static const char *const arms[][6] = {
    {"arm.links=1", "arm.hub_joint=rigid", "wall.kind=plane"},
    {"arm.links=1", "arm.hub_joint=beam", "wall.contact=kelvin-voigt",
     "arm.tip_mass=0.01"},
    {"arm.links=2", "arm.hub_joint=spring", "wall.restitution=0.5", "arm.k1=500"},
    {"arm.links=3", "arm.hub_joint=rigid", "wall.kind=plane", "arm.tip_mass=0.02"},
    {"arm.links=4", "arm.hub_joint=beam", "arm.damping_ratio=0.1", "arm.air_drag=2"},
    {"arm.links=5", "arm.hub_joint=beam", "arm.joint_stiffness=9,7,6,5,4"},
    {"arm.links=4", "arm.hub_joint=beam", "arm.stiffening=1", "wall.kind=plane"},
    {"arm.links=5", "arm.hub_joint=beam", "arm.modal_ratios=0.01,0.05",
     "wall.kind=plane"},
    {"arm.links=6", "arm.hub_joint=rigid", "motor.inductance=2e-3",
     "motor.current_limit=0.3"},
    {"arm.links=3", "arm.hub_joint=beam", "motor.current_limit=0.2", "wall.kind=plane"},
    {"arm.links=4", "arm.hub_joint=beam", "wall.contact=kelvin-voigt",
     "motor.inductance=1e-3"},
    {"arm.links=4", "arm.hub_joint=rigid", "wall.contact=hunt-crossley",
     "arm.tip_mass=0.01"},
    {"arm.links=4", "arm.hub_joint=beam", "wall.contact=kelvin-voigt", "wall.mass=0.05",
     "wall.restitution=0.4"},
    {"arm.links=7", "arm.hub_joint=beam", "wall.restitution=0.7",
     "arm.damping_ratio=0.01"},
    {"arm.links=3", "arm.hub_joint=rigid", "motor.inductance=3e-4", "arm.k2=1.7"},
    {"arm.links=3", "arm.hub_joint=beam", "wall.contact=hunt-crossley",
     "wall.stiffness=200", "wall.exponent=2.8", "motor.inductance=4e-4"},
    {"arm.links=7", "arm.hub_joint=rigid", "wall.contact=hunt-crossley",
     "wall.stiffness=1e8", "wall.damping=1e5", "motor.inductance=2e-4"},
    {"arm.links=1", "arm.hub_joint=beam", "wall.stiffness=1e4",
     "wall.contact=hunt-crossley", "wall.exponent=2.5"},

    // that nothing but motor and wall damps
    {"arm.links=3", "arm.hub_joint=rigid", "wall.kind=plane", "motor.voltage=1"},
    {"arm.links=4", "wall.restitution=0.6", "motor.voltage=3", "motor.stiction=0.4"},
    {"arm.links=9", "arm.hub_joint=rigid", "arm.damping_ratio=0.001", "motor.voltage=-1",
     "motor.stiction=0.4"},
    {"arm.links=17", "arm.hub_joint=beam", "motor.voltage=2"},
};
enum { ARMS = sizeof arms / sizeof arms[0] };

static parameters parameters_of(int i)
{
    const char *settings[7] = {0};
    for (int k = 0; k < 6; k++) {
        settings[k] = arms[i][k];
    }
    return fixture_parameters(settings);
}

static chain_outcome outcome_of(const parameters *p, const engine *by)
{
    return chain_outcome_of(&(chain_start){p, START_ANGLE, 0.7, DURATION, DURATION, by});
}

// The same by the explicit formula, in steps that leave rounding only.
static chain_outcome outcome_by_formula(chain_start start)
{
    parameters p = *start.parameters;
    p.method.step = 1e-5;
    start.parameters = &p;
    start.by = &explicit_engine;
    return chain_outcome_of(&start);
}

TEST(the_explicit_formula_gives_the_same)
{
    for (int i = 0; i < ARMS; i++) {
        const parameters p = parameters_of(i);
        const chain_outcome truth =
            outcome_by_formula((chain_start){&p, START_ANGLE, 0.7, DURATION, DURATION});
        const chain_outcome stiff = outcome_of(&p, &stiff_engine);
        assert_int_equal(truth.status, STATUS_OK);
        assert_int_equal(stiff.status, STATUS_OK);
        assert_false(isnan(truth.first_contact));
        assert_int_equal(stiff.impacts, truth.impacts);
        assert_int_equal(stiff.samples, truth.samples);
        check_close(stiff.first_contact, truth.first_contact, 1e-11);
        check_close(stiff.first_impulse, truth.first_impulse, 1e-9 * truth.first_impulse);
        const double most = truth.momentum[truth.samples - 1];
        for (int k = 0; k < truth.samples; k++) {
            check_close(stiff.momentum[k], truth.momentum[k], 1e-9 * most);
        }
        check_close(stiff.peak, truth.peak, 1e-8 * fabs(truth.peak) + 1e-9);
        check_close(stiff.motor_work, truth.motor_work, 1e-9 * truth.put_in);
        check_below(stiff.residual, 1e-9 * stiff.put_in);
        for (int k = 0; k < 5; k++) {
            check_close(stiff.lost[k], truth.lost[k], 1e-8 * truth.put_in);
        }
    }
}

// One link on a hub spring moves by a linear law, and its steps are long.
TEST(air_on_one_link_that_turns_far_closes_the_ledger)
{
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=1", "arm.hub_joint=spring", "arm.k1=4.94721",
                 "arm.hub_inertia=0.0272", "arm.mass=0.0675", "arm.air_drag=0.0015",
                 "arm.damping_ratio=0", "wall.kind=none", "motor.voltage=3.965",
                 "motor.stiction=0", "motor.viscous_friction=0.05"));
    chain_outcome o = chain_outcome_of(&(chain_start){&p, -0.083, 0, 0.6, 0.6, NULL});
    assert_int_equal(o.status, STATUS_OK);
    check_below(o.residual, 1e-9 * o.put_in);
}

// How a motion is made: with stops at every interval [s], from a copy of its state alone
// at each step, in vectors of at most a width (0: any).
typedef struct way {
    double interval;
    bool forgetful;
    int width;
} way;

// The motion after DURATION; its state into `end`.
static size_t motion_to_end(const parameters *p, way how, double *end)
{
    enum { MOST_COPY = 4096 };
    taylor_limit_width(how.width);
    STARTED(a, m, p, &stiff_engine, START_ANGLE, 0.7);
    int stops = 0;
    while (m->state[SLOT_TIME] < DURATION) {
        motion_report r;
        const double stop = fmin(how.interval * (stops + 1), DURATION);
        assert_int_equal(motion_step(&a, m, stop, 1e-3, &r), STATUS_OK);
        stops += !(m->state[SLOT_TIME] < stop);
        motion_apply(&a, m, &r);
        if (how.forgetful) { // only the state is left
            static double copy[MOST_COPY];
            assert_true(m->size <= (int)MOST_COPY);
            memcpy(copy, m->state, (size_t)m->size * sizeof *copy);
            motion_destroy(m);
            m = motion_create_by(&a, &p->method, &stiff_engine);
            memcpy(m->state, copy, (size_t)m->size * sizeof *copy);
            motion_invalidate_history(m);
        }
    }
    const size_t size = (size_t)(SLOT_COUNT + 2 * m->dof + QUADRATURE_COUNT);
    memcpy(end, m->state, size * sizeof *end);
    taylor_limit_width(0);
    return size;
}

// Of the arms from `first` on.
static void check_same_bits(int first, way one, way other)
{
    for (int i = first; i < ARMS; i++) {
        const parameters p = parameters_of(i);
        double a[256], b[256];
        const size_t size = motion_to_end(&p, one, a);
        motion_to_end(&p, other, b);
        for (size_t k = 0; k < size; k++) {
            fail_if(memcmp(&a[k], &b[k], sizeof a[k]) != 0,
                    "arm %d: number %zu differs: %.17g and %.17g", i, k, a[k], b[k]);
        }
    }
}

TEST(stops_change_no_bit)
{
    for (EACH_OF(double, c, 1e-3, 0.77e-4)) {
        // the first arm's force adds up at rest, from stop to stop
        check_same_bits(1, (way){.interval = HUGE_VAL}, (way){.interval = *c});
    }
}

TEST(a_copy_of_the_state_goes_on_with_the_same_bits)
{
    check_same_bits(0, (way){.interval = 0.5e-3},
                    (way){.interval = 0.5e-3, .forgetful = true});
}

TEST(every_width_of_vectors_gives_the_same_bits)
{
    check_same_bits(0, (way){.interval = HUGE_VAL},
                    (way){.interval = HUGE_VAL, .width = 1});
}

// A light arm behind a spring swings off the wall as the fourth power of the time; one
// that moves into the wall strikes it at once.
TEST(starts_on_the_wall_are_told_from_rounding)
{
    const parameters off =
        fixture_parameters(SETTINGS("arm.hub_joint=spring", "arm.k1=276", "arm.k2=64",
                                    "motor.voltage=2", "wall.angle=0"));
    const chain_outcome swings =
        chain_outcome_of(&(chain_start){&off, 0, 0, DURATION, DURATION, &stiff_engine});
    const chain_outcome by_formula =
        outcome_by_formula((chain_start){&off, 0, 0, DURATION, DURATION});
    check_close(swings.first_contact, by_formula.first_contact, 1e-11);
    assert_int_equal(swings.impacts, by_formula.impacts);
    check_close(swings.peak, by_formula.peak, 1e-7 * by_formula.peak);

    const parameters into =
        fixture_parameters(SETTINGS("arm.links=3", "arm.tip_mass=0.01"));
    const chain_outcome strikes = chain_outcome_of(
        &(chain_start){&into, 0.1, 0.6, DURATION, DURATION, &stiff_engine});
    const chain_outcome truth =
        outcome_by_formula((chain_start){&into, 0.1, 0.6, DURATION, DURATION});
    check_close(strikes.first_contact, 0, 1e-12);
    check_close(strikes.first_impulse, truth.first_impulse, 1e-10 * truth.first_impulse);
}

// A light face behind a strong damper is met at rest: the force rises faster than the
// first step shows, which is no release.
TEST(an_arm_that_rests_on_a_face_stays_on_it)
{
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=1", "arm.hub_joint=spring", "wall.angle=2.1487444233014976",
                 "wall.kind=plane", "motor.voltage=5.25", "motor.stiction=0.09",
                 "arm.mass=0.84", "arm.hub_inertia=3.5e-3", "arm.k2=19",
                 "motor.current_limit=3.65", "wall.contact=kelvin-voigt",
                 "wall.stiffness=6.7", "wall.damping=21860", "wall.mass=0.027"));
    chain_outcome o[2];
    for (int i = 0; i < 2; i++) {
        const chain_start start = {&p, p.wall.angle, 0, 0.02, 0.02, &stiff_engine};
        o[i] = i == 0 ? chain_outcome_of(&start) : outcome_by_formula(start);
        assert_int_equal(o[i].status, STATUS_OK);
    }
    assert_int_equal(o[0].contacts, o[1].contacts);
    check_close(o[0].peak, o[1].peak, 1e-8 * o[1].peak);
    check_close(o[0].lost[4], o[1].lost[4], 1e-9 * o[1].put_in);
}

// Ten links lie on a soft wall while the hub starts: for milliseconds the tip's gap is
// rounding. A hub on a stiff spring comes to rest slowly, far from zero: its angle's last
// digits are momentum. A link leaves a light face on a stiff spring, whose place's last
// digits push it.
TEST(rounding_makes_no_events_and_stops_none)
{
    const parameters lies = fixture_parameters(
        SETTINGS("arm.links=10", "arm.hub_joint=spring", "wall.angle=-2.5203893907510242",
                 "initial.angle=-2.5203893907510242", "motor.voltage=0.34",
                 "arm.mass=0.1", "arm.k2=1.55", "motor.inductance=0.44",
                 "wall.contact=kelvin-voigt", "wall.stiffness=56"));
    const parameters slow = fixture_parameters(
        SETTINGS("arm.links=1", "arm.hub_joint=spring", "wall.angle=1.6029091097614279",
                 "initial.angle=1.6013044654119684", "motor.voltage=1.0383019815759789",
                 "arm.mass=0.67605488209424403", "arm.hub_inertia=0.0013041262868641415",
                 "motor.stiction=0.0049450852012509119", "arm.k2=1.397745898348157",
                 "wall.restitution=0.73448653687268595",
                 "arm.damping_ratio=0.0045224480198796518"));
    const parameters leaves = fixture_parameters(
        SETTINGS("arm.links=1", "arm.hub_joint=beam", "wall.angle=0.52551617311434207",
                 "initial.angle=-2.6139982837488329", "motor.voltage=9.2267505502571954",
                 "arm.mass=0.2539037021673044", "arm.hub_inertia=0.032602848952261856",
                 "motor.stiction=0.057846404023573494", "arm.k2=1.1296948727964351",
                 "arm.stiffening=0.17374677983270193", "wall.contact=kelvin-voigt",
                 "wall.stiffness=44316398.161449909", "wall.damping=1.2410654660832594",
                 "wall.mass=0.014843778839791476", "wall.restitution=0"));
    const chain_start starts[] = {
        {&lies, lies.wall.angle, 0, 0.03, 0.03, NULL},
        {&slow, 1.6013044654119684, 0.101077, 0.06, 0.06, NULL},
        {&leaves, -2.6139982837488329, -0.11927640780125666, 0.06, 0.03, NULL},
    };
    // a straight arm on its point, whose hub starts: the tip's gap grows as a high power
    // of time, and touches within rounding are no impacts to be counted
    const parameters starts_straight = fixture_parameters(
        SETTINGS("arm.links=12", "arm.hub_joint=beam", "arm.damping_ratio=0.01",
                 "wall.kind=point", "wall.angle=0", "motor.voltage=5.625"));
    const chain_outcome straight = chain_outcome_of(
        &(chain_start){&starts_straight, 0, 0, 0.03, 0.03, &stiff_engine});
    assert_int_equal(straight.status, STATUS_OK);
    check_below(straight.residual, 1e-9 * straight.put_in);

    // the same by a current that grows: the gap opens as the fourth power of the time
    const parameters breaks_away = fixture_parameters(
        SETTINGS("arm.hub_joint=beam", "arm.damping_ratio=0.84005097425089026",
                 "wall.kind=point", "wall.angle=1.6867664463009513",
                 "motor.voltage=1.3641530173187046",
                 "motor.inductance=0.074513991456584897",
                 "motor.current_limit=4.1334815398448788", "arm.mass=0.24099001101541614",
                 "arm.hub_inertia=0.013887622986487512", "arm.joint_stiffness=4.7,4.5"));
    const chain_outcome opens = chain_outcome_of(&(
        chain_start){&breaks_away, breaks_away.wall.angle, 0, 0.03, 0.03, &stiff_engine});
    assert_int_equal(opens.status, STATUS_OK);
    check_below(opens.residual, 1e-9 * opens.put_in);

    for (EACH(c, starts)) {
        chain_start start = *c;
        start.by = &stiff_engine;
        const chain_outcome o = chain_outcome_of(&start);
        const chain_outcome truth = outcome_by_formula(start);
        assert_int_equal(o.status, STATUS_OK);
        assert_int_equal(o.impacts, truth.impacts);
        check_close(o.motor_work, truth.motor_work, 1e-9 * truth.put_in);
        check_below(o.residual, 1e-9 * o.put_in);
    }
}

// Where the wall holds the link and friction the hub, the force stays what it is while
// the motor's current still changes: its peak is reached when the hub comes to rest.
TEST(a_force_that_stays_has_its_peak_at_its_start)
{
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=1", "arm.hub_joint=beam", "wall.kind=plane",
                 "motor.voltage=0.49199248223745717", "arm.mass=0.95154417458975349",
                 "arm.hub_inertia=0.0033970417183283095", "arm.k2=17.381623622079722",
                 "motor.inductance=0.011351328772705165"));
    const double end = 0.06;
    double held = 0;
    STARTED(a, m, &p, &stiff_engine, 0.099711351379691532, 0.058592421014174362);
    while (m->state[SLOT_TIME] < end) {
        const motion_event met = step_on(&a, m, end, p.method.step).event;
        held = met == MOTION_STICK ? m->state[SLOT_TIME] : held;
    }
    assert_true(m->state[SLOT_CONTACT] != 0 && m->state[SLOT_FRICTION] == HUB_STICK);
    assert_true(held > 0 && held < 0.8 * end);
    check_close(m->record.pulse_peak_time, held, 1e-9);
    check_close(m->record.pulse_peak, m->state[SLOT_FORCE], 1e-9 * m->record.pulse_peak);
}

// Bounces amplify errors: 62 of them leave a hundred-thousandth of the momentum in doubt.
TEST(a_chain_that_bounces_keeps_its_impacts)
{
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=18", "wall.kind=plane",
                 "wall.restitution=0.89485274850248742",
                 "motor.voltage=5.5178188164179405", "arm.k2=26.16118528162535",
                 "arm.mass=0.53343796353978479", "arm.hub_inertia=0.001109107661660298"));
    chain_outcome o[2];
    for (int i = 0; i < 2; i++) {
        const engine *by = i == 0 ? &stiff_engine : &explicit_engine;
        o[i] = chain_outcome_of(&(chain_start){&p, 0.0930597, 2.17651, 0.1, 0.0501, by});
        assert_int_equal(o[i].status, STATUS_OK);
        assert_int_equal(o[i].impacts, 62);
    }
    const int last = o[1].samples - 1;
    check_close(o[0].momentum[last], o[1].momentum[last], 1e-4 * o[1].momentum[last]);
}

// Decays of 1e10 to 1e19 1/s, after an impact and where the hub sticks and slips: what is
// over within a step takes no steps of its own, and rounding that such rates amplify
// makes no event.
TEST(decays_of_any_rate_are_passed_over)
{
    static const char *const fast[][6] = {
        {"arm.links=64", "arm.EI=1e6", "arm.damping_ratio=1"},
        {"arm.links=8", "arm.hub_joint=spring", "arm.k1=1e8", "arm.hub_inertia=1e-12",
         "arm.damping_ratio=1"},
        {"arm.links=128", "arm.damping_ratio=0.1", "motor.inductance=1e-4"},
        {"arm.links=3", "arm.hub_joint=rigid", "motor.inductance=1e-12",
         "arm.tip_mass=0.01"},
        {"arm.links=6", "wall.contact=hunt-crossley", "wall.stiffness=1e8",
         "wall.damping=1e15"},
    };
    for (EACH(c, fast)) {
        const parameters p = fixture_parameters(*c);
        STARTED(a, m, &p, &stiff_engine, 0, 0);
        int steps = 0;
        bool touched = false;
        for (; m->state[SLOT_TIME] < 0.36 && steps < 20000; steps++) {
            step_on(&a, m, 0.36, 1e-3);
            touched = touched || m->state[SLOT_CONTACT] != 0;
        }
        assert_true(steps < 20000);
        assert_true(touched);
        const double put_in = motion_motor_work(m, m->state);
        check_below(fabs(motion_energy_residual(&a, m, m->state)), 1e-9 * put_in);
    }
}

// A force of rounding on the wall that the arm just touches ends no step beyond the hub's
// break-away, and what friction holds stays within stiction.
TEST(a_force_of_rounding_hides_no_slip)
{
    const parameters p = fixture_parameters(SETTINGS(
        "arm.links=3", "arm.hub_joint=rigid", "wall.kind=plane", "method.engine=stiff",
        "motor.voltage=2.5157641983999302", "arm.mass=0.26491769416740801",
        "arm.hub_inertia=0.027055577608406902", "motor.stiction=0.020115620297431486",
        "wall.angle=-2.4908818215445754", "initial.angle=-2.4908818215445754",
        "arm.k2=21.635624238531371", "arm.air_drag=0.52074942104057076",
        "motor.inductance=0.92955259258329925", "motor.current_limit=0.90031986558427557",
        "wall.contact=kelvin-voigt", "wall.stiffness=7616.9205058752668",
        "wall.damping=68.236035295918327", "arm.damping_ratio=0.026265943154315696"));
    STARTED(a, m, &p, NULL, p.initial.angle, 0);
    bool slid = false;
    for (int i = 0; i < 200 && m->state[SLOT_TIME] < 0.01; i++) {
        motion_report r;
        assert_int_equal(motion_step(&a, m, 0.01, 1e-3, &r), STATUS_OK);
        check_below(fabs(m->state[SLOT_FRICTION_TORQUE]), a.motor.stiction + 1e-9);
        motion_apply(&a, m, &r);
        slid = slid || r.event == MOTION_SLIP;
    }
    assert_true(slid);
}

static bool is_refused(const char *const *settings)
{
    parameters p = unresolved_parameters(settings);
    fault f = {.text = ""};
    return parameters_resolve(&p, &f) == STATUS_BAD_SCENARIO &&
           strstr(f.text, "method.engine");
}

TEST(an_engine_that_cannot_take_the_arm_is_refused)
{
    assert_true(is_refused(SETTINGS("method.engine=pair", "arm.links=3")));
    assert_true(is_refused(SETTINGS("method.engine=pair", "arm.tip_mass=0.01")));
    assert_true(is_refused(SETTINGS("method.engine=pair", "wall.contact=kelvin-voigt")));
    assert_true(is_refused(SETTINGS("method.engine=pair", "motor.inductance=1e-3")));
    assert_true(is_refused(SETTINGS("method.engine=stiff", "method.name=newmark")));
    assert_false(is_refused(SETTINGS("method.engine=pair", "arm.hub_joint=spring")));
    assert_false(is_refused(SETTINGS("method.engine=stiff", "arm.tip_mass=0.01")));
}
