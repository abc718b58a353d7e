// The pages of runs: those that are pinned, and two of them in numbers.
#include "ui/explorer/panels/panel.h"

#include <math.h>

enum { SAMPLE = 4, PEAK = 10 }; // columns of a line's sample and of a peak [cells]

// --- the page --------------------------------------------------------------------------
// The page of pinned runs: what differs, and what can be done with them.

// Columns of a line [cells]: number, sample, name, peak, differences.
enum { SAMPLE_AT = 3, NAME_AT = 8, NAME_WIDTH = 30, NARROW_NAME_WIDTH = 20 };

// A pinned run: its number, line, name, peak, and what differs from the present one.
static void draw_pinned(const explorer_model *model, screen *s, area a, int index)
{
    const pinned_run *p = &model->pinned.runs[index];
    const int name_width = a.width >= 80 ? NAME_WIDTH : NARROW_NAME_WIDTH;
    const char *mark = index == model->pinned.baseline ? "\u25b8" : " ";
    const shown_run run = {.kind = SHOWN_PINNED, .index = index};
    unsigned pattern = 0;
    ink name_ink = INK_DIM;
    if (!p->hidden) {
        pattern = style_pattern(LINE_SOLID);
        name_ink = INK_TITLE;
    }
    screen_print(s, a.x, a.y, SAMPLE_AT, INK_DIM, "%s%d", mark, index + 1);
    draw_line_sample(s, a.x + SAMPLE_AT, a.y, SAMPLE, pattern,
                     run_ink(shown_run_rank(&run)));
    screen_words(s, a.x + NAME_AT, a.y, name_width - 1, name_ink, p->name);

    // behind the name
    const area rest = area_right(a, NAME_AT + name_width);
    char differences[LINE_TEXT];
    run_list_differences(p, &model->session, differences, sizeof differences);
    screen_print(s, rest.x, a.y, PEAK, INK_FORCE, "%7s N",
                 draw_number(p->run.summary.peak_force_N).text);
    area_words(s, area_right(rest, PEAK), INK_TEXT, differences);
}

// What they stand beside, and the keys.
static void draw_pinned_edges(const explorer_model *model, screen *s, area a)
{
    const char *keys = "none yet: b pins the run there is, then change something";
    if (model->pinned.count > 0) {
        keys = "Enter takes it, Space hides, = compares, r renames, d drops, D subtracts";
    }
    area_print(s, area_row(a, 0), INK_DIM, "this run peaks at %.4g N; beside it:",
               model->session.run.summary.peak_force_N);
    area_text(s, area_row(a, a.height - 1), INK_DIM, keys);
}

// How many runs are pinned.
static int pinned_count(const explorer_model *model)
{
    return model->pinned.count;
}

static int selected_run(const explorer_model *model, const explorer_view *view)
{
    (void)view;
    return model->pinned.selected;
}

static void select_run(explorer_model *model, explorer_view *view, int index)
{
    (void)view;
    model->pinned.selected = index;
}

// What a key does with the selected run; any other closes the page.
static bool press_pinned_key(explorer_model *model, explorer_view *view,
                             explorer_input *input, int key, int index)
{
    switch (key) {
    case ' ':
        act_hide_run(model, index);
        return true;
    case '=':
        return act_compare_with(model, input, index);
    case 'r':
        act_ask_run_name(model, input, index);
        return true;
    case 'd':
    case 'x':
    case KEY_CODE_DELETE:
        return act_drop_run(model, input, index);
    case KEY_CODE_ENTER:
        view->page = PANEL_NONE;
        return act_take_run(model, view, input, index);
    case 'D':
        view->page = PANEL_NONE;
        return act_difference(model, view, input, "");
    default:
        view->page = PANEL_NONE;
        return true;
    }
}

static const page_list pinned_list = {.title = "pinned runs (Esc closes)",
                                      .most_width = 100,
                                      .head = 1,
                                      .foot = 2,
                                      .needs_lines = true,
                                      .count = pinned_count,
                                      .selected = selected_run,
                                      .select = select_run,
                                      .draw_line = draw_pinned,
                                      .draw_edges = draw_pinned_edges,
                                      .press_key = press_pinned_key};

const panel run_list_panel = {.name = "run list", .list = &pinned_list};

// --- the comparison --------------------------------------------------------------------

// A quantity of the summary in this run and in the other one.
typedef struct compared {
    double value, other; // NaN without the other run
    bool means_anything; // in either run
    bool differs;
} compared;

