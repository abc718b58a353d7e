#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/base/plain_math.h"
#include "src/exchange/mat_file.h"
#include "ui/commands/studies/linear_pictures.h"
#include "ui/commands/pictures.h"

// Outputs whose zeros are told.
static const int zero_outputs[] = {LINEAR_HUB_ANGLE, LINEAR_TIP, LINEAR_FORCE};
#define TWO_PI (2 * 3.14159265358979323846)
enum { ZERO_SETS = sizeof zero_outputs / sizeof zero_outputs[0] };

// Poles, or zeros, one behind the other.
typedef struct root_set {
    const char *output; // of zeros, else NULL
    int count;
    double complex *values; // [1/s]
} root_set;

// What is computed of a scenario.
typedef struct analysis {
    const scenario *scenario;
    const char *place;
    linear_arm arm;
    root_set poles, zeros[ZERO_SETS];
    int zero_sets;

    // with --law the poles are those of the closed loop, the zeros those of the loop gain
    double period; // of its samples, 0: of none [s]
    linear_system loop;
    linear_response response;
    linear_margins margins; // of a stable loop
    bool stable, measured;
    double least_push; // that loses contact [N s]
} analysis;

// --- computing --------------------------------------------------------------------------------

static bool make_room(root_set *set, int count)
{
    set->values = calloc((size_t)count + 1, sizeof *set->values);
    set->count = set->values != NULL ? count : 0;
    return set->values != NULL;
}

// Zeros and closed poles of the sampled loop, and its margins.
static status analyse_loop(analysis *x, linear_place place, fault *f)
{
    const parameters *p = &x->scenario->parameters;
    if (p->control.law == LAW_NONE) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, "control.law",
                            "--law needs a control law, such as --set control.law=hybrid");
    }
    if (x->measured && place != LINEAR_CONTACT) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "--inject measures the arm in contact, not %s",
                         x->place);
    }
    status code = x->measured ? STATUS_UNSTABLE : linear_loop(&x->loop, &x->arm, p, f);
    if (code == STATUS_UNSTABLE && place == LINEAR_CONTACT) {
        x->measured = x->stable = true;
        code = linear_inject(x->scenario, &x->arm, &x->response, f);
        x->margins = code == STATUS_OK ? linear_margins_of(&x->response) : x->margins;
        return code;
    }
    if (code != STATUS_OK) {
        return code;
    }
    if (!make_room(&x->poles, x->loop.states) || !make_room(&x->zeros[0], x->loop.states)) {
        return fault_no_memory(f);
    }
    x->zero_sets = 1;
    x->zeros[0].output = "loop";
    x->period = 1 / p->control.rate;
    code = linear_loop_response(&x->loop, x->period, &x->response, f);
    code = code == STATUS_OK ? linear_zeros(&x->loop, 0, &x->zeros[0].count, x->zeros[0].values, f)
                             : code;
    linear_close(&x->loop);
    code = code == STATUS_OK ? linear_poles(&x->loop, x->poles.values, f) : code;
    x->stable = true;
    for (int i = 0; i < x->poles.count; i++) {
        x->stable = x->stable && cabs(x->poles.values[i]) < 1;
    }
    if (code == STATUS_OK && x->stable) {
        x->margins = linear_margins_of(&x->response);
    }
    return code;
}

static status analyse(analysis *x, linear_place place, bool looped, fault *f)
{
    status code = linear_arm_init(&x->arm, &x->scenario->parameters, place, f);
    const linear_system *s = &x->arm.system;
    if (code == STATUS_OK && place != LINEAR_FREE &&
        x->scenario->parameters.control.law != LAW_NONE) {
        code = linear_contact_margin(x->scenario, &x->least_push, f);
    }
    if (code == STATUS_OK && looped) {
        code = analyse_loop(x, place, f);
        looped = !x->measured;
    }
    if (code != STATUS_OK || looped) {
        return code;
    }
    if (!make_room(&x->poles, s->states)) {
        return fault_no_memory(f);
    }
    code = linear_poles(s, x->poles.values, f);

    // a tip on the wall has no zeros, nor a force without one
    for (int i = 0; i < ZERO_SETS && code == STATUS_OK; i++) {
        const int output = zero_outputs[i];
        root_set *set = &x->zeros[x->zero_sets];
        if ((output == LINEAR_TIP) != (place == LINEAR_FREE) && output != LINEAR_HUB_ANGLE) {
            continue;
        }
        if (!make_room(set, s->states)) {
            return fault_no_memory(f);
        }
        set->output = linear_output_table[output].name;
        x->zero_sets++;
        code = linear_zeros(s, output, &set->count, set->values, f);
    }
    return code;
}

