// The strip of results below the title: what each run comes to, how far that is from the
// run that it is held against, and why it comes out so.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

// --- columns ---------------------------------------------------------------------------

enum {
    NAME = 16,        // cells of a run's name and its line, on a screen of 80 columns
    MOST_NAME = 30,   // the same where there is plenty of room
    SAMPLE = 2,       // cells of its line
    NUMBER = 8,       // cells of a number and the blank behind it
    CHANGE = 9,       // of how far it is from the reference
    MOST_COLUMNS = 8, // besides the name
    MOST_RUNS = 2 + PINNED_RUNS
};

// A quantity of the summary in a column.
typedef struct result_column {
    char heading[40];
    int quantity;
    bool asked;      // a sweep or a limit is about it
    bool has_change; // how far it is from the reference stands behind it
    int width;       // of all that [cells]
} result_column;

// The columns of the strip from left to right.
typedef struct result_columns {
    result_column column[MOST_COLUMNS];
    int count;
} result_columns;

// Adds a column, unless its quantity has one already or there is no room.
static void add_column(result_columns *all, int *room, int quantity, const char *heading,
                       bool has_change)
{
    result_column c = {.quantity = quantity, .has_change = has_change};
    for (int i = 0; i < all->count; i++) {
        if (all->column[i].quantity == quantity) {
            return;
        }
    }
    snprintf(c.heading, sizeof c.heading, "%s", heading);
    c.width = has_change ? NUMBER + CHANGE : NUMBER;
    if (text_cells(heading) >= c.width) {
        c.width = text_cells(heading) + 1;
    }
    if (c.width <= *room) {
        *room -= c.width;
        all->column[all->count++] = c;
    }
}

// Adds the largest force that means something for the arm: a chain on a rigid wall
// presses the harder the finer it is, and only what a sensor reads has a limit then.
static void add_peak(result_columns *all, int *room, const parameters *p)
{
    if (p->arm.links > 2 && p->wall.contact == WALL_RIGID) {
        add_column(all, room, SUMMARY_INDEX(sensor_1ms_peak_N), "peak N of 1 ms", true);
    } else {
        add_column(all, room, SUMMARY_INDEX(peak_force_N), "peak N", true);
    }
}

// The quantity that is asked for by a sweep, else by the last limit; -1 for none.
static int asked_quantity(const explorer_model *model)
{
    if (lab_sweep_is_on(&model->sweep)) {
        return model->sweep.metric;
    }
    return model->limit.quantity;
}

// The columns for a strip of this width, those that tell most first.
static result_columns choose_columns(const explorer_model *model, int room)
{
    result_columns all = {.count = 0};
    add_peak(&all, &room, &model->session.effective.parameters);
    add_column(&all, &room, SUMMARY_INDEX(contact_impulse_Ns), "impulse N s", true);

    // what was asked for
    const int asked = asked_quantity(model);
    if (asked >= 0) {
        char heading[40];
        const summary_info *info = &summary_table[asked];
        snprintf(heading, sizeof heading, "%s %s", info->label, info->unit);
        add_column(&all, &room, asked, heading, false);
    }

    // how the contact goes on
    add_column(&all, &room, SUMMARY_INDEX(steady_force_N), "steady N", false);
    if (model_has_law(model)) {
        add_column(&all, &room, SUMMARY_INDEX(force_overshoot_percent), "over %", false);
        add_column(&all, &room, SUMMARY_INDEX(settling_time_s), "settled s", false);
    }
    add_column(&all, &room, SUMMARY_INDEX(separations), "bounces", false);

    // the changes of others where there is room left
    for (int i = 0; i < all.count; i++) {
        result_column *c = &all.column[i];
        c->asked = c->quantity == asked;
        if (!c->has_change && room >= CHANGE) {
            c->has_change = true;
            c->width += CHANGE;
            room -= CHANGE;
        }
    }
    return all;
}

// --- runs ------------------------------------------------------------------------------

// A run of the strip.
typedef struct result_run {
    const char *name;
    const summary *summary;
    int rank;       // among the looks of runs
    int pinned;     // index of a pinned run, -1 of others
    bool reference; // the others are held against it
} result_run;

