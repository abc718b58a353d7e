// impactlab figures: draws the figures and tables of the thesis.
#include "ui/commands/command.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/study/pool.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

#define DEFAULT_FOLDER  "figures"
#define DEFAULT_FORMATS "png"

// One of the figures that were asked for.
typedef struct asked_figure {
    const thesis_figure *figure;
    char *tex;   // its figure environment, NULL before it is drawn
    fault fault; // of a file of it that could not be written
    bool done;   // it is drawn, or was tried
} asked_figure;

// Figures in the order in which they were asked for.
typedef struct figure_list {
    asked_figure *figures;
    size_t *order; // in which they are begun
    size_t count;
    size_t printed; // the first ones, whose lines are printed
    size_t drawn;   // without a fault
    bool quiet;
    const char *folder, *formats;
    figure_options options;
    const fault *failed; // of the first file that could not be written, NULL: all could
} figure_list;

// --- what is drawn ---------------------------------------------------------------------

// Complains about an ID that names no figure. Returns the exit status.
static int complain_figure(const char *id)
{
    nearest_word near = nearest_begin(id);
    const thesis_figure *known;
    for (int i = 0; (known = drawing()->thesis_figure_at(i)) != NULL; i++) {
        nearest_try(&near, known->id);
    }

    const char *suggested = near.best;
    if (suggested == NULL) {
        suggested = drawing()->thesis_figure_at(0)->id;
    }
    return complain("there is no figure '%s', did you mean '%s'? (impactlab figures "
                    "--help lists all)",
                    id, suggested);
}

// Lists the figures whose IDs are given, without any all there are. Returns the exit
// status.
static int choose_figures(figure_list *list, const arguments *a)
{
    list->count = (size_t)a->operand_count;
    if (list->count == 0) {
        list->count = (size_t)drawing()->thesis_figure_count();
    }
    list->figures = g_new0(asked_figure, list->count);

    // in their order
    for (size_t i = 0; i < list->count; i++) {
        if (a->operand_count == 0) {
            list->figures[i].figure = drawing()->thesis_figure_at((int)i);
            continue;
        }
        list->figures[i].figure = drawing()->thesis_figure_find(a->operands[i]);
        if (list->figures[i].figure == NULL) {
            return complain_figure(a->operands[i]);
        }
    }
    return EXIT_DONE;
}

// Slow figures are begun first, so that no thread is left with one at the end.
static void order_slow_first(figure_list *list)
{
    size_t placed = 0;
    list->order = g_new(size_t, list->count);
    for (size_t i = 0; i < list->count; i++) {
        if (list->figures[i].figure->slow) {
            list->order[placed++] = i;
        }
    }
    for (size_t i = 0; i < list->count; i++) {
        if (!list->figures[i].figure->slow) {
            list->order[placed++] = i;
        }
    }
    assert(placed == list->count);
}

static void figure_list_finish(figure_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        free(list->figures[i].tex);
    }
    g_free(list->figures);
    g_free(list->order);
}

// --- drawing, on several threads -------------------------------------------------------

// Draws the i-th figure to be begun; the result is its status.
static void draw_listed_figure(void *context, size_t i, void *scratch, void *result)
{
    (void)scratch;
    const figure_list *list = context;
    asked_figure *drawn = &list->figures[list->order[i]];
    status *code = result;

    // the figure environment waits in memory until it is its turn in the file
    text_stream tex;
    if (!text_stream_open(&tex)) {
        *code = fault_no_memory(&drawn->fault);
        return;
    }
    *code = drawing()->figure_draw(drawn->figure->id, &list->options, list->folder,
                                   list->formats, tex.stream, &drawn->fault);
    drawn->tex = text_stream_close(&tex, NULL);
    if (drawn->tex == NULL) {
        *code = fault_no_memory(&drawn->fault);
    }
    drawn->fault.code = *code;
}

// Prints a line for each figure before which all are done.
static void print_done_figures(figure_list *list)
{
    while (list->printed < list->count && list->figures[list->printed].done) {
        const asked_figure *next = &list->figures[list->printed++];
        if (!list->quiet && next->fault.code == STATUS_OK) {
            say("%-10s  %s/%s  %s\n", next->figure->id, list->folder, next->figure->file,
                next->figure->caption);
        }
    }
}