static void finish(analysis *x)
{
    linear_system_finish(&x->arm.system);
    linear_system_finish(&x->loop);
    free(x->response.frequency);
    free(x->poles.values);
    for (int i = 0; i < x->zero_sets; i++) {
        free(x->zeros[i].values);
    }
}

// --- files ------------------------------------------------------------------------------------

// A root as one of s; of a sampled system s = log(z)/period.
static double complex in_time(const analysis *x, double complex root)
{
    return x->period > 0 ? complex_of(plain_log(cabs(root)), carg(root)) / x->period : root;
}

static void add_roots(json_t *array, const analysis *x, const root_set *set)
{
    for (int i = 0; i < set->count; i++) {
        json_t *root = json_object();
        const double complex s = in_time(x, set->values[i]);
        if (set->output != NULL) {
            json_put(root, "output", json_string(set->output));
        }
        json_put(root, "real_per_s", json_number(creal(s)));
        json_put(root, "imaginary_rad_per_s", json_number(cimag(s)));
        json_put(root, "damping", json_number(linear_damping(s)));
        if (x->period > 0) {
            json_put(root, "z_real", json_number(creal(set->values[i])));
            json_put(root, "z_imaginary", json_number(cimag(set->values[i])));
        }
        json_add(array, root);
    }
}

static json_t *matrix(const double *values, int rows, int columns)
{
    json_t *array = json_array();
    for (int i = 0; i < rows; i++) {
        json_add(array, json_numbers(values + (size_t)i * (size_t)columns, columns));
    }
    return array;
}

static json_t *margins(const linear_margins *m)
{
    json_t *object = json_object();
    json_put(object, "gain_db", json_number(m->gain_db));
    json_put(object, "gain_down_db", json_number(m->gain_down_db));
    json_put(object, "phase_deg", json_number(m->phase_deg));
    json_put(object, "delay_s", json_number(m->delay_s));
    json_put(object, "disk", json_number(m->disk));
    return object;
}

static json_t *loop_gain(const linear_response *r)
{
    json_t *array = json_array();
    for (int i = 0; i < r->count; i++) {
        json_t *entry = json_object();
        json_put(entry, "frequency_Hz", json_number(r->frequency[i] / TWO_PI));
        json_put(entry, "gain_db", json_number(20 * plain_log(cabs(r->gain[i])) / plain_log(10)));
        json_put(entry, "phase_deg", json_number(carg(r->gain[i]) * 360 / TWO_PI));
        json_add(array, entry);
    }
    return array;
}

static json_t *as_json(const analysis *x)
{
    const linear_system *s = &x->arm.system;
    json_t *object = json_object(), *poles = json_array(), *zeros = json_array();
    json_t *outputs = json_array();
    json_put(object, "scenario", json_text(x->scenario->name));
    json_put(object, "at", json_string(x->place));
    json_put(object, "force_N", json_number(x->arm.force));
    json_put(object, "command_V", json_number(x->arm.voltage));
    json_put(object, "hub_angle_rad", json_number(x->arm.hub_angle));
    add_roots(poles, x, &x->poles);
    json_put(object, "poles", poles);
    for (int i = 0; i < x->zero_sets; i++) {
        add_roots(zeros, x, &x->zeros[i]);
    }
    json_put(object, "zeros", zeros);

    if (x->response.count > 0) {
        json_put(object, "stable", json_boolean(x->stable));
        json_put(object, "measured", json_boolean(x->measured));
        json_put(object, "margins", x->stable ? margins(&x->margins) : json_null());
        json_put(object, "loop", loop_gain(&x->response));
    }
    json_put(object, "contact_margin_Ns", json_number(x->least_push));

    // the matrices, row by row
    for (int i = 0; i < LINEAR_OUTPUTS; i++) {
        json_add(outputs, json_string(linear_output_table[i].name));
    }
    json_put(object, "outputs", outputs);
    json_put(object, "A", matrix(s->a, s->states, s->states));
    json_put(object, "B", matrix(s->b, s->states, 1));
    json_put(object, "C", matrix(s->c, s->outputs, s->states));
    json_put(object, "D", matrix(s->d, s->outputs, 1));
    return object;
}

