// impactlab converge: the numbers of a run as its step is halved, or its tolerance
// becomes a tenth.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/convergence.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

// The panel, and for --plot its runs.
typedef struct three_runs {
    const scenario *scenario;
    convergence_panel panel;
    run_result run[PANEL_STEPS];
} three_runs;

// --- numbers ---------------------------------------------------------------------------

// The numbers of the three runs, with their orders or digits.
static json_t *convergence_json(const void *found)
{
    const three_runs *runs = found;
    const convergence_panel *panel = &runs->panel;
    json_t *rows = json_array();
    for (int k = 0; k < panel->row_count; k++) {
        const convergence_row *row = &panel->rows[k];
        json_t *values = json_numbers(row->value, PANEL_STEPS);
        if (panel->of_tolerance) {
            json_add(rows, json_of("quantity:t values:o digits:n", row->key, values,
                                   row->digits));
        } else {
            json_add(rows, json_of("quantity:t values:o order:n", row->key, values,
                                   row->order));
        }
    }
    json_t *settings = json_numbers(panel->setting, PANEL_STEPS);
    if (panel->of_tolerance) {
        return json_of("scenario:t tolerance:o convergence:o", runs->scenario->name,
                       settings, rows);
    }
    return json_of("scenario:t step_s:o convergence:o", runs->scenario->name, settings,
                   rows);
}

// Scenario, method and the three steps or tolerances.
static void print_settings_heading(const three_runs *runs)
{
    char method[32];
    parameter_format(&runs->scenario->parameters, PARAMETER_INDEX(method.name), method,
                     sizeof method);
    say_title(runs->scenario);
    const char *varied = "step [s]", *shown = "order";
    if (runs->panel.of_tolerance) {
        varied = "tolerance";
        shown = "digits";
    }
    printf("method %s\n\n  %-26s", method, varied);
    for (int i = 0; i < PANEL_STEPS; i++) {
        char setting[32];
        decimal_print(setting, sizeof setting, "%g", runs->panel.setting[i]);
        printf(" %15s", setting);
    }
    printf("   %s\n", shown);
}

// Whether a number is the same at all steps but for rounding.
static bool agrees(const convergence_row *row)
{
    const double *v = row->value;
    const double spread = fmax(fabs(v[0] - v[1]), fabs(v[1] - v[2]));
    return spread <= 1e-9 * fabs(v[2]);
}

// A number of the three runs, with its order or digits where they can be told.
static void print_convergence_row(const convergence_row *row, bool of_tolerance)
{
    const summary_info *quantity = &summary_table[summary_index(row->key)];
    printf("  %-26s", quantity->label);
    for (int i = 0; i < PANEL_STEPS; i++) {
        print_cell(15, "%.10g", row->value[i]);
    }
    printf(" %-4s", quantity->unit);
    if (of_tolerance && isnan(row->digits)) {
        printf("-\n");
    } else if (of_tolerance) {
        char digits[32];
        decimal_print(digits, sizeof digits, "%.1f", row->digits);
        printf("%s\n", digits);
    } else if (agrees(row)) {
        printf("agree\n");
    } else if (isnan(row->order)) {
        printf("-\n");
    } else {
        printf("%.2f\n", row->order);
    }
}

// The table of all numbers.
static void print_convergence(const void *found)
{
    const three_runs *runs = found;
    if (runs->panel.done == 0) {
        return;
    }
    print_settings_heading(runs);
    for (int k = 0; k < runs->panel.row_count; k++) {
        print_convergence_row(&runs->panel.rows[k], runs->panel.of_tolerance);
    }
    if (runs->panel.of_tolerance) {
        printf(
            "\n  digits that the first and the last column share; -: not determined\n");
        return;
    }
    printf("\n  order p: the error falls as (step)^p, from the differences of the three "
           "columns;\n"
           "  agree: equal to nine digits; -: not determined\n");
}

// --- the force of the three runs -------------------------------------------------------

static const int colours[PANEL_STEPS] = {5, 0, 6};
static const char *const step_names[PANEL_STEPS] = {"h", "h/2", "h/4"};
static const char *const tolerance_names[PANEL_STEPS] = {"t", "t/10", "t/100"};

