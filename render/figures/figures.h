// The catalogue of figures and tables: those of the thesis and additional maps. Each is
// drawn from runs of the program.
#pragma once

#include "src/scenario/scenario.h"
#include "render/figures/artwork.h"
#include "render/plot/trace_plot.h"
#include "src/study/thesis_tables.h"

enum { THESIS_PANELS = 3 }; // most panels of recorded signals

typedef struct figure_order figure_order;

// A function that opens a figure: it makes the runs it needs and fails as they do; the
// title is copied.
typedef status figure_opener(const figure_order *order, artwork *out, fault *f);

// A second run of a figure's scenario, drawn dashed.
typedef struct second_run {
    const char *change;   // by which it differs, "arm.links=8"
    const char *names[2]; // of the first run and of this one
} second_run;

// A row of the catalogue: drawn by a function (`open`), or recorded signals (`panels`).
typedef struct thesis_figure {
    const char *id;       // "3.4", "T4.1", "beta-gamma"
    const char *file;     // name of its files without extension, "fig-3-4"
    const char *caption;  // plain, one line
    const char *scenario; // "thesis/fig-3-4"; NULL: it needs no run
    const char *model;    // plain, the model used: "printed; corrected dashed"
    bool slow;            // takes as long as all others, so it is started first

    // drawn by a function
    figure_opener *open;
    int variant; // of what one function opens in several ways

    // recorded signals
    const trace_panel *panels; // NULL: the usual ones of a run
    int panel_count;
    const second_run *second; // NULL: the run stands alone
    double from, to;          // ends of the time axis [s]; from >= to: automatic
    bool steps;               // a point at every step of the first run
    bool modes;               // the controller's second mode is shaded instead of contact
    int printed_voltage; // the peak of Table 4.3 in this column as a point, 1 to 4; 0:
                         // none
    const char *note;    // markup, appended to the caption; NULL for none
} thesis_figure;

// A figure that is to be opened.
struct figure_order {
    const thesis_figure *which;
    const char *title;
    const figure_options *options;
    run_monitor *monitor; // of recorded signals: of the first run; NULL: nobody looks on
};

// The drawn figures, chapter by chapter.
figure_opener diagram_sensor, diagram_links, diagram_free_bodies, table_motor;
figure_opener diagram_contact, table_stability, table_algorithm;
figure_opener stability_map, printed_stability_map;
figure_opener diagram_springs, diagram_collision, figure_force_profile, assumed_motion,
    diagram_deformation, table_predictions, printed_values_figure, table_errors;

// The number of figures, and the i-th: NULL after the last.
int thesis_figure_count(void);
const thesis_figure *thesis_figure_at(int i);

// A figure by its id or the name of its files, or NULL.
const thesis_figure *thesis_figure_find(const char *id);

// Makes the runs that the figure needs and opens it. Figures of recorded signals run
// their scenario twice unless they stand alone, with the corrected model as a thin dashed
// line. To be ended with artwork_finish. Returns the status of the runs.
status figure_open(const thesis_figure *which, const figure_options *o, artwork *out,
                   fault *f);

// Opens the usual panels of a scenario's run, whose name and arm stay valid as long as
// the artwork. Returns the status of the run, STATUS_STOPPED if `monitor` (may be NULL)
// requested it.
status scenario_figure_open(const char *name, run_monitor *monitor, artwork *out,
                            const scenario **s, fault *f);

// Draws a figure to FOLDER/fig-3-4.png and so on for every format in the list
// ("png,pdf,svg") and writes FOLDER/fig-3-4.csv; with `tex` (may be NULL) it prints the
// figure environment of the first format's file there. The folder is created if it does
// not exist. Options that are all zero: in colour, at its own width, 200 dpi.
// STATUS_BAD_ARGUMENT for an unknown id or format, otherwise the status of the run or of
// writing: STATUS_STOPPED, and nothing is written, once stop_everything is set.
status figure_draw(const char *id, const figure_options *o, const char *folder,
                   const char *formats, FILE *tex, fault *f);

