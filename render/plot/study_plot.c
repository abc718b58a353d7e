// Pictures of studies: sweeps and the comparison of laws.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/palette.h"
#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/base/shipped.h"
#include "src/tables/settings.h"

// ==== robust: the distribution of the overshoot

owned_figure *robust_figure_create(const robust_table *t, const char *changes)
{
    assert(t->count >= 1 && t->count <= ROBUST_MOST_CURVES);
    owned_figure *o = owned_figure_create(1, "%s: what the laws make of what they were not told%s",
                                          t->scenario, changes);

    // a curve for each law: of the same runs, run i of n, in the order of their overshoots, is at
    // (i + 1)/n
    for (int i = 0; i < t->count; i++) {
        const robust_law *law = &t->laws[i];
        double *share = owned_figure_numbers(o, law->runs);
        for (size_t k = 0; k < law->runs; k++) {
            share[k] = 100 * (double)(k + 1) / (double)law->runs;
        }
        const char *label = owned_figure_keep(o, text_escape(law->law));
        o->series[0][i] = (figure_series){law->law, label,     law->overshoots,
                                          share,    law->runs, .colour = palette_slot(i)};
    }
    o->panels[0].series_count = t->count;
    o->panels[0].weight = 2.4;
    o->panels[0].y = (figure_axis){"share", "Runs with at most this overshoot", .unit = "%",
                                   .low = 0, .high = 100};

    // the page
    o->figure.caption =
        owned_figure_printf(o, "%zu runs a law. Overshoot of the force: %s%s. impactlab %s.",
                            t->laws[0].runs, t->laws[0].overshoot_of,
                            t->laws[0].by_smoothed > 0 ? " (mean over 5 ms)" : "", lab_version());
    o->figure.x =
        (figure_axis){"overshoot", "Overshoot over the commanded force", .unit = "%", .room = 0.02};
    return o;
}

// ==== sweeps

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

// A picture in the making.
typedef struct sweep_drawing {
    owned_figure *drawn;
    varied varied[2];
} sweep_drawing;

static void *own(sweep_drawing *s, void *block)
{
    return owned_figure_keep(s->drawn, block);
}

// ---- axes

static int compare_values(const void *a, const void *b, void *context)
{
    const double *values = context, x = values[*(const size_t *)a], y = values[*(const size_t *)b];
    return (x > y) - (x < y);
}

// Sets the points of an axis in ascending order; words stay in theirs.
static void order_points(sweep_drawing *s, varied *v)
{
    const sweep_axis *axis = v->axis;
    v->count = axis->count;
    v->place = owned_figure_numbers(s->drawn, v->count);
    v->order = own(s, g_new(size_t, v->count));

    for (size_t i = 0; i < v->count; i++) {
        v->order[i] = i;
    }

    // numbers ascend
    if (!v->words) {
        g_qsort_with_data(v->order, (int)v->count, sizeof *v->order, compare_values, axis->values);
    }
    for (size_t i = 0; i < v->count; i++) {
        v->place[i] = v->words ? (double)i : axis->values[v->order[i]];
    }
}

// True for a few values that are spaced unevenly and have no long digits.
static bool points_are_good_ticks(const varied *v)
{
    const sweep_axis *axis = v->axis;
    bool good =
        (axis->logarithmic || !axis->is_range) && v->count > 0 && v->count <= LABELLED_VALUES;

    for (size_t i = 0; i < v->count && good; i++) {
        char digits[32];
        decimal_print(digits, sizeof digits, "%.3g", axis->values[i]);
        good = fabs(decimal_parse(digits, NULL) - axis->values[i]) <= 1e-9 * fabs(axis->values[i]);
    }
    return good;
}

static char *point_label(const varied *v, size_t i)
{
    char word[PARAMETER_TEXT_SIZE] = "";
    double value = v->axis->values[v->order[i]];
    if (!v->words) {
        return text_number(value, 6);
    }

    // a word of the parameter table
    sweep_axis_format(v->axis, value, word, sizeof word);
    return text_escape(word);
}

