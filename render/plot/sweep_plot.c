// Pictures of sweeps: lines, maps and dots over one or two varied parameters.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/base/shipped.h"
#include "src/tables/settings.h"

#define PANEL_WEIGHT 2.4  // of its height
#define DOTS_ROOM    0.03 // of an axis, free at both ends
#define LINE_ROOM    0.05 // of the quantity's range, free above and below it

enum { LABELLED_VALUES = 9, MOST_MARKERS = 80, MOST_CURVES = 16 };

// A varied parameter as an axis: where its points lie, in order.
typedef struct varied {
    const sweep_axis *axis;
    bool words;    // its points are counted
    double *place; // ascending, count of them; NULL if the values were drawn
    size_t *order; // place[i] belongs to value order[i] of the sweep's axis
    size_t count;
} varied;

// ---- what pictures of a sweep's numbers have in common with others

// The more points, the smaller each [pt].
double marker_radius(size_t points)
{
    if (points > 500) {
        return 1.1;
    }
    if (points > 12) {
        return 1.9;
    }
    return 2.4;
}

marker_kind marker_of(size_t points, size_t index)
{
    if (points > MOST_MARKERS) {
        return MARKER_NONE;
    }
    return MARKER_CIRCLE + index % 4;
}

figure_axis described_axis(owned_figure *o, const char *name, const char *description,
                           const char *unit)
{
    if (description == NULL) {
        return (figure_axis){name, owned_figure_keep(o, text_escape(name)), unit};
    }
    g_autofree char *label = text_label(description);
    return (figure_axis){name, owned_figure_keep(o, text_escape(label)), unit};
}

// The different values of a column, ascending. Returns their number.
static size_t different_values(const double *column, size_t count, double *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        out[i] = column[i];
    }
    qsort(out, count, sizeof *out, compare_numbers);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || out[i] != out[kept - 1]) {
            out[kept++] = out[i];
        }
    }
    return kept;
}

static size_t place_among(const double *values, size_t count, double value)
{
    const double *found = bsearch(&value, values, count, sizeof *values, compare_numbers);
    return (size_t)(found - values);
}

// The map of values over a grid: NULL where points fill less than half of it.
figure_map *figure_grid(owned_figure *o, const double *x, const double *y,
                        const double *z, size_t count)
{
    double *columns = owned_figure_numbers(o, count),
           *rows = owned_figure_numbers(o, count);
    figure_map *map = OWNED(o, figure_map, columns, rows, .contours = true,
                            .columns = different_values(x, count, columns),
                            .rows = different_values(y, count, rows));
    const size_t cells = map->columns * map->rows;
    if (cells > 2 * count) {
        return NULL;
    }

    // the map goes column by column; cells that no point fills keep no number
    double *values = owned_figure_numbers(o, cells);
    for (size_t i = 0; i < cells; i++) {
        values[i] = (double)NAN;
    }
    for (size_t i = 0; i < count; i++) {
        size_t column = place_among(map->x, map->columns, x[i]);
        values[column * map->rows + place_among(map->y, map->rows, y[i])] = z[i];
    }
    map->z = values;
    return map;
}

// ---- axes

static int compare_values(const void *a, const void *b, void *context)
{
    const double *values = context, x = values[*(const size_t *)a],
                 y = values[*(const size_t *)b];
    return (x > y) - (x < y);
}

// Sets the points of an axis in ascending order; words stay in theirs.
static void order_points(owned_figure *o, varied *v)
{
    const sweep_axis *axis = v->axis;
    v->count = axis->count;
    v->place = owned_figure_numbers(o, v->count);
    v->order = owned_figure_keep(o, g_new(size_t, v->count));
    for (size_t i = 0; i < v->count; i++) {
        v->order[i] = i;
    }

    // numbers ascend
    double *values = owned_figure_numbers(o, v->count);
    for (size_t i = 0; i < v->count; i++) {
        values[i] = v->words ? (double)i : sweep_axis_value(axis, i);
    }
    g_qsort_with_data(v->order, (int)v->count, sizeof *v->order, compare_values, values);
    for (size_t i = 0; i < v->count; i++) {
        v->place[i] = values[v->order[i]];
    }
}

