// The pages that are read: help, the scenario, what one stands on, the poles.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <glib.h>

#include "src/arm/modes.h"
#include "src/base/text_stream.h"
#include "src/session/account.h"
#include "src/session/session.h"
#include "src/study/linear/linear.h"

// --- the text of the help --------------------------------------------------------------

static const char first_visit[] =
    "A first visit: o lists the scenarios. Space stops the arm, I goes back to just "
    "before it touched. Enter types another voltage from here on, Space plays on beside "
    "the run as opened, s saves a figure of both.";
static const char everywhere[] =
    "Esc goes back one level. : takes a command, Tab completes it, "
    "the beginning of a name will do.";
static const char mouse[] =
    "Mouse: click or drag in the curves to move the cursor, the wheel zooms there, "
    "Shift-wheel pans. Drag the time axis or an axis of values to move it, turn the "
    "wheel on it too. Click an event, a parameter or a scenario (once more opens it); "
    "drag a slider and let go. Shift-drag selects text in most terminals.";

enum { TEXT_LINES = 24, MOST_LINES = 600 }; // of one text, of a page
enum { TEXT_WIDTH = 84 };                   // of a page of sentences [cells]

// A page that is being written.
typedef struct page {
    help_line *lines;
    int count, most, width;
    int column; // where meanings begin, behind the keys
} page;

// Another line of a page, empty; those that have no room on it are lost.
static help_line *new_line(page *p)
{
    static help_line beyond; // what has no room on the page
    help_line *line = &beyond;
    if (p->count < p->most) {
        line = &p->lines[p->count++];
    }
    *line = (help_line){0};
    return line;
}

// Adds bytes to a line from a column on; an overlong line loses its end.
static void add_to_line(help_line *line, int column, const text_line *part)
{
    enum { MOST_BYTES = LINE_TEXT / 2 };
    const int used = (int)strlen(line->text);
    if (used < MOST_BYTES) {
        const int blanks = column > used ? column - used : 0;
        const int bytes = part->bytes < MOST_BYTES ? part->bytes : MOST_BYTES;
        text_add(line->text, sizeof line->text, "%*s%.*s", blanks, "", bytes,
                 part->start);
    }
}

// A text in as many lines as it takes, from a column on; its first line goes on in
// `begun`, unless that is NULL.
static void add_column(page *p, int column, const char *text, help_line *begun)
{
    text_line parts[TEXT_LINES];
    const int room = p->width > column ? p->width - column : 1;
    const int count = text_wrap(text, room, parts, TEXT_LINES, NULL);
    for (int i = 0; i < count; i++) {
        help_line *line = begun;
        if (i > 0 || begun == NULL) {
            line = new_line(p);
        }
        add_to_line(line, column, &parts[i]);
    }
}