// A description's beginning as an axis' label, markup.
static char *label_of(sweep_drawing *s, const char *description)
{
    char *plain = text_label(description), *label = own(s, text_escape(plain));
    g_free(plain);
    return label;
}

// The axis of a varied parameter.
static figure_axis describe_axis(sweep_drawing *s, varied *v, const sweep_axis *axis)
{
    const parameter_info *info = sweep_axis_parameter(axis);
    *v = (varied){.axis = axis,
                  .words = info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN};

    figure_axis out = {own(s, g_strdup(axis->name)),
                       axis->element > 0 || info == &setting_info ? own(s, text_escape(axis->name))
                                                                  : label_of(s, info->description),
                       info->unit, .scale = axis->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR,
                       .room = DOTS_ROOM};

    // words are counted
    if (axis->values != NULL) {
        order_points(s, v);
    }
    if (v->words) {
        out.low = -0.5;
        out.high = (double)v->count - 0.5;
    }

    // ticks at the points themselves
    if (v->words || points_are_good_ticks(v)) {
        figure_tick *ticks = own(s, g_new0(figure_tick, v->count));
        for (size_t i = 0; i < v->count; i++) {
            ticks[i] = (figure_tick){v->place[i], own(s, point_label(v, i))};
        }
        out.ticks = ticks;
        out.tick_count = (int)v->count;
    }
    return out;
}

// Where a run's value lies on the axis.
static double place_of(const varied *v, double value)
{
    for (size_t i = 0; v->words && i < v->count; i++) {
        if (v->axis->values[i] == value) {
            return (double)i;
        }
    }
    return value;
}

// Places of all runs along an axis of drawn values.
static double *drawn_places(sweep_drawing *s, const sweep *from, int axis)
{
    double *places = owned_figure_numbers(s->drawn, from->run_count);
    for (size_t run = 0; run < from->run_count; run++) {
        places[run] = place_of(&s->varied[axis], sweep_value(from, run, axis));
    }
    return places;
}

static const summary_info *info_of(const sweep_picture *p)
{
    return p->info != NULL ? p->info : &summary_table[summary_index(p->key)];
}

// ---- layers

static double marker_radius(size_t points)
{
    return points > 500 ? 1.1 : points > 12 ? 1.9 : 2.4;
}

// One parameter: a curve; dots alone where nothing lies between the points.
static void describe_line(sweep_drawing *s, const sweep_picture *p)
{
    const sweep *from = p->sweep;
    const varied *v = &s->varied[0];
    size_t count = from->run_count;
    bool grid = from->sampling == SWEEP_GRID;

    double *y = owned_figure_numbers(s->drawn, count);
    for (size_t i = 0; i < count; i++) {
        y[i] = p->values[grid ? v->order[i] : i];
    }

    // one curve, or dots alone
    bool joined = grid && !v->words;
    s->drawn->series[0][0] =
        (figure_series){.name = p->key,
                        .x = grid ? v->place : drawn_places(s, from, 0),
                        .y = y,
                        .count = count,
                        .no_line = !joined,
                        .marker = joined && count > MOST_MARKERS ? MARKER_NONE : MARKER_CIRCLE,
                        .radius = marker_radius(count)};

    s->drawn->panels[0].series_count = 1;
}

// A parameter of words and one of numbers: a curve for each word, over the numbers.
static void describe_words(sweep_drawing *s, const sweep_picture *p, int words, int numbers)
{
    const varied *word = &s->varied[words], *number = &s->varied[numbers];
    size_t inner = s->varied[1].count;

    // a curve for each word
    for (size_t k = 0; k < word->count; k++) {
        double *y = owned_figure_numbers(s->drawn, number->count);
        for (size_t i = 0; i < number->count; i++) {
            size_t w = word->order[k], n = number->order[i];
            y[i] = p->values[words == 0 ? w * inner + n : n * inner + w];
        }
        s->drawn->series[0][k] = (figure_series){
            .name = own(s, point_label(word, k)),
            .label = own(s, point_label(word, k)),
            .x = number->place,
            .y = y,
            .count = number->count,
            .colour = palette_slot((int)k),
            .marker = number->count > MOST_MARKERS ? MARKER_NONE : MARKER_CIRCLE + k % 4,
            .radius = marker_radius(number->count)};
    }

    s->drawn->panels[0].series_count = (int)word->count;
}