// Compares the quantity of the summary with that index.
static compared compare_quantity(const session *e, int index)
{
    compared c = {.value = summary_value(&e->run.summary, index), .other = (double)NAN};
    if (e->has_other) {
        c.other = summary_value(&e->other.summary, index);
    }
    const bool has_value = !isnan(c.value) || !isnan(c.other);
    c.means_anything = has_value && !summary_table[index].timing;

    // smaller differences are rounding, of numbers near zero too
    const double rounding = 1e-9 + 1e-6 * fmax(fabs(c.value), fabs(c.other));
    const bool alike = fabs(c.value - c.other) <= rounding;
    c.differs = e->has_other && has_value && !alike;
    return c;
}

// How the comparison is laid out: a narrow screen has the name and the numbers below each
// other.
typedef struct comparison_layout {
    int rows;    // of a quantity
    int numbers; // column of the first number, behind the names or below them [cells]
    int width;   // of a number [cells]
} comparison_layout;

// The layout on a screen of this width [cells].
static comparison_layout comparison_layout_for(int screen_width)
{
    enum { NAMES = 30, NUMBER = 12, NARROW_NUMBER = 11 };
    if (screen_width - 6 < NAMES + 3 * NUMBER) {
        return (comparison_layout){.rows = 2, .numbers = 0, .width = NARROW_NUMBER};
    }
    return (comparison_layout){.rows = 1, .numbers = NAMES, .width = NUMBER};
}

// The names of the columns.
static void draw_comparison_head(const explorer_model *model, screen *s, area line,
                                 const comparison_layout *form)
{
    const area now = area_right(line, form->numbers);
    area_print(s, now, INK_DIM, "%*s", form->width, "now");
    if (model->session.has_other) {
        // under the name that the strip of results has
        const area other = area_right(now, form->width + 1);
        screen_words(s, other.x, other.y, form->width - 1, INK_DIM,
                     model_reference_name(model));
        screen_print(s, other.x + form->width - 1, other.y, form->width, INK_DIM, "%*s",
                     form->width, "change");
    }
}

// The numbers of a quantity; a single run has no change.
static void draw_compared(const session *e, screen *s, area line, compared c, ink colour,
                          int width)
{
    char columns[128];
    snprintf(columns, sizeof columns, "%*s", width, draw_number(c.value).text);
    if (e->has_other) {
        const double change = c.differs ? c.value - c.other : (double)NAN;
        text_add(columns, sizeof columns, "%*s%*s", width, draw_number(c.other).text,
                 width, draw_number(change).text);
    } else {
        text_add(columns, sizeof columns, "%*s", 2 * width, "");
    }
    area_text(s, line, colour, columns);
}

// The name of a quantity with its unit.
static void draw_summary_name(screen *s, area line, const summary_info *info, ink colour)
{
    if (info->unit[0] != '\0') {
        area_print(s, line, colour, "%s [%s]", info->label, info->unit);
    } else {
        area_text(s, line, colour, info->label);
    }
}

// The quantities that mean anything, from the row on to which the page is scrolled.
static void draw_quantities(const session *e, screen *s, area a,
                            const comparison_layout *form, int scroll)
{
    int row = -scroll;
    for (int i = 0; i < summary_count; i++) {
        const compared c = compare_quantity(e, i);
        if (!c.means_anything) {
            continue;
        }
        const ink colour = c.differs || !e->has_other ? INK_TEXT : INK_DIM;
        const int numbers_row = row + form->rows - 1;
        if (row >= 0 && row < a.height) {
            draw_summary_name(s, area_row(a, row), &summary_table[i], colour);
        }
        if (numbers_row >= 0 && numbers_row < a.height) {
            const area line = area_right(area_row(a, numbers_row), form->numbers);
            draw_compared(e, s, line, c, colour, form->width);
        }
        row += form->rows;
    }
}

// The page that compares the numbers of this run with those of the baseline.
static void draw_comparison(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area body)
{
    (void)view;
    enum { EDGES = 3 }; // the frame, and the names of the columns
    const session *e = &model->session;
    const comparison_layout form = comparison_layout_for(s->width);
    int count = 0;
    for (int i = 0; i < summary_count; i++) {
        if (compare_quantity(e, i).means_anything) {
            count++;
        }
    }

    // the page, scrolled by rows
    const int all = form.rows * count;
    const area a = page_area(body, form.numbers + 3 * form.width + 4, all + EDGES);
    const int scroll = page_scroll(lay, PANEL_COMPARISON, a, all, EDGES);
    int end = scroll + a.height - EDGES;
    if (end > all) {
        end = all;
    }
    const char *title = "this run (b branches, Esc closes)";
    if (e->has_other) {
        title = "two runs (Esc closes)";
    }
    draw_page_frame(s, a, title, end / form.rows, count);

    const area inside = area_inside(a);
    draw_comparison_head(model, s, area_row(inside, 0), &form);
    draw_quantities(e, s, area_below(inside, 1), &form, scroll);
}

const panel comparison_panel = {.name = "comparison",
                                .draw = draw_comparison,
                                .key = page_key};