// Draws each run's force, and what it lacks of the finest. `numbers` has for both coarser
// steps room for `room` instants and as many values.
static int plot_forces(const arguments *a, const three_runs *runs, double *numbers,
                       size_t room)
{
    const trace *finest = &runs->run[PANEL_STEPS - 1].trace;
    const bool of_tolerance = runs->panel.of_tolerance;
    const char *const *names = step_names;
    const char *title = "the same run at three steps";
    if (of_tolerance) {
        names = tolerance_names;
        title = "the same run at three tolerances";
    }
    char label[PANEL_STEPS][48];
    figure_series force[PANEL_STEPS], difference[PANEL_STEPS - 1];

    // the force of each run
    for (int i = 0; i < PANEL_STEPS; i++) {
        const trace *t = &runs->run[i].trace;
        if (of_tolerance) {
            decimal_print(label[i], sizeof label[i], "tolerance %g",
                          runs->panel.setting[i]);
        } else {
            decimal_print(label[i], sizeof label[i], "<i>h</i> = %g\u2009ms",
                          1e3 * runs->panel.setting[i]);
        }
        force[i] = curve_of(names[i], label[i], &t->rows[0].time, &t->rows[0].force,
                            t->row_count, colours[i]);
        force[i].stride = sizeof(sample);
    }

    // what the coarser ones lack of the finest
    for (int i = 0; i < PANEL_STEPS - 1; i++) {
        double *x = numbers + 2 * room * (size_t)i, *y = x + room;
        const size_t count = convergence_difference(&runs->run[i].trace, finest, x, y);
        difference[i] = curve_of(names[i], label[i], x, y, count, colours[i]);
    }

    // one panel below the other
    const figure_panel panels[] = {
        {.y = {.name = "force",
               .label = "Contact force <i>f</i>",
               .unit = "N",
               .with_zero = true},
         .series = force,
         .series_count = PANEL_STEPS},
        {.y = {.name = "difference",
               .label = "Less the finest",
               .unit = "N",
               .with_zero = true},
         .series = difference,
         .series_count = PANEL_STEPS - 1},
    };
    const figure fig = {.x = {.name = "time", .label = "Time <i>t</i>", .unit = "s"},
                        .panels = panels,
                        .panel_count = 2};
    return publish_titled(a, runs->scenario, title, &fig);
}

static int plot_convergence(const arguments *a, const void *found)
{
    const three_runs *runs = found;
    const size_t room = runs->run[0].trace.row_count + runs->run[1].trace.row_count + 1;
    g_autofree double *numbers = g_new(double, 2 * (PANEL_STEPS - 1) * room);
    return plot_forces(a, runs, numbers, room);
}

// --- the command -----------------------------------------------------------------------

// The command: runs the scenario at three steps or tolerances and compares them.
static int refine_and_report(const arguments *a, scenario *s)
{
    static const command_results results = {.json = convergence_json,
                                            .text = print_convergence,
                                            .plot = plot_convergence,
                                            .kept = "the table is that of these runs"};
    three_runs runs = {.scenario = s};

    // a picture needs the runs themselves
    run_result *kept_runs = NULL;
    if (a->plot != NULL) {
        kept_runs = runs.run;
    }

    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", PANEL_STEPS);
    const status code = convergence_compute(s, monitor, kept_runs, &runs.panel, &f);
    const int result = work_finish(a, code, &f, &results, &runs);
    for (int i = 0; i < PANEL_STEPS; i++) {
        run_finish(&runs.run[i]);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}",
           "draw the contact force of the three runs", PLACE(plot)),
};

const command converge_command = {
    .name = "converge",
    .group = GROUP_MANY_RUNS,
    .summary = "Run at finer steps or tolerances, show orders or shared digits",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "Runs at the steps h, h/2 and h/4, h being the scenario's method.step, and shows "
        "the order of each number.\n"
        "Steps of the stiff engine follow their error: arms that it integrates run at "
        "their method.tolerance, at a\n"
        "tenth and at a hundredth of it, with the digits that the first and the last run "
        "share. ^C ends it with the\n"
        "runs that are done (exit status 130).\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = refine_and_report,
};
