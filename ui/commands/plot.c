// impactlab plot: a figure from a recipe.
#include "ui/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/figures/recipe.h"
#include "ui/commands/pictures.h"

// The recipe's name with .png, in the present folder; NULL without memory.
static char *default_name(const char *recipe)
{
    const char *slash = strrchr(recipe, '/'), *name = slash != NULL ? slash + 1 : recipe;
    const char *dot = strrchr(name, '.');
    const size_t length = dot != NULL && dot != name ? (size_t)(dot - name) : strlen(name);
    char *path = NULL;
    return asprintf(&path, "%.*s.png", (int)length, name) < 0 ? NULL : path;
}

static int plot(const arguments *a)
{
    figure_options o;
    fault f = {0};
    artwork drawn;

    // what can be refused before the recipe is read
    int code = read_picture_options(a, &o);
    if (code == EXIT_DONE && (o.overlay != NULL || o.signals != NULL)) {
        code = complain("a recipe says itself which signals and data it shows, --%s is for runs",
                        o.overlay != NULL ? "overlay" : "signals");
    }
    char *path = a->plot != NULL ? strdup(a->plot) : default_name(a->operands[0]);
    if (path == NULL) {
        fault_no_memory(&f);
        return complain_fault(&f);
    }
    if (code == EXIT_DONE && picture_check_path(path, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }

    // faults in the recipe are reported as they are found and leave f empty
    if (code == EXIT_DONE) {
        status opened = recipe_open(a->operands[0], &o, report_to_stderr, NULL, &drawn, &f);
        if (opened != STATUS_OK) {
            code = f.code != STATUS_OK ? complain_fault(&f) : EXIT_BAD_ARGUMENTS;
        } else {
            code = artwork_publish(&drawn, &o, path, true, &f) == STATUS_OK ? EXIT_DONE
                                                                            : complain_fault(&f);
            artwork_finish(&drawn);
        }
    }

    // a default name is not known to the user yet
    if (code == EXIT_DONE && !a->quiet) {
        say("%s: %s\n", a->operands[0], path);
    }
    free(path);
    return code;
}

static const option_row rows[] = {
    {.name = "output",
     .letter = 'o',
     .type = OPTION_PICTURE,
     .value = "FILE.{png,pdf,svg}",
     .help = "where to draw it (the recipe's name, as PNG)",
     PLACE(plot)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command plot_command = {
    .name = "plot",
    .group = GROUP_PICTURES,
    .operands = "RECIPE.yaml",
    .summary = "Draw a figure from a recipe: runs, data and tables in panels",
    .help = "A recipe names runs with changed parameters, measured data and the databases of "
            "sweeps, and the\npanels that show them. A CSV of what is drawn stands beside the "
            "picture. Examples are in\nscenarios/recipes, all keys in docs/reference/recipes.md.\n",
    .least = 1,
    .most = 1,
    .options = {&options, &quiet_options, &page_options},
    .run = plot,
};
