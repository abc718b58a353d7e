#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/exchange/mat_file.h"
#include "src/study/linear/linear.h"
#include "ui/commands/command.h"

// Outputs whose zeros are told.
static const int zero_outputs[] = {LINEAR_HUB_ANGLE, LINEAR_TIP, LINEAR_FORCE};
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
} analysis;

// --- computing --------------------------------------------------------------------------------

static bool make_room(root_set *set, int count)
{
    set->values = calloc((size_t)count + 1, sizeof *set->values);
    set->count = set->values != NULL ? count : 0;
    return set->values != NULL;
}

static status analyse(analysis *x, linear_place place, fault *f)
{
    status code = linear_arm_init(&x->arm, &x->scenario->parameters, place, f);
    const linear_system *s = &x->arm.system;
    if (code != STATUS_OK) {
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
    free(x->poles.values);
    for (int i = 0; i < x->zero_sets; i++) {
        free(x->zeros[i].values);
    }
}

// --- files ------------------------------------------------------------------------------------

static void add_roots(json_t *array, const root_set *set)
{
    for (int i = 0; i < set->count; i++) {
        json_t *root = json_object();
        if (set->output != NULL) {
            json_put(root, "output", json_string(set->output));
        }
        json_put(root, "real_per_s", json_number(creal(set->values[i])));
        json_put(root, "imaginary_rad_per_s", json_number(cimag(set->values[i])));
        json_put(root, "damping", json_number(linear_damping(set->values[i])));
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
    add_roots(poles, &x->poles);
    json_put(object, "poles", poles);
    for (int i = 0; i < x->zero_sets; i++) {
        add_roots(zeros, &x->zeros[i]);
    }
    json_put(object, "zeros", zeros);

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

static void write_roots(csv_writer *w, const char *kind, const root_set *set)
{
    for (int i = 0; i < set->count; i++) {
        csv_text(w, kind);
        csv_text(w, set->output != NULL ? set->output : "");
        csv_number(w, creal(set->values[i]));
        csv_number(w, cimag(set->values[i]));
        csv_number(w, linear_damping(set->values[i]));
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
    write_roots(&w, "pole", &x->poles);
    for (int i = 0; i < x->zero_sets; i++) {
        write_roots(&w, "zero", &x->zeros[i]);
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

static void print_roots(const char *title, const root_set *set)
{
    printf("\n  %-24s %14s %14s %10s\n", title, "real [1/s]", "imag. [rad/s]", "damping");
    for (int i = 0; i < set->count; i++) {
        const double complex root = set->values[i];
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
    print_roots("poles", &x->poles);
    for (int i = 0; i < x->zero_sets; i++) {
        char title[64];
        snprintf(title, sizeof title, "zeros, motor to %s", x->zeros[i].output);
        print_roots(title, &x->zeros[i]);
    }
}

// --- the command ------------------------------------------------------------------------------

static int report(const arguments *a, const analysis *x)
{
    int result = EXIT_DONE;
    if (a->json != NULL) {
        result = worse(result, write_json(a->json, as_json(x)));
    }
    result = worse(result, write_file(a->csv, write_csv, x));
    result = worse(result, write_file(a->mat, write_mat, x));
    if (summary_wanted(a)) {
        print_analysis(x);
    }
    return result;
}

static int analyse_and_report(const arguments *a, scenario *s)
{
    fault f = {.code = STATUS_OK};
    analysis x = {.scenario = s, .place = a->place != NULL ? a->place : "contact"};
    const linear_place place = strcmp(x.place, "free") == 0      ? LINEAR_FREE
                               : strcmp(x.place, "contact") == 0 ? LINEAR_CONTACT
                                                                 : LINEAR_STUCK;
    const int result = analyse(&x, place, &f) == STATUS_OK ? report(a, &x) : complain_fault(&f);
    finish(&x);
    return result;
}

static const option_row rows[] = {
    OPTION(CHOICE, "at", "free|contact|stuck",
           "the arm in the air, pressing, or pressing with its hub held by friction (contact)",
           PLACE(place)),
    OPTION(RESULT, "csv", "FILE|-", "write poles and zeros, one a row", PLACE(csv)),
    OPTION(RESULT, "mat", "FILE.mat", "write A, B, C, D, poles and zeros for MATLAB or Octave",
           PLACE(mat)),
};
static const option_table options = OPTION_TABLE("Options", rows);

const command linear_command = {
    .name = "linear",
    .group = GROUP_CONTROL,
    .operands = "SCENARIO",
    .summary = "Poles, zeros and margins of the arm near rest",
    .help = "Linearises the arm at rest, x' = A x + B u from the command u, with back EMF, "
            "viscous friction and damping.\nIt presses with control.force where a law "
            "is to hold it, else under motor.voltage; Coulomb friction is left out.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &json_options, &options, &quiet_options},
    .use = analyse_and_report,
};
