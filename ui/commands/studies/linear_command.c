// impactlab linear: poles, zeros and margins of the arm near rest, and where its loop is
// stable.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/study_plot.h"
#include "src/base/json.h"
#include "src/base/plain_math.h"
#include "src/base/whole_file.h"
#include "src/exchange/mat_file.h"
#include "src/study/result_rows.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

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
    const char *word; // of the place
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

    linear_survey survey; // with --vary
} analysis;

// --- one arm ---------------------------------------------------------------------------

// Poles of a system, or zeros to an output of it if that has a name.
static status find_roots(root_set *set, const linear_system *s, const char *name,
                         int output, fault *f)
{
    *set = (root_set){"pole", "", s->states,
                      calloc((size_t)s->states + 1, sizeof *set->values)};
    if (set->values == NULL) {
        return fault_no_memory(f);
    }
    if (name != NULL) {
        set->kind = "zero";
        set->output = name;
        return linear_zeros(s, output, &set->count, set->values, f);
    }
    return linear_poles(s, set->values, f);
}

// Zeros and closed poles of the sampled loop, and its margins.
static status analyse_loop(analysis *x, fault *f)
{
    const parameters *p = &x->scenario->parameters;
    const bool contact = x->place == LINEAR_CONTACT;
    if (p->control.law == LAW_NONE) {
        return fault_set_at(
            f, STATUS_BAD_ARGUMENT, "control.law",
            "--law needs a control law, such as --set control.law=hybrid");
    }
    FAULT_IF(x->measured && !contact, f, STATUS_BAD_ARGUMENT,
             "--inject measures the arm in contact, not %s", x->word);
    status code = STATUS_UNSTABLE;
    if (!x->measured) {
        code = linear_loop(&x->loop, &x->arm, p, f);
    }
    x->measured = x->stable = code == STATUS_UNSTABLE && contact;
    if (x->measured) {
        TRY(linear_inject(x->scenario, &x->response, f));
    } else {
        TRY(code);
        x->period = 1 / p->control.rate;
        TRY(linear_respond(&x->loop, 0, x->period, &x->response, f));
        TRY(find_roots(&x->sets[HUB_ZEROS], &x->loop, "loop", 0, f));
        linear_close(&x->loop);
        TRY(find_roots(&x->sets[POLES], &x->loop, NULL, 0, f));
        x->stable = cabs(x->sets[POLES].values[x->sets[POLES].count - 1]) < 1;
    }
    x->margins = linear_margins_of(&x->response);
    if (x->stable && !x->measured) {
        return linear_delay_margin(&x->arm, p, &x->margins.delay_s, f);
    }
    return STATUS_OK;
}

static status analyse(analysis *x, bool looped, fault *f)
{
    const linear_system *s = &x->arm.system;
    TRY(linear_arm_init(&x->arm, &x->scenario->parameters, x->place, f));
    status code = STATUS_OK;
    if (x->place != LINEAR_FREE && x->scenario->parameters.control.law != LAW_NONE) {
        code = linear_contact_margin(x->scenario, &x->least_push, f);
    }
    if (code == STATUS_OK && looped) {
        code = analyse_loop(x, f);
    }

    // an interrupt leaves what needs no run
    if (x->period > 0 || (code != STATUS_OK && code != STATUS_STOPPED)) {
        return code;
    }

    // a tip on the wall has no zeros, nor a force without one
    const int hub = LINEAR_HUB_ANGLE,
              end = x->place == LINEAR_FREE ? LINEAR_TIP : LINEAR_FORCE;
    TRY(find_roots(&x->sets[POLES], s, NULL, 0, f));
    TRY(find_roots(&x->sets[HUB_ZEROS], s, linear_output_names[hub], hub, f));
    TRY(find_roots(&x->sets[END_ZEROS], s, linear_output_names[end], end, f));
    return code;
}

// A root as one of s; of a sampled system s = log(z)/period.
static double complex in_time(const analysis *x, double complex root)
{
    if (x->period > 0) {
        return complex_of(plain_log(cabs(root)), carg(root)) / x->period;
    }
    return root;
}

// The matrices, and how files name them.
typedef struct matrix {
    const char *name;
    int rows, columns;
    const double *values;
} matrix;
enum { MATRICES = 4 };

