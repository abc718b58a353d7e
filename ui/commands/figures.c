#include "ui/commands/command.h"

#include <string.h>

#include "render/figures/figures.h"
#include "src/base/words.h"
#include "src/base/numbers.h"
#include "ui/commands/pictures.h"

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

        for (int k = 0; k < thesis_figure_count; k++) {
            nearest_try(&near, thesis_figures[k].id);
        }
        return complain("there is no figure '%s', did you mean '%s'? (impactlab figures --help "
                        "lists all)",
                        a->operands[i], near.best ? near.best : thesis_figures[0].id);
    }
    return EXIT_DONE;
}

static int figures(const arguments *a)
{
    figure_options options;
    const char *folder = a->output ? a->output : DEFAULT_FOLDER;
    const char *formats = a->format ? a->format : DEFAULT_FORMATS;
    int count = a->operand_count > 0 ? a->operand_count : thesis_figure_count;

    int code = check_ids(a);
    code = code == EXIT_DONE ? read_picture_options(a, &options) : code;
    GString *tex = g_string_new(NULL);

    for (int i = 0; i < count && code == EXIT_DONE; i++) {
        const thesis_figure *drawn =
            a->operand_count > 0 ? thesis_figure_find(a->operands[i]) : &thesis_figures[i];
        fault f = {0};
        if (figure_draw_into(drawn->id, &options, folder, formats, tex, &f) != STATUS_OK) {
            code = complain_fault(&f);
        } else if (!a->quiet) {
            printf("%-10s  %s/%s  %s\n", drawn->id, folder, drawn->file, drawn->caption);
        }
    }

    fault f = {0};
    if (code == EXIT_DONE && a->latex != NULL && latex_write(a->latex, tex, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }

    g_string_free(tex, TRUE);
    return code;
}

static const char *figure_word(int i)
{
    return i < thesis_figure_count ? thesis_figures[i].id : NULL;
}

static const option_row rows[] = {
    {.name = "output",
     .letter = 'o',
     .type = OPTION_PLACE,
     .value = "FOLDER",
     .help = "folder to write to (figures)",
     PLACE(output)},
    {.name = "format",
     .type = OPTION_TEXT,
     .value = "png,pdf,svg",
     .help = "which kinds of files to write",
     PLACE(format)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command figures_command = {
    .name = "figures",
    .group = GROUP_THESIS,
    .operands = "[ID]...",
    .summary = "Draw the figures and tables of the thesis",
    .help = "Without IDs all of them, into the folder 'figures' unless -o says otherwise; a CSV of "
            "what is\ndrawn stands beside each.\n\n"
            "IDs are the thesis's numbers: 2.1 to 2.6, 3.1 to 3.11, 4.1 to 4.6, 5.1 to 5.7, T2.1, "
            "T3.1, T3.2,\nT4.1 to T4.3; errors: how near those come out; beta-gamma: the map of "
            "Newmark's "
            "parameters.\n",
    .most = 1 << 20,
    .operand_word = figure_word,
    .options = {&options, &quiet_options, &page_options},
    .run = figures,
};