static void write_roots(csv_writer *w, const char *kind, const analysis *x, const root_set *set)
{
    for (int i = 0; i < set->count; i++) {
        const double complex s = in_time(x, set->values[i]);
        csv_text(w, kind);
        csv_text(w, set->output != NULL ? set->output : "");
        csv_number(w, creal(s));
        csv_number(w, cimag(s));
        csv_number(w, linear_damping(s));
        csv_end_row(w);
    }
}

static void write_csv(FILE *stream, const void *what)
{
    const analysis *x = what;
    csv_writer w = csv_begin(stream);
    csv_heading(&w, "kind", "");
    csv_heading(&w, "output", "");
    csv_heading(&w, "real", "1/s");
    csv_heading(&w, "imaginary", "rad/s");
    csv_heading(&w, "damping", "");
    csv_end_row(&w);
    write_roots(&w, "pole", x, &x->poles);
    for (int i = 0; i < x->zero_sets; i++) {
        write_roots(&w, "zero", x, &x->zeros[i]);
    }
}

static void write_mat(FILE *stream, const void *what)
{
    const analysis *x = what;
    const linear_system *s = &x->arm.system;
    mat_file_begin(stream);
    mat_file_matrix(stream, "A", s->states, s->states, s->a);
    mat_file_matrix(stream, "B", s->states, 1, s->b);
    mat_file_matrix(stream, "C", s->outputs, s->states, s->c);
    mat_file_matrix(stream, "D", s->outputs, 1, s->d);
    mat_file_complex(stream, "poles", x->poles.count, x->poles.values);
    for (int i = 0; i < x->zero_sets; i++) {
        char name[64];
        snprintf(name, sizeof name, "zeros_%s", x->zeros[i].output);
        mat_file_complex(stream, name, x->zeros[i].count, x->zeros[i].values);
    }
}

// --- for people -------------------------------------------------------------------------------

static void print_roots(const char *title, const analysis *x, const root_set *set)
{
    printf("\n  %-24s %14s %14s %10s\n", title, "real [1/s]", "imag. [rad/s]", "damping");
    for (int i = 0; i < set->count; i++) {
        const double complex root = in_time(x, set->values[i]);
        if (cimag(root) < 0) {
            continue; // with the one before
        }
        printf("  %22s  ", "");
        print_cell(14, "%.6g", creal(root));
        print_cell(14, cimag(root) > 0 ? "±%.6g" : "%.6g", cimag(root));
        print_cell(10, "%.4g", linear_damping(root));
        printf("\n");
    }
    if (set->count == 0) {
        printf("  none\n");
    }
}

static void print_analysis(const analysis *x)
{
    say_title(x->scenario);
    printf("linear arm, %s, %d states", x->place, x->arm.system.states);
    if (strcmp(x->place, "free") != 0) {
        printf(", pressing with %.4g N under %.4g V", x->arm.force, x->arm.voltage);
    }
    printf("\n");
    print_roots(x->period > 0 ? "poles, loop closed" : "poles", x, &x->poles);
    for (int i = 0; i < x->zero_sets; i++) {
        char title[64];
        snprintf(title, sizeof title, "zeros, motor to %s", x->zeros[i].output);
        print_roots(title, x, &x->zeros[i]);
    }
}

static void print_margins(const analysis *x)
{
    const linear_margins *m = &x->margins;
    if (!x->stable) {
        printf("\n  the loop is unstable\n");
        return;
    }
    printf("\n  margins%s: gain %.3g dB up, %.3g dB down; phase %.3g degrees; delay %.3g ms; disk "
           "%.3g\n",
           x->measured ? ", measured" : "", m->gain_db, m->gain_down_db, m->phase_deg,
           1e3 * m->delay_s, m->disk);
}

// --- the command ------------------------------------------------------------------------------

