// What impactlab sweep writes and prints of its runs.
#include "ui/commands/sweep_report.h"

#include <math.h>
#include <stdlib.h>

#include "render/plot/study_plot.h"
#include "ui/commands/many_runs.h"
#include "ui/commands/pictures.h"
#include "src/study/store/sweep_store.h"

enum { ROWS_SHOWN = 40 };

// Writes all rows to a file in the form that `write` gives them; path NULL: nothing is asked for.
static int write_rows(sweep_store *store, const char *path,
                      status (*write)(sweep_store *store, FILE *stream, fault *f))
{
    whole_file file;
    fault f = {0};
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    const status code = whole_file_close(&file, write(store, file.stream, &f), &f);
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

static int write_plot(const sweep_order *o, const double *values)
{
    sweep_picture shown = {.sweep = &o->sweep, .key = o->quantity, .values = values};
    owned_figure *drawn = sweep_figure_create(&shown);
    int code = publish_figure(o->arguments, &drawn->figure);
    owned_figure_destroy(drawn);
    return code;
}

// "motor.voltage = 2 V, method.name = event" of a run.
static void print_values(const sweep *s, size_t run)
{
    for (int i = 0; i < s->axis_count; i++) {
        const parameter_info *info = &parameter_table[s->axes[i].parameter];
        char text[128];
        sweep_value_text(s, run, i, text, sizeof text);
        say("%s%s = %s%s%s", i > 0 ? ", " : "", s->axes[i].name, text, info->unit[0] ? " " : "",
            info->unit);
    }
}

// One line for the smallest or largest value.
static void print_extreme(const sweep *s, const char *word, const double *values, size_t run,
                          const char *unit)
{
    printf("  %-9s %.6g%s%s  in run %zu: ", word, values[run], unit[0] ? " " : "", unit, run + 1);
    print_values(s, run);
    printf("\n");
}

static void print_table(const sweep_order *o, const double *values)
{
    size_t shown = o->sweep.run_count < ROWS_SHOWN ? o->sweep.run_count : ROWS_SHOWN;
    for (size_t run = 0; run < shown; run++) {
        printf("  %10.5g  ", values[run]);
        print_values(&o->sweep, run);
        printf("\n");
    }
    if (shown < o->sweep.run_count) {
        printf("  ... and %zu more (--csv writes all)\n", o->sweep.run_count - shown);
    }
}

static void print_summary(const sweep_order *o, const double *values, size_t failed,
                          const sweep_progress *p)
{
    const sweep *s = &o->sweep;
    const arguments *a = o->arguments;
    const summary_info *quantity = &summary_table[summary_index(o->quantity)];
    const char *unit = quantity->unit;

    // how many runs there were
    char changes[SCENARIO_CHANGES];
    say("%s%s: %zu run%s (%s), %zu failed", o->scenario.name,
        scenario_changes(&o->scenario, changes), s->run_count, s->run_count == 1 ? "" : "s",
        sweep_sampling_name(s->sampling), failed);
    if (p->done_now < p->total) {
        printf(", %zu were there already", p->total - p->done_now);
    }
    printf("\n%s%s%s%s\n", quantity->label, unit[0] ? " [" : "", unit, unit[0] ? "]" : "");

    // each value, where no file has them
    if (a->csv == NULL && a->json == NULL && a->db == NULL && a->plot == NULL) {
        print_table(o, values);
    }

    // the smallest and the largest of those that occurred
    size_t low = s->run_count, high = s->run_count;
    for (size_t run = 0; run < s->run_count; run++) {
        if (isfinite(values[run])) {
            low = low == s->run_count || values[run] < values[low] ? run : low;
            high = high == s->run_count || values[run] > values[high] ? run : high;
        }
    }
    if (low == s->run_count) {
        printf("  did not occur in any run\n");
        return;
    }
    print_extreme(s, "smallest", values, low, unit);
    print_extreme(s, "largest", values, high, unit);
}

int report_sweep(const sweep_order *o, sweep_store *store, const sweep_progress *p)
{
    const arguments *a = o->arguments;
    fault f = {0};
    size_t failed = 0;
    int code = EXIT_DONE, plotted = EXIT_DONE;
    double *values = malloc(o->sweep.run_count * sizeof *values);
    if (values == NULL) {
        fault_set(&f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
        return complain_fault(&f);
    }
    if (sweep_store_quantity(store, o->quantity, values, &failed, &f) != STATUS_OK) {
        free(values);
        return complain_fault(&f);
    }

    // files first: what is printed may be cut off
    code = worse(write_rows(store, a->csv, sweep_store_csv),
                 write_rows(store, a->json, sweep_store_json));
    plotted = a->plot != NULL ? write_plot(o, values) : EXIT_DONE;
    code = plotted > code ? plotted : code;
    if (summary_wanted(a)) {
        print_summary(o, values, failed, p);
    }
    free(values);
    if (p->failed > 0 && (!a->quiet || failed == o->sweep.run_count)) {
        many_runs_tell_failure(p);
    } else if (failed == o->sweep.run_count) {
        complain("all %zu runs failed; the message of each is in its row", failed);
    }
    code = failed == o->sweep.run_count ? worse(code, EXIT_FAILED) : code;
    return code;
}