// True for a few values that are spaced unevenly and have no long digits.
static bool points_are_good_ticks(const varied *v)
{
    const sweep_axis *axis = v->axis;
    bool good = (axis->logarithmic || !axis->is_range) && v->count > 0 &&
                v->count <= LABELLED_VALUES;

    for (size_t i = 0; i < v->count && good; i++) {
        char digits[32];
        const double value = sweep_axis_value(axis, i);
        decimal_print(digits, sizeof digits, "%.3g", value);
        good = fabs(decimal_parse(digits, NULL) - value) <= 1e-9 * fabs(value);
    }
    return good;
}

static const char *point_label(owned_figure *o, const varied *v, size_t i)
{
    char word[PARAMETER_TEXT_SIZE] = "";
    const double value = sweep_axis_value(v->axis, v->order[i]);
    if (!v->words) {
        return owned_figure_keep(o, text_number(value, 6));
    }

    // a word of the parameter table
    sweep_axis_format(v->axis, value, word, sizeof word);
    return owned_figure_keep(o, text_escape(word));
}

void axis_name_shortly(owned_figure *o, figure_axis *a, const char *symbol)
{
    if (symbol == NULL) {
        a->symbol = owned_figure_keep(o, text_escape(a->name));
        return;
    }
    char *markup = owned_figure_keep(o, text_symbol(symbol));
    a->symbol = markup;
    a->label = owned_figure_printf(o, "%s %s", a->label, markup);
}

// The axis of a varied parameter.
static figure_axis varied_axis(owned_figure *o, varied *v, const sweep_axis *axis)
{
    const parameter_info *info = sweep_axis_parameter(axis);
    const bool words = info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN;
    *v = (varied){.axis = axis, .words = words};

    // elements of vectors and settings of a law go by their own names
    const char *description = info->description;
    if (axis->element > 0 || info == &setting_info) {
        description = NULL;
    }
    figure_axis out = described_axis(o, axis->name, description, info->unit);
    axis_name_shortly(o, &out, info->symbol);
    if (axis->logarithmic) {
        out.scale = SCALE_LOGARITHMIC;
    }
    out.room = DOTS_ROOM;

    // words are counted
    if (axis->count > 0) {
        order_points(o, v);
    }
    if (v->words) {
        out.low = -0.5;
        out.high = (double)v->count - 0.5;
    }

    // ticks at the points themselves
    if (v->words || points_are_good_ticks(v)) {
        figure_tick *ticks = owned_figure_keep(o, g_new0(figure_tick, v->count));
        for (size_t i = 0; i < v->count; i++) {
            ticks[i] = (figure_tick){v->place[i], point_label(o, v, i)};
        }
        out.ticks = ticks;
        out.tick_count = (int)v->count;
    }
    return out;
}

// Where a run's value lies on the axis.
static double place_on_axis(const varied *v, double value)
{
    for (size_t i = 0; v->words && i < v->count; i++) {
        if (sweep_axis_value(v->axis, i) == value) {
            return (double)i;
        }
    }
    return value;
}

// Places of all runs along an axis.
static double *run_places(owned_figure *o, const sweep *from, const varied *v, int axis)
{
    double *places = owned_figure_numbers(o, from->run_count);
    for (size_t run = 0; run < from->run_count; run++) {
        places[run] = place_on_axis(v, sweep_value(from, run, axis));
    }
    return places;
}

// ---- layers

// One parameter: a curve; dots alone where nothing lies between the points.
static void describe_line(owned_figure *o, const sweep_picture *p, const varied *v)
{
    const size_t count = p->sweep->run_count;
    figure_series s = {p->key, .count = count, .radius = marker_radius(count)};

    // dots where values were drawn at random
    if (p->sweep->sampling != SWEEP_GRID) {
        s.x = run_places(o, p->sweep, v, 0);
        s.y = p->values;
        s.no_line = true;
        s.marker = MARKER_CIRCLE;
        owned_figure_add(o, 0, s);
        return;
    }

    // points of a grid in ascending order
    double *y = owned_figure_numbers(o, count);
    for (size_t i = 0; i < count; i++) {
        y[i] = p->values[v->order[i]];
    }
    s.x = v->place;
    s.y = y;
    s.no_line = v->words;
    s.marker = MARKER_CIRCLE;
    if (!v->words) {
        s.marker = marker_of(count, 0);
    }
    owned_figure_add(o, 0, s);
}

