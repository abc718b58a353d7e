// The commands that draw figures: those of the thesis, of a recipe, and a report of many.
#include "ui/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/figures/figures.h"
#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/study/pool.h"
#include "ui/commands/progress.h"
#include "ui/commands/command_pictures.h"

// --- figures ---------------------------------------------------------------------------

#define DEFAULT_FOLDER  "figures"
#define DEFAULT_FORMATS "png"

// Whether every ID names a figure; says which does not.
static int check_ids(const arguments *a)
{
    for (int i = 0; i < a->operand_count; i++) {
        nearest_word near = nearest_begin(a->operands[i]);
        if (thesis_figure_find(a->operands[i]) != NULL) {
            continue;
        }

        const thesis_figure *known;
        for (int k = 0; (known = thesis_figure_at(k)) != NULL; k++) {
            nearest_try(&near, known->id);
        }
        return complain("there is no figure '%s', did you mean '%s'? (impactlab figures "
                        "--help lists all)",
                        a->operands[i], near.best ? near.best : thesis_figure_at(0)->id);
    }
    return EXIT_DONE;
}

typedef struct asked_figure {
    const thesis_figure *figure;
    char *tex;   // its figure environment, NULL before it is drawn
    fault fault; // of a file of it that could not be written
    bool taken;  // it is drawn, and the drawing thread is through with it
} asked_figure;

// Figures in the order in which they were asked for.
typedef struct figure_list {
    asked_figure *figures;
    size_t *order;          // in which they are begun
    size_t count, reported; // of all, and of those already reported
    size_t drawn;
    bool quiet;
    const char *folder, *formats;
    figure_options options;
    const fault *failed; // of the first file that could not be written, NULL: all could
} figure_list;

static void draw_one(void *context, size_t i, void *scratch, void *result)
{
    const figure_list *list = context;
    asked_figure *drawn = &list->figures[list->order[i]];
    status *code = result;
    text_stream tex;
    if (text_stream_open(&tex)) {
        *code = figure_draw(drawn->figure->id, &list->options, list->folder,
                            list->formats, tex.stream, &drawn->fault);
        drawn->tex = text_stream_close(&tex, NULL);
    }
    if (drawn->tex == NULL) {
        *code = fault_no_memory(&drawn->fault);
    }
    drawn->fault.code = *code;
}

// Prints every figure whose predecessors have been printed.
static status take_one(void *context, size_t i, const void *result, fault *f)
{
    figure_list *list = context;
    asked_figure *taken = &list->figures[list->order[i]];
    const status code = *(const status *)result;
    if (code == STATUS_STOPPED) {
        return STATUS_OK; // as if it had not been begun
    }
    taken->taken = true;
    list->drawn += code == STATUS_OK;
    if (code != STATUS_OK && list->failed == NULL) {
        list->failed = &taken->fault;
    }
    if (code != STATUS_OK && code != STATUS_CANNOT_WRITE) {
        *f = taken->fault;
        return code;
    }
    for (; list->reported < list->count && list->figures[list->reported].taken;
         list->reported++) {
        const asked_figure *next = &list->figures[list->reported];
        if (!list->quiet && next->fault.code == STATUS_OK) {
            say("%-10s  %s/%s  %s\n", next->figure->id, list->folder, next->figure->file,
                next->figure->caption);
        }
    }
    return STATUS_OK;
}

// Draws the figures that were asked for, on as many threads as there are processors, and
// writes their environments.
static status draw_and_write(figure_list *list, const arguments *a, fault *f)
{
    const pool_work work = {.context = list,
                            .count = list->count,
                            .result_size = sizeof(status),
                            .compute = draw_one,
                            .collect = take_one,
                            .stop = &interrupted};
    for (size_t i = 0; i < list->count; i++) {
        if (a->operand_count > 0) {
            list->figures[i].figure = thesis_figure_find(a->operands[i]);
        } else {
            list->figures[i].figure = thesis_figure_at((int)i);
        }
    }

    // slow ones first, so that no thread is left with one at the end
    list->order = (size_t *)(list->figures + list->count);
    size_t placed = 0;
    for (int slow = 1; slow >= 0; slow--) {
        for (size_t i = 0; i < list->count; i++) {
            if (list->figures[i].figure->slow == slow) {
                list->order[placed++] = i;
            }
        }
    }

    whole_file out;
    status code = pool_run(&work, many_runs_jobs(a), f);
    if (code == STATUS_OK && a->latex != NULL &&
        (code = whole_file_open(&out, a->latex, f)) == STATUS_OK) {
        for (size_t i = 0; i < list->count; i++) {
            if (list->figures[i].taken) {
                fputs(list->figures[i].tex, out.stream);
            }
        }
        code = whole_file_commit(&out, f);
    }
    return code;
}

