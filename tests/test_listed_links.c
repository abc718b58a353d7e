// Masses, inertias and joint damping that are given link by link: against closed forms
// and against matrices that are written down here, their limits, and what contradicts
// them.

#include <complex.h>

#include "src/study/linear/linear.h"
#include "tests/arm_fixture.h"

enum { MOST = 8, POLES = 40 };

// --- the straight arm by textbook matrices ---------------------------------------------

// An arm of `links` bodies on a hub: lengths, masses, inertias about the middles, and the
// stiffness and damping of the joint before each, of a rigid hub 0.
typedef struct known_arm {
    const char *settings;
    bool spring; // the hub is a body of its own
    int links;
    double length[MOST], mass[MOST], inertia[MOST], stiffness[MOST], damping[MOST];
} known_arm;

#define LOOSE                                                                            \
    "wall.kind=none motor.voltage=0 motor.stiction=0 motor.viscous_friction=0 "          \
    "motor.back_emf=0 arm.hub_inertia=0.004 "

static const known_arm known_arms[] = {
    {"arm.links=2 arm.link_lengths=0.3,0.25 arm.link_masses=0.4,0.2 "
     "arm.link_inertias=0.004,0.0005 arm.joint_stiffness=9 arm.joint_damping=0.03",
     false,
     2,
     {0.3, 0.25},
     {0.4, 0.2},
     {0.004, 0.0005},
     {0, 9},
     {0, 0.03}},
    {"arm.links=3 arm.hub_joint=spring arm.k1=80 arm.length=0.9 "
     "arm.link_masses=0.3,0.1,0.2 "
     "arm.joint_stiffness=12,7 arm.joint_damping=0.5,0.01,0",
     true,
     3,
     {0.3, 0.3, 0.3},
     {0.3, 0.1, 0.2},
     {0.3 * 0.09 / 12, 0.1 * 0.09 / 12, 0.2 * 0.09 / 12},
     {80, 12, 7},
     {0.5, 0.01, 0}},
    {"arm.links=3 arm.hub_joint=beam arm.k2=4 arm.length=0.6 arm.mass=0.3 "
     "arm.link_inertias=0.0002,0,0.001 arm.joint_damping=0.02",
     true,
     3,
     {0.2, 0.2, 0.2},
     {0.1, 0.1, 0.1},
     {0.0002, 0, 0.001},
     {12, 6, 6},
     {0.02, 0.02, 0.02}},
    {"arm.links=4 arm.length=0.8 arm.mass=0.4 arm.k2=3 arm.joint_damping=0.04,0,0.002",
     false,
     4,
     {0.2, 0.2, 0.2, 0.2},
     {0.1, 0.1, 0.1, 0.1},
     {0.1 * 0.04 / 12, 0.1 * 0.04 / 12, 0.1 * 0.04 / 12, 0.1 * 0.04 / 12},
     {0, 6, 6, 6},
     {0, 0.04, 0, 0.002}},
};

// M s^2 + C s + K of the arm's absolute angles.
static int dynamic_matrix(const known_arm *k, double complex s,
                          double complex matrix[MOST + 1][MOST + 1])
{
    const int first = k->spring ? 1 : 0, n = k->links + first;
    memset(matrix, 0, sizeof(double complex[MOST + 1][MOST + 1]));
    matrix[0][0] += 0.004 * s * s;
    for (int i = 0; i < k->links; i++) {
        for (int j = 0; j < k->links; j++) {
            // what both turn: all beyond the outer of them, and of that one the half
            const int outer = i > j ? i : j;
            double beyond = k->mass[outer] / (i == j ? 4 : 2), own = 0;
            for (int m = outer + 1; m < k->links; m++) {
                beyond += k->mass[m];
            }
            if (i == j) {
                own = k->inertia[i];
            }
            matrix[first + i][first + j] +=
                s * s * (k->length[i] * k->length[j] * beyond + own);
        }
    }
    for (int b = 1; b < n; b++) {
        const double complex joint = k->stiffness[b - first] + s * k->damping[b - first];
        matrix[b][b] += joint;
        matrix[b - 1][b - 1] += joint;
        matrix[b][b - 1] -= joint;
        matrix[b - 1][b] -= joint;
    }
    return n;
}

