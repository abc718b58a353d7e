#include "ui/command.h"

#include "render/figures.h"

#define DEFAULT_FOLDER  "figures"
#define DEFAULT_FORMATS "png"

// Whether every ID names a figure; says which does not.
static int check_ids(const arguments *a)
{
    for (int i = 0; i < a->operand_count; i++) {
        if (thesis_figure_find(a->operands[i]) == NULL) {
            return complain("there is no figure '%s', expected one of %s to %s", a->operands[i],
                            thesis_figures[0].id, thesis_figures[thesis_figure_count - 1].id);
        }
    }
    return EXIT_DONE;
}

static int figures(const arguments *a)
{
    const char *folder = a->output ? a->output : DEFAULT_FOLDER;
    const char *formats = a->format ? a->format : DEFAULT_FORMATS;
    int count = a->operand_count > 0 ? a->operand_count : thesis_figure_count;
    int code = check_ids(a);
    for (int i = 0; i < count && code == EXIT_DONE; i++) {
        const thesis_figure *drawn =
            a->operand_count > 0 ? thesis_figure_find(a->operands[i]) : &thesis_figures[i];
        fault f = {0};
        if (figure_draw(drawn->id, folder, formats, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
        if (!a->quiet) {
            printf("%s/%s  %s\n", folder, drawn->file, drawn->caption);
        }
    }
    return code;
}

const command figures_command = {
    .name = "figures",
    .operands = "[ID]...",
    .options = "ofq",
    .summary = "Draw the figures of the thesis",
    .help = "Without IDs all of them, into the folder 'figures' unless -o says otherwise; a CSV of "
            "what is\ndrawn stands beside each.\n",
    .most = 1 << 20,
    .run = figures,
};