static int figures(const arguments *a)
{
    fault f = {0};
    size_t count = (size_t)a->operand_count;
    if (count == 0) {
        count = (size_t)thesis_figure_count();
    }
    figure_list list = {.count = count,
                        .quiet = !summary_wanted(a),
                        .folder = DEFAULT_FOLDER,
                        .formats = DEFAULT_FORMATS};
    if (a->output != NULL) {
        list.folder = a->output;
    }
    if (a->format != NULL) {
        list.formats = a->format;
    }

    int code = EXIT_DONE;
    int ended = check_ids(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_picture_options(a, &list.options);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // lists of figures to be drawn and of their results; an interrupt leaves those that
    // are drawn
    interrupts_catch();
    list.figures = calloc(count, sizeof *list.figures + sizeof *list.order);
    status drawn;
    if (list.figures != NULL) {
        drawn = draw_and_write(&list, a, &f);
    } else {
        drawn = fault_no_memory(&f);
    }
    if (drawn != STATUS_OK) {
        code = complain_fault(&f);
    } else if (a->json != NULL) {
        json_t *array = json_array();
        for (size_t i = 0; i < count; i++) {
            const thesis_figure *which = list.figures[i].figure;
            if (list.figures[i].taken && list.figures[i].fault.code == STATUS_OK) {
                json_add(array,
                         json_of("id:t folder:t file:t formats:t caption:t", which->id,
                                 list.folder, which->file, list.formats, which->caption));
            }
        }
        code = write_json(a->json, array);
    }
    if (drawn == STATUS_OK && list.failed != NULL) {
        code = worse(code, complain_fault(list.failed));
    }
    if (drawn == STATUS_OK && interrupted != 0 && list.drawn < count) {
        code = worse(EXIT_FAILED,
                     complain("stopped: %zu of %zu figures were drawn and are kept",
                              list.drawn, count));
    }
    for (size_t i = 0; list.figures != NULL && i < count; i++) {
        free(list.figures[i].tex);
    }
    free(list.figures);
    return code;
}

static const char *figure_word(const command_list *all, int i)
{
    const thesis_figure *which = thesis_figure_at(i);
    if (which != NULL) {
        return which->id;
    }
    return NULL;
}

static const option_row rows[] = {
    OUTPUT_OPTION(PLACE, "FOLDER", "folder to write to (figures)"),
    OPTION(TEXT, "format", "png,pdf,svg", "which kinds of files to write", PLACE(format)),
};

const command figures_command = {
    CALLED("figures", THESIS, "Draw the figures and tables of the thesis"),
    OPERANDS("[ID]...", 0, 1 << 20),
    .help =
        "Without IDs all of them, into the folder 'figures' unless -o says otherwise; a "
        "CSV of "
        "what is\ndrawn stands beside each.\n\n"
        "IDs are the thesis's numbers: 2.1 to 2.6, 3.1 to 3.11, 4.1 to 4.6, 5.1 to 5.7, "
        "T2.1, "
        "T3.1, T3.2,\nT4.1 to T4.3; forces, delays: those printed as points with "
        "residuals; "
        "errors: how near they\ncome out; beta-gamma: the map of Newmark's parameters.\n",
    .operand_word = figure_word,
    .options = {&json_options, OWN_OPTIONS(rows), &quiet_options, &page_options},
    .run = figures,
};

// --- plot ------------------------------------------------------------------------------

static int plot(const arguments *a)
{
    figure_options o;

    // what can be refused before the recipe is read
    int ended = read_picture_options(a, &o);
    if (ended != EXIT_DONE) {
        return ended;
    }
    if (o.overlay != NULL || o.signals != NULL) {
        return complain(
            "a recipe says itself which signals and data it shows, --%s is for runs",
            o.overlay != NULL ? "overlay" : "signals");
    }

    // the recipe's name with .png, in the present folder, unless there is another
    const char *slash = strrchr(a->operands[0], '/');
    const char *name = slash != NULL ? slash + 1 : a->operands[0],
               *dot = strrchr(name, '.');
    const int length = dot != NULL && dot != name ? (int)(dot - name) : (int)strlen(name);
    SCOPED(free_kept) char *path = NULL;
    if (a->plot != NULL ? asprintf(&path, "%s", a->plot) < 0
                        : asprintf(&path, "%.*s.png", length, name) < 0) {
        path = NULL;
    }
    fault f = {0};
    if (path != NULL) {
        if (picture_check_path(path, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    } else {
        if (fault_no_memory(&f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }

    // what the command line does not name: the picture, and what stands beside it
    g_autofree char *csv = artwork_beside(path, ".csv"),
                    *text = artwork_beside(path, ".txt");
    const bool named = a->plot != NULL;
    if ((!named && !whole_file_add_result(path)) || !whole_file_add_result(csv) ||
        (a->bare && !named && !whole_file_add_result(text))) {
        return complain("two results cannot both be written to %s or beside it", path);
    }

    // faults in the recipe are reported as they are found and leave `why` empty
    interrupts_catch();
    SCOPED(artwork_finish) artwork art = {0};
    fault why = {0};
    if (recipe_open(a->operands[0], &o, report_to_stderr, NULL, &art, &why) !=
        STATUS_OK) {
        return why.code != STATUS_OK ? complain_fault(&why) : EXIT_BAD_ARGUMENTS;
    }
    if (artwork_publish(&art, &o, path, true, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // a default name is not known to the user yet
    if (!a->quiet) {
        say("%s: %s\n", a->operands[0], path);
    }
    return EXIT_DONE;
}

static const option_row plot_rows[] = {
    OPTION(PICTURE, "output", "FILE.{png,pdf,svg}",
           "where to draw it (the recipe's name, as PNG)", PLACE(plot), .letter = 'o'),
};

const command plot_command = {
    CALLED("plot", PICTURES,
           "Draw a figure from a recipe: runs, data and tables in panels"),
    OPERANDS("RECIPE.yaml", 1, 1),
    .help = "A recipe names runs with changed parameters, measured data and the "
            "databases of sweeps, and the\npanels that show them. A CSV of what "
            "is drawn stands beside the picture. Examples are "
            "in\nscenarios/recipes, all keys in docs/reference/recipes.md.\n",
    .options = {OWN_OPTIONS(plot_rows), &quiet_options, &page_options},
    .run = plot,
};

// --- report ----------------------------------------------------------------------------

static int report(const arguments *a)
{
    fault f = {0};
    const char *folder = a->output ? a->output : "report";
    const int items = a->operand_count > 0 ? a->operand_count : thesis_figure_count();
    const int steps = 2 * items; // computed, then drawn
    run_monitor *monitor = work_begin(a, "steps", steps);
    status code = report_write(folder, a->operands, a->operand_count, monitor, &f);
    work_end();

    if (code == STATUS_STOPPED) {
        complain("stopped: %d of %d steps were done, the report is as it was before",
                 monitor->pieces, steps);
        return EXIT_FAILED;
    }
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (!a->quiet) {
        say("%s/report.html\n%s/report.pdf\n", folder, folder);
    }
    return EXIT_DONE;
}

static const option_row report_rows[] = {
    OUTPUT_OPTION(PLACE, "FOLDER", "folder to write to (report)"),
};

const command report_command = {
    CALLED("report", THESIS, "Figures and tables as one web page and one PDF"),
    SCENARIOS("[SCENARIO|RECIPE.yaml]...", 0, 64),
    .help = "Of the scenarios and recipes named, or without any of the whole "
            "thesis. Into the folder 'report' unless -o says otherwise. The page "
            "needs no other file and no network. Under\neach item stand its "
            "scenario, its model and the command that makes it again.\n^C ends "
            "it and leaves the report of before (exit status 130).\n",
    .options = {OWN_OPTIONS(report_rows), &quiet_options},
    .run = report,
};