static void list_matrices(const linear_system *s, matrix *list)
{
    list[0] = (matrix){"A", s->states, s->states, s->a};
    list[1] = (matrix){"B", s->states, 1, s->b};
    list[2] = (matrix){"C", s->outputs, s->states, s->c};
    list[3] = (matrix){"D", s->outputs, 1, s->d};
}

static json_t *as_json(const scenario *base, const void *found)
{
    const analysis *x = found;
    json_t *roots[2] = {json_array(), json_array()};
    for (int set = 0; set < SETS; set++) {
        for (int i = 0; i < x->sets[set].count; i++) {
            const double complex z = x->sets[set].values[i], s = in_time(x, z);
            json_t *root = json_object();
            if (set != POLES) {
                json_put(root, "output", json_string(x->sets[set].output));
            }
            json_members(root, "real_per_s:n imaginary_rad_per_s:n damping:n", creal(s),
                         cimag(s), linear_damping(s));
            if (x->period > 0) {
                json_members(root, "z_real:n z_imaginary:n", creal(z), cimag(z));
            }
            json_add(roots[set != POLES], root);
        }
    }
    json_t *object = json_of("scenario:t at:t force_N:n command_V:n hub_angle_rad:n "
                             "contact_margin_Ns:n poles:o zeros:o",
                             base->name, x->word, x->arm.force, x->arm.voltage,
                             x->arm.hub_angle, x->least_push, roots[0], roots[1]);

    // the loop
    const linear_response *r = &x->response;
    if (r->count > 0) {
        const linear_margins *m = &x->margins;
        json_t *loop = json_array();
        json_t *margins;
        if (x->stable) {
            margins =
                json_of("gain_db:n gain_down_db:n phase_deg:n delay_s:n disk:n",
                        m->gain_db, m->gain_down_db, m->phase_deg, m->delay_s, m->disk);
        } else {
            margins = json_null();
        }
        for (int i = 0; i < r->count; i++) {
            json_add(loop, json_of("frequency_Hz:n gain_db:n phase_deg:n",
                                   r->frequency[i] / TWO_PI,
                                   20 * plain_log(cabs(r->gain[i])) / plain_log(10),
                                   carg(r->gain[i]) * 360 / TWO_PI));
        }
        json_members(object, "stable:b measured:b margins:o loop:o", x->stable,
                     x->measured, margins, loop);
    }

    // the matrices, row by row
    matrix list[MATRICES];
    json_t *outputs = json_array();
    list_matrices(&x->arm.system, list);
    for (int i = 0; i < LINEAR_OUTPUTS; i++) {
        json_add(outputs, json_string(linear_output_names[i]));
    }
    json_put(object, "outputs", outputs);
    for (int k = 0; k < MATRICES; k++) {
        json_t *rows = json_array();
        for (int i = 0; i < list[k].rows; i++) {
            json_add(rows,
                     json_numbers(list[k].values + i * list[k].columns, list[k].columns));
        }
        json_put(object, list[k].name, rows);
    }
    return object;
}

static void write_csv(FILE *stream, const scenario *base, const void *found)
{
    static const result_column columns[] = {{NULL, "kind", ""},
                                            {NULL, "output", ""},
                                            {NULL, "real", "1/s"},
                                            {NULL, "imaginary", "rad/s"},
                                            {NULL, "damping", ""}};
    const analysis *x = found;
    csv_writer w = csv_begin(stream);
    result_headings(&w, columns, sizeof columns / sizeof *columns);
    for (const root_set *set = x->sets; set < x->sets + SETS; set++) {
        for (int i = 0; i < set->count; i++) {
            const double complex s = in_time(x, set->values[i]);
            csv_text(&w, set->kind);
            csv_text(&w, set->output);
            csv_number(&w, creal(s));
            csv_number(&w, cimag(s));
            csv_number(&w, linear_damping(s));
            csv_end_row(&w);
        }
    }
}

static void write_mat(FILE *stream, const scenario *base, const void *found)
{
    const analysis *x = found;
    matrix list[MATRICES];
    list_matrices(&x->arm.system, list);
    mat_file_begin(stream);
    for (int i = 0; i < MATRICES; i++) {
        mat_file_matrix(stream, list[i].name, list[i].rows, list[i].columns,
                        list[i].values);
    }
    for (const root_set *set = x->sets; set < x->sets + SETS; set++) {
        char name[64];
        snprintf(name, sizeof name, set == x->sets ? "poles" : "zeros_%s", set->output);
        if (set->values != NULL) {
            mat_file_complex(stream, name, set->count, set->values);
        }
    }
}