static void add_text(page *p, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void add_text(page *p, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    add_column(p, 0, text, NULL);
}

// A heading, with a blank line before it unless it is the first of the page.
static void add_heading(page *p, const char *title)
{
    if (p->count > 0) {
        new_line(p);
    }
    help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", title);
    line->heading = true;
}

// Keys in a column of their own, then what they do; many keys take a line for themselves.
static void add_keys(page *p, const char *keys, const char *text)
{
    help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", keys);
    line->keys = (int)strlen(keys);
    if (line->keys + 1 < p->column) {
        add_column(p, p->column, text, line);
    } else {
        add_column(p, p->column, text, NULL);
    }
}

// What a command does, with the keys that carry it out. Where there is room keys, call
// and meaning are three columns, else the call goes before the meaning.
static void add_command(page *p, const char *keys, const explorer_command *c)
{
    char call[64], text[LINE_TEXT];
    const int first = p->count;
    snprintf(call, sizeof call, ":%s", c->name);
    if (c->argument[0] != '\0') {
        text_add(call, sizeof call, " %s", c->argument);
    }
    if (p->width >= 96) {
        snprintf(text, sizeof text, "%-32s %s", call, c->help);
    } else {
        snprintf(text, sizeof text, "%s  %s", call, c->help);
    }
    add_keys(p, keys, text);
    for (int i = first; i < p->count; i++) {
        p->lines[i].also = synonyms_of(c->name);
    }
}

// The commands of a group from the index-th on, those with keys or those without;
// returns the index of the next group's first.
static int add_group(page *p, const key_bindings *b, int index, bool with_keys)
{
    int i = index;
    do {
        char keys[64];
        const explorer_command *c = &explorer_command_table[i];
        key_names_of(b, c->name, keys, sizeof keys);
        if ((keys[0] != '\0') == with_keys) {
            add_command(p, keys, c);
        }
        i++;
    } while (i < explorer_command_count && explorer_command_table[i].group[0] == '\0');
    return i;
}

// The groups of commands in one sentence, then each: first what has keys.
static void add_commands(page *p, const key_bindings *b)
{
    char index[LINE_TEXT] = "Below:";
    for (int i = 0; i < explorer_command_count; i++) {
        const char *group = explorer_command_table[i].group;
        if (group[0] != '\0') {
            text_add(index, sizeof index, "%s %s", i == 0 ? "" : ",", group);
        }
    }
    add_text(p, "%s. / filters by words.", index);
    for (int i = 0; i < explorer_command_count;) {
        add_heading(p, explorer_command_table[i].group);
        add_group(p, b, i, true);
        i = add_group(p, b, i, false);
    }
}

// What the keys of the user do now, and what they did before.
static void add_user_keys(page *p, const key_bindings *b)
{
    if (b->count > 0) {
        add_heading(p, "Keys of your own");
    }
    for (int i = 0; i < b->count; i++) {
        const user_key *own = &b->own[i];
        const char *built_in = key_built_in_line(own->key);
        const char *line = own->line[0] != '\0' ? own->line : "nothing";
        char key[KEY_NAME], text[2 * LINE_TEXT + 32];
        snprintf(text, sizeof text, "%s", line);
        if (built_in != NULL) {
            text_add(text, sizeof text, " (the lab's: %s)", built_in);
        }
        key_name(own->key, key, sizeof key);
        add_keys(p, key, text);
    }
}

int help_write(const key_bindings *b, int width, help_line *lines, int most)
{
    assert(most > 0);
    page p = {.lines = lines, .most = most, .width = width, .column = 12};
    if (width >= 96) {
        p.column = 26;
    } else if (width >= 60) {
        p.column = 20;
    }
    add_text(&p, "%s", first_visit);
    add_text(&p, "%s", everywhere);
    add_commands(&p, b);
    add_user_keys(&p, b);
    new_line(&p);
    add_text(&p, "%s", mouse);
    return p.count;
}

// --- help ------------------------------------------------------------------------------

// Keeps the lines that pass a filter, below a heading that does all; returns how many.
static int keep_matching(help_line *lines, int count, const char *filter)
{
    int kept = 0;
    bool in_group = false;
    for (int i = 0; i < count; i++) {
        if (lines[i].heading || lines[i].text[0] == '\0') {
            in_group = lines[i].heading && filter_passes(filter, lines[i].text);
        }

        // other words for a command find it, too
        char all[2 * LINE_TEXT];
        const char *also = lines[i].also != NULL ? lines[i].also : "";
        snprintf(all, sizeof all, "%.255s %.255s", lines[i].text, also);
        if (in_group || (lines[i].text[0] != '\0' && filter_passes(filter, all))) {
            lines[kept++] = lines[i];
        }
    }
    return kept;
}

void draw_page_frame(screen *s, area a, const char *title, int last, int count)
{
    const area inside = area_inside(a);
    area_frame(s, a, INK_CURSOR, title);
    if (last < count || count > inside.height) {
        area_print(s, area_row(inside, inside.height), INK_DIM, " %d of %d lines ", last,
                   count);
    }
}

// A page of at most `width` that is to be written.
static page begin_page(area body, int width)
{
    static help_line lines[MOST_LINES];
    const area a = page_area(body, width, body.height);
    return (page){.lines = lines, .most = MOST_LINES, .width = a.width - 4};
}

// Draws one that is written, as high as its lines and `below` rows for what comes under
// them, or scrolled; returns its area.
static area draw_page(const explorer_view *view, layout *lay, screen *s, area body,
                      const page *p, const char *title, int below)
{
    const area a = page_area(body, p->width + 4, p->count + 2 + below);
    const area inside = area_inside(a);
    const int scroll = page_scroll(lay, view->page, a, p->count, 2);
    int rows = p->count - scroll;
    if (rows > inside.height) {
        rows = inside.height;
    }
    draw_page_frame(s, a, title, scroll + rows, p->count);

    // headings and keys in their colours
    for (int i = 0; i < rows; i++) {
        const help_line *line = &p->lines[scroll + i];
        area row = area_row(inside, i);
        const ink shade = line->heading ? INK_EVENT : INK_TEXT;
        area_text(s, row, shade, line->text);
        if (line->keys < row.width) {
            row.width = line->keys;
        }
        area_tint(s, row, INK_TITLE);
    }
    return a;
}

// All keys and commands, or those that pass the filter.
static void draw_help(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, area body)
{
    (void)model;
    const char *filter = view->filters.text[PANEL_HELP];
    char title[LINE_TEXT] = "keys and commands (/ filters, Esc closes)";
    page p = begin_page(body, 114);
    p.count = help_write(&view->keys, p.width, p.lines, p.most);
    if (filter[0] != '\0') {
        snprintf(title, sizeof title, "keys and commands /%.200s", filter);
        p.count = keep_matching(p.lines, p.count, filter);
    }
    draw_page(view, lay, s, body, &p, title, 0);
}

const panel help_panel = {.name = "help", .draw = draw_help, .key = page_key};

// --- the scenario ----------------------------------------------------------------------

// What an action of a script does, with its instant.
static void add_script_line(page *p, const action *a)
{
    char value[PARAMETER_TEXT_SIZE], path[ACTION_PATH]; // no list is timed
    char *line = new_line(p)->text;
    if (a->kind == ACTION_PUSH) {
        snprintf(line, LINE_TEXT, "%9.5f s  push %g N s", a->time, a->value);
        return;
    }
    action_format_value(a, value, sizeof value);
    snprintf(line, LINE_TEXT, "%9.5f s  %s = %s", a->time, action_path(a, path), value);
}

// Whether the last line of a page is a blank one.
static bool ends_with_blank(const page *p)
{
    return p->count > 0 && p->lines[p->count - 1].text[0] == '\0';
}

// The title, the description and the script, a blank line between them.
static void draw_info(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, area body)
{
    page p = begin_page(body, TEXT_WIDTH);
    const scenario *base = &model->session.base;
    if (base->title != NULL) {
        add_column(&p, 0, base->title, NULL);
    }
    p.lines[0].keys = text_cells(p.lines[0].text); // in their colour
    if (p.count > 0) {
        new_line(&p);
    }
    if (base->description != NULL) {
        add_column(&p, 0, base->description, NULL);
    }
    if (p.count > 0 && !ends_with_blank(&p)) {
        new_line(&p);
    }
    for (int i = 0; i < base->action_count; i++) {
        add_script_line(&p, &base->actions[i]);
    }
    if (ends_with_blank(&p)) {
        p.count--;
    }

    char title[LINE_TEXT];
    snprintf(title, sizeof title, "%.180s (Esc closes)", base->name);
    draw_page(view, lay, s, body, &p, title, 0);
}

const panel info_panel = {.name = "info", .draw = draw_info, .key = page_key};

// --- what is selected ------------------------------------------------------------------

// The selected parameter: what it is, in which range, why it has no effect.
static void explain_parameter(const explorer_model *model, const explorer_view *view,
                              page *p)
{
    const int index = view->parameters.parameter;
    const parameter_info *info = &parameter_table[index];
    const char *inert = model_inert_reason(model, index);
    add_heading(p, info->path);
    if (info->choices != NULL) {
        add_text(p, "%s. One of %s.", info->description, info->choices);
    } else if (info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER) {
        add_text(p, "%s. From %g to %g %s.", info->description, info->minimum,
                 info->maximum, info->unit);
    } else {
        add_text(p, "%s.", info->description);
    }
    if (inert != NULL) {
        add_text(p, "Without effect here: %s.", inert);
    }
    add_text(p, "Enter edits it, < and > nudge it, :sweep and :solve vary it.");
}

// What the predictors say, and from what.
static void explain_predictors(page *p)
{
#define PREDICTOR_WORDS(id, name, label, short_label, about) label ": " about ".",
    static const char *const words[] = {PREDICTOR_LIST(PREDICTOR_WORDS)};
#undef PREDICTOR_WORDS
    add_heading(p, "predictors: the largest force of the pulse if the tip touched now");
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        add_text(p, "%s", words[i]);
    }
    add_text(
        p, "\"would not hold\": the touch would throw the tip off. What came: the run.");
}