// The axis of words that gives a curve each, -1 if the picture is a map.
static int axis_of_curves(const sweep_drawing *s, const sweep *from)
{
    for (int i = 0; i < 2 && from->sampling == SWEEP_GRID && from->axis_count == 2; i++) {
        if (s->varied[i].words && !s->varied[1 - i].words && s->varied[i].count <= MOST_CURVES) {
            return i;
        }
    }
    return -1;
}

// Two parameters: a map of every combination, or dots where they were drawn.
static void describe_map(sweep_drawing *s, const sweep_picture *p, figure_axis quantity)
{
    const sweep *from = p->sweep;
    const varied *x = &s->varied[0], *y = &s->varied[1];
    figure_colours *colours = own(s, g_new(figure_colours, 1));
    *colours = (figure_colours){.axis = quantity, .bar = true};
    s->drawn->panels[0].colours = colours;

    // values that were drawn are dots
    if (from->sampling != SWEEP_GRID) {
        s->drawn->series[0][0] = (figure_series){.name = p->key,
                                                 .x = drawn_places(s, from, 0),
                                                 .y = drawn_places(s, from, 1),
                                                 .shade = p->values,
                                                 .count = from->run_count,
                                                 .no_line = true,
                                                 .marker = MARKER_CIRCLE,
                                                 .radius = from->run_count > 1000  ? 1.5
                                                           : from->run_count > 200 ? 2.2
                                                                                   : 3.2};
        s->drawn->panels[0].series_count = 1;
        return;
    }

    // a grid is a map
    double *z = owned_figure_numbers(s->drawn, x->count * y->count);
    for (size_t i = 0; i < x->count; i++) {
        for (size_t j = 0; j < y->count; j++) {
            z[i * y->count + j] = p->values[x->order[i] * y->count + y->order[j]];
        }
    }

    figure_map *map = own(s, g_new(figure_map, 1));
    *map = (figure_map){x->place,         y->place, .columns = x->count,
                        .rows = y->count, .z = z,   .contours = !x->words && !y->words};
    s->drawn->panels[0].map = map;
    s->drawn->figure.x.room = s->drawn->panels[0].y.room = 0;
}

// ---- the picture

// What was varied, and how many runs have no value.
static char *caption_of(const sweep_picture *p, size_t missing)
{
    const sweep *s = p->sweep;
    GString *out = g_string_new("Varied: ");
    for (int i = 0; i < s->axis_count; i++) {
        text_append(out, "%s%s", i > 0 ? ", " : "", s->axes[i].name);
    }

    if (missing > 0) {
        text_append(out, "; %zu %s without a value%s", missing, missing == 1 ? "run" : "runs",
                    s->axis_count == 1          ? ""
                    : s->sampling == SWEEP_GRID ? " (hatched, or a gap)"
                                                : " (empty)");
    }

    text_append(out, ". impactlab %s.", lab_version());
    return g_string_free(out, FALSE);
}

