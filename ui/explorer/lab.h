// The terminal lab without its terminal: what is looked at, how, and what keys and commands do.
#pragma once

#include "src/session/session.h"
#include "src/predict/predict.h"
#include "src/rig/rig.h"
#include "ui/terminal/key_codes.h"
#include "ui/terminal/pointer.h"
#include "ui/terminal/screen.h"

enum { EXTREMES_BLOCK = 64, LAB_SIGNALS = 64 };
enum { LAB_PANES = 10, PANE_SIGNALS = 4, LAB_TEXT = 256, LAB_SPOTS = 160, LAB_USER_KEYS = 64 };
enum { SIDE_WIDTH = 72 }; // of a screen that has room for the side beside the curves

typedef enum lab_overlay { OVERLAY_NONE, OVERLAY_HELP, OVERLAY_OPEN, OVERLAY_COMPARE } lab_overlay;
typedef enum lab_side { SIDE_PARAMETERS, SIDE_VALUES, SIDES } lab_side;

// What a pane's axis of values spans.
typedef enum axis_mode {
    AXIS_AUTO, // what the visible part of the run holds
    AXIS_GROW, // everything that has been seen; never less
    AXIS_FIXED // what the user says
} axis_mode;

// A pane of curves: signals of one unit.
typedef struct lab_pane {
    int signals[PANE_SIGNALS]; // indices in the signal table
    int count;                 // 0: not defined
    bool shown;
    axis_mode axis;
    double low, high;             // fixed: the axis
    double grown_low, grown_high; // growing: what has been seen; nothing if low is above high
    double drawn_low, drawn_high; // of the axis as it was drawn last
} lab_pane;

// Parts of the screen that the mouse can point at.
typedef enum lab_part {
    PART_NONE,
    PART_CURVES,
    PART_LABELS,    // a pane's axis of values; index: the pane
    PART_TIME_AXIS, // below the curves
    PART_VALUES,
    PART_LOG,       // index: the first line shown
    PART_PARAMETER, // a line of the parameters; index: which one
    PART_SLIDER,    // of a parameter; index: which one
    PART_HELP,
    PART_LIST, // index: the first line shown
    PART_COMPARISON
} lab_part;

// Where a part was drawn last [cells].
typedef struct lab_spot {
    lab_part part;
    int x, y, width, height;
    int index;
} lab_spot;

// Smallest and largest values of blocks of rows, for signals that were drawn: keeps long runs
// quick.
typedef struct lab_extremes {
    unsigned version;           // of the session; 0: nothing is known
    size_t blocks;              // number of whole or begun blocks of EXTREMES_BLOCK rows
    double *pairs[LAB_SIGNALS]; // by signal: low, high of each block; NULL where not asked for yet
    size_t rows[LAB_SIGNALS];   // by signal: rows that are in them, less than all of a growing run
} lab_extremes;

// A key of the user's own.
typedef struct lab_user_key {
    int key;
    char line[LAB_TEXT]; // what it carries out, "" for nothing
} lab_user_key;

// The modes of the law that is on.
enum { LAB_MODES = 12 };
typedef struct lab_modes {
    unsigned version; // of the session; 0: nothing is known
    int count;
    bool lockable;
    char names[LAB_MODES][MODE_NAME_SIZE];
} lab_modes;

// A line of the log: an event of the run, or the controller went into another mode.
typedef struct log_entry {
    double time; // [s]
    int event;   // index in the trace, -1 for a change of mode
    double mode; // that it went into
} log_entry;

typedef struct lab_log {
    unsigned version; // of the session; 0: nothing is known
    log_entry *entries;
    size_t count, capacity;
    size_t rows, events; // of the run that were gone through
    double mode;         // at the last of them, NaN if there was none yet
} lab_log;

// What a slider spans.
typedef struct slider_scale {
    double low, high;
    bool logarithmic;
} slider_scale;

