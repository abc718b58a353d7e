#include "ui/commands/studies/loop_analysis.h"

#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "src/base/json.h"
#include "src/base/plain_math.h"
#include "src/exchange/mat_file.h"
#include "src/study/result_rows.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/interrupts.h"
#include "ui/commands/messages.h"
#include "ui/commands/results.h"

#define TWO_PI (2 * 3.14159265358979323846)

enum { POLES, HUB_ZEROS, END_ZEROS, SETS };

// Poles, or zeros, one behind the other.
typedef struct root_set {
    const char *kind, *output;
    int count;
    double complex *values; // [1/s], sampled ones as numbers
} root_set;

typedef struct analysis {
    const scenario *scenario;
    const char *place_name;
    linear_place place;
    linear_arm arm;
    root_set sets[SETS];

    // with --law the poles are those of the closed loop, the zeros those of the loop gain
    double period; // of its samples, 0: of none [s]
    linear_system loop;
    linear_response response;
    linear_margins margins; // of a stable loop
    bool stable, measured;
    double least_push; // that loses contact [N s]
} analysis;

static void analysis_finish(analysis *x)
{
    linear_system_finish(&x->arm.system);
    linear_system_finish(&x->loop);
    free(x->response.frequency);
    for (int i = 0; i < SETS; i++) {
        g_free(x->sets[i].values);
    }
}

// --- the analysis ----------------------------------------------------------------------

// Finds the poles of a system.
static status find_poles(root_set *set, const linear_system *s, fault *f)
{
    *set = (root_set){.kind = "pole", .output = "", .count = s->states};
    set->values = g_new0(double complex, s->states + 1);
    return linear_poles(s, set->values, f);
}

// Finds the zeros to an output of a system, which the results call by `name`.
static status find_zeros(root_set *set, const linear_system *s, int output,
                         const char *name, fault *f)
{
    *set = (root_set){.kind = "zero", .output = name};
    set->values = g_new0(double complex, s->states + 1);
    return linear_zeros(s, output, &set->count, set->values, f);
}

// Whether the largest pole of a sampled system lies within the unit circle.
static bool poles_decay(const root_set *poles)
{
    return cabs(poles->values[poles->count - 1]) < 1;
}

// Zeros, closed poles and margins of a loop that is linear.
static status analyse_linear_loop(analysis *x, fault *f)
{
    const parameters *p = &x->scenario->parameters;
    x->period = 1 / p->control.rate;
    TRY(linear_respond(&x->loop, 0, x->period, &x->response, f));
    TRY(find_zeros(&x->sets[HUB_ZEROS], &x->loop, 0, "loop", f));
    linear_close(&x->loop);
    TRY(find_poles(&x->sets[POLES], &x->loop, f));
    x->stable = poles_decay(&x->sets[POLES]);
    x->margins = linear_margins_of(&x->response);
    if (x->stable) {
        return linear_delay_margin(&x->arm, p, &x->margins.delay_s, f);
    }
    return STATUS_OK;
}

// The margins of a loop that is measured by small sines, which it has to be stable for.
static status measure_loop(analysis *x, fault *f)
{
    x->measured = x->stable = true;
    TRY(linear_inject(x->scenario, &x->response, f));
    x->margins = linear_margins_of(&x->response);
    return STATUS_OK;
}

// The loop of the arm's law. In contact a law that does not answer linearly is measured.
static status analyse_loop(analysis *x, bool injects, fault *f)
{
    const parameters *p = &x->scenario->parameters;
    const bool contact = x->place == LINEAR_CONTACT;
    if (p->control.law == LAW_NONE) {
        return fault_set_at(
            f, STATUS_BAD_ARGUMENT, "control.law",
            "--law needs a control law, such as --set control.law=hybrid");
    }

    FAULT_IF(injects && !contact, f, STATUS_BAD_ARGUMENT,
             "--inject measures the arm in contact, not %s", x->place_name);

    // measured where that is asked for, or where the law is not linear
    if (injects) {
        return measure_loop(x, f);
    }

    const status code = linear_loop(&x->loop, &x->arm, p, f);
    if (code == STATUS_UNSTABLE && contact) {
        return measure_loop(x, f);
    }
    TRY(code);
    return analyse_linear_loop(x, f);
}