// The runs in the order in which they are listed, the present one and the reference
// first, in one row as long as both are the same; returns how many.
static int list_runs(const explorer_model *model, result_run runs[MOST_RUNS])
{
    const session *s = &model->session;
    const run_list *pins = &model->pinned;
    const reference_run *o = &model->opened_run;
    const int baseline = s->has_other ? pins->baseline : -1;
    int count = 0;
    const pinned_run *same = model_kept_run(model);
    const char *name = same != NULL ? same->name : "";
    runs[count++] = (result_run){name, &s->run.summary, 1, -1, same != NULL};
    if (baseline >= 0 && same == NULL) {
        const pinned_run *p = &pins->runs[baseline];
        runs[count++] = (result_run){p->name, &p->run.summary,
                                     model_reference_rank(model), baseline, true};
    }
    if (o->shown) {
        runs[count++] = (result_run){AS_OPENED, &o->run.summary, 2, -1, baseline < 0};
    }
    for (int i = 0; i < pins->count; i++) {
        const shown_run pinned = {.kind = SHOWN_PINNED, .index = i};
        const pinned_run *p = &pins->runs[i];
        if (i != baseline) {
            runs[count++] =
                (result_run){p->name, &p->run.summary, shown_run_rank(&pinned), i, false};
        }
    }
    return count;
}

// How far a quantity is from the reference's, with as many digits as a blank behind it
// leaves room for; "" where that is nothing or unknown.
static void write_change(double value, double reference, char text[24])
{
    const double change = value - reference;
    const double rounding = 1e-9 + 1e-6 * fmax(fabs(value), fabs(reference));
    text[0] = '\0';
    if (!(fabs(change) > rounding)) {
        return;
    }
    for (int digits = 3; digits > 0; digits--) {
        if (snprintf(text, 24, "%+.*g", digits, change) < CHANGE) {
            return;
        }
    }
}

// A number of a run in its column, and behind it how far it is from the reference.
static void draw_result(screen *s, area a, const result_column *c, const result_run *run,
                        const summary *reference)
{
    const double value = summary_value(run->summary, c->quantity);
    area_text(s, a, c->asked ? INK_TITLE : INK_TEXT, draw_number(value).text);
    if (!c->has_change || reference == NULL || run->reference) {
        return;
    }
    char change[24];
    write_change(value, summary_value(reference, c->quantity), change);
    area_text(s, area_right(a, NUMBER), INK_EVENT, change);
}

// The numbers of a run in their columns.
static void draw_numbers(screen *s, area line, const result_columns *columns,
                         const result_run *run, const summary *reference)
{
    if (run->reference) {
        area_text(s, area_right(line, NUMBER), INK_DIM, "ref");
    }
    for (int i = 0; i < columns->count; i++) {
        const result_column *c = &columns->column[i];
        draw_result(s, (area){line.x, line.y, c->width, 1}, c, run, reference);
        line = area_right(line, c->width);
    }
}

// The name of a run with the colour that its curves have; of a hidden one without.
static void draw_name(const explorer_model *model, screen *s, area line,
                      const result_run *run)
{
    char name[RUN_NAME];
    const bool hidden = run->pinned >= 0 && model->pinned.runs[run->pinned].hidden;
    snprintf(name, sizeof name, "%s", run->name);
    if (run->name[0] == '\0') {
        run_list_describe(&model->session, name, sizeof name);
    }
    for (int i = 0; i < SAMPLE && model_shows_others(model) && !hidden; i++) {
        screen_put(s, line.x + i, line.y, GLYPH_THICK_LINE, run_ink(run->rank));
    }
    screen_words(s, line.x + SAMPLE + 1, line.y, line.width - SAMPLE - 2,
                 hidden ? INK_DIM : INK_TEXT, name);
}

// --- the strip -------------------------------------------------------------------------

// How many rows the runs and measured data want. The reference has one before there is a
// change, too, so that a change moves nothing else.
static int rows_of_runs(const explorer_model *model)
{
    result_run runs[MOST_RUNS];
    int count = list_runs(model, runs);
    if (model_kept_run(model) != NULL) {
        count++;
    }
    if (model->measured.row_count > 0) {
        count++;
    }
    return count > 2 ? count : 2;
}

// The heading, the runs and why; a quarter of the screen at most, a little more of a tall
// one. Beside a lesson numbers are enough.
static int results_rows(const explorer_model *model, const explorer_view *view,
                        screen_size body)
{
    (void)view;
    enum { LEAST = 2, LEAST_IN_LESSON = 3, TALL = 30 };
    const bool tall = body.height >= TALL;
    int most = body.height / 4 + (tall ? 1 : 0);
    if (most < LEAST) {
        most = LEAST;
    }
    if (model->lesson.on && !tall && most > LEAST_IN_LESSON) {
        most = LEAST_IN_LESSON;
    }
    const int wanted = 1 + rows_of_runs(model) + 1;
    return wanted < most ? wanted : most;
}