// The signals of the pane in focus, their symbols spelled out.
static void explain_signals(const explorer_view *view, page *p)
{
    const int focused = panes_focused(&view->panes);
    if (focused < 0 || view->panes.pane[focused].count == 0) {
        return;
    }
    const pane *in_focus = &view->panes.pane[focused];
    add_heading(p, "signals of the pane in focus (w: next pane)");
    for (int k = 0; k < in_focus->count; k++) {
        const signal_info *info = &signal_table[in_focus->signals[k]];
        const char *in = info->unit[0] != '\0' ? ", in " : "";
        add_text(p, "%s (%s%s%s): %s.", info->name, info->ascii, in, info->unit,
                 info->description);
    }
}

// What an event is.
static void explain_event(const event *e, page *p)
{
    add_heading(p, "the event at the cursor");
    add_text(p, "%s: %s.", event_name(e->kind), event_description((int)e->kind));
}

// What is selected, in focus and at the cursor, in sentences.
static void draw_explain(const explorer_model *model, const explorer_view *view,
                         layout *lay, screen *s, area body)
{
    page p = begin_page(body, TEXT_WIDTH);
    const event *at_cursor = session_event(&model->session);
    explain_parameter(model, view, &p);
    explain_signals(view, &p);
    if (at_cursor != NULL) {
        explain_event(at_cursor, &p);
    }
    explain_predictors(&p);
    draw_page(view, lay, s, body, &p,
              "what is here (? lists keys and commands, Esc closes)", 0);
}

