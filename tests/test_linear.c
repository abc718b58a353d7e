// The linear arm: its poles and zeros against closed forms and the modes, and the MAT
// file.
#include "src/study/linear/linear.h"

#include "src/arm/modes.h"
#include "src/exchange/mat_file.h"
#include "tests/shipped_scenario.h"

enum { MOST = 200 };

static void finish_arm(linear_arm *l)
{
    linear_system_finish(&l->system);
}

#define LINEARISED(l, ...) SCOPED(finish_arm) linear_arm l = linearised(__VA_ARGS__)

static linear_arm linearised(const char *name, const char *changes, linear_place place)
{
    KEPT_SCENARIO(s) = shipped_with(name, changes);
    linear_arm l;
    DONE(linear_arm_init(&l, &s.parameters, place, &f));
    return l;
}

static void poles_of(const linear_arm *l, double complex *poles)
{
    assert_true(l->system.states <= MOST);
    DONE(linear_poles(&l->system, poles, &f));
}

#define ROUND "corrected/first-impact"

// The straight two-link arm: in contact M x'' + D x' + 4 k2 x = K u; in flight the hub's
// and the bend's cubic; and with the force as input or output the zeros +-(4
// k2/mu)^(1/2).
TEST(two_links_have_their_closed_forms)
{
    double complex poles[MOST], zeros[MOST];
    int count;
    const double m = 0.40108 / 2, half = 0.5, own = m * half * half / 12, k2 = 4.92;
    const double K = 6.02 * 0.249092 * 9.80665 / 33.6;
    const double D = 5.4192e-3 + 0.249092 * 9.80665 * 2.443 / 33.6;
    const double M = 5.2e-3 + 2 * own + m * half * half / 2,
                 mu = (m * half * half / 4 - own) / half;

    // pressed without force
    LINEARISED(l, ROUND, "motor.voltage=0", LINEAR_CONTACT);
    poles_of(&l, poles);
    check_relative(creal(poles[0]), -D / (2 * M), 1e-9);
    check_relative(cimag(poles[0]), sqrt(4 * k2 / M - D * D / (4 * M * M)), 1e-9);
    check_relative(l.system.b[1], K / M, 1e-9);
    DONE(linear_zeros(&l.system, LINEAR_FORCE, &count, zeros, &f));
    assert_int_equal(count, 2);
    check_relative(creal(zeros[0]), -sqrt(4 * k2 / mu), 1e-9);
    check_relative(creal(zeros[1]), sqrt(4 * k2 / mu), 1e-9);

    // in flight: det(M s^2 + C s + K)/s vanishes at every pole but the one at rest
    LINEARISED(free, ROUND, "", LINEAR_FREE);
    poles_of(&free, poles);
    const double M11 = 5.2e-3 + own + m * half * half * 1.25,
                 M22 = own + m * half * half / 4, M12 = m * half * half / 2;
    check_close(cabs(poles[0]), 0, 1e-9);
    for (int i = 1; i < 4; i++) {
        const double complex s = poles[i];
        const double complex a = M11 * s * s + D * s + k2, b = M22 * s * s + k2;
        const double complex c = M12 * s * s - k2;
        check_close(cabs(a * b - c * c) / cabs(a * b), 0, 1e-9);
    }
}

// Where the motor cannot move the hub are the frequencies of the arm with its hub locked.
TEST(zeros_to_the_hub_are_frequencies_of_the_held_arm)
{
    static const char *const joints[] = {"rigid", "spring arm.k1=90", "beam"};
    for (int i = 0; i < 6; i++) {
        const linear_place place = i % 2 == 0 ? LINEAR_FREE : LINEAR_CONTACT;
        const char *changes =
            formatted("arm.links=6 motor.voltage=0 arm.hub_joint=%s", joints[i / 2]);
        KEPT_SCENARIO(s) = shipped_with(ROUND, changes);
        LINEARISED(with, ROUND, changes, place);
        double complex zeros[MOST];
        double frequencies[MOST], shapes[MOST];
        arm a;
        int modes, count;
        arm_init(&a, &s.parameters);
        assert_int_equal(modes_compute(&a, HUB_LOCKED,
                                       place == LINEAR_FREE ? TIP_FREE : TIP_PINNED,
                                       &modes, frequencies, shapes),
                         STATUS_OK);
        DONE(linear_zeros(&with.system, LINEAR_HUB_ANGLE, &count, zeros, &f));
        assert_int_equal(count, 2 * modes);
        for (int k = 0; k < modes; k++) {
            check_relative(cimag(zeros[2 * k]), frequencies[k], 1e-9);
            check_close(creal(zeros[2 * k]), 0, 1e-8 * frequencies[k]);
        }
    }
}