static void print_margin(const char *name, const char *format, double value)
{
    printf(" %s ", name);
    if (isfinite(value)) {
        printf(format, value);
    } else {
        printf("none;");
    }
}

static void print_margins(const analysis *x)
{
    const linear_margins *m = &x->margins;
    printf("\n  margins%s:", x->measured ? ", measured" : "");
    print_margin("gain up", "%.3g dB,", m->gain_db);
    print_margin("down", "%.3g dB;", m->gain_down_db);
    print_margin("phase", "%.3g degrees;", m->phase_deg);
    print_margin("delay", "%.3g ms;", 1e3 * m->delay_s);
    print_margin("disk", "%.3g\n", m->disk);
}

static void print_analysis(const scenario *s, const void *found)
{
    const analysis *x = found;
    say_title(s);
    printf("linear arm, %s, %d states", x->word, x->arm.system.states);
    if (x->place != LINEAR_FREE) {
        printf(", pressing with %.4g N under %.4g V", x->arm.force, x->arm.voltage);
    }
    printf("\n");
    for (const root_set *set = x->sets; set < x->sets + SETS && set->values != NULL;
         set++) {
        char title[64] = "poles";
        if (set > x->sets) {
            snprintf(title, sizeof title, "zeros, motor to %s", set->output);
        } else if (x->period > 0) {
            snprintf(title, sizeof title, "poles, loop closed");
        }
        printf("\n  %-24s %14s %14s %10s\n", title, "real [1/s]", "imag. [rad/s]",
               "damping");
        for (int i = 0; i < set->count; i++) {
            const double complex root = in_time(x, set->values[i]);
            if (cimag(root) >= 0) { // the other one of a pair is with it
                printf("  %22s  ", "");
                print_cell(14, "%.6g", creal(root));
                print_cell(14, cimag(root) > 0 ? "±%.6g" : "%.6g", cimag(root));
                print_cell(10, "%.4g", linear_damping(root));
                printf("\n");
            }
        }
        printf(set->count == 0 ? "  none\n" : "");
    }
    if (x->response.count > 0 && x->stable) {
        print_margins(x);
    } else if (x->response.count > 0) {
        printf("\n  the loop is unstable\n");
    }
    if (!isnan(x->least_push)) {
        printf("  least impulse at the tip that loses contact: %.4g mN s\n",
               1e3 * x->least_push);
    }
}

// The loop gain, or the arm from the command to the hub's velocity, and to force or tip.
static int plot(const arguments *a, const analysis *x)
{
    const int outputs[] = {LINEAR_HUB_VELOCITY,
                           x->arm.force > 0 ? LINEAR_FORCE : LINEAR_TIP};
    linear_curve curves[2] = {{"loop gain", x->response}};
    if (x->response.count > 0) {
        return publish_owned(a, bode_figure_create(x->scenario, curves, 1));
    }
    fault f = {.code = STATUS_OK};
    for (int i = 0; i < 2 && f.code == STATUS_OK; i++) {
        curves[i].name = linear_output_names[outputs[i]];
        f.code = linear_respond(&x->arm.system, outputs[i], 0, &curves[i].response, &f);
    }
    const int result = f.code == STATUS_OK
                           ? publish_owned(a, bode_figure_create(x->scenario, curves, 2))
                           : complain_fault(&f);
    free(curves[0].response.frequency);
    free(curves[1].response.frequency);
    return result;
}

// --- many ------------------------------------------------------------------------------

// What is told of each value, by poles and by runs.
static const summary_info told[2] = {{.key = "growth_per_s",
                                      .name = "growth",
                                      .label = "growth without friction",
                                      .unit = "1/s"},
                                     {.key = "settling_time_s",
                                      .name = "settling_time",
                                      .label = "settling time",
                                      .unit = "s"}};

