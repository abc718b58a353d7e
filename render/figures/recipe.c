#include "render/figures/recipe.h"

#include <stdlib.h>

#include "render/figures/recipe_parts.h"

static void release(void *owner)
{
    recipe_figure *fig = owner;
    for (int i = 0; i < fig->recipe.source_count; i++) {
        opened_source *s = &fig->sources[i];
        if (s->ran) {
            run_end(&s->run);
        }
        trace_finish(&s->data.trace);
        for (int k = 0; k < SWEEP_TABLE_COLUMNS; k++) {
            free(s->columns[k]);
        }
    }

    owned_figure_finish(&fig->plot);
    recipe_finish(&fig->recipe);
    g_free(fig->path);
    g_free(fig);
}

// ---- opening what the recipe names

// A file as the recipe's folder sees it; a scenario's name stays.
static char *path_of(const recipe_figure *fig, const char *name)
{
    g_autofree char *folder = g_path_get_dirname(fig->path);
    char *path = g_path_is_absolute(name) ? g_strdup(name) : g_build_filename(folder, name, NULL);
    return path;
}

static status open_data(recipe_figure *fig, const recipe_source *s, opened_source *out, fault *f)
{
    trace_panel shown[FIGURE_PANELS];
    int count = 0;

    // the signals that a nameless column may lie over
    for (int i = 0; i < fig->recipe.panel_count; i++) {
        if (fig->recipe.panels[i].signal_count > 0) {
            shown[count++] = (trace_panel){.signals = {fig->recipe.panels[i].signals[0]}};
        }
    }

    g_autofree char *path = path_of(fig, s->file), *name = NULL;
    return overlay_read_column(&out->data.trace, path, s->column, s->shift, shown, count, &name, f);
}

static status open_source(recipe_figure *fig, int index, fault *f)
{
    const recipe_source *s = &fig->recipe.sources[index];
    opened_source *out = &fig->sources[index];
    fault why = {0};
    status code = STATUS_OK;

    if (s->kind == SOURCE_RUN) {
        g_autofree char *beside = path_of(fig, s->scenario);
        bool own = g_file_test(beside, G_FILE_TEST_IS_REGULAR);
        code = run_begin_changed(&out->run, own ? beside : s->scenario, s->change, s->change_count,
                                 NULL, &why);
        out->ran = code == STATUS_OK;
    } else if (s->kind == SOURCE_DATA) {
        code = open_data(fig, s, out, &why);
    } else {
        g_autofree char *path = path_of(fig, s->file);
        const char *const keys[] = {s->x, s->y, s->z};
        code = sweep_table_read(path, keys, s->z != NULL ? 3 : 2, out->columns, &out->count, &why);
    }

    // the place in the recipe stands before what went wrong
    return code == STATUS_OK
               ? code
               : fault_set(f, code, "%s:%d:%d: %s", fig->path, s->at.line, s->at.column, why.text);
}

// ---- the page

// The axis below all panels: time, or the first column of the first table.
static figure_axis horizontal_axis(recipe_figure *fig)
{
    const recipe *r = &fig->recipe;
    const recipe_source *first = &r->sources[0];
    figure_axis x = {.name = "time", .label = "Time <i>t</i>", .unit = "s"};

    if (first->kind == SOURCE_TABLE) {
        x = recipe_column_axis(fig, first->x);
        x.room = first->z != NULL ? 0 : 0.03;
    }

    // what the recipe says of it
    x.label = r->x_label != NULL ? r->x_label : x.label;
    x.unit = r->x_unit != NULL ? r->x_unit : x.unit;
    x.low = r->from;
    x.high = r->to;
    x.scale = r->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR;
    return x;
}

static void describe(recipe_figure *fig, const figure_options *o)
{
    const recipe *r = &fig->recipe;
    for (int i = 0; i < r->panel_count; i++) {
        recipe_describe_panel(fig, i);
    }

    figure *shown = &fig->plot.figure;
    shown->title = r->title;
    shown->caption = r->caption;
    shown->x = horizontal_axis(fig);
    shown->panel_count = r->panel_count;
    shown->columns = (int)r->columns;
    shown->shared_y = r->shared;
    shown->marks = r->marks;
    shown->mark_count = r->mark_count;

    // runs with every parameter, for the file
    GString *values = g_string_new(NULL);
    for (int i = 0; i < r->source_count; i++) {
        if (fig->sources[i].ran) {
            g_autofree char *line = parameters_line(&fig->sources[i].run.scenario);
            text_append(values, "%s%s", values->len > 0 ? "; " : "", line);
        }
    }
    shown->parameters = owned_figure_keep(&fig->plot, g_string_free(values, FALSE));

    // the first run's contact
    if (r->contact && fig->sources[0].ran) {
        trace_shade(&fig->plot, &fig->sources[0].run.result.trace, false);
    }

    figure_take_look(&fig->plot.figure, &o->look);
    figure_take_range(&fig->plot.figure, o);
}

status recipe_open(const char *path, const figure_options *o, fault_handler report, void *context,
                   artwork *out, fault *f)
{
    gchar *text = NULL;
    gsize length = 0;
    GError *error = NULL;
    if (!g_file_get_contents(path, &text, &length, &error)) {
        fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path, error->message);
        g_error_free(error);
        return STATUS_CANNOT_READ;
    }

    // what it says
    recipe_figure *fig = g_new0(recipe_figure, 1);
    fig->path = g_strdup(path);
    owned_figure_init(&fig->plot, NULL, FIGURE_PANELS);
    status code = recipe_read(&fig->recipe, path, text, length, report, context)
                      ? STATUS_OK
                      : STATUS_BAD_SCENARIO;
    g_free(text);

    // what it names
    for (int i = 0; i < fig->recipe.source_count && code == STATUS_OK; i++) {
        code = open_source(fig, i, f);
    }
    if (code != STATUS_OK) {
        release(fig);
        return code;
    }

    // what it shows
    describe(fig, o);
    *out = artwork_of_figure(&fig->plot.figure, fig, release);
    return STATUS_OK;
}

bool recipe_is(const char *path)
{
    gchar *text = NULL;
    gsize length = 0;
    if (!g_file_get_contents(path, &text, &length, NULL)) {
        return false;
    }

    // its faults are reported when it is opened
    fault unused = {0};
    tree_node *root = tree_parse(text, length, &unused);
    bool is = root != NULL && root->kind == TREE_MAP && recipe_child(root, "panels") != NULL;
    tree_free(root);
    g_free(text);
    return is;
}
