// The pages that are read: help, the scenario, what one stands on, the poles.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/modes.h"
#include "src/base/text_stream.h"
#include "src/session/session.h"
#include "src/study/linear/linear.h"

// --- the text of the help --------------------------------------------------------------

static const char first_visit[] =
    "A first visit: o lists the scenarios. Watch the arm bounce, Space stops it. I "
    "goes back to just before it touched, PgUp further. b keeps this run, Enter types "
    "another voltage from here on, Space plays on beside the old run, c compares their "
    "peaks, s saves a figure of both.";
static const char everywhere[] =
    "Esc goes back one level. : takes a command, Tab completes it, "
    "the beginning of a name will do.";
static const char mouse[] =
    "Mouse: click or drag in the curves to move the cursor, the wheel zooms there, "
    "Shift-wheel pans. Drag the time axis or an axis of values to move it, turn the "
    "wheel on it too. Click an event, a parameter or a scenario (once more opens it); "
    "drag a slider and let go. Shift-drag selects text in most terminals.";

enum { WRAPPED = 24, MOST_LINES = 600 }; // of one text, of a page
enum { TEXT_WIDTH = 84 };                // of a page of sentences [cells]

// A page that is being written.
typedef struct page {
    help_line *lines;
    int count, most, width;
    int column; // where meanings begin, behind the keys
} page;

static help_line *new_line(page *p)
{
    static help_line beyond;
    help_line *line = p->count < p->most ? &p->lines[p->count++] : &beyond;
    *line = (help_line){0};
    return line;
}

// A text in as many lines as it takes, from a column on; the first line may be begun
// already.
static void add_column(page *p, int column, const char *text, help_line *begun)
{
    text_line parts[WRAPPED];
    int room = p->width - column;
    int count = text_wrap(text, room < 1 ? 1 : room, parts, WRAPPED, NULL);

    // the first part may go on in the begun line, the others have lines of their own
    for (int i = 0; i < count; i++) {
        help_line *line = i == 0 && begun != NULL ? begun : new_line(p);
        size_t used = strlen(line->text);
        int blanks = column > (int)used ? column - (int)used : 0;
        int bytes = parts[i].bytes < LINE_TEXT / 2 ? parts[i].bytes : LINE_TEXT / 2;
        if (used < LINE_TEXT / 2) {
            snprintf(line->text + used, LINE_TEXT - used, "%*s%.*s", blanks, "", bytes,
                     parts[i].start);
        }
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
static void add_entry(page *p, const char *keys, const char *text)
{
    help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", keys);
    line->keys = (int)strlen(keys);
    add_column(p, p->column, text, line->keys + 1 < p->column ? line : NULL);
}

// What the commands do, in groups, with the keys that carry each out.
static void add_commands(page *p, const key_bindings *b)
{
    // wide enough: keys, call and meaning are three columns; else the call goes before
    // the meaning
    bool wide = p->width >= 96;

    // a group's heading before its first command
    for (int i = 0; i < explorer_command_count; i++) {
        const explorer_command *c = &explorer_command_table[i];
        char keys[64], call[64], text[LINE_TEXT];
        if (c->group[0] != '\0') {
            add_heading(p, c->group);
        }
        key_names_of(b, c->name, keys, sizeof keys);
        snprintf(call, sizeof call, ":%s%s%s", c->name, c->argument[0] ? " " : "",
                 c->argument);
        snprintf(text, sizeof text, wide ? "%-32s %s" : "%s  %s", call, c->help);
        add_entry(p, keys, text);
    }
}

static void add_user_keys(page *p, const key_bindings *b)
{
    for (int i = 0; i < b->count; i++) {
        const user_key *own = &b->own[i];
        const char *before = key_built_in_line(own->key);
        char key[KEY_NAME], text[2 * LINE_TEXT + 32];

        // no heading without a key below it
        if (i == 0) {
            add_heading(p, "Keys of your own");
        }

        // what the key does now, and what it did before
        key_name(own->key, key, sizeof key);
        snprintf(text, sizeof text, "%s%s%s%s", own->line[0] ? own->line : "nothing",
                 before ? " (the lab's: " : "", before ? before : "", before ? ")" : "");
        add_entry(p, key, text);
    }
}

int help_write(const key_bindings *b, int width, help_line *lines, int most)
{
    assert(most > 0);
    page p = {.lines = lines, .most = most, .width = width};
    if (width >= 96) {
        p.column = 26;
    } else if (width >= 60) {
        p.column = 20;
    } else {
        p.column = 12;
    }
    add_text(&p, "%s", first_visit);
    new_line(&p);
    add_text(&p, "%s", everywhere);
    add_commands(&p, b);
    add_user_keys(&p, b);
    new_line(&p);
    add_text(&p, "%s", mouse);
    return p.count;
}

// --- help ------------------------------------------------------------------------------

// Keeps the lines that pass a filter; returns how many.
static int keep_matching(help_line *lines, int count, const char *filter)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        lines[kept] = lines[i];
        kept += lines[i].text[0] != '\0' && filter_passes(filter, lines[i].text);
    }
    return kept;
}

