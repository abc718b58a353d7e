// impactlab converge: the numbers of a run as its step is halved.
#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/convergence.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

// The panel, and for --plot its runs.
typedef struct three_steps {
    convergence_panel panel;
    run_result runs[PANEL_STEPS];
} three_steps;

static json_t *panel_object(const scenario *s, const void *found)
{
    const convergence_panel *panel = &((const three_steps *)found)->panel;
    json_t *rows = json_array();
    for (int k = 0; k < panel->row_count; k++) {
        const convergence_row *row = &panel->rows[k];
        json_add(rows, json_of("quantity:t values:o order:n", row->key,
                               json_numbers(row->value, PANEL_STEPS), row->order));
    }
    return json_of("scenario:t step_s:o convergence:o", s->name,
                   json_numbers(panel->step, PANEL_STEPS), rows);
}

static void print_panel(const scenario *s, const void *found)
{
    const convergence_panel *panel = &((const three_steps *)found)->panel;
    if (panel->done == 0) {
        return;
    }
    char step[PANEL_STEPS][32], method[32];

    // head: scenario, method and the three steps
    parameter_format(&s->parameters, PARAMETER_INDEX(method.name), method, sizeof method);
    say_title(s);
    printf("method %s\n\n  %-26s", method, "step [s]");
    for (int i = 0; i < PANEL_STEPS; i++) {
        decimal_print(step[i], sizeof step[i], "%g", panel->step[i]);
        printf(" %15s", step[i]);
    }
    printf("   %s\n", "order");

    for (int k = 0; k < panel->row_count; k++) {
        const convergence_row *row = &panel->rows[k];
        const summary_info *quantity = &summary_table[summary_index(row->key)];
        printf("  %-26s", quantity->label);

        for (int i = 0; i < PANEL_STEPS; i++) {
            print_cell(15, "%.10g", row->value[i]);
        }

        printf(" %-4s", quantity->unit);
        const double *v = row->value;
        const double spread = fmax(fabs(v[0] - v[1]), fabs(v[1] - v[2]));
        if (spread <= 1e-9 * fabs(v[2])) { // no difference beyond rounding
            printf("agree\n");
        } else if (isnan(row->order)) {
            printf("-\n");
        } else {
            printf("%.2f\n", row->order);
        }
    }

    printf("\n  order p: the error falls as (step)^p, from the differences of the three "
           "columns;\n"
           "  agree: equal to nine digits; -: cannot be told\n");
}

// --- the force at the three steps ------------------------------------------------------

// `work` has room for the instants of two differences, and each one's values.
static int draw(const arguments *a, const scenario *s, const three_steps *r, double *work,
                size_t room)
{
    static const int colours[PANEL_STEPS] = {5, 0, 6};
    static const char *const names[PANEL_STEPS] = {"h", "h/2", "h/4"};
    const trace *finest = &r->runs[PANEL_STEPS - 1].trace;
    char label[PANEL_STEPS][48];
    figure_series force[PANEL_STEPS], less[PANEL_STEPS - 1];

    // each run's force, and what it lacks of the finest
    for (int i = 0; i < PANEL_STEPS; i++) {
        const trace *t = &r->runs[i].trace;
        decimal_print(label[i], sizeof label[i], "<i>h</i> = %g\u2009ms",
                      1e3 * r->panel.step[i]);
        force[i] = curve_of(names[i], label[i], &t->rows[0].time, &t->rows[0].force,
                            t->row_count, colours[i]);
        force[i].stride = sizeof(sample);

        if (i < PANEL_STEPS - 1) {
            double *x = work + 2 * room * (size_t)i, *y = x + room;
            size_t count = convergence_difference(t, finest, x, y);
            less[i] = curve_of(names[i], label[i], x, y, count, colours[i]);
        }
    }

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
         .series = less,
         .series_count = PANEL_STEPS - 1},
    };

    const figure fig = {.x = {.name = "time", .label = "Time <i>t</i>", .unit = "s"},
                        .panels = panels,
                        .panel_count = 2};
    return publish_titled(a, s, "the same run at three steps", &fig);
}

static int plot(const arguments *a, const scenario *s, const void *found)
{
    const three_steps *r = found;
    const size_t room = r->runs[0].trace.row_count + r->runs[1].trace.row_count + 1;
    SCOPED(free_kept) double *work = malloc(4 * room * sizeof *work);
    if (work != NULL) {
        return draw(a, s, r, work, room);
    }
    return worse(EXIT_FAILED, complain("out of memory"));
}

static int converge(const arguments *a, scenario *s)
{
    static const command_results r = {panel_object, print_panel, plot,
                                      .kept = "the table is that of these steps"};
    three_steps found = {.panel = {.done = 0}};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", PANEL_STEPS);
    const status code =
        convergence_compute(s, monitor, a->plot != NULL ? found.runs : NULL, &found.panel,
                            &f);
    const int result = work_finish(a, code, &f, &r, s, &found);
    for (int i = 0; i < PANEL_STEPS; i++) {
        run_finish(&found.runs[i]);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}",
           "draw the contact force at the three steps", PLACE(plot)),
};

const command converge_command = {
    CALLED("converge", MANY_RUNS,
           "Run at the steps h, h/2, h/4 and tell the observed orders"),
    ONE_SCENARIO,
    .help = "h is the scenario's method.step. --plot draws the contact force at the "
            "three steps. ^C ends it with the\nsteps that are done (exit status 130).\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = converge,
};
