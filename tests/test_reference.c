// The library against an independent simulation of the same arm (tests/reference).
//
//   test_reference          compare
//   test_reference --print  print the reference's answers and how well they are converged
#include <stdlib.h>
#include <string.h>

#include "src/lab/run.h"
#include "tests/check.h"
#include "tests/reference/reference_arm.h"

enum comparison {
    FIRST_CONTACT,   // and impulse of the first impact
    FIRST_PULSE = 1, // and peak, its delay and the length of the first pulse
    WHOLE_RUN = 2,   // and impacts, separations, steady force and largest force
};

typedef struct comparison_case {
    reference_case reference;
    enum comparison depth;
} comparison_case;

#define RIGID_LOOK  1e-4
#define SPRING_LOOK 2e-5
#define TOLERANCE   1e-12

static comparison_case cases[] = {
    {{"rigid hub, point, N = 2, 1 V", 2, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, point, N = 2, 5 V", 2, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 2, 1 V", 2, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 2, 5 V", 2, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, point, N = 3, 1 V", 3, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, point, N = 3, 5 V", 3, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 3, 1 V", 3, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 3, 5 V", 3, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, point, N = 5, 1 V", 5, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, point, N = 5, 5 V", 5, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 5, 1 V", 5, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"rigid hub, plane, N = 5, 5 V", 5, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"e = 0.5, point, N = 2, 1 V", 2, false, false, 1, 0.5, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"e = 0.5, point, N = 3, 5 V", 3, false, false, 5, 0.5, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"e = 0.5, plane, N = 2, 5 V", 2, false, true, 5, 0.5, 1, TOLERANCE, RIGID_LOOK}, WHOLE_RUN},
    {{"spring hub, plane, N = 3, 5 V", 3, true, true, 5, 0, 1, TOLERANCE, SPRING_LOOK}, WHOLE_RUN},
    {{"spring hub, point, N = 2, 1 V", 2, true, false, 1, 0, 1, TOLERANCE, SPRING_LOOK}, WHOLE_RUN},
    {{"spring hub, point, N = 2, 5 V", 2, true, false, 5, 0, 1, TOLERANCE, SPRING_LOOK}, WHOLE_RUN},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static reference_answer reference_of(const reference_case *c)
{
    reference_answer answer;
    char message[256];
    if (!reference_simulate(c, &answer, message, sizeof message)) {
        fail_msg("the reference failed: %s", message);
    }
    return answer;
}

static void set_text(parameters *p, const char *path, const char *text)
{
    fault f = {0};
    int index = parameter_find(path);
    assert_true(index >= 0);
    if (parameter_set_text(p, index, text, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
}

static void set_number(parameters *p, const char *path, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    set_text(p, path, text);
}

// The library's answer to the same case, with its default method and step.
static summary library_of(const reference_case *c)
{
    scenario s;
    fault f = {0};
    run_result result;
    memset(&s, 0, sizeof s);
    char name[64];
    snprintf(name, sizeof name, "%s", c->name);
    s.name = s.file = s.title = s.description = name;
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    set_number(&s.parameters, "arm.links", c->links);
    set_text(&s.parameters, "arm.hub_joint", c->spring_hub ? "spring" : "rigid");
    set_text(&s.parameters, "wall.kind", c->plane_wall ? "plane" : "point");
    set_number(&s.parameters, "wall.restitution", c->restitution);
    set_number(&s.parameters, "motor.voltage", c->voltage);
    set_number(&s.parameters, "run.duration", c->duration);
    if (parameters_resolve(&s.parameters, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    run_scenario(&s, false, &result);
    summary answer = result.summary;
    run_finish(&result);
    if (answer.status != STATUS_OK) {
        fail_msg("%s: %s", c->name, answer.message);
    }
    return answer;
}

// NaN on both sides agrees.
static bool agrees(const char *what, double library, double reference, double tolerance)
{
    bool same = isnan(reference) ? isnan(library) : fabs(library - reference) <= tolerance;
    printf("    %-20s %.12g  %.12g  %s %.2g%s\n", what, reference, library, "off by",
           library - reference, same ? "" : "  <-- too far");
    return same;
}

static void library_agrees(void **state)
{
    const comparison_case *c = *state;
    reference_answer r = reference_of(&c->reference);
    summary l = library_of(&c->reference);
    printf("%s (reference, library)\n", c->reference.name);
    bool same = agrees("first contact", l.first_contact_s, r.first_contact, 1e-6);
    same &= agrees("impulse", l.contact_impulse_Ns, r.first_impulse, 1e-4 * r.first_impulse);
    if (c->depth >= FIRST_PULSE) {
        same &= agrees("first pulse peak", l.first_pulse_peak_N, r.first_pulse_peak,
                       1e-4 * r.first_pulse_peak);
        same &= agrees("its delay", l.first_pulse_time_to_peak_s, r.first_pulse_delay, 1e-4);
        same &= agrees("first pulse", l.first_pulse_s, r.first_pulse, 1e-4);
    }
    if (c->depth >= WHOLE_RUN) {
        same &= agrees("largest force", l.peak_force_N, r.peak, 1e-4 * r.peak);
        same &= agrees("its delay", l.time_to_peak_s, r.peak_delay, 1e-4);
        same &= agrees("impacts", l.impacts, r.impacts, 0);
        same &= agrees("separations", l.separations, r.separations, 0);
        same &= agrees("steady force", l.steady_force_N, r.steady_force, 1e-4 * r.steady_force);
        same &= agrees("motor work", l.motor_work_J, r.motor_work, 1e-6 * r.motor_work);
        same &= agrees("impact loss", l.energy_residual_J, 0, 1);
    }
    assert_true(same);
}

// ---------------------------------------------------------------------------------------------
// the reference itself

static void equations_are_lagranges(void **state)
{
    (void)state;
    for (int links = 1; links <= 6; links++) {
        for (int kind = 0; kind < 4; kind++) {
            reference_case c = {.name = "random state",
                                .links = links,
                                .spring_hub = kind & 1,
                                .plane_wall = kind & 2,
                                .voltage = 1};
            for (unsigned seed = 1; seed <= 10; seed++) {
                check_below(reference_lagrangian_defect(&c, seed), 1e-8);
            }
        }
    }
}

static void reference_conserves_energy(void **state)
{
    const comparison_case *c = *state;
    reference_answer r = reference_of(&c->reference);
    check_below(r.energy_residual, 1e-12 * (1.0 + r.motor_work));
    check_below(r.largest_gap_error, 1e-14);
    assert_true(r.impact_loss > 0.0);
}

// Half the distance of looks and a fifth of the tolerance change nothing that is compared.
static void reference_is_converged(void **state)
{
    const comparison_case *c = *state;
    reference_case finer = c->reference;
    finer.longest_step *= 0.5;
    finer.tolerance *= 0.2;
    reference_answer a = reference_of(&c->reference), b = reference_of(&finer);
    check_close(a.first_contact, b.first_contact, 1e-11);
    check_relative(a.first_impulse, b.first_impulse, 1e-9);
    if (!isnan(b.first_pulse_peak)) {
        check_relative(a.first_pulse_peak, b.first_pulse_peak, 1e-9);
        check_close(a.first_pulse_delay, b.first_pulse_delay, 1e-7);
    }
    check_relative(a.peak, b.peak, 1e-9);
    check_relative(a.steady_force, b.steady_force, 1e-8);
    assert_int_equal(a.impacts, b.impacts);
    assert_int_equal(a.separations, b.separations);
}

static int print_all(void)
{
    for (int i = 0; i < CASES; i++) {
        reference_answer answer;
        char message[256];
        if (!reference_simulate(&cases[i].reference, &answer, message, sizeof message)) {
            fprintf(stderr, "%s\n", message);
            return 1;
        }
        reference_print(&cases[i].reference, &answer);
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--print") == 0) {
        return print_all();
    }
    struct CMUnitTest tests[1 + 3 * CASES] = {cmocka_unit_test(equations_are_lagranges)};
    for (int i = 0; i < CASES; i++) {
        struct CMUnitTest *t = &tests[1 + 3 * i];
        const char *name = cases[i].reference.name;
        t[0] = (struct CMUnitTest){name, reference_conserves_energy, NULL, NULL, &cases[i]};
        t[1] = (struct CMUnitTest){name, reference_is_converged, NULL, NULL, &cases[i]};
        t[2] = (struct CMUnitTest){name, library_agrees, NULL, NULL, &cases[i]};
    }
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