const panel explain_panel = {.name = "explain", .draw = draw_explain, .key = page_key};

// --- the account of the run ------------------------------------------------------------

// The course of the run in sentences.
static void draw_why(const explorer_model *model, const explorer_view *view, layout *lay,
                     screen *s, area body)
{
    char sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE];
    page p = begin_page(body, TEXT_WIDTH);
    const int count =
        run_account(&model->session.effective, &model->session.run, sentences);
    for (int i = 0; i < count; i++) {
        add_text(&p, "%s", sentences[i]);
    }
    draw_page(view, lay, s, body, &p, "why (Esc closes)", 0);
}

const panel why_panel = {.name = "why", .draw = draw_why, .key = page_key};

// --- the poles -------------------------------------------------------------------------

// A pole as frequency [Hz], damping and decay [s]; one at the origin has only the first.
static void add_pole(page *p, double complex pole)
{
    double frequency = 0, damping = (double)NAN, decay = (double)NAN;
    const bool at_origin = cabs(pole) < 1e-6; // but for rounding
    if (!at_origin) {
        frequency = cabs(pole) / (2 * acos(-1));
        damping = linear_damping(pole);
        decay = -1 / creal(pole);
    }
    snprintf(new_line(p)->text, LINE_TEXT, "%12s%12s%12s", draw_number(frequency).text,
             draw_number(damping).text, draw_number(decay).text);
}

// The poles of the arm near rest in one place, of a pair the upper one, or why there are
// none.
static void add_poles(page *p, const parameters *values, linear_place place)
{
    static const char *const names[] = {"free", "pressing on the wall",
                                        "pressing on the wall, hub held by friction"};
    fault f = {0};
    linear_arm of;
    g_autofree double complex *poles = NULL;
    int count = 0;
    add_heading(p, names[place]);
    status code = linear_arm_init(&of, values, place, &f);
    if (code == STATUS_OK) {
        count = of.system.states;
        poles = g_new0(double complex, (size_t)count + 1);
        code = linear_poles(&of.system, poles, &f);
    }
    linear_system_finish(&of.system);

    if (code != STATUS_OK) {
        loss_unless(code != STATUS_NO_MEMORY);
        add_text(p, "%s", f.text);
        return;
    }
    if (count == 0) {
        add_text(p, "none: nothing is left that could move");
    }
    for (int i = 0; i < count; i++) {
        if (cimag(poles[i]) >= 0) {
            add_pole(p, poles[i]);
        }
    }
}