// The smallest pivot of Gauss's elimination over the largest: 0 of a singular matrix.
static double least_pivot(int n, double complex a[MOST + 1][MOST + 1])
{
    double least = HUGE_VAL, most = 0;
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = cabs(a[i][k]) > cabs(a[best][k]) ? i : best;
        }
        for (int j = 0; j < n; j++) {
            const double complex kept = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = kept;
        }
        least = fmin(least, cabs(a[k][k]));
        most = fmax(most, cabs(a[k][k]));
        for (int i = k + 1; i < n && a[k][k] != 0; i++) {
            const double complex factor = a[i][k] / a[k][k];
            for (int j = k; j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return least / most;
}

static void finish_arm(linear_arm *l)
{
    linear_system_finish(&l->system);
}

// Poles of the arm in flight, which the lab has from its own equations of motion.
static int free_poles(const parameters *p, double complex *poles)
{
    SCOPED(finish_arm) linear_arm l;
    DONE(linear_arm_init(&l, p, LINEAR_FREE, &f));
    assert_in_range(l.system.states, 1, POLES);
    DONE(linear_poles(&l.system, poles, &f));
    return l.system.states;
}

TEST(poles_are_those_of_textbook_matrices)
{
    for (EACH(k, known_arms)) {
        const parameters p = parameters_with(LOOSE "%s", k->settings);
        double complex poles[POLES], matrix[MOST + 1][MOST + 1];
        int singular = 0;
        const int count = free_poles(&p, poles);
        for (int i = 0; i < count; i++) {
            const int n = dynamic_matrix(k, poles[i], matrix);
            if (cabs(poles[i]) > 1) { // but the turn as a whole
                check_below(least_pivot(n, matrix), 1e-7);
                singular++;
            }
        }
        assert_int_equal(singular, 2 * (k->links - 1 + (k->spring ? 1 : 0)));

        // another place is none
        const int n = dynamic_matrix(k, poles[count - 1] * 1.01 + 1, matrix);
        assert_true(least_pivot(n, matrix) > 1e-5);
    }
}

// Two links on a free hub: the bend decays as exp(-c t/(2 J)), J being what the joint
// turns, and both engines follow it.
TEST(a_joint_decays_by_its_damping_over_twice_its_inertia)
{
    const double c = 0.02, k = 4.92, l = 0.5, m = 0.20054, own = 0.002, hub = 0.004;
    const double m11 = hub + own + m * l * l / 4 + m * l * l, m12 = m * l * l / 2;
    const double m22 = own + m * l * l / 4;
    const double J = (m11 * m22 - m12 * m12) / (m11 + 2 * m12 + m22);
    const parameters p =
        parameters_with(LOOSE "arm.link_inertias=%g,%g arm.joint_damping=%g", own, own,
                        c);
    double complex poles[POLES];
    const int count = free_poles(&p, poles);
    int found = 0;
    for (int i = 0; i < count; i++) {
        if (cimag(poles[i]) > 1) {
            check_relative(creal(poles[i]), -c / (2 * J), 1e-8);
            check_relative(cabs(poles[i]), sqrt(k / J), 1e-8);
            found++;
        }
    }
    assert_int_equal(found, 1);

    // a whole run into the wall, by either engine
    for (int i = 0; i < 2; i++) {
        const char *both = "arm.link_inertias=0.002,0.002 arm.joint_damping=0.02";
        KEPT_RUN(pair) = run_arm(parameters_with("%s method.engine=pair", both), true);
        KEPT_RUN(stiff) = run_arm(parameters_with("%s method.engine=stiff", both), true);
        check_relative(stiff.summary.contact_impulse_Ns, pair.summary.contact_impulse_Ns,
                       1e-6);
        check_relative(stiff.summary.first_contact_s, pair.summary.first_contact_s, 1e-8);
    }
}

// One link that hangs: w^2 = m g (l/2)/(I_hub + own + m l^2/4).
TEST(a_compound_pendulum_swings_by_its_inertia)
{
    const double l = 0.8, m = 0.5, own = 0.01;
    const double w = sqrt(m * 9.80665 * l / 2 / (0.004 + own + m * l * l / 4));
    const double quarter = M_PI / 2 / w, start = 1e-4;
    KEPT_RUN(r) =
        run_arm(parameters_with(LOOSE "arm.links=1 arm.length=%g arm.link_masses=%g "
                                      "arm.link_inertias=%g arm.tilt=%.17g "
                                      "initial.angle=%.17g run.duration=%.17g",
                                l, m, own, M_PI / 2, -M_PI / 2 + start, 2 * quarter),
                true);
    const sample *last = &r.trace.rows[r.trace.row_count - 1];
    check_close(last->hub_angle, -M_PI / 2 - start, 1e-3 * start);
}

// --- the same arm said otherwise -------------------------------------------------------

static void check_same(const char *one, const char *other, double tolerance)
{
    KEPT_RUN(a) = run_arm(parameters_with("%s", one), false);
    KEPT_RUN(b) = run_arm(parameters_with("%s", other), false);
    assert_true(a.summary.contact_impulse_Ns > 0);
    check_relative(b.summary.first_contact_s, a.summary.first_contact_s, tolerance);
    check_relative(b.summary.contact_impulse_Ns, a.summary.contact_impulse_Ns, tolerance);
    check_below(fabs(b.summary.energy_residual_J), 1e-9);
}

TEST(what_is_the_same_arm_runs_alike)
{
    check_same("arm.link_inertia=0.003", "arm.link_inertias=0.003,0.003", 0);
    check_same("arm.mass=0.4", "arm.link_masses=0.2,0.2", 1e-12);
    check_same(
        "arm.links=5 arm.hub_joint=beam arm.joint_damping=0.01",
        "arm.links=5 arm.hub_joint=beam arm.joint_damping=0.01,0.01,0.01,0.01,0.01",
        1e-9);
    check_same("arm.links=4 arm.link_lengths=0.2,0.3,0.2,0.3 arm.mass=0.5",
               "arm.links=4 arm.link_lengths=0.2,0.3,0.2,0.3 "
               "arm.link_masses=0.1,0.15,0.1,0.15",
               1e-9);

    // damping by a ratio is damping of each joint in proportion to its stiffness
    const arm a =
        arm_with(given("arm.links=6 arm.hub_joint=beam arm.damping_ratio=0.02"));
    const char *const listed = formatted(
        "arm.links=6 arm.hub_joint=beam arm.joint_damping=%.17g,%.17g,%.17g,%.17g,%.17g,"
        "%.17g",
        a.hub_joint_damping, a.joint_damping, a.joint_damping, a.joint_damping,
        a.joint_damping, a.joint_damping);
    check_same("arm.links=6 arm.hub_joint=beam arm.damping_ratio=0.02", listed, 1e-8);
}

// --- long lists ------------------------------------------------------------------------

// "first,value,value..." of so many numbers.
static const char *list_of(int count, const char *first, const char *value)
{
    static char text[2 * PARAMETER_VALUE_SIZE];
    snprintf(text, sizeof text, "%s", first);
    for (int k = 1; k < count; k++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, ",%s", value);
    }
    return text;
}