void draw_page_frame(screen *s, area a, const char *title, int last, int count)
{
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, title);
    if (last < count || count > a.height - 2) {
        screen_print(s, a.x + 2, a.y + a.height - 1, a.width - 4, INK_DIM,
                     " %d of %d lines ", last, count);
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
    const int scroll = page_scroll(lay, view->page, a, p->count, 2);
    const int left = p->count - scroll, rows = left < a.height - 2 ? left : a.height - 2;
    draw_page_frame(s, a, title, scroll + rows, p->count);
    for (int i = 0; i < rows; i++) {
        const help_line *line = &p->lines[scroll + i];
        const int x = a.x + 2, y = a.y + 1 + i, room = a.width - 4;
        screen_text(s, x, y, room, line->heading ? INK_EVENT : INK_TEXT, line->text);
        screen_tint(s, x, y, line->keys < room ? line->keys : room, 1, INK_TITLE);
    }
    return a;
}

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

// The title, the description and the script.
static void draw_info(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, area body)
{
    page p = begin_page(body, TEXT_WIDTH);
    char title[LINE_TEXT];
    const scenario *base = &model->session.base;
    add_column(&p, 0, base->title != NULL ? base->title : "", NULL);
    p.lines[0].keys = text_cells(p.lines[0].text); // in their colour
    if (p.count > 0) {
        new_line(&p);
    }
    add_column(&p, 0, base->description != NULL ? base->description : "", NULL);
    if (p.count > 0 && p.lines[p.count - 1].text[0] != '\0') {
        new_line(&p);
    }

    // what its script does
    for (int i = 0; i < base->action_count; i++) {
        const action *a = &base->actions[i];
        char value[PARAMETER_TEXT_SIZE], path[ACTION_PATH], *line = new_line(&p)->text;
        if (a->kind == ACTION_PUSH) {
            snprintf(line, LINE_TEXT, "%9.5f s  push %g N s", a->time, a->value);
        } else {
            action_format_value(a, value, sizeof value);
            snprintf(line, LINE_TEXT, "%9.5f s  %s = %s", a->time, action_path(a, path),
                     value);
        }
    }
    p.count -= p.count > 0 && p.lines[p.count - 1].text[0] == '\0';
    snprintf(title, sizeof title, "%.180s (Esc closes)", base->name);
    draw_page(view, lay, s, body, &p, title, 0);
}

const panel info_panel = {.name = "info", .draw = draw_info, .key = page_key};

// --- what one stands on ----------------------------------------------------------------

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

static void draw_explain(const explorer_model *model, const explorer_view *view,
                         layout *lay, screen *s, area body)
{
    page p = begin_page(body, TEXT_WIDTH);
    const int focused = panes_focused(&view->panes);
    const event *e = session_event(&model->session);
    explain_parameter(model, view, &p);

    // the signals in focus, their symbols spelled out, then the event at the cursor
    for (int k = 0; focused >= 0 && k < view->panes.pane[focused].count; k++) {
        const signal_info *info = &signal_table[view->panes.pane[focused].signals[k]];
        if (k == 0) {
            add_heading(&p, "signals of the pane in focus (w: next pane)");
        }
        add_text(&p, "%s (%s%s%s): %s.", info->name, info->ascii,
                 info->unit[0] ? ", in " : "", info->unit, info->description);
    }
    if (e != NULL) {
        add_heading(&p, "the event at the cursor");
        add_text(&p, "%s: %s.", event_name(e->kind), event_description((int)e->kind));
    }
    explain_predictors(&p);
    draw_page(view, lay, s, body, &p,
              "what is here (? lists keys and commands, Esc closes)", 0);
}

const panel explain_panel = {.name = "explain", .draw = draw_explain, .key = page_key};

// The page of a first visit: what is behind it goes on, the first key closes it and acts.
static void draw_welcome(const explorer_model *model, const explorer_view *view,
                         layout *lay, screen *s, area body)
{
    (void)model;
    static const char *const steps[] = {
        "The arm hits the wall by itself. Space stops it, I goes back to just before.",
        "b keeps this run; Enter, 0.5, Enter halves the voltage: both are compared.",
        "o / hybrid Enter presses with 1 N by a control law. ? lists all keys."};
    page p = begin_page(body, 76);
    p.column = 3;
    for (int i = 0; i < 3; i++) {
        add_entry(&p, (char[]){(char)('1' + i), '\0'}, steps[i]);
    }
    draw_page(view, lay, s, body, &p, "a first visit (any key goes on)", 0);
}

const panel welcome_panel = {.name = "welcome", .draw = draw_welcome, .key = page_key};

// --- the account of the run ------------------------------------------------------------

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

