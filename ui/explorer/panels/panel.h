// A panel: a part of the screen that draws a part of the state and handles the mouse, and
// keys if it is a page. view.h lists them all.
#pragma once

#include "render/scene/plan_extent.h"
#include "src/predict/predictors.h"
#include "src/session/account.h"
#include "ui/explorer/actions/actions.h"
#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/state.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

// --- lines -----------------------------------------------------------------------------
// Dash patterns of curves, so that signals and runs can be distinguished without colours.

// Sixteen dots, repeated: bit i is dot i.
unsigned style_pattern(line_style style);

// Whether a line has a dot at a column of dots.
bool line_has_dot(unsigned pattern, long across);

// A short piece of a line for a legend, `cells` wide.
void draw_line_sample(screen *s, int x, int y, int cells, unsigned pattern, ink colour);

// --- areas -----------------------------------------------------------------------------

typedef struct area {
    int x, y, width, height; // [cells]
} area;

bool area_holds(area a, int x, int y);

// What is inside the frame around an area, with a column of blanks on both sides.
area area_inside(area a);
// A row of an area, 0 the uppermost.
area area_row(area a, int row);
// What is right of some columns of an area, and what is below some of its rows.
area area_right(area a, int columns);
area area_below(area a, int rows);

// A frame around an area, with a title.
void area_frame(screen *s, area a, ink colour, const char *title);
// Gives all cells of an area another ink.
void area_tint(screen *s, area a, ink colour);