static json_t *survey_json(const scenario *base, const void *found)
{
    const analysis *x = found;
    const linear_survey *y = &x->survey;
    const sweep *s = &y->sweep;
    json_t *points = json_array(), *limits = json_array();
    for (size_t i = 0; i < y->done; i++) {
        json_t *values = json_object();
        for (int axis = 0; axis < s->axis_count; axis++) {
            json_put(values, s->axes[axis].name, json_number(sweep_value(s, i, axis)));
        }
        json_add(points,
                 json_of("values:o growth_per_s:n stable:b settling_time_s:n", values,
                         y->numbers[0][i], linear_is_stable(false, y->numbers[0][i]),
                         y->numbers[1][i]));
    }
    for (int i = 0; i < y->limit_count; i++) {
        json_add(limits,
                 json_of("path:t value:n of:t", s->axes[0].name, y->limits[i].value,
                         y->limits[i].by_runs ? "runs" : "poles"));
    }
    return json_of("scenario:t at:t varied:o limits:o", base->name, x->word, points,
                   limits);
}

static void write_survey(FILE *stream, const scenario *base, const void *found)
{
    const linear_survey *y = &((const analysis *)found)->survey;
    const sweep *s = &y->sweep;
    csv_writer w = csv_begin(stream);
    for (int axis = 0; axis < s->axis_count; axis++) {
        csv_heading(&w, s->axes[axis].name, sweep_axis_parameter(&s->axes[axis])->unit);
    }
    csv_heading(&w, told[0].name, told[0].unit);
    csv_heading(&w, told[1].name, told[1].unit);
    csv_end_row(&w);
    for (size_t i = 0; i < y->done; i++) {
        for (int axis = 0; axis < s->axis_count; axis++) {
            csv_number(&w, sweep_value(s, i, axis));
        }
        csv_number(&w, y->numbers[0][i]);
        csv_number(&w, y->numbers[1][i]);
        csv_end_row(&w);
    }
}

// Growth and settling time, one picture above the other.
static int plot_survey(const arguments *a, const scenario *base, const void *found)
{
    const linear_survey *y = &((const analysis *)found)->survey;
    owned_figure *both[2];
    for (int k = 0; k < 2; k++) {
        const sweep_picture shown = {&y->sweep, told[k].key, &told[k], y->numbers[k]};
        both[k] = sweep_figure_create(&shown);
    }
    both[0]->panels[0].y.with_zero = y->sweep.axis_count == 1;
    both[0]->panels[1] = both[1]->panels[0];
    both[0]->panels[0].heading = "linear, without friction: unstable above zero";
    both[0]->panels[1].heading = "runs, with friction: where one has a value it settles";
    both[0]->figure.panel_count = 2;
    const int code = publish_titled(a, base, "stability of the loop", &both[0]->figure);
    owned_figure_destroy(both[0]);
    owned_figure_destroy(both[1]);
    return code;
}

static void print_survey(const scenario *base, const void *found)
{
    const linear_survey *y = &((const analysis *)found)->survey;
    const sweep *s = &y->sweep;
    size_t stable = 0, settle = 0;
    for (size_t i = 0; i < y->done; i++) {
        stable += linear_is_stable(false, y->numbers[0][i]);
        settle += linear_is_stable(true, y->numbers[1][i]);
    }
    say_title(base);
    printf("%zu of %zu loops are stable without friction, %zu of the runs settle\n",
           stable, y->done, settle);
    for (int i = 0; i < y->limit_count; i++) {
        say("  limit %s = %.6g %s, %s\n", s->axes[0].name, y->limits[i].value,
            sweep_axis_parameter(&s->axes[0])->unit,
            y->limits[i].by_runs ? "of runs, with friction"
                                 : "of poles, without friction");
    }
}