// Poles and zeros of the arm alone.
static status analyse_arm(analysis *x, fault *f)
{
    const linear_system *s = &x->arm.system;
    const int hub = LINEAR_HUB_ANGLE;

    // a tip on the wall has no zeros, nor a force without one
    int end = LINEAR_FORCE;
    if (x->place == LINEAR_FREE) {
        end = LINEAR_TIP;
    }
    TRY(find_poles(&x->sets[POLES], s, f));
    TRY(find_zeros(&x->sets[HUB_ZEROS], s, hub, linear_output_names[hub], f));
    return find_zeros(&x->sets[END_ZEROS], s, end, linear_output_names[end], f);
}

// Everything; STATUS_STOPPED with what needs no run after an interrupt.
static status analyse(analysis *x, const arguments *a, fault *f)
{
    TRY(linear_arm_init(&x->arm, &x->scenario->parameters, x->place, f));
    status code = STATUS_OK;
    if (x->place != LINEAR_FREE && x->scenario->parameters.control.law != LAW_NONE) {
        code = linear_contact_margin(x->scenario, &x->least_push, f);
    }
    if (code == STATUS_OK && a->looped) {
        code = analyse_loop(x, a->injects, f);
    }
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return code;
    }

    // a loop that was found linear has poles and zeros of its own
    if (x->period > 0) {
        return code;
    }
    TRY(analyse_arm(x, f));
    return code;
}

// A root as one of s; of a sampled system s = log(z)/period.
static double complex root_in_time(const analysis *x, double complex root)
{
    if (x->period > 0) {
        return complex_of(plain_log(cabs(root)), carg(root)) / x->period;
    }
    return root;
}

// --- files -----------------------------------------------------------------------------

// The matrices, and how files name them.
typedef struct matrix {
    const char *name;
    int rows, columns;
    const double *values;
} matrix;
enum { MATRICES = 4 };

static void list_matrices(const linear_system *s, matrix list[MATRICES])
{
    list[0] = (matrix){"A", s->states, s->states, s->a};
    list[1] = (matrix){"B", s->states, 1, s->b};
    list[2] = (matrix){"C", s->outputs, s->states, s->c};
    list[3] = (matrix){"D", s->outputs, 1, s->d};
}

static json_t *matrix_json(const matrix *m)
{
    json_t *rows = json_array();
    for (int i = 0; i < m->rows; i++) {
        json_add(rows, json_numbers(m->values + i * m->columns, m->columns));
    }
    return rows;
}

// A pole, or a zero with its output.
static json_t *root_json(const analysis *x, const root_set *set, double complex root)
{
    const double complex s = root_in_time(x, root);
    json_t *object = json_object();
    if (set->output[0] != '\0') {
        json_put(object, "output", json_string(set->output));
    }
    json_members(object, "real_per_s:n imaginary_rad_per_s:n damping:n", creal(s),
                 cimag(s), linear_damping(s));

    if (x->period > 0) {
        json_members(object, "z_real:n z_imaginary:n", creal(root), cimag(root));
    }
    return object;
}

static void add_roots(json_t *array, const analysis *x, const root_set *set)
{
    for (int i = 0; i < set->count; i++) {
        json_add(array, root_json(x, set, set->values[i]));
    }
}

static json_t *margins_json(const analysis *x)
{
    const linear_margins *m = &x->margins;
    if (!x->stable) {
        return json_null();
    }
    return json_of("gain_db:n gain_down_db:n phase_deg:n delay_s:n disk:n", m->gain_db,
                   m->gain_down_db, m->phase_deg, m->delay_s, m->disk);
}

// Gain and phase over frequency.
static json_t *response_json(const linear_response *r)
{
    json_t *points = json_array();
    for (int i = 0; i < r->count; i++) {
        json_add(points,
                 json_of("frequency_Hz:n gain_db:n phase_deg:n", r->frequency[i] / TWO_PI,
                         20 * plain_log(cabs(r->gain[i])) / plain_log(10),
                         carg(r->gain[i]) * 360 / TWO_PI));
    }
    return points;
}