TEST(an_uneven_arm_may_have_as_many_links_as_a_list_has_numbers)
{
    const int n = PARAMETER_LIST_MOST;
    const parameters even =
        parameters_with("arm.links=%d arm.length=1.28 arm.hub_joint=beam", n);
    const parameters listed =
        parameters_with("arm.links=%d arm.hub_joint=beam arm.link_lengths=%s", n,
                        list_of(n, "0.01000001", "0.01"));
    arm one = arm_of(&even), other = arm_of(&listed);
    assert_true(other.uneven);
    const arm_modes by_links = modes_of(&one, HUB_LOCKED, TIP_FREE);
    const arm_modes by_list = modes_of(&other, HUB_LOCKED, TIP_FREE);
    for (int i = 0; i < 10; i++) {
        check_relative(by_list.w[i], by_links.w[i], 1e-6);
    }

    // and a run of one that is longer than lists once were
    KEPT_RUN(r) =
        run_arm(parameters_with("arm.links=40 arm.hub_joint=beam run.duration=0.4 "
                                "arm.link_lengths=%s arm.joint_damping=0.001",
                                list_of(40, "0.015", "0.025")),
                true);
    assert_true(r.summary.contact_impulse_Ns > 0);
    check_below(fabs(r.summary.energy_residual_J), 1e-9);
}

// --- what is refused -------------------------------------------------------------------

TEST(contradictions_are_refused_with_what_was_expected)
{
    const struct {
        const char *settings, *path, *expected;
    } cases[] = {
        {"arm.links=3 arm.link_masses=1,2", "arm.link_masses",
         "has 2 numbers, expected 3: arm.links = 3 have one each"},
        {"arm.link_inertias=1", "arm.link_inertias", "has 1 number, expected 2"},
        {"arm.links=3 arm.joint_damping=1,2,3", "arm.joint_damping",
         "expected 2: arm.links = 3 have a joint between each two"},
        {"arm.hub_joint=spring arm.links=3 arm.joint_damping=1,2", "arm.joint_damping",
         "expected 3: arm.links = 3 have a joint before each (arm.hub_joint = spring)"},
        {"arm.link_masses=1,2 arm.mass=3", "arm.link_masses", "expected one of them"},
        {"arm.link_inertias=0,0 arm.link_inertia=0", "arm.link_inertias",
         "expected one of them"},
        {"arm.link_masses=1,2 arm.link_inertia=0", "arm.link_inertia",
         "is for two equal links"},
        {"arm.joint_damping=0.1 arm.damping_ratio=0.1", "arm.joint_damping",
         "expected one of them"},
        {"arm.joint_damping=0.1 arm.modal_ratios=0.1", "arm.joint_damping",
         "expected one of them"},
        {"arm.length=1 arm.mass=0.4 arm.link_inertias=0.001,0.0126", "arm.link_inertias",
         "gives link 2 0.0126 kg m2, expected at most m l^2/4 = 0.0125 kg m2"},
        {"arm.joint_damping=0.1 method.name=newmark", "arm.joint_damping",
         "method.name = event only"},
    };
    for (EACH(c, cases)) {
        parameters p = unresolved_parameters(given("%s", c->settings));
        fault f = {.text = ""};
        status code = parameters_resolve(&p, &f);
        if (code == STATUS_OK) {
            code = features_check(&p, &f);
        }
        fail_if(code != STATUS_BAD_SCENARIO || strstr(f.text, c->expected) == NULL,
                "%s: '%s'", c->settings, f.text);
        assert_string_equal(f.path, c->path);
    }

    // the inertia of two halves at the ends is the most there is
    parameters_with("arm.length=1 arm.mass=0.4 arm.link_inertias=0,0.0125");
}