typedef struct lab {
    session session;
    lab_modes modes;
    lab_log log;
    char last_law[LAB_TEXT]; // the one that was on when it was switched off, "" for none
    struct {
        bool held; // the mouse holds it: nothing is changed before it lets go
        int parameter;
        double value;
        slider_scale scale;
    } slider;
    bool playing;
    double speed;              // wanted: simulated seconds per second
    double measured;           // what came out of it lately
    lab_pane panes[LAB_PANES]; // the last one is the user's own
    bool panes_controlled;     // they are those of a controlled run
    bool panes_chosen;         // by the user: another scenario shows the same ones
    int focus;                 // pane that the keys for axes mean
    bool alone;                // that pane only
    double from, to;           // visible part of the run [s]; to <= from: all of it
    bool adrift;               // that part was panned and does not follow the cursor
    bool has_mark;
    double mark; // second cursor [s]
    lab_side side;
    bool side_in_front; // a narrow screen shows it in the place of the curves
    int parameter;      // selected, index in parameter_table
    lab_overlay overlay;
    int scroll;     // of a page; selected line of the list
    int list_first; // first line shown of the list; negative: round the selected one
    int page_lines; // of it that are shown at once
    char **names;   // of all scenarios
    char **titles;  // theirs, where there is one; NULL before they are wanted
    int name_count;
    char filter[LAB_TEXT];
    bool filtering; // keys go to the filter
    bool prompting; // keys go to the prompt
    char prompt[LAB_TEXT];
    char history[LAB_TEXT]; // the prompt's last line
    char message[1024];
    bool warning; // the message is one
    glyph_set glyphs;
    colour_theme theme;
    colour_depth depth;
    bool mouse;
    int fault_at; // where the line that failed last is wrong: characters before that
    lab_user_key user_keys[LAB_USER_KEYS];
    int user_key_count;
    bool settings_broken; // the settings file has faults
    bool quit, redraw;
    int width, height;                           // of the screen drawn last [cells]
    int plot_x, plot_width, plot_y, plot_height; // where the curves were drawn last [cells]
    lab_spot spots[LAB_SPOTS];                   // drawn last, the upper ones behind
    int spot_count;
    lab_spot grabbed;         // what the mouse holds
    int grabbed_x, grabbed_y; // where it was then, or when it was dragged last
    bool holding, dragged;    // its button is down, it was moved meanwhile
    int log_scroll;           // lines that the log is away from the present event
    int value_scroll;         // first value shown
    lab_extremes run_extremes, other_extremes;
    struct {
        unsigned version; // of the session; 0: nothing was asked
        size_t row;
        bool known;
        prediction answer;
    } linearised; // what the linearised arm predicts for a touch at a row
    struct {
        unsigned version;
        size_t rows;            // looked at
        bool whole;             // of a complete run
        double lowest, highest; // of all points of the arm over the run [m]
        double most_angle;      // [rad]
    } extent;
} lab;

// Opens a lab on a scenario, taken over also on failure. lab_open_patiently waits for runs not
// longer than `patience` [s]: lab_follow then brings the rest; lab_init waits for their end.
status lab_init(lab *l, scenario *s, fault *f);
status lab_open_patiently(lab *l, scenario *s, double patience, fault *f);
void lab_finish(lab *l);

// Takes note of what has been computed since the last call. True if there is something to draw.
bool lab_follow(lab *l);

// What is being computed and how far it is, "" if nothing is.
void lab_progress(const lab *l, char *text, size_t size);

// Complains and returns false while the run is being computed: what needs all of it cannot be done.
bool lab_has_whole_run(lab *l);

// Lets wall-clock time pass [s]: moves the cursor if the lab plays.
void lab_advance(lab *l, double seconds);

// A key was pressed.
void lab_key(lab *l, int key);
// Presses the keys of a text: characters, and names in angle brackets ("<Space>", "<Right>",
// "<C-l>"). False, with what is wrong in f, at a name that is none.
bool lab_keys(lab *l, const char *text, fault *f);
// The mouse did something.
void lab_point(lab *l, pointer_event p);
// A click or a drag at a cell, or the wheel (-1 up, 1 down), where no part takes it in its own way.
void lab_click(lab *l, int x, int y);
void lab_wheel(lab *l, int direction);

// Carries out a line of `:`, a script or a key; complaints and news go to l->message. False if it
// failed.
bool lab_carry_out(lab *l, const char *line);

// Says something on the message line.
void lab_say(lab *l, bool warning, const char *format, ...) __attribute__((format(printf, 3, 4)));

