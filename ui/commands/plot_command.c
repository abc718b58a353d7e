// impactlab plot: draws a figure from a recipe.
#include "ui/commands/command.h"

#include <string.h>

#include "src/base/result_places.h"
#include "src/base/words.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/interrupts.h"

// Where the picture goes if -o does not say it: a PNG of the recipe's name in the present
// folder. To be freed with g_free.
static char *default_picture(const char *recipe)
{
    g_autofree char *name = g_path_get_basename(recipe);
    char *dot = strrchr(name, '.');
    if (dot != NULL && dot != name) {
        *dot = '\0';
    }
    return g_strconcat(name, ".png", NULL);
}

// Claims the places of the picture and of what stands beside it, as far as the command
// line has not. Returns the exit status.
static int claim_places(const arguments *a, const char *path)
{
    g_autofree char *csv = picture_beside(path, ".csv");
    g_autofree char *text = picture_beside(path, ".txt");
    bool free_places = result_places_add(csv);
    if (a->plot == NULL) {
        free_places = free_places && result_places_add(path) &&
                      (!a->bare || result_places_add(text));
    }
    if (!free_places) {
        return complain("two results cannot both be written to %s or beside it", path);
    }
    return EXIT_DONE;
}

// Draws the figure of a recipe. Returns the exit status.
static int draw_recipe(const char *recipe, const figure_options *o, const char *path)
{
    // faults in the recipe are reported as they are found and leave `f` empty
    SCOPED(artwork_finish) artwork art = {0};
    fault f = {0};
    interrupts_catch();
    if (drawing()->recipe_open(recipe, o, report_to_stderr, NULL, &art, &f) !=
        STATUS_OK) {
        if (f.code == STATUS_OK) {
            return EXIT_BAD_ARGUMENTS;
        }
        return complain_fault(&f);
    }
    if (drawing()->artwork_publish(&art, o, path, true, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// The command: checks what is asked for, and draws the figure of the recipe.
static int plot_recipe(const arguments *a)
{
    const char *recipe = a->operands[0];
    figure_options o;
    int ended = read_picture_options(a, &o);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // without options that change it the picture remembers its recipe alone
    g_autofree char *made_by = drawing()->recipe_command(recipe);
    if (strstr(a->command_line, " -") == NULL) {
        o.command = made_by;
    }

    // where the picture goes
    g_autofree char *path = g_strdup(a->plot);
    if (path == NULL) {
        path = default_picture(recipe);
    }
    fault f = {0};
    if (picture_check_path(path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    ended = claim_places(a, path);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // a default name is not known to the user yet
    const int result = draw_recipe(recipe, &o, path);
    if (result == EXIT_DONE && !a->quiet) {
        say("%s: %s\n", recipe, path);
    }
    return result;
}

static const option_row plot_rows[] = {
    OPTION(PICTURE, "output", "FILE.{png,pdf,svg}",
           "where to draw it (the recipe's name, as PNG)", PLACE(plot), .letter = 'o'),
};

const command plot_command = {
    .name = "plot",
    .group = GROUP_PICTURES,
    .summary = "Draw a figure from a recipe: runs, data and tables in panels",
    .operands = "RECIPE.yaml",
    .least = 1,
    .most = 1,
    .draws = true,
    .help =
        "A recipe names runs with changed parameters, measured data and the databases of "
        "sweeps, and the\n"
        "panels that show them. A CSV of what is drawn stands beside the picture. "
        "Examples are in\n"
        "scenarios/recipes, all keys in docs/reference/recipes.md.\n",
    .options = {OWN_OPTIONS(plot_rows), &quiet_options, &page_options},
    .run = plot_recipe,
};