// The arm rests where it is said to: the force is the torque over the lever, and a wall
// that gives is as deep as its law says.
TEST(the_arm_rests_under_its_force)
{
    const double K = 6.02 * 0.249092 * 9.80665 / 33.6;
    LINEARISED(l, ROUND, "motor.voltage=1e-3", LINEAR_CONTACT);
    check_relative(l.force, K * 1e-3, 1e-6);

    // its weight presses more than the motor pulls
    LINEARISED(low, ROUND, "motor.voltage=-0.5 arm.tilt=-0.2", LINEAR_CONTACT);
    check_close(low.force, 9.80665 * sin(0.2) * 0.40108 / 2 * cos(0.1) - K * 0.5, 1e-3);

    // which a wall that stiffens with its depth does not change, be it soft or hard
    static const char *const weights[] = {"", " control.force=2"};
    for (int i = 0; i < 4; i++) {
        const char *changes =
            formatted("wall.contact=hunt-crossley wall.stiffness=%s arm.tilt=-1.5%s",
                      i % 2 == 0 ? "1e4" : "1e8", weights[i / 2]);
        LINEARISED(gives, i / 2 == 0 ? ROUND : "compare/hybrid", changes, LINEAR_CONTACT);
        check_close(gives.force,
                    i / 2 == 0 ? 9.80665 * sin(1.5) * 0.40108 / 2 * cos(0.1) + K : 2,
                    i / 2 == 0 ? 0.03 : 1e-9);
    }

    for (EACH_TEXT(c, "kelvin-voigt wall.stiffness=1e4",
                   "hunt-crossley wall.stiffness=1e6")) {
        LINEARISED(gives, "compare/hybrid",
                   formatted("wall.contact=%s wall.damping=5 control.force=2", *c),
                   LINEAR_CONTACT);
        double complex poles[MOST];
        poles_of(&gives, poles);
        check_close(gives.force, 2, 1e-9);
        assert_int_equal(gives.system.states, 4);
        for (int k = 0; k < 4; k++) {
            check_below(creal(poles[k]), 0);
        }
    }
}

// A pole that friction alone holds still is not in the arm with its hub held, and what
// cannot be linearised is said.
TEST(what_has_no_linear_form_is_refused)
{
    static const struct {
        const char *changes, *says;
        linear_place place;
    } cases[] = {
        {"wall.kind=none", "no wall", LINEAR_CONTACT},
        {"motor.voltage=-1", "does not press", LINEAR_CONTACT},
        {"arm.model=printed", "printed", LINEAR_FREE},
        {"arm.links=65", "64 links", LINEAR_FREE},
        {"wall.contact=hunt-crossley wall.stiffness=1e6 motor.voltage=0", "Hunt",
         LINEAR_STUCK},
        {"wall.contact=hunt-crossley arm.tilt=0.3", "does not press", LINEAR_STUCK},
        {"wall.contact=hunt-crossley arm.tilt=1.5", "does not press", LINEAR_CONTACT},
        {"wall.motion=sine", "moves", LINEAR_CONTACT},
    };
    for (EACH(c, cases)) {
        KEPT_SCENARIO(s) = shipped_with(ROUND, c->changes);
        linear_arm l;
        REFUSED(STATUS_BAD_ARGUMENT, c->says,
                linear_arm_init(&l, &s.parameters, c->place, &f));
    }
    LINEARISED(stuck, ROUND, "", LINEAR_STUCK);
    assert_int_equal(stuck.system.states, 0);
}

// A word of a file in this machine's order of bytes.
static uint32_t word(const unsigned char *at)
{
    uint32_t value;
    memcpy(&value, at, sizeof value);
    return value;
}

// Names of every length: the reader walks from element to element by their sizes alone.
TEST(mat_files_are_read_element_by_element)
{
    const double values[6] = {1, 2, 3, 4, 5, 6};
    const double complex roots[2] = {complex_of(1, 2), complex_of(3, -4)};
    KEPT_TEXT(bytes) = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&bytes, &size);
    mat_file_begin(stream);
    mat_file_matrix(stream, "A", 2, 3, values);
    mat_file_matrix(stream, "eightlet", 3, 2, values);
    mat_file_complex(stream, "ninelette", 2, roots);
    mat_file_matrix(stream, "none", 0, 3, values);
    assert_int_equal(fclose(stream), 0);

    const unsigned char *at = (unsigned char *)bytes + 128,
                        *end = (unsigned char *)bytes + size;
    assert_memory_equal(bytes, "MATLAB 5.0 MAT-file", 19);
    for (int i = 0; i < 4; i++) {
        static const char *const names[] = {"A", "eightlet", "ninelette", "none"};
        static const int rows[] = {2, 3, 2, 0}, columns[] = {3, 2, 1, 3};
        static const double second[] = {4, 3, 3, 0}; // down the first column
        const unsigned char *next = at + 8 + word(at + 4), *name = at + 40;
        assert_int_equal(word(at), 14);
        assert_int_equal(word(at + 32), rows[i]);
        assert_int_equal(word(at + 36), columns[i]);
        assert_int_equal(word(name + 4), strlen(names[i]));
        assert_memory_equal(name + 8, names[i], strlen(names[i]));
        const unsigned char *data = name + 8 + (strlen(names[i]) + 7) / 8 * 8;
        assert_int_equal(word(data), 9);
        assert_int_equal(word(data + 4), 8 * rows[i] * columns[i]);
        if (rows[i] > 0) {
            double number;
            memcpy(&number, data + 16, sizeof number);
            check_close(number, second[i], 0);
        }
        if (i == 2) {
            double imaginary;
            memcpy(&imaginary, data + 8 + 16 + 8 + 8, sizeof imaginary);
            check_close(imaginary, -4, 0);
        }
        at = next;
    }
    assert_ptr_equal(at, end);
}