static int look_around(const arguments *a, analysis *x)
{
    static const command_results r = {survey_json,
                                      print_survey,
                                      plot_survey,
                                      write_survey,
                                      .draws_part = true,
                                      .kept = "the results are those of these",
                                      .none = "there is nothing to show"};
    const sweep_request request = {.vary = a->varies.items,
                                   .vary_count = a->varies.count};
    if (a->plot != NULL && a->varies.count > 2) {
        return complain("--plot shows one or two varied parameters, but %d are varied",
                        a->varies.count);
    }
    fault f = {0};
    if (linear_survey_begin(&x->survey, x->scenario, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    run_monitor *monitor = work_begin(a, "combinations", (int)x->survey.sweep.run_count);
    const status code = linear_survey_make(&x->survey, x->place, monitor, &f);
    const int result = work_finish(a, code, &f, &r, x->scenario, x);
    linear_survey_finish(&x->survey);
    return result;
}

// --- the command -----------------------------------------------------------------------

// Whether the numbers of both pictures would stand in one file.
static bool share_numbers(const arguments *a)
{
    g_autofree char *one = artwork_beside(a->plot, ".csv");
    g_autofree char *other = artwork_beside(a->nyquist, ".csv");
    return whole_file_same_place(one, other);
}

static int linear(const arguments *a, scenario *s)
{
    fault f = {.code = STATUS_OK};
    analysis x = {.scenario = s,
                  .word = a->place != NULL ? a->place : "contact",
                  .measured = a->injects,
                  .least_push = (double)NAN};
    if (strcmp(x.word, "free") == 0) {
        x.place = LINEAR_FREE;
    } else if (strcmp(x.word, "contact") == 0) {
        x.place = LINEAR_CONTACT;
    } else {
        x.place = LINEAR_STUCK;
    }
    if (x.place != LINEAR_FREE && s->parameters.wall.kind == WALL_NONE) {
        return complain("there is no wall to press on, try --at free");
    }
    if (a->varies.count > 0 && (a->mat != NULL || a->nyquist != NULL || a->injects)) {
        return complain("--mat, --nyquist and --inject are of one loop, not of --vary");
    }
    if (a->varies.count > 0 && s->parameters.control.law == LAW_NONE) {
        return complain("--vary needs a control law, such as --set control.law=hybrid");
    }
    if ((a->nyquist != NULL || a->injects) && !a->looped) {
        return complain("--nyquist and --inject are of the loop of --law");
    }
    if (a->plot != NULL && a->nyquist != NULL && (a->latex != NULL || share_numbers(a))) {
        return complain(
            "--plot and --nyquist are two pictures: expected names that differ "
            "in more than their ending, and --latex for one of them");
    }
    if (a->varies.count > 0) {
        return look_around(a, &x);
    }
    static const command_results r = {as_json, print_analysis, .csv = write_csv,
                                      .mat = write_mat};
    interrupts_catch();
    const status code = analyse(&x, a->looped, &f);
    const bool stopped = code == STATUS_STOPPED, known = code == STATUS_OK || stopped;
    int result;
    if (!known) {
        result = complain_fault(&f);
    } else if (a->plot != NULL) {
        result = plot(a, &x);
    } else {
        result = EXIT_DONE;
    }
    if (known && a->nyquist != NULL && x.response.count > 0) {
        arguments there = *a;
        there.plot = a->nyquist;
        result =
            worse(result, publish_owned(&there, nyquist_figure_create(s, &x.response)));
    }
    if (known) {
        result = worse(result, write_results(a, &r, s, &x, !stopped));
    }
    if (stopped) {
        result = worse(EXIT_FAILED,
                       complain("stopped: what runs were to measure is missing, the "
                                "results are those of the arm alone"));
    }
    linear_system_finish(&x.arm.system);
    linear_system_finish(&x.loop);
    free(x.response.frequency);
    for (int i = 0; i < SETS; i++) {
        free(x.sets[i].values);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(CHOICE, "at", "free|contact|stuck",
           "the arm in the air, pressing, or pressing with its hub held by friction "
           "(contact)",
           PLACE(place)),
    OPTION(FLAG, "law", NULL, "in the loop of its law: closed poles and margins",
           PLACE(looped)),
    OPTION(FLAG, "inject", NULL,
           "measure the loop by small sines, as is done for laws that are not linear",
           PLACE(injects)),
    OPTION(RESULT, "csv", "FILE|-", "write poles and zeros, one a row", PLACE(csv)),
    PLOT_OPTION("draw gain and phase, with --vary where the loop is stable"),
    OPTION(PICTURE, "nyquist", "FILE.{png,pdf,svg}", "draw the loop gain in the plane",
           PLACE(nyquist)),
    OPTION(RESULT, "mat", "FILE.mat",
           "write A, B, C, D, poles and zeros for MATLAB or Octave", PLACE(mat)),
};

const command linear_command = {
    CALLED("linear", CONTROL, "Poles, zeros and margins of the arm near rest"),
    ONE_SCENARIO,
    .help =
        "Linearises the arm at rest, x' = A x + B u from the command u, with back EMF, "
        "viscous "
        "friction and damping.\nIt presses with control.force where a law is to hold it, "
        "else "
        "under motor.voltage; Coulomb friction is left out.\n"
        "--law closes the sampled loop of its law; one that does not answer linearly is "
        "measured by small sines.\n--vary tells where the loop is stable, by its poles "
        "and, "
        "with friction, by runs that settle.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = linear,
};