// --- Tables 4.1 to 4.3, computed once for all pages that show them

// All rows, computed at the first call, on any thread; valid until the program ends. NULL
// with a reason if they cannot be computed.
const thesis_tables *computed_tables(fault *f);

// The row of a table ("4.1"), model ("printed") and quantity ("max_force_energy"), which
// must exist.
const table_row *computed_row(const thesis_tables *t, const char *table,
                              const char *model, const char *quantity);

// The defaults of both models, of the parameters from *next on that are of its group,
// "arm" or "motor", as a table; *next is the first of another group then.
table_page *defaults_table(int *next);

// --- scenarios run for figures

// A run with its scenario; of measured data the trace alone.
typedef struct opened_run {
    scenario scenario;
    run_result result; // with its trace
} opened_run;

// Opens and runs a scenario, with one parameter changed if `change`
// ("arm.model=corrected") is not NULL. NULL with the reason if that fails. To be ended
// with run_close, which accepts NULL.
opened_run *run_open(const char *name, const char *change, fault *f);
void run_close(void *run);

// The same with several changes, each "PATH=VALUE". STATUS_STOPPED if `monitor` (may be
// NULL) requested it.
opened_run *run_open_changed(const char *name, const char *const *changes, int count,
                             run_monitor *monitor, fault *f);

// The same of the text of a scenario file; `name` is the scenario's in messages.
opened_run *run_open_text(const char *text, const char *name, const char *const *changes,
                          int count, fault *f);

// A figure of empty panels with an order's title and a run of its scenario, which it
// owns: *run. NULL with the reason if the run fails.
owned_figure *run_plot_create(const figure_order *order, const char *change, int panels,
                              const opened_run **run, fault *f);

// The recorded signal whose name is nearest to a misspelt one.
const char *nearest_signal(const char *name);

// --- their figures

// A figure of the runs, which it borrows: o->signals in place of `panels` (NULL: the
// usual ones of a run), o->overlay as points with a panel of residuals, o->from to o->to,
// and the look. NULL with the status of overlay_read, or STATUS_BAD_ARGUMENT for an
// unknown signal or too many runs.
owned_figure *run_figure_create(const char *title, const trace_panel *panels,
                                int panel_count, const trace_run *runs, int run_count,
                                const figure_options *o, fault *f);

// --- from recipes: files that define which runs, data and tables a figure shows, and how

// Opens the recipe at `path`: reads it, makes its runs and describes its figure with the
// look of the options. Faults in the recipe are reported with file:line:column. To be
// ended with artwork_finish. STATUS_BAD_SCENARIO if any was reported (*f is then empty),
// otherwise the status of runs and files.
status recipe_open(const char *path, const figure_options *o, fault_handler report,
                   void *context, artwork *out, fault *f);

// The same of a recipe's text, which is or will be at `path`.
status recipe_open_text(const char *text, size_t length, const char *path,
                        const figure_options *o, fault_handler report, void *context,
                        artwork *out, fault *f);

// The command that draws a recipe, as its pictures remember it: in which folder the
// recipe is does not change them. To be freed with g_free.
char *recipe_command(const char *path);

// Whether a file is a recipe: YAML with panels. False for a file that cannot be read.
bool recipe_is(const char *path);

// --- the report: every figure and table of the catalogue, or the given runs and recipes,
// each with its origin and the command that makes it, as one web page and one PDF

// What a report is of.
typedef struct report_request {
    char *const *names; // scenarios and recipe files
    int count;          // of them; 0: the catalogue
    const char *page; // file with the lab's page, which then stands under each figure of
                      // one scenario; NULL: none
} report_request;

// Writes FOLDER/report.html, which needs no other file and no network, and
// FOLDER/report.pdf. The folder is created if it does not exist. Returns the status of
// runs and writing; STATUS_STOPPED if `monitor` (may be NULL) requested it, with both
// files unchanged. Counts in the monitor each item when it is computed and again when it
// is drawn on the page.
status report_write(const char *folder, const report_request *what, run_monitor *monitor,
                    fault *f);