// Describes a sweep over a parameter of words and one of numbers: a curve for each word,
// over the numbers.
static void describe_words(owned_figure *o, const sweep_picture *p, const varied *both,
                           int words)
{
    const varied *word = &both[words], *number = &both[1 - words];
    const size_t count = number->count;

    // the index of a run is (point of the first axis) count of the second + (point of the
    // second): the distances of neighbours along each axis
    size_t word_step = 1, number_step = 1;
    if (words == 0) {
        word_step = number->count;
    } else {
        number_step = word->count;
    }
    for (size_t k = 0; k < word->count; k++) {
        double *y = owned_figure_numbers(o, count);
        for (size_t i = 0; i < count; i++) {
            y[i] = p->values[word->order[k] * word_step + number->order[i] * number_step];
        }
        const char *name = point_label(o, word, k);
        owned_figure_add(o, 0,
                         (figure_series){name, name, number->place, y, count,
                                         .colour = palette_slot((int)k),
                                         .radius = marker_radius(count),
                                         .marker = marker_of(count, k)});
    }
}

// The index of the axis of words that get a curve each; -1 if the picture is a map.
static int axis_of_curves(const varied *both, const sweep *from)
{
    for (int i = 0; i < 2 && from->sampling == SWEEP_GRID && from->axis_count == 2; i++) {
        if (both[i].words && !both[1 - i].words && both[i].count <= MOST_CURVES) {
            return i;
        }
    }
    return -1;
}

// The radius of shaded dots, smaller where they are many [pt].
static double dot_radius(size_t dots)
{
    if (dots > 1000) {
        return 1.5;
    }
    if (dots > 200) {
        return 2.2;
    }
    return 3.2;
}

// Describes a sweep over two parameters: a map of all combinations of a grid, or shaded
// dots where values were drawn at random.
static void describe_map(owned_figure *o, const sweep_picture *p, const varied *both,
                         figure_axis quantity)
{
    const size_t count = p->sweep->run_count;
    const double *x = run_places(o, p->sweep, &both[0], 0);
    const double *y = run_places(o, p->sweep, &both[1], 1);
    o->panels[0].colours = OWNED(o, figure_colours, .axis = quantity, .bar = true);
    if (p->sweep->sampling != SWEEP_GRID) {
        owned_figure_add(o, 0,
                         (figure_series){p->key, NULL, x, y, count, .shade = p->values,
                                         .no_line = true, .marker = MARKER_CIRCLE,
                                         .radius = dot_radius(count)});
        return;
    }
    figure_map *map = figure_grid(o, x, y, p->values, count);
    map->contours = !both[0].words && !both[1].words;
    o->panels[0].map = map;
    o->figure.x.room = o->panels[0].y.room = 0;
}

// ---- the picture

// What was varied, and how many runs have no value.
static char *caption_of(const sweep *s, size_t missing)
{
    g_autofree char *name = text_escape(s->base->name);
    GString *out = g_string_new(name);
    g_string_append(out, ", varied: ");
    for (int i = 0; i < s->axis_count; i++) {
        const char *symbol = sweep_axis_parameter(&s->axes[i])->symbol;
        text_append(out, "%s%s", i > 0 ? ", " : "", s->axes[i].name);
        if (symbol != NULL) {
            g_autofree char *markup = text_symbol(symbol);
            text_append(out, " (%s)", markup);
        }
    }
    if (missing > 0) {
        const char *runs = missing == 1 ? "run" : "runs";
        text_append(out, "; %zu %s without a value", missing, runs);
    }

    // how they look on a map, and among dots
    if (missing > 0 && s->axis_count > 1 && s->sampling == SWEEP_GRID) {
        text_append(out, " (hatched, or a gap)");
    } else if (missing > 0 && s->axis_count > 1) {
        text_append(out, " (empty)");
    }
    text_append(out, ". impactlab %s.", lab_version());
    return g_string_free(out, FALSE);
}

