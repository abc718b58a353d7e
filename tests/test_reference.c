// The library against an independent simulation of the same arm (tests/reference).
//
//   test_reference          compare
//   test_reference --print  print the reference's answers

#include "src/run/run.h"
#include "tests/check.h"
#include "tests/reference/reference_arm.h"

#define RIGID_LOOK  1e-4
#define SPRING_LOOK 2e-5
#define TOLERANCE   1e-12

static reference_case cases[] = {
    {"rigid hub, point, N = 2, 1 V", 2, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, point, N = 2, 5 V", 2, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 2, 1 V", 2, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 2, 5 V", 2, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, point, N = 3, 1 V", 3, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, point, N = 3, 5 V", 3, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 3, 1 V", 3, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 3, 5 V", 3, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, point, N = 5, 1 V", 5, false, false, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, point, N = 5, 5 V", 5, false, false, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 5, 1 V", 5, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK},
    {"rigid hub, plane, N = 5, 5 V", 5, false, true, 5, 0, 1, TOLERANCE, RIGID_LOOK},
    {"e = 0.5, point, N = 2, 1 V", 2, false, false, 1, 0.5, 1, TOLERANCE, RIGID_LOOK},
    {"e = 0.5, point, N = 3, 5 V", 3, false, false, 5, 0.5, 1, TOLERANCE, RIGID_LOOK},
    {"e = 0.5, plane, N = 2, 5 V", 2, false, true, 5, 0.5, 1, TOLERANCE, RIGID_LOOK},
    {"spring hub, plane, N = 3, 5 V", 3, true, true, 5, 0, 1, TOLERANCE, SPRING_LOOK},
    {"spring hub, point, N = 2, 1 V", 2, true, false, 1, 0, 1, TOLERANCE, SPRING_LOOK},
    {"spring hub, point, N = 2, 5 V", 2, true, false, 5, 0, 1, TOLERANCE, SPRING_LOOK},
    {"beam root, plane, N = 3, 1 V", 3, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK, true},
    {"beam root, plane, N = 5, 1 V", 5, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK, true},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static reference_answer simulate(const reference_case *c)
{
    reference_answer answer;
    char message[256];
    fail_if(!reference_simulate(c, &answer, message, sizeof message), "the reference failed: %s",
            message);
    return answer;
}

// The answer to one of the cases, simulated only once.
static reference_answer reference_of(const reference_case *c)
{
    static reference_answer answers[CASES];
    static bool known[CASES];
    size_t i = (size_t)(c - cases);
    if (!known[i]) {
        answers[i] = simulate(c);
        known[i] = true;
    }
    return answers[i];
}

static void set_text(parameters *p, const char *path, const char *text)
{
    int index = parameter_find(path);
    assert_true(index >= 0);
    DONE(parameter_set_text(p, index, text, &f));
}

static void set_number(parameters *p, const char *path, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    set_text(p, path, text);
}

// The library's answer to the same case; method NULL: its default method and step.
static summary library_of(const reference_case *c, const char *method, double step)
{
    scenario s;
    run_result result;
    memset(&s, 0, sizeof s);
    char name[64];
    snprintf(name, sizeof name, "%s", c->name);
    s.name = s.file = s.title = s.description = name;
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    set_number(&s.parameters, "arm.links", c->links);
    set_text(&s.parameters, "arm.hub_joint",
             c->beam_root    ? "beam"
             : c->spring_hub ? "spring"
                             : "rigid");
    set_text(&s.parameters, "wall.kind", c->plane_wall ? "plane" : "point");
    set_number(&s.parameters, "wall.restitution", c->restitution);
    set_number(&s.parameters, "motor.voltage", c->voltage);
    set_number(&s.parameters, "run.duration", c->duration);
    if (method) {
        set_text(&s.parameters, "method.name", method);
        set_number(&s.parameters, "method.step", step);
    }
    DONE(parameters_resolve(&s.parameters, &f));
    run_scenario(&s, false, &result);
    summary answer = result.summary;
    run_finish(&result);
    fail_if(answer.status != STATUS_OK, "%s: %s", c->name, answer.message);
    return answer;
}

// Prints both and says whether they agree; NaN on both sides does.
static bool agrees(const char *what, double library, double reference, double tolerance)
{
    bool same = isnan(reference) ? isnan(library) : fabs(library - reference) <= tolerance;
    printf("    %-18s %-18.12g %-18.12g %9.2g%s\n", what, reference, library, library - reference,
           same ? "" : "  <-- too far");
    return same;
}

static bool agrees_relatively(const char *what, double library, double reference, double tolerance)
{
    return agrees(what, library, reference, tolerance * fabs(reference));
}

// The tolerances are what a reader of a result may rely on; the two programs agree far better.
static void library_agrees(void **state)
{
    const reference_case *c = *state;
    reference_answer r = reference_of(c);
    summary l = library_of(c, NULL, 0);
    printf("%s: reference, library, difference\n", c->name);
    bool same = agrees("first contact", l.first_contact_s, r.first_contact, 1e-6);
    same &= agrees_relatively("impulse", l.contact_impulse_Ns, r.first_impulse, 1e-4);
    same &= agrees_relatively("first pulse peak", l.first_pulse_peak_N, r.first_pulse_peak, 1e-4);
    same &= agrees("its delay", l.first_pulse_time_to_peak_s, r.first_pulse_delay, 1e-4);
    same &= agrees("first pulse", l.first_pulse_s, r.first_pulse, 1e-4);
    same &= agrees_relatively("largest force", l.peak_force_N, r.peak, 1e-4);
    same &= agrees("its delay", l.time_to_peak_s, r.peak_delay, 1e-4);
    same &= agrees("impacts", l.impacts, r.impacts, 0);
    same &= agrees("separations", l.separations, r.separations, 0);
    same &= agrees_relatively("steady force", l.steady_force_N, r.steady_force, 1e-4);
    same &= agrees_relatively("motor work", l.motor_work_J, r.motor_work, 1e-4);
    same &= agrees("energy residual", l.energy_residual_J, 0, 1e-9);
    same &= agrees("penetration", l.max_penetration_m, 0, 1e-9);
    assert_true(same);
}

// Newmark (gamma = 1/2) and generalised-alpha approach the reference with the square of the step.
static void implicit_methods_converge(void **state)
{
    (void)state;
    reference_answer r = reference_of(&cases[0]);
    for (EACH_TEXT(c, "newmark", "generalized-alpha")) {
        summary coarse = library_of(&cases[0], *c, 1e-3);
        summary fine = library_of(&cases[0], *c, 1e-4);
        double errors[3][2] = {
            {coarse.first_contact_s - r.first_contact, fine.first_contact_s - r.first_contact},
            {coarse.contact_impulse_Ns - r.first_impulse,
             fine.contact_impulse_Ns - r.first_impulse},
            {coarse.first_pulse_s - r.first_pulse, fine.first_pulse_s - r.first_pulse},
        };
        for (int k = 0; k < 3; k++) {
            check_close(log10(fabs(errors[k][0] / errors[k][1])), 2, 0.1);
        }
        check_relative(fine.first_pulse_peak_N, r.first_pulse_peak, 1e-5);
        check_close(fine.first_pulse_time_to_peak_s, r.first_pulse_delay, 1e-4);
        check_relative(fine.steady_force_N, r.steady_force, 1e-5);
        check_close(fine.impacts, r.impacts, 0);
        check_close(fine.separations, r.separations, 0);
    }
}

// ---------------------------------------------------------------------------------------------
// the reference itself

static void reference_conserves_energy(void **state)
{
    const reference_case *c = *state;
    reference_answer r = reference_of(c);
    check_below(r.energy_residual, 1e-12 * (1.0 + r.motor_work));
    check_below(r.largest_gap_error, 1e-14);
    assert_true(r.impact_loss > 0.0);
}

// Half the distance of the looks and a fifth of the tolerance change nothing that is compared.
static void reference_is_converged(void **state)
{
    const reference_case *c = *state;
    reference_case finer = *c;
    finer.longest_step *= 0.5;
    finer.tolerance *= 0.2;
    reference_answer a = reference_of(c), b = simulate(&finer);
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

// Prints the reference's answers with all digits, one quantity a line.
static int print_all(void)
{
    for (int k = 0; k < CASES; k++) {
        const reference_answer answer = simulate(&cases[k]), *a = &answer;
        printf("%s\n", cases[k].name);
        const struct {
            const char *label;
            double value;
        } lines[] = {
            {"first_contact_s", a->first_contact},
            {"first_approach_m_s", a->first_approach},
            {"contact_impulse_Ns", a->first_impulse},
            {"first_pulse_peak_N", a->first_pulse_peak},
            {"first_pulse_time_to_peak_s", a->first_pulse_delay},
            {"first_pulse_s", a->first_pulse},
            {"peak_force_N", a->peak},
            {"time_to_peak_s", a->peak_delay},
            {"steady_force_N", a->steady_force},
            {"impacts", a->impacts},
            {"touches", a->touches},
            {"separations", a->separations},
            {"smallest_separation_m", a->smallest_separation},
            {"largest_touch_m", a->largest_touch},
            {"slowest_approach_m_s", a->slowest_approach},
            {"last_impact_s", a->last_impact},
            {"weakest_hold_N", a->weakest_hold},
            {"final_hub_angle_rad", a->final_hub_angle},
            {"motor_work_J", a->motor_work},
            {"viscous_loss_J", a->viscous_loss},
            {"friction_loss_J", a->friction_loss},
            {"impact_loss_J", a->impact_loss},
            {"energy_residual_J", a->energy_residual},
            {"largest_gap_error_m", a->largest_gap_error},
        };
        for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
            printf("    %-28s %.15g\n", lines[i].label, lines[i].value);
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--print") == 0) {
        return print_all();
    }
    struct CMUnitTest tests[1 + 3 * CASES] = {cmocka_unit_test(implicit_methods_converge)};
    for (int i = 0; i < CASES; i++) {
        struct CMUnitTest *t = &tests[1 + 3 * i];
        const char *name = cases[i].name;
        t[0] = (struct CMUnitTest){name, reference_conserves_energy, NULL, NULL, &cases[i]};
        t[1] = (struct CMUnitTest){name, reference_is_converged, NULL, NULL, &cases[i]};
        t[2] = (struct CMUnitTest){name, library_agrees, NULL, NULL, &cases[i]};
    }
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
