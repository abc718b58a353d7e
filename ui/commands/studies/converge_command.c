// impactlab converge: the numbers of a run as its step is halved.
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
typedef struct three_steps {
    const scenario *scenario;
    convergence_panel panel;
    run_result runs[PANEL_STEPS];
} three_steps;

// --- numbers ---------------------------------------------------------------------------

// The numbers at the three steps, with their orders.
static json_t *convergence_json(const void *found)
{
    const three_steps *steps = found;
    const convergence_panel *panel = &steps->panel;
    json_t *rows = json_array();
    for (int k = 0; k < panel->row_count; k++) {
        const convergence_row *row = &panel->rows[k];
        json_add(rows, json_of("quantity:t values:o order:n", row->key,
                               json_numbers(row->value, PANEL_STEPS), row->order));
    }
    return json_of("scenario:t step_s:o convergence:o", steps->scenario->name,
                   json_numbers(panel->step, PANEL_STEPS), rows);
}

// Scenario, method and the three steps.
static void print_steps_heading(const three_steps *steps)
{
    char method[32];
    parameter_format(&steps->scenario->parameters, PARAMETER_INDEX(method.name), method,
                     sizeof method);
    say_title(steps->scenario);
    printf("method %s\n\n  %-26s", method, "step [s]");
    for (int i = 0; i < PANEL_STEPS; i++) {
        char step[32];
        decimal_print(step, sizeof step, "%g", steps->panel.step[i]);
        printf(" %15s", step);
    }
    printf("   %s\n", "order");
}

// Whether a number is the same at all steps but for rounding.
static bool agrees(const convergence_row *row)
{
    const double *v = row->value;
    const double spread = fmax(fabs(v[0] - v[1]), fabs(v[1] - v[2]));
    return spread <= 1e-9 * fabs(v[2]);
}

// A number at the three steps, with its order where it can be told.
static void print_convergence_row(const convergence_row *row)
{
    const summary_info *quantity = &summary_table[summary_index(row->key)];
    printf("  %-26s", quantity->label);
    for (int i = 0; i < PANEL_STEPS; i++) {
        print_cell(15, "%.10g", row->value[i]);
    }
    printf(" %-4s", quantity->unit);
    if (agrees(row)) {
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
    const three_steps *steps = found;
    if (steps->panel.done == 0) {
        return;
    }
    print_steps_heading(steps);
    for (int k = 0; k < steps->panel.row_count; k++) {
        print_convergence_row(&steps->panel.rows[k]);
    }
    printf("\n  order p: the error falls as (step)^p, from the differences of the three "
           "columns;\n"
           "  agree: equal to nine digits; -: not determined\n");
}

// --- the force at the three steps ------------------------------------------------------

static const int colours[PANEL_STEPS] = {5, 0, 6};
static const char *const step_names[PANEL_STEPS] = {"h", "h/2", "h/4"};

// Draws each run's force, and what it lacks of the finest. `numbers` has for both coarser
// steps room for `room` instants and as many values.
static int plot_forces(const arguments *a, const three_steps *steps, double *numbers,
                       size_t room)
{
    const trace *finest = &steps->runs[PANEL_STEPS - 1].trace;
    char label[PANEL_STEPS][48];
    figure_series force[PANEL_STEPS], difference[PANEL_STEPS - 1];

    // the force of each run
    for (int i = 0; i < PANEL_STEPS; i++) {
        const trace *t = &steps->runs[i].trace;
        decimal_print(label[i], sizeof label[i], "<i>h</i> = %g\u2009ms",
                      1e3 * steps->panel.step[i]);
        force[i] = curve_of(step_names[i], label[i], &t->rows[0].time, &t->rows[0].force,
                            t->row_count, colours[i]);
        force[i].stride = sizeof(sample);
    }

    // what the coarser ones lack of the finest
    for (int i = 0; i < PANEL_STEPS - 1; i++) {
        double *x = numbers + 2 * room * (size_t)i, *y = x + room;
        const size_t count = convergence_difference(&steps->runs[i].trace, finest, x, y);
        difference[i] = curve_of(step_names[i], label[i], x, y, count, colours[i]);
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
    return publish_titled(a, steps->scenario, "the same run at three steps", &fig);
}

static int plot_convergence(const arguments *a, const void *found)
{
    const three_steps *steps = found;
    const size_t room =
        steps->runs[0].trace.row_count + steps->runs[1].trace.row_count + 1;
    g_autofree double *numbers = g_new(double, 2 * (PANEL_STEPS - 1) * room);
    return plot_forces(a, steps, numbers, room);
}

// --- the command -----------------------------------------------------------------------

// The command: runs the scenario at three steps and compares them.
static int halve_steps_and_report(const arguments *a, scenario *s)
{
    static const command_results results = {.json = convergence_json,
                                            .text = print_convergence,
                                            .plot = plot_convergence,
                                            .kept = "the table is that of these steps"};
    three_steps steps = {.scenario = s};

    // a picture needs the runs themselves
    run_result *kept_runs = NULL;
    if (a->plot != NULL) {
        kept_runs = steps.runs;
    }

    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", PANEL_STEPS);
    const status code = convergence_compute(s, monitor, kept_runs, &steps.panel, &f);
    const int result = work_finish(a, code, &f, &results, &steps);
    for (int i = 0; i < PANEL_STEPS; i++) {
        run_finish(&steps.runs[i]);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}",
           "draw the contact force at the three steps", PLACE(plot)),
};

const command converge_command = {
    .name = "converge",
    .group = GROUP_MANY_RUNS,
    .summary = "Run at the steps h, h/2, h/4 and show the observed orders",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "h is the scenario's method.step. --plot draws the contact force at the three "
        "steps. ^C ends it with the\n"
        "steps that are done (exit status 130).\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = halve_steps_and_report,
};