// The poles of the arm near rest in one place, of a pair the upper one, or why there are
// none.
static void add_poles(page *p, const parameters *values, linear_place place)
{
    static const char *const names[] = {"free", "pressing on the wall",
                                        "pressing on the wall, hub held by friction"};
    fault f = {0};
    linear_arm of;
    double complex *poles = NULL;
    add_heading(p, names[place]);
    status code = linear_arm_init(&of, values, place, &f);
    const int count = code == STATUS_OK ? of.system.states : 0;
    if (code == STATUS_OK) {
        poles = calloc((size_t)count + 1, sizeof *poles);
        if (poles != NULL) {
            code = linear_poles(&of.system, poles, &f);
        } else {
            code = fault_no_memory(&f);
        }
    }
    loss_unless(code != STATUS_NO_MEMORY);
    if (code != STATUS_OK) {
        add_text(p, "%s", f.text);
    } else if (count == 0) {
        add_text(p, "none: nothing is left that could move");
    }
    for (int i = 0; code == STATUS_OK && i < count; i++) {
        const double complex s = poles[i];
        const bool rests = cabs(s) < 1e-6; // rounding of a pole at the origin
        double frequency = 0, damping = (double)NAN, decay = (double)NAN; // [Hz], [], [s]
        if (!rests) {
            frequency = cabs(s) / (2 * acos(-1));
            damping = linear_damping(s);
            decay = -1 / creal(s);
        }
        if (cimag(s) >= 0) {
            snprintf(new_line(p)->text, LINE_TEXT, "%12s%12s%12s",
                     draw_number(frequency).text, draw_number(damping).text,
                     draw_number(decay).text);
        }
    }
    free(poles);
    linear_system_finish(&of.system);
}

enum { SHAPES = 4, SHAPE_ROWS = 5, MOST_SHAPED = 64 };

// The lowest modes of the arm that nothing holds, hub to the left, one beside the other.
static void draw_shapes(screen *s, area a, const parameters *values)
{
    arm m;
    int count = 0;
    double lengths[PARAMETER_LINKS_MOST];
    arm_init(&m, values);
    double *w = calloc((size_t)m.dof, sizeof *w);
    double *shapes = calloc((size_t)m.dof * (size_t)m.dof, sizeof *shapes);
    loss_unless(w != NULL && shapes != NULL);
    const int links = values->arm.links, wide = a.width / SHAPES - 1;
    parameters_link_lengths(&values->arm, lengths);
    if (w == NULL || shapes == NULL ||
        modes_compute(&m, HUB_FREE, TIP_FREE, &count, w, shapes) != STATUS_OK) {
        count = 0;
    }
    for (int i = 0, n = 0; i < count && n < SHAPES; i++) {
        const double *angle = shapes + i * m.dof + m.dof - links;
        double at[PARAMETER_LINKS_MOST + 1] = {0}, most = 0;
        for (int k = 0; k < links; k++) {
            at[k + 1] = at[k] + lengths[k] * angle[k];
            most = fmax(most, fabs(at[k + 1]));
        }
        const canvas c = {s, a.x + n * (wide + 1), a.y + 1, wide, a.height - 1};
        double x = 0, middle = 2.0 * c.height - 0.5;
        for (int k = 0; k < links && most > 0; k++) {
            const double end = x + lengths[k] / values->arm.length * (2.0 * wide - 1);
            canvas_line(&c, x, middle * (1 - at[k] / most), end,
                        middle * (1 - at[k + 1] / most), INK_ARM);
            x = end;
        }
        screen_print(s, c.x, a.y, wide, INK_DIM, "free, %.3g Hz", w[i] / (2 * acos(-1)));
        n++;
    }
    free(w);
    free(shapes);
}

static void draw_poles(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, area body)
{
    static help_line lines[MOST_LINES];
    static parameters shown;
    static page p;
    const parameters now = model_parameters(model);
    const int width = begin_page(body, 64).width;

    // computed anew where a parameter has changed: many links take a while
    if (p.width != width || memcmp(&shown, &now, sizeof now) != 0) {
        memcpy(&shown, &now, sizeof now);
        p = (page){.lines = lines, .most = MOST_LINES, .width = width};
        add_text(&p, "The arm near rest with the values at the cursor, without its law.");
        snprintf(new_line(&p)->text, LINE_TEXT, "%12s%12s%12s", "[Hz]", "damping",
                 "decay [s]");
        for (linear_place place = LINEAR_FREE; place <= LINEAR_STUCK; place++) {
            add_poles(&p, &now, place);
        }
    }
    const bool shows =
        p.count + 2 + SHAPE_ROWS <= body.height && now.arm.links <= MOST_SHAPED;
    const int below = shows ? SHAPE_ROWS : 0;
    const area a = draw_page(view, lay, s, body, &p, "poles (Esc closes)", below);
    if (shows) {
        draw_shapes(s, (area){a.x + 2, a.y + a.height - 1 - below, a.width - 4, below},
                    &now);
    }
}

const panel poles_panel = {.name = "poles", .draw = draw_poles, .key = page_key};