// The cells of a name: half of what a screen has beyond 80 columns is for it.
static int width_of_name(int screen_width)
{
    enum { COLUMNS = 80 };
    const int width = NAME + (screen_width - COLUMNS) / 2;
    if (width < NAME) {
        return NAME;
    }
    return width < MOST_NAME ? width : MOST_NAME;
}

// The headings, and how many runs have no row.
static void draw_headings(screen *s, area line, int name, const result_columns *columns,
                          int left_out)
{
    if (left_out > 0) {
        area_print(s, line, INK_DIM, "run, %d more: R", left_out);
    } else {
        area_text(s, line, INK_DIM, "run");
    }
    line = area_right(line, name);
    for (int i = 0; i < columns->count; i++) {
        const result_column *c = &columns->column[i];
        area_text(s, line, c->asked ? INK_TITLE : INK_DIM, c->heading);
        line = area_right(line, c->width);
    }
}

// The account of the present run in a few rows; it is written once for each run.
static void draw_why(const explorer_model *model, layout *lay, screen *s, area a)
{
    enum { MOST = 2, LABEL = 8 };
    const session *e = &model->session;
    account_line *known = &lay->account;
    const bool whole = e->computing == NULL;
    if (known->run != model_run_id(model) || known->rows != e->run.trace.row_count ||
        known->whole != whole) {
        known->run = model_run_id(model);
        known->rows = e->run.trace.row_count;
        known->whole = whole;
        run_account_line(&e->run, known->text);
    }

    // the last row says if words are left out
    text_line lines[MOST];
    const area words = area_right(a, LABEL);
    area_text(s, a, INK_DIM, "why (W)");
    const int count = text_wrap(known->text, words.width, lines, MOST, NULL);
    if (a.height >= count) {
        area_lines(s, words, INK_TEXT, lines, count);
    } else {
        area_words(s, words, INK_TEXT, known->text);
    }
}

// The name of the file with measured data and the mark of its curves.
static void draw_measured(const explorer_model *model, screen *s, area line)
{
    for (int i = 0; i < SAMPLE; i++) {
        screen_put(s, line.x + i, line.y, GLYPH_MEASURED, INK_TEXT);
    }
    screen_words(s, line.x + SAMPLE + 1, line.y, line.width - SAMPLE - 2, INK_TEXT,
                 scenario_leaf(model->measured_file));
}

static void draw_results(const explorer_model *model, const explorer_view *view,
                         layout *lay, screen *s, area a)
{
    (void)view;
    result_run runs[MOST_RUNS];
    const int count = list_runs(model, runs);
    const int name = width_of_name(a.width);
    const area lines = {a.x + 1, a.y, a.width - 2, a.height};
    const result_columns columns = choose_columns(model, lines.width - name);

    // the first two rows are the runs', the third tells why, and of more one is that of
    // measured data
    enum { FOR_RUNS = 2 };
    int rows = a.height - 1;
    if (rows > FOR_RUNS) {
        rows--;
    }
    const bool has_data = model->measured.row_count > 0 && rows > 1;
    if (has_data) {
        rows--;
    }

    // what the others are held against
    const summary *reference = NULL;
    if (model->session.has_other) {
        reference = &model->session.other.summary;
    }
    draw_headings(s, area_row(lines, 0), name, &columns, count - rows);
    int row = 1;
    for (int i = 0; i < count && i < rows; i++, row++) {
        const area line = area_row(lines, row);
        draw_name(model, s, (area){line.x, line.y, name, 1}, &runs[i]);
        draw_numbers(s, area_right(line, name), &columns, &runs[i], reference);
        if (runs[i].pinned >= 0) {
            layout_add_hit(lay,
                           (hit_area){PANEL_RESULTS, PART_LINES, runs[i].pinned, line});
        }
    }
    if (has_data) {
        draw_measured(model, s, area_row(lines, row++));
    }
    if (row < a.height) {
        draw_why(model, lay, s, area_below(lines, row));
    }
}

// A click on a pinned run hides its curves or shows them. The run may be gone since the
// strip was drawn.
static bool point_at_results(explorer_model *model, explorer_view *view,
                             explorer_input *input, const panel_gesture *g)
{
    (void)view;
    (void)input;
    if (g->event.kind != POINTER_PRESS || g->hit.index >= model->pinned.count) {
        return false;
    }
    act_hide_run(model, g->hit.index);
    return true;
}

const panel results_panel = {.name = "results",
                             .rows = results_rows,
                             .draw = draw_results,
                             .point = point_at_results};