enum { SHAPES = 4, SHAPE_ROWS = 5, MOST_SHAPED_LINKS = 64 };

// The shape of a mode, from the angles of its links, hub to the left; its largest
// deflection fills the canvas.
static void draw_shape(const canvas *c, const arm_parameters *beam, const double *lengths,
                       const double *angles)
{
    double deflection[PARAMETER_LINKS_MOST + 1] = {0}, largest = 0;
    for (int k = 0; k < beam->links; k++) {
        deflection[k + 1] = deflection[k] + lengths[k] * angles[k];
        largest = fmax(largest, fabs(deflection[k + 1]));
    }
    if (!(largest > 0)) {
        return;
    }
    const double middle = 2.0 * c->height - 0.5; // [dots]
    double x = 0;
    for (int k = 0; k < beam->links; k++) {
        const double end = x + lengths[k] / beam->length * (2.0 * c->width - 1);
        canvas_line(c, x, middle * (1 - deflection[k] / largest), end,
                    middle * (1 - deflection[k + 1] / largest), INK_ARM);
        x = end;
    }
}

// The lowest modes of the arm that nothing holds, one beside the other.
static void draw_shapes(screen *s, area a, const parameters *values)
{
    arm m;
    int count = 0;
    arm_init(&m, values);
    const size_t dof = (size_t)m.dof, shape_values = dof * dof;
    g_autofree double *frequencies = g_new0(double, dof); // [rad/s]
    g_autofree double *shapes = g_new0(double, shape_values);
    if (modes_compute(&m, HUB_FREE, TIP_FREE, &count, frequencies, shapes) != STATUS_OK) {
        return;
    }

    // the links are the last coordinates of a shape
    const int width = a.width / SHAPES - 1;
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(&values->arm, lengths);
    for (int i = 0; i < count && i < SHAPES; i++) {
        const double *angles = shapes + (i + 1) * m.dof - values->arm.links;
        const canvas c = {s, a.x + i * (width + 1), a.y + 1, width, a.height - 1};
        draw_shape(&c, &values->arm, lengths, angles);
        screen_print(s, c.x, a.y, width, INK_DIM, "free, %.3g Hz",
                     frequencies[i] / (2 * acos(-1)));
    }
}

// The poles of the arm with these values in each place near rest.
static void write_poles(page *p, const parameters *values)
{
    add_text(p, "The arm near rest with the values at the cursor, without its law.");
    snprintf(new_line(p)->text, LINE_TEXT, "%12s%12s%12s", "[Hz]", "damping",
             "decay [s]");
    for (linear_place place = LINEAR_FREE; place <= LINEAR_STUCK; place++) {
        add_poles(p, values, place);
    }
}

// The poles, and below them the shapes of the lowest modes.
static void draw_poles(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, area body)
{
    static help_line lines[MOST_LINES];
    static parameters written; // the values that the page is of
    static page p;
    const parameters now = model_parameters(model);
    const int width = begin_page(body, 64).width;

    // computed again where a parameter has changed: many links take a while
    if (p.width != width || memcmp(&written, &now, sizeof now) != 0) {
        memcpy(&written, &now, sizeof now);
        p = (page){.lines = lines, .most = MOST_LINES, .width = width};
        write_poles(&p, &now);
    }

    // the shapes below, where they have room
    const bool has_room = p.count + 2 + SHAPE_ROWS <= body.height;
    if (!has_room || now.arm.links > MOST_SHAPED_LINKS) {
        draw_page(view, lay, s, body, &p, "poles (Esc closes)", 0);
        return;
    }
    const area a = draw_page(view, lay, s, body, &p, "poles (Esc closes)", SHAPE_ROWS);
    const area inside = area_inside(a);
    draw_shapes(s, area_below(inside, inside.height - SHAPE_ROWS), &now);
}

const panel poles_panel = {.name = "poles", .draw = draw_poles, .key = page_key};