// Write a text, as many of its words as there is room for, or a formatted text into the
// first row of an area; return the cells they take.
int area_text(screen *s, area a, ink colour, const char *text);
int area_words(screen *s, area a, ink colour, const char *text);
int area_print(screen *s, area a, ink colour, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// Writes lines of a wrapped text, as many as the area has rows.
void area_lines(screen *s, area a, ink colour, const text_line *lines, int count);

// --- the layout ------------------------------------------------------------------------
// What drawing stores besides the screen: the positions of parts, for the mouse; how far
// panels can be scrolled; and what is kept from one picture to the next. Drawing does not
// change the state.

enum { LABEL_WIDTH = 9 }; // of an axis of values [cells]
enum {
    LEAST_WIDTH = 40,
    LEAST_HEIGHT = 12
}; // of a screen that shows the explorer [cells]
enum { HIT_AREAS = 256 };

// The kinds of parts of a panel that the mouse distinguishes.
typedef enum hit_part {
    PART_BODY,      // the panel itself, or its plot
    PART_LINES,     // its lines; index: the first one shown, or the line's own
    PART_SLIDER,    // index: the parameter
    PART_LABELS,    // an axis of values; index: the pane
    PART_PANE,      // the curves of a pane; index: the pane
    PART_CELLS,     // those of a map; index: their height
    PART_LEGEND,    // a signal in a legend; index: the pane * PANE_SIGNALS + which of its
                    // signals
    PART_TIME_AXIS, // below curves
    PART_VIEW,      // a pane that is not over time; index: the pane
    PART_LANES,     // bands below that
    PART_HINT       // of no panel; index: the command that a click carries out
} hit_part;

// A part of the screen that the mouse can point at.
typedef struct hit_area {
    panel_id panel; // its panel, or PANEL_NONE
    hit_part part;
    int index; // its meaning depends on the part
    area area;
} hit_area;

// The region that the arm covers in a run.
typedef struct arm_extent {
    unsigned opened;   // of the state
    unsigned long run; // 0: nothing is known
    size_t rows;       // looked at
    bool whole;        // of a complete run
    plan_extent over;  // the run
} arm_extent;

// The linearised predictor's answer for a touch at a row.
typedef struct linearised_answer {
    unsigned long run; // 0: not computed
    size_t row;
    prediction_answer answer;
} linearised_answer;

// The account of a run in a line.
typedef struct account_line {
    unsigned long run; // 0: not written
    size_t rows;       // of the run when it was
    bool whole;        // of a complete run
    char text[ACCOUNT_SENTENCE];
} account_line;

typedef struct layout {
    hit_area hits[HIT_AREAS]; // later ones are on top
    int hit_count;
    area plot;                    // where the curves were drawn, no width if nowhere
    value_range axes[PANES];      // of the panes as they were drawn last
    drawn_view drawn;             // the state's, brought up to date by drawing
    arm_extent extent;            // remembered
    linearised_answer linearised; // remembered
    account_line account;         // remembered
} layout;

// Stores the position of a part. Parts beyond the capacity are not found by the mouse.
void layout_add_hit(layout *lay, hit_area hit);
// The uppermost part at a cell; one of PANEL_NONE if there is none.
hit_area layout_hit(const layout *lay, int x, int y);

// Keeps a panel's scrolling from 0 to `last` lines; returns it.
int layout_keep_scroll(layout *lay, panel_id id, int last);

// A number in at most nine cells; values that are only rounding are shown as 0, NaN as
// "-".
typedef struct number_text {
    char text[24];
} number_text;
number_text draw_number(double value);

// Whether an event is something that was done to the run: a change or a push.
bool event_is_input(event_kind kind);

// The first line to show so that the selected one is visible.
int draw_first_line(int selected, int count, int height);

// The column of a time axis at which an instant [s] is, -1 if it is not visible.
int time_column(const explorer_model *model, const explorer_view *view, area line,
                double time);

// The area of a page of at most this size, centred in the area of the panels.
area page_area(area body, int width, int height);

enum { WHEEL_LINES = 3 }; // scrolled by one step of the wheel

// A gesture of the mouse on a part of a panel.
typedef struct panel_gesture {
    pointer_event event;
    hit_area hit;   // the part that was pressed, or under the wheel
    int across, up; // a drag: cells since the last event
    bool dragged;   // it has moved since it was pressed
} panel_gesture;

// Which way the wheel turns: -1 up, 1 down; 0: another gesture.
int pointer_wheel(pointer_event e);

// The line under the mouse, of a part of lines whose index is that of its first one.
int gesture_line(const panel_gesture *g);

typedef struct panel {
    const char *name;

    // The number of rows it takes of `body`, 0 if it has nothing to show or there is no
    // room. Panels of the strip, and the one below the side's.
    int (*rows)(const explorer_model *model, const explorer_view *view, screen_size body);

    // Draws it into an area of the screen; pages are centred in the area of all panels.
    void (*draw)(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a);

    int wheel; // lines that a step of the wheel scrolls it, 0 where `point` has the wheel

    // Handles the mouse; false if the gesture does nothing. May be NULL.
    bool (*point)(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g);

    // Handles a key while the page is open. Pages only.
    bool (*key)(explorer_model *model, explorer_view *view, explorer_input *input,
                int key);

    // Of a page that is a list, in the place of its draw, point and key; else NULL.
    const struct page_list *list;
} panel;

#define PANEL_DECLARATION(id, place, description) extern const panel description;
PANEL_LIST(PANEL_DECLARATION)
#undef PANEL_DECLARATION

// --- the catalogue ---------------------------------------------------------------------
// panel_catalogue.c alone knows all panels; no panel calls it.

// The description of a panel; not for PANEL_NONE.
const panel *panel_of(panel_id id);

// Draws a panel into an area of the screen, a page that is a list included.
void panel_draw(panel_id id, const explorer_model *model, const explorer_view *view,
                layout *lay, screen *s, area a);

// Passes a gesture of the mouse to the panel of its hit area; false if it has no effect.
// The wheel scrolls the panel, or presses a page's keys for up and down.
bool panel_point(explorer_model *model, explorer_view *view, explorer_input *input,
                 const panel_gesture *g);

// Passes a key to the page that is open; false if it was refused.
bool panel_key(explorer_model *model, explorer_view *view, explorer_input *input,
               int key);

// --- pages -----------------------------------------------------------------------------
// Keys and mouse in pages that are scrolled line by line.

// Scrolls the page that is open; any other key closes it.
bool page_key(explorer_model *model, explorer_view *view, explorer_input *input, int key);

// What a page of `lines` lines in an area stores for keys and the mouse, `head` rows of
// which are not lines; returns how far it is scrolled.
int page_scroll(layout *lay, panel_id id, area a, int lines, int head);

// The frame of a page, which says how many of its lines are shown down to its end.
void draw_page_frame(screen *s, area a, const char *title, int last, int count);

// A page of lines of which one is selected. Keys for up and down and a press of the mouse
// select another one.
typedef struct page_list {
    const char *title;
    const char *narrow_title, *empty_title;    // NULL: the same
    int most_width;                            // [cells]
    int head, foot;                            // rows over and below the lines
    int least_lines;                           // rows left for them where there are none
    bool needs_lines;                          // without any every key closes it
    int (*count)(const explorer_model *model); // of its lines
    int (*selected)(const explorer_model *model, const explorer_view *view);
    void (*select)(explorer_model *model, explorer_view *view, int index);
    void (*draw_line)(const explorer_model *model, screen *s, area a, int index);
    void (*draw_edges)(const explorer_model *model, screen *s, area a); // head and foot

    // Handles a key but those for up and down, for the selected line; those without a
    // meaning close the page.
    bool (*press_key)(explorer_model *model, explorer_view *view, explorer_input *input,
                      int key, int index);
} page_list;

// Draws the list that is open, handles a press of the mouse on it, and a key.
void list_draw(const page_list *list, const explorer_model *model,
               const explorer_view *view, layout *lay, screen *s, area body);
bool list_point(const page_list *list, explorer_model *model, explorer_view *view,
                const panel_gesture *g);
bool list_press_key(const page_list *list, explorer_model *model, explorer_view *view,
                    explorer_input *input, int key);

// --- the palette -----------------------------------------------------------------------

// Draws it into the rows above the prompt, at the bottom of the area. It is the one panel
// that sees the prompt, so it has no `draw`.
void draw_palette(const explorer_model *model, const explorer_view *view, const prompt *p,
                  layout *lay, screen *s, area a);

// --- the arm ---------------------------------------------------------------------------

// The rows that the arm's panel makes use of where there is plenty of room.
int arm_rows(const explorer_model *model, layout *lay, screen_size room);

// --- the help --------------------------------------------------------------------------
// The text of the help page, made from the tables of keys and commands.

typedef struct help_line {
    char text[LINE_TEXT];
    int keys; // cells at its beginning that are keys
    bool heading;
    const char *also; // words by which it is found, too; NULL: none
} help_line;

// Writes the help page, wrapped to a width; returns how many lines it has, not more than
// `most`.
int help_write(const key_bindings *b, int width, help_line *lines, int most);

// --- views -----------------------------------------------------------------------------
// Panes whose axis is not time: one signal over another, and the spectrum of a signal.

// Draws a pane's inside; its signals are those of a view that is not over time. *axis is
// the range of its axis of values. False, with nothing drawn, if there are no values.
bool draw_pane_view(const explorer_model *model, const explorer_view *view, screen *s,
                    const pane *p, area a, value_range *axis);

// --- lanes -----------------------------------------------------------------------------
// Below the curves, on the same time axis: the modes of the law.

// The number of rows of these below curves of a given height.
int lanes_rows(const explorer_model *model, int height);

// Draws the lanes in the number of rows given by lanes_rows; the area has the same
// columns as the curves and their labels.
void draw_lanes(const explorer_model *model, const explorer_view *view, layout *lay,
                screen *s, area a);

// --- the whole screen ------------------------------------------------------------------
// Title, panels, page, status and prompt.

// Whether a screen has room for the explorer; on a smaller one only a message is drawn.
bool compose_fits(screen_size size);

// Draws everything from an up-to-date state; the layout depends on the screen's size.
void compose_screen(const explorer_model *model, const explorer_view *view,
                    const explorer_input *input, layout *lay, screen *s);
