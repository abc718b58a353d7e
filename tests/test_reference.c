// The library against an independent simulation of the same arm (tests/reference).
//
//   test_reference          compare
//   test_reference --print  print the reference's answers

#include "tests/arm_fixture.h"
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
    {"beam root, plane, N = 3, 1 V", 3, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK,
     true},
    {"beam root, plane, N = 5, 1 V", 5, false, true, 1, 0, 1, TOLERANCE, RIGID_LOOK,
     true},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static reference_answer simulate(const reference_case *c)
{
    reference_answer answer;
    char message[256];
    fail_if(!reference_simulate(c, &answer, message, sizeof message),
            "the reference failed: %s", message);
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

// The library's answer to the same case by a method and its step.
static summary library_of(const reference_case *c, const char *method, double step)
{
    const scenario s = {
        .name = (char *)c->name,
        .parameters = parameters_with(
            "arm.links=%d arm.hub_joint=%s wall.kind=%s wall.restitution=%.17g "
            "motor.voltage=%.17g run.duration=%.17g method.name=%s method.step=%.17g",
            c->links,
            c->beam_root    ? "beam"
            : c->spring_hub ? "spring"
                            : "rigid",
            c->plane_wall ? "plane" : "point", c->restitution, c->voltage, c->duration,
            method, step)};
    KEPT_RUN(result);
    run_scenario(&s, false, &result);
    fail_if(result.summary.status != STATUS_OK, "%s: %s", c->name,
            result.summary.message);
    return result.summary;
}

// What is told of a case: by the reference, and by the library, which may be off by
// `most` or by this share of it; HUGE_VAL where it is not asked.
typedef struct row {
    const char *label;
    double reference, library, most, share;
} row;

enum { ROWS = 24 };

// The tolerances are what a reader of a result may rely on; the two programs agree far
// better.
static void list_rows(const reference_answer *r, const summary *l, row rows[static ROWS])
{
    const row all[ROWS] = {
        {"first_contact_s", r->first_contact, l->first_contact_s, 1e-6, 0},
        {"first_approach_m_s", r->first_approach, 0, HUGE_VAL, 0},
        {"contact_impulse_Ns", r->first_impulse, l->contact_impulse_Ns, 0, 1e-4},
        {"first_pulse_peak_N", r->first_pulse_peak, l->first_pulse_peak_N, 0, 1e-4},
        {"first_pulse_time_to_peak_s", r->first_pulse_delay,
         l->first_pulse_time_to_peak_s, 1e-4},
        {"first_pulse_s", r->first_pulse, l->first_pulse_s, 1e-4, 0},
        {"peak_force_N", r->peak, l->peak_force_N, 0, 1e-4},
        {"time_to_peak_s", r->peak_delay, l->time_to_peak_s, 1e-4, 0},
        {"steady_force_N", r->steady_force, l->steady_force_N, 0, 1e-4},
        {"impacts", r->impacts, l->impacts, 0, 0},
        {"touches", r->touches, 0, HUGE_VAL, 0},
        {"separations", r->separations, l->separations, 0, 0},
        {"smallest_separation_m", r->smallest_separation, 0, HUGE_VAL, 0},
        {"largest_touch_m", r->largest_touch, 0, HUGE_VAL, 0},
        {"slowest_approach_m_s", r->slowest_approach, 0, HUGE_VAL, 0},
        {"last_impact_s", r->last_impact, 0, HUGE_VAL, 0},
        {"weakest_hold_N", r->weakest_hold, 0, HUGE_VAL, 0},
        {"final_hub_angle_rad", r->final_hub_angle, 0, HUGE_VAL, 0},
        {"motor_work_J", r->motor_work, l->motor_work_J, 0, 1e-4},
        {"viscous_loss_J", r->viscous_loss, 0, HUGE_VAL, 0},
        {"friction_loss_J", r->friction_loss, 0, HUGE_VAL, 0},
        {"impact_loss_J", r->impact_loss, 0, HUGE_VAL, 0},
        {"energy_residual_J", r->energy_residual, l->energy_residual_J, 1e-9, 0},
        {"largest_gap_error_m", r->largest_gap_error, l->max_penetration_m, 1e-9, 0},
    };
    memcpy(rows, all, sizeof all);
}

static void library_agrees(void **state)
{
    const reference_case *c = *state;
    const reference_answer r = reference_of(c);
    const summary l = library_of(c, "event", 1e-3);
    row rows[ROWS];
    list_rows(&r, &l, rows);
    bool same = true;
    printf("%s: reference, library, difference\n", c->name);
    for (EACH(w, rows)) {
        const double off = w->library - w->reference;
        const bool close = isnan(w->reference)
                               ? isnan(w->library)
                               : fabs(off) <= w->most + w->share * fabs(w->reference);
        if (w->most < HUGE_VAL) {
            printf("    %-26s %-18.12g %-18.12g %9.2g%s\n", w->label, w->reference,
                   w->library, off, close ? "" : "  <-- too far");
            same &= close;
        }
    }
    assert_true(same);
}

// Newmark (gamma = 1/2) and generalised-alpha approach the reference with the square of
// the step.
static void implicit_methods_converge(void **state)
{
    (void)state;
    reference_answer r = reference_of(&cases[0]);
    for (EACH_TEXT(c, "newmark", "generalized-alpha")) {
        summary coarse = library_of(&cases[0], *c, 1e-3);
        summary fine = library_of(&cases[0], *c, 1e-4);
        double errors[3][2] = {
            {coarse.first_contact_s - r.first_contact,
             fine.first_contact_s - r.first_contact},
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

// --- the reference itself

static void reference_conserves_energy(void **state)
{
    const reference_case *c = *state;
    reference_answer r = reference_of(c);
    check_below(r.energy_residual, 1e-12 * (1.0 + r.motor_work));
    check_below(r.largest_gap_error, 1e-14);
    assert_true(r.impact_loss > 0.0);
}

// Half the distance of the looks and a fifth of the tolerance change nothing that is
// compared.
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
        const reference_answer answer = simulate(&cases[k]);
        row rows[ROWS];
        list_rows(&answer, &(summary){0}, rows);
        printf("%s\n", cases[k].name);
        for (EACH(w, rows)) {
            printf("    %-28s %.15g\n", w->label, w->reference);
        }
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--print") == 0) {
        return print_all();
    }
    struct CMUnitTest tests[1 + 3 * CASES] = {
        cmocka_unit_test(implicit_methods_converge)};
    for (int i = 0; i < CASES; i++) {
        struct CMUnitTest *t = &tests[1 + 3 * i];
        const char *name = cases[i].name;
        t[0] =
            (struct CMUnitTest){name, reference_conserves_energy, NULL, NULL, &cases[i]};
        t[1] = (struct CMUnitTest){name, reference_is_converged, NULL, NULL, &cases[i]};
        t[2] = (struct CMUnitTest){name, library_agrees, NULL, NULL, &cases[i]};
    }
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