// The loop gain, or the arm from the command to the hub's velocity, and to force or tip.
static int plot(const arguments *a, const analysis *x)
{
    const linear_system *s = &x->arm.system;
    const int outputs[] = {LINEAR_HUB_VELOCITY, x->arm.force > 0 ? LINEAR_FORCE : LINEAR_TIP};
    linear_response drawn[2] = {{0}};
    linear_curve curves[2] = {{"loop gain", &x->response}};
    int result = EXIT_DONE, count = 1;
    if (x->response.count == 0) {
        fault f = {.code = STATUS_OK};
        for (count = 0; count < 2 && result == EXIT_DONE; count++) {
            curves[count] = (linear_curve){linear_output_table[outputs[count]].name, &drawn[count]};
            result = linear_arm_response(s, outputs[count], &drawn[count], &f) == STATUS_OK
                         ? EXIT_DONE
                         : complain_fault(&f);
        }
    }
    result = result == EXIT_DONE ? plot_bode(a, x->scenario, curves, count) : result;
    free(drawn[0].frequency);
    free(drawn[1].frequency);
    return result;
}

static int report(const arguments *a, const analysis *x)
{
    int result = EXIT_DONE;
    if (a->json != NULL) {
        result = worse(result, write_json(a->json, as_json(x)));
    }
    if (a->plot != NULL) {
        result = worse(result, plot(a, x));
    }
    if (a->nyquist != NULL) {
        result =
            worse(result, x->response.count > 0 ? plot_nyquist(a, x->scenario, &x->response)
                                                : complain("--nyquist draws the loop of --law"));
    }
    result = worse(result, write_file(a->csv, write_csv, x));
    result = worse(result, write_file(a->mat, write_mat, x));
    if (summary_wanted(a)) {
        print_analysis(x);
        if (x->response.count > 0) {
            print_margins(x);
        }
        if (!isnan(x->least_push)) {
            printf("  least impulse at the tip that loses contact: %.4g mN s\n",
                   1e3 * x->least_push);
        }
    }
    return result;
}

static int analyse_and_report(const arguments *a, scenario *s)
{
    fault f = {.code = STATUS_OK};
    analysis x = {.scenario = s,
                  .place = a->place != NULL ? a->place : "contact",
                  .measured = a->injects,
                  .least_push = (double)NAN};
    const linear_place place = strcmp(x.place, "free") == 0      ? LINEAR_FREE
                               : strcmp(x.place, "contact") == 0 ? LINEAR_CONTACT
                                                                 : LINEAR_STUCK;
    if (a->varies.count > 0) {
        return survey_stability(a, s, place, x.place);
    }
    const int result =
        analyse(&x, place, a->looped, &f) == STATUS_OK ? report(a, &x) : complain_fault(&f);
    finish(&x);
    return result;
}

static const option_row rows[] = {
    OPTION(CHOICE, "at", "free|contact|stuck",
           "the arm in the air, pressing, or pressing with its hub held by friction (contact)",
           PLACE(place)),
    OPTION(FLAG, "law", NULL, "in the loop of its law: closed poles and margins", PLACE(looped)),
    OPTION(FLAG, "inject", NULL,
           "measure the loop by small sines, as is done for laws that are not linear",
           PLACE(injects)),
    OPTION(RESULT, "csv", "FILE|-", "write poles and zeros, one a row", PLACE(csv)),
    PLOT_OPTION("draw gain and phase, with --vary where the loop is stable"),
    OPTION(PICTURE, "nyquist", "FILE.{png,pdf,svg}", "draw the loop gain in the plane",
           PLACE(nyquist)),
    OPTION(RESULT, "mat", "FILE.mat", "write A, B, C, D, poles and zeros for MATLAB or Octave",
           PLACE(mat)),
};
static const option_table options = OPTION_TABLE("Options", rows);

const command linear_command = {
    .name = "linear",
    .group = GROUP_CONTROL,
    .operands = "SCENARIO",
    .summary = "Poles, zeros and margins of the arm near rest",
    .help =
        "Linearises the arm at rest, x' = A x + B u from the command u, with back EMF, "
        "viscous friction and damping.\nIt presses with control.force where a law "
        "is to hold it, else under motor.voltage; Coulomb friction is left out.\n"
        "--law closes the sampled loop of its law; one that does not answer linearly is "
        "measured by small sines.\n--vary tells where the loop is stable, by its poles and, with "
        "friction, by runs that settle.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &vary_options, &json_options, &options, &quiet_options,
                &page_options},
    .use = analyse_and_report,
};