// Everything: poles and zeros, the loop, and the matrices.
static json_t *analysis_json(const void *found)
{
    const analysis *x = found;
    json_t *poles = json_array(), *zeros = json_array();
    add_roots(poles, x, &x->sets[POLES]);
    add_roots(zeros, x, &x->sets[HUB_ZEROS]);
    add_roots(zeros, x, &x->sets[END_ZEROS]);
    json_t *object =
        json_of("scenario:t at:t force_N:n command_V:n hub_angle_rad:n "
                "contact_margin_Ns:n poles:o zeros:o",
                x->scenario->name, x->place_name, x->arm.force, x->arm.voltage,
                x->arm.hub_angle, x->least_push, poles, zeros);
    if (x->response.count > 0) {
        json_members(object, "stable:b measured:b margins:o loop:o", x->stable,
                     x->measured, margins_json(x), response_json(&x->response));
    }

    // the matrices, and the outputs that C and D belong to
    json_t *outputs = json_array();
    for (int i = 0; i < LINEAR_OUTPUTS; i++) {
        json_add(outputs, json_string(linear_output_names[i]));
    }
    json_put(object, "outputs", outputs);
    matrix list[MATRICES];
    list_matrices(&x->arm.system, list);
    for (int k = 0; k < MATRICES; k++) {
        json_put(object, list[k].name, matrix_json(&list[k]));
    }
    return object;
}

// A row for each pole and zero.
static void write_roots_csv(FILE *stream, const void *found)
{
    static const result_column columns[] = {{NULL, "kind", ""},
                                            {NULL, "output", ""},
                                            {NULL, "real", "1/s"},
                                            {NULL, "imaginary", "rad/s"},
                                            {NULL, "damping", ""}};
    const analysis *x = found;
    csv_writer w = csv_begin(stream);
    result_headings(&w, columns, sizeof columns / sizeof *columns);

    // a row for each pole and zero
    for (int k = 0; k < SETS; k++) {
        const root_set *set = &x->sets[k];
        for (int i = 0; i < set->count; i++) {
            const double complex s = root_in_time(x, set->values[i]);
            csv_text(&w, set->kind);
            csv_text(&w, set->output);
            csv_number(&w, creal(s));
            csv_number(&w, cimag(s));
            csv_number(&w, linear_damping(s));
            csv_end_row(&w);
        }
    }
}

// The matrices, poles and zeros for MATLAB or Octave.
static void write_mat(FILE *stream, const void *found)
{
    const analysis *x = found;
    matrix list[MATRICES];
    list_matrices(&x->arm.system, list);
    mat_file_begin(stream);
    for (int i = 0; i < MATRICES; i++) {
        mat_file_matrix(stream, list[i].name, list[i].rows, list[i].columns,
                        list[i].values);
    }

    // poles, zeros_hub_angle ...
    for (int k = 0; k < SETS; k++) {
        const root_set *set = &x->sets[k];
        char name[64] = "poles";
        if (k != POLES) {
            snprintf(name, sizeof name, "zeros_%s", set->output);
        }
        if (set->values != NULL) {
            mat_file_complex(stream, name, set->count, set->values);
        }
    }
}

// --- text ------------------------------------------------------------------------------

static void print_margin(const char *name, double value, const char *unit)
{
    printf(" %s ", name);
    if (isfinite(value)) {
        printf("%.3g%s", value, unit);
    } else {
        printf("none;");
    }
}

// How far the loop is from instability.
static void print_margins(const analysis *x)
{
    const linear_margins *m = &x->margins;
    const char *how = x->measured ? ", measured" : "";
    printf("\n  margins%s:", how);
    print_margin("gain up", m->gain_db, " dB,");
    print_margin("down", m->gain_down_db, " dB;");
    print_margin("phase", m->phase_deg, " degrees;");
    print_margin("delay", 1e3 * m->delay_s, " ms;");
    print_margin("disk", m->disk, "\n");
}

// What a table of roots is called.
static void format_roots_title(const analysis *x, int set, char *title, size_t size)
{
    if (set != POLES) {
        snprintf(title, size, "zeros, motor to %s", x->sets[set].output);
    } else if (x->period > 0) {
        snprintf(title, size, "poles, loop closed");
    } else {
        snprintf(title, size, "poles");
    }
}

// A line for a root; of a pair the lower one is with the upper one.
static void print_root(double complex root)
{
    if (cimag(root) < 0) {
        return;
    }
    printf("  %22s  ", "");
    print_cell(14, "%.6g", creal(root));
    if (cimag(root) > 0) {
        print_cell(14, "±%.6g", cimag(root));
    } else {
        print_cell(14, "%.6g", cimag(root));
    }
    print_cell(10, "%.4g", linear_damping(root));
    printf("\n");
}