static void describe(sweep_drawing *s, const sweep_picture *p)
{
    const sweep *from = p->sweep;
    size_t missing = 0;
    for (size_t i = 0; i < from->run_count; i++) {
        missing += !isfinite(p->values[i]);
    }

    // axes and layers
    figure_axis axes[2] = {describe_axis(s, &s->varied[0], &from->axes[0])};
    if (from->axis_count > 1) {
        axes[1] = describe_axis(s, &s->varied[1], &from->axes[1]);
    }
    int words = axis_of_curves(s, from);
    const summary_info *info = info_of(p);
    figure_axis quantity = {.name = p->key, .label = label_of(s, info->label), .unit = info->unit};
    s->drawn->figure.x = axes[words == 0];
    s->drawn->panels[0].y = quantity;
    s->drawn->panels[0].y.room = LINE_ROOM;
    if (from->axis_count == 1) {
        describe_line(s, p);
    } else if (words >= 0) {
        describe_words(s, p, words, 1 - words);
    } else {
        s->drawn->panels[0].y = axes[1];
        describe_map(s, p, quantity);
    }
    if (missing == from->run_count) {
        s->drawn->panels[0].remark = "the quantity did not occur in any run";
    }

    // the page
    figure *fig = &s->drawn->figure;
    fig->caption = own(s, caption_of(p, missing));
    s->drawn->panels[0].weight = PANEL_WEIGHT;

    // what was varied, as on the command line
    GString *command = g_string_new(NULL);
    for (int i = 0; i < from->axis_count; i++) {
        const sweep_axis *axis = &from->axes[i];
        text_append(command, "%s--vary %s%s=%s", i > 0 ? " " : "", axis->together ? "with " : "",
                    axis->name, axis->text);
    }
    fig->parameters = own(s, g_string_free(command, FALSE));
}

status sweep_plot_check(const sweep *s, const char *path, fault *f)
{
    FAIL_IF(s->axis_count > 2,
            fault_set(f, STATUS_BAD_ARGUMENT,
                      "--plot shows one or two varied parameters, but %d are varied",
                      s->axis_count));
    status code = picture_check_path(path, f);
    return code == STATUS_OK ? text_check_font(f) : code;
}

owned_figure *sweep_figure_create(const sweep_picture *p)
{
    static const char *const how[] = {
        [SWEEP_GRID] = "", [SWEEP_RANDOM] = " at random", [SWEEP_LATIN] = " of a Latin hypercube"};
    const sweep *from = p->sweep;
    char changes[SCENARIO_CHANGES];
    assert(from->axis_count >= 1 && from->axis_count <= 2);
    sweep_drawing s = {owned_figure_create(1, "%s: %s of %zu runs%s%s", from->base->name,
                                           info_of(p)->label, from->run_count, how[from->sampling],
                                           scenario_changes(from->base, changes))};
    describe(&s, p);
    return s.drawn;
}

// ==== tune: how the search went

owned_figure *tune_figure_create(const tuning *t, const char *changes)
{
    owned_figure *o = owned_figure_create(1, "%s: tuned%s", t->asked.base->name, changes);
    double *number = owned_figure_numbers(o, t->done), *value = owned_figure_numbers(o, t->done);
    double *least = owned_figure_numbers(o, t->done);
    for (size_t i = 0; i < t->done; i++) {
        number[i] = (double)i + 1;
        value[i] = t->ranks[i] < TUNE_REFUSED ? t->ranks[i] : (double)NAN;
        least[i] = i > 0 ? fmin(least[i - 1], value[i]) : value[i];
    }

    o->series[0][0] = (figure_series){.name = "value",
                                      .label = "an evaluation",
                                      .x = number,
                                      .y = value,
                                      .count = t->done,
                                      .no_line = true,
                                      .marker = MARKER_CIRCLE,
                                      .radius = marker_radius(t->done),
                                      .colour = palette_slot(0)};
    o->series[0][1] = (figure_series){"least",    "the least so far", .x = number,
                                      .y = least, .count = t->done,   .colour = palette_slot(1)};
    o->panels[0].series_count = 2;
    o->panels[0].weight = PANEL_WEIGHT;
    o->panels[0].y = (figure_axis){.name = "value",
                                   .label = owned_figure_keep(o, text_escape(t->asked.minimise)),
                                   .room = 0.05};
    o->figure.x = (figure_axis){.name = "evaluation", .label = "Evaluation", .room = 0.02};
    o->figure.caption = owned_figure_printf(
        o,
        "%zu evaluations of %zu runs. What fails, or is not allowed, has no point. impactlab %s.",
        t->done, t->each, lab_version());
    return o;
}