// What was varied, as on the command line.
static char *command_of(const sweep *s)
{
    GString *command = g_string_new(NULL);
    for (int i = 0; i < s->axis_count; i++) {
        const sweep_axis *axis = &s->axes[i];
        const char *with = axis->together ? "with " : "";
        text_append(command, "%s--vary %s%s=%s", i > 0 ? " " : "", with, axis->name,
                    axis->text);
    }
    return g_string_free(command, FALSE);
}

status sweep_plot_check(const sweep *s, const char *path, fault *f)
{
    FAULT_IF(s->axis_count > 2, f, STATUS_BAD_ARGUMENT,
             "--plot shows one or two varied parameters, but %d are varied",
             s->axis_count);
    TRY(picture_check_path(path, f));
    return text_check_font(f);
}

// Runs in which the quantity did not occur.
static size_t count_missing(const sweep_picture *p)
{
    size_t missing = 0;
    for (size_t i = 0; i < p->sweep->run_count; i++) {
        if (!isfinite(p->values[i])) {
            missing++;
        }
    }
    return missing;
}

// One parameter: the quantity over it.
static void describe_one_parameter(owned_figure *o, const sweep_picture *p,
                                   figure_axis quantity)
{
    varied parameter;
    o->figure.x = varied_axis(o, &parameter, &p->sweep->axes[0]);
    o->panels[0].y = quantity;
    o->panels[0].y.room = LINE_ROOM;
    describe_line(o, p, &parameter);
}

// Two parameters: a curve for each word of one of them, or a map.
static void describe_two_parameters(owned_figure *o, const sweep_picture *p,
                                    figure_axis quantity)
{
    varied both[2];
    const figure_axis first = varied_axis(o, &both[0], &p->sweep->axes[0]);
    const figure_axis second = varied_axis(o, &both[1], &p->sweep->axes[1]);
    const int words = axis_of_curves(both, p->sweep);
    if (words < 0) {
        o->figure.x = first;
        o->panels[0].y = second;
        describe_map(o, p, both, quantity);
        return;
    }

    // over the parameter of numbers
    o->figure.x = first;
    if (words == 0) {
        o->figure.x = second;
    }
    o->panels[0].y = quantity;
    o->panels[0].y.room = LINE_ROOM;
    describe_words(o, p, both, words);
}

// A title with quantity and runs, axes of what was varied, and the runs' values.
owned_figure *sweep_figure_create(const sweep_picture *p)
{
    static const char *const sampled[] = {[SWEEP_GRID] = "",
                                          [SWEEP_RANDOM] = " at random",
                                          [SWEEP_LATIN] = " of a Latin hypercube"};
    const sweep *from = p->sweep;
    assert(from->axis_count >= 1 && from->axis_count <= 2);

    // the quantity and what was run
    const summary_info *info = p->info;
    if (info == NULL) {
        info = &summary_table[summary_index(p->key)];
    }
    char changes[SCENARIO_CHANGES];
    g_autofree char *quantity_name = text_label(info->label);
    owned_figure *o = owned_figure_create(1, "%s of %zu runs%s%s", quantity_name,
                                          from->run_count, sampled[from->sampling],
                                          scenario_changes(from->base, changes));

    // axes and layers
    const figure_axis quantity = described_axis(o, p->key, info->label, info->unit);
    if (from->axis_count == 1) {
        describe_one_parameter(o, p, quantity);
    } else {
        describe_two_parameters(o, p, quantity);
    }

    // the page
    const size_t missing = count_missing(p);
    if (missing == from->run_count) {
        o->panels[0].remark = "the quantity did not occur in any run";
    }
    o->panels[0].weight = PANEL_WEIGHT;
    o->figure.caption = owned_figure_keep(o, caption_of(from, missing));
    o->figure.parameters = owned_figure_keep(o, command_of(from));
    return o;
}