// Takes a figure that a thread is through with. A file that cannot be written keeps no
// other figure from being drawn; every other fault ends the work.
static status collect_figure(void *context, size_t i, const void *result, fault *f)
{
    figure_list *list = context;
    asked_figure *collected = &list->figures[list->order[i]];
    const status code = *(const status *)result;
    if (code == STATUS_STOPPED) {
        return STATUS_OK; // as if it had not been begun
    }

    // count it, and keep the first fault
    collected->done = true;
    if (code == STATUS_OK) {
        list->drawn++;
    } else if (list->failed == NULL) {
        list->failed = &collected->fault;
    }

    if (code != STATUS_OK && code != STATUS_CANNOT_WRITE) {
        *f = collected->fault;
        return code;
    }
    print_done_figures(list);
    return STATUS_OK;
}

// Writes the figure environments of what was drawn to --latex.
static status write_environments(const figure_list *list, const char *path, fault *f)
{
    whole_file out;
    TRY(whole_file_open(&out, path, f));
    for (size_t i = 0; i < list->count; i++) {
        if (list->figures[i].done) {
            fputs(list->figures[i].tex, out.stream);
        }
    }
    return whole_file_commit(&out, f);
}

// Draws all figures of the list, and writes their environments.
static status draw_figures(figure_list *list, const arguments *a, fault *f)
{
    const pool_work work = {.context = list,
                            .count = list->count,
                            .result_size = sizeof(status),
                            .compute = draw_listed_figure,
                            .collect = collect_figure,
                            .stop = &interrupted};
    order_slow_first(list);
    TRY(pool_run(&work, many_runs_jobs(a), f));
    if (a->latex != NULL) {
        return write_environments(list, a->latex, f);
    }
    return STATUS_OK;
}

// --- the command -----------------------------------------------------------------------

// The figures that were drawn, and where they are.
static json_t *figures_json(const figure_list *list)
{
    json_t *array = json_array();
    for (size_t i = 0; i < list->count; i++) {
        const asked_figure *asked = &list->figures[i];
        if (asked->done && asked->fault.code == STATUS_OK) {
            json_add(array, json_of("id:t folder:t file:t formats:t caption:t",
                                    asked->figure->id, list->folder, asked->figure->file,
                                    list->formats, asked->figure->caption));
        }
    }
    return array;
}

// Says what became of all figures. Returns the exit status.
static int report_figures(const figure_list *list, const arguments *a)
{
    int result = EXIT_DONE;
    if (a->json != NULL) {
        result = write_json_file(a->json, figures_json(list));
    }
    if (list->failed != NULL) {
        result = worse(result, complain_fault(list->failed));
    }
    if (interrupted != 0 && list->drawn < list->count) {
        complain("stopped: %zu of %zu figures were drawn and are kept", list->drawn,
                 list->count);
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

// The command: draws the figures that are named, else all.
static int draw_thesis_figures(const arguments *a)
{
    SCOPED(figure_list_finish)
    figure_list list = {.quiet = !summary_wanted(a),
                        .folder = DEFAULT_FOLDER,
                        .formats = DEFAULT_FORMATS};
    if (a->output != NULL) {
        list.folder = a->output;
    }
    if (a->format != NULL) {
        list.formats = a->format;
    }
    int ended = choose_figures(&list, a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_picture_options(a, &list.options);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // an interrupt leaves the figures that are drawn
    fault f = {0};
    interrupts_catch();
    if (draw_figures(&list, a, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return report_figures(&list, a);
}

static const char *figure_word(const command_list *all, int i)
{
    (void)all;
    fault unused = {0};
    if (drawing_open(&unused) != STATUS_OK) {
        return NULL;
    }
    const thesis_figure *known = drawing()->thesis_figure_at(i);
    if (known == NULL) {
        return NULL;
    }
    return known->id;
}

static const option_row figures_rows[] = {
    OUTPUT_OPTION(PLACE, "FOLDER", "folder to write to (figures)"),
    OPTION(TEXT, "format", "png,pdf,svg", "which kinds of files to write", PLACE(format)),
};

const command figures_command = {
    .name = "figures",
    .group = GROUP_THESIS,
    .summary = "Draw the figures and tables of the thesis",
    .operands = "[ID]...",
    .least = 0,
    .most = 1 << 20,
    .draws = true,
    .help =
        "Without IDs all of them, into the folder 'figures' unless -o says otherwise; a "
        "CSV of what is\n"
        "drawn stands beside each.\n\n"
        "IDs are the thesis's numbers: 2.1 to 2.6, 3.1 to 3.11, 4.1 to 4.6, 5.1 to 5.7, "
        "T2.1, T3.1, T3.2,\n"
        "T4.1 to T4.3; forces, delays: those printed as points with residuals; errors: "
        "how near they\n"
        "come out; beta-gamma: the map of Newmark's parameters.\n",
    .operand_word = figure_word,
    .options = {&json_options, OWN_OPTIONS(figures_rows), &quiet_options, &page_options,
                &signal_options},
    .run = draw_thesis_figures,
};
