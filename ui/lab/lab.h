// The terminal lab without its terminal: what is looked at, how, and what keys and commands do.
#pragma once

#include "src/lab/session.h"
#include "ui/key_codes.h"
#include "ui/screen.h"

enum { EXTREMES_BLOCK = 64, LAB_SIGNALS = 64 };
enum { LAB_PANES = 10, PANE_SIGNALS = 4, LAB_TEXT = 256 };

typedef enum lab_overlay { OVERLAY_NONE, OVERLAY_HELP, OVERLAY_OPEN, OVERLAY_COMPARE } lab_overlay;
typedef enum lab_side { SIDE_PARAMETERS, SIDE_VALUES, SIDES } lab_side;

// A pane of curves: signals of one unit.
typedef struct lab_pane {
    int signals[PANE_SIGNALS]; // indices in the signal table
    int count;                 // 0: not defined
    bool shown;
} lab_pane;

// Smallest and largest values of blocks of rows, for signals that were drawn: keeps long runs
// quick.
typedef struct lab_extremes {
    unsigned version;           // of the session; 0: nothing is known
    size_t blocks;              // number of whole or begun blocks of EXTREMES_BLOCK rows
    double *pairs[LAB_SIGNALS]; // by signal: low, high of each block; NULL where not asked for yet
} lab_extremes;

typedef struct lab {
    session session;
    bool playing;
    double speed;              // wanted: simulated seconds per second
    double measured;           // what came out of it lately
    lab_pane panes[LAB_PANES]; // the last one is the user's own
    double from, to;           // visible part of the run [s]; to <= from: all of it
    bool has_mark;
    double mark; // second cursor [s]
    lab_side side;
    int parameter; // selected, index in parameter_table
    lab_overlay overlay;
    int scroll;   // of help; selected line of the list
    char **names; // of all scenarios
    int name_count;
    char filter[LAB_TEXT];
    bool filtering; // keys go to the filter
    bool prompting; // keys go to the prompt
    char prompt[LAB_TEXT];
    char history[LAB_TEXT]; // the prompt's last line
    char message[1024];
    bool warning; // the message is one
    glyph_set glyphs;
    lab_theme theme;
    bool mouse;
    bool settings_broken; // the settings file has faults
    bool quit, redraw;
    int width, height;                           // of the screen drawn last [cells]
    int plot_x, plot_width, plot_y, plot_height; // where the curves were drawn last [cells]
    lab_extremes run_extremes, other_extremes;
    struct {
        unsigned version;
        double lowest, highest; // of all points of the arm over the run [m]
        double most_angle;      // [rad]
    } extent;
} lab;

// Opens a lab on a scenario, taken over also on failure.
status lab_init(lab *l, scenario *s, fault *f);
void lab_finish(lab *l);

// Lets wall-clock time pass [s]: moves the cursor if the lab plays.
void lab_advance(lab *l, double seconds);

// A key was pressed.
void lab_key(lab *l, int key);
// Presses the keys of a text: characters, and names in angle brackets ("<Space>", "<Right>",
// "<C-l>"). False, with what is wrong in f, at a name that is none.
bool lab_keys(lab *l, const char *text, fault *f);
// A click or a drag at a cell, or the wheel (-1 up, 1 down).
void lab_click(lab *l, int x, int y);
void lab_wheel(lab *l, int direction);

// Carries out a line of `:`, a script or a key; complaints and news go to l->message. False if it
// failed.
bool lab_carry_out(lab *l, const char *line);

// Says something on the message line.
void lab_say(lab *l, bool warning, const char *format, ...) __attribute__((format(printf, 3, 4)));

// Replaces the session by one of another scenario; the old one stays if that fails.
bool lab_open(lab *l, const char *name);

// Whether the list's filter lets a name through.
bool lab_listed(const lab *l, const char *name);

// The visible part of the run [s].
void lab_window(const lab *l, double *from, double *to);

// Whether the parameter means anything for the run (printed.* only for the printed model...).
bool lab_applies(const lab *l, int parameter);

// The names of the commands, NULL after the last.
const char *lab_command_name(int index);

// The keys that carry a command out, blanks between them.
void lab_keys_of(const char *command, char *text, size_t size);

// The lines of the help, NULL after the last.
const char *lab_help_line(int index);

// Carries out the settings file's commands, if there is one. Faults are told and ignored.
void lab_settings_load(lab *l);
// Writes it, whole or not at all; not over a file with faults. False, with the reason in
// l->message, if it could not.
bool lab_settings_save(lab *l);

// Frees what drawing remembers.
void lab_draw_finish(lab *l);

// Draws everything. The screen's size decides the layout.
void lab_draw(lab *l, screen *s);