// The table of poles, or of the zeros to an output.
static void print_roots(const analysis *x, int set)
{
    const root_set *roots = &x->sets[set];
    char title[64];
    format_roots_title(x, set, title, sizeof title);
    printf("\n  %-24s %14s %14s %10s\n", title, "real [1/s]", "imag. [rad/s]", "damping");
    for (int i = 0; i < roots->count; i++) {
        print_root(root_in_time(x, roots->values[i]));
    }
    if (roots->count == 0) {
        printf("  none\n");
    }
}

// The analysis as text.
static void print_analysis(const void *found)
{
    const analysis *x = found;
    say_title(x->scenario);
    printf("linear arm, %s, %d states", x->place_name, x->arm.system.states);
    if (x->place != LINEAR_FREE) {
        printf(", pressing with %.4g N under %.4g V", x->arm.force, x->arm.voltage);
    }
    printf("\n");

    // poles and zeros
    for (int set = 0; set < SETS && x->sets[set].values != NULL; set++) {
        print_roots(x, set);
    }

    // the loop
    if (x->response.count > 0) {
        if (x->stable) {
            print_margins(x);
        } else {
            printf("\n  the loop is unstable\n");
        }
    }
    if (!isnan(x->least_push)) {
        printf("  least impulse at the tip that loses contact: %.4g mN s\n",
               1e3 * x->least_push);
    }
}

// --- pictures --------------------------------------------------------------------------

// The arm from the command to the hub's velocity, and to force or tip.
static int plot_arm(const arguments *a, const analysis *x)
{
    int outputs[2] = {LINEAR_HUB_VELOCITY, LINEAR_TIP};
    if (x->arm.force > 0) {
        outputs[1] = LINEAR_FORCE;
    }

    // their answers over frequency
    linear_curve curves[2] = {{.name = NULL}};
    fault f = {0};
    status code = STATUS_OK;
    for (int i = 0; i < 2 && code == STATUS_OK; i++) {
        curves[i].name = linear_output_names[outputs[i]];
        code = linear_respond(&x->arm.system, outputs[i], 0, &curves[i].response, &f);
    }

    // the picture
    int result;
    if (code == STATUS_OK) {
        result =
            publish_owned(a, drawing()->bode_figure_create(x->scenario, curves, 2, NULL));
    } else {
        result = complain_fault(&f);
    }
    for (int i = 0; i < 2; i++) {
        free(curves[i].response.frequency);
    }
    return result;
}

// The margins, of which an unstable loop has none.
static linear_margins drawn_margins(const analysis *x)
{
    if (x->stable) {
        return x->margins;
    }
    return (linear_margins){HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
}

static int plot_analysis(const arguments *a, const analysis *x)
{
    if (x->response.count == 0) {
        return plot_arm(a, x);
    }
    const linear_curve gain = {"loop gain", x->response};
    const linear_margins margins = drawn_margins(x);
    return publish_owned(a,
                         drawing()->bode_figure_create(x->scenario, &gain, 1, &margins));
}

static int plot_nyquist(const arguments *a, const analysis *x)
{
    arguments of_nyquist = *a;
    of_nyquist.plot = a->nyquist;
    const linear_margins margins = drawn_margins(x);
    return publish_owned(&of_nyquist,
                         drawing()->nyquist_figure_create(x->scenario, &x->response,
                                                          &margins));
}

// --- the command -----------------------------------------------------------------------

int analyse_and_report(const arguments *a, const scenario *s, linear_place place,
                       const char *place_name)
{
    static const command_results results = {.json = analysis_json,
                                            .text = print_analysis,
                                            .csv = write_roots_csv,
                                            .mat = write_mat};
    SCOPED(analysis_finish)
    analysis x = {.scenario = s,
                  .place_name = place_name,
                  .place = place,
                  .least_push = (double)NAN};

    // an interrupt leaves what needs no run
    fault f = {0};
    interrupts_catch();
    const status code = analyse(&x, a, &f);
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }

    // pictures first: what is printed may be cut off
    int result = EXIT_DONE;
    if (a->plot != NULL) {
        result = plot_analysis(a, &x);
    }
    if (a->nyquist != NULL && x.response.count > 0) {
        result = worse(result, plot_nyquist(a, &x));
    }
    result = worse(result, write_results(a, &results, &x, code == STATUS_OK));
    if (code == STATUS_STOPPED) {
        complain("stopped: what runs were to measure is missing, the results are those "
                 "of the arm alone");
        result = worse(result, EXIT_FAILED);
    }
    return result;
}