// Replaces the session by one of another scenario; the old one stays if that fails.
bool lab_open(lab *l, const char *name);

// Reads the titles of all scenarios, once; what was read is freed by lab_forget_titles.
void lab_load_titles(lab *l);
void lab_forget_titles(lab *l);
// The title of a scenario of the list, "" if there is none or none was read.
const char *lab_title(const lab *l, int index);
// Whether the list's filter lets a scenario through, by name or title.
bool lab_listed(const lab *l, int index);

// The visible part of the run [s].
void lab_window(const lab *l, double *from, double *to);

// Moves the visible part so that the cursor is in it, unless it is adrift.
void lab_keep_cursor_visible(lab *l);
// Makes a part of the run visible, kept within the run and not too short [s].
void lab_show_part(lab *l, double from, double to);

// Fills the panes with what the run has to show: a controlled run has readings and commands too.
void lab_define_panes(lab *l);
// Does so if a law was taken up or given up since.
void lab_notice_law(lab *l);
// The pane the keys for axes mean: one that is shown, or -1.
int lab_focused_pane(const lab *l);
// The axis of a pane in the visible part of the run; false if no signal of it has a value there.
bool lab_pane_axis(lab *l, int pane, double *low, double *high);
// Takes what has been seen into the growing axes.
void lab_grow_axes(lab *l);

// Whether a control law is on, and what its modes are called.
bool lab_has_law(const lab *l);
const lab_modes *lab_law_modes(lab *l);
void lab_mode_name(lab *l, double mode, char *text, size_t size);

// Events and changes of mode in the order of time.
const lab_log *lab_run_log(lab *l);
void lab_forget_log(lab *l);
// Moves to the next line of the log after the cursor (direction 1) or the one before it (-1). False
// if there is none.
bool lab_step_log(lab *l, int direction);

// What a slider of a parameter spans round a value; false if it is no number.
bool lab_slider_scale(int parameter, double value, slider_scale *scale);
// Where on it a value lies, 0 to 1, and the value at a share of it, rounded to what a cell of
// `cells` can tell and kept within the parameter's range.
double slider_share(const slider_scale *scale, double value);
double slider_value(const slider_scale *scale, int parameter, double share, int cells);

// Low and high of each block of rows of a signal, also of what has come to a growing run; NULL
// without memory. Low is above high in a block without a finite value.
const double *lab_extremes_of(lab_extremes *e, unsigned version, const trace *t, int signal);
void lab_forget_extremes(lab_extremes *e);

// Whether the parameter means anything for the run (printed.* only for the printed model...).
bool lab_applies(const lab *l, int parameter);

// The names of the commands, NULL after the last.
const char *lab_command_name(int index);

// Whether a line begins with a command; a complaint goes to l->message if not.
bool lab_is_command(lab *l, const char *line);

// The key of a name ("Space", "C-r", "x"), 0 if there is none; and the name of a key.
int lab_key_of(const char *name, size_t length);
void lab_key_name(int key, char *text, size_t size);
// What a key carries out, NULL for nothing.
const char *lab_bound_line(const lab *l, int key);
// What a key did before it was the user's own, or NULL.
const char *lab_overridden_line(const lab_user_key *own);
// The keys that carry a command out, blanks between them.
void lab_keys_of(const lab *l, const char *command, char *text, size_t size);

// What a command is: its name, its argument and what it does, as the help shows them. NULL beyond
// the last one.
const char *lab_command_help(int index, const char **argument, const char **help);

// A line of the help page.
typedef struct lab_help_line {
    char text[LAB_TEXT];
    int keys; // cells at its beginning that are keys
    bool heading;
} lab_help_line;

// Writes the help page, wrapped to a width; returns how many lines it has.
int lab_write_help(const lab *l, int width, lab_help_line *lines, int most);

// Carries out the settings file's commands, if there is one. Faults are told and ignored.
void lab_settings_load(lab *l);
// Writes it, whole or not at all; not over a file with faults. False, with the reason in
// l->message, if it could not.
bool lab_settings_save(lab *l);

// Frees what drawing remembers.
void lab_draw_finish(lab *l);

// Draws everything. The screen's size decides the layout.
void lab_draw(lab *l, screen *s);
