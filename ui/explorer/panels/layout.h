// What drawing writes besides the screen: where parts were drawn, for the mouse; how far panels can
// be scrolled; and what it remembers from one picture to the next. The state stays as it is.
#pragma once

#include "src/predict/predictors.h"
#include "ui/explorer/state/state.h"

enum { LABEL_WIDTH = 9 };                     // of an axis of values [cells]
enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 12 }; // of a screen that shows the explorer [cells]
enum { HIT_AREAS = 160 };

typedef struct area {
    int x, y, width, height; // [cells]
} area;

// What a part of a panel is to the mouse.
typedef enum hit_part {
    PART_BODY,      // the panel itself, or its plot
    PART_LINES,     // its lines; index: the first one shown, or the line's own
    PART_HEADING,   // of a group of lines; index: its first parameter
    PART_SLIDER,    // index: the parameter
    PART_LABELS,    // an axis of values; index: the pane
    PART_TIME_AXIS, // below curves
    PART_VIEW,      // a pane that is not over time; index: the pane
    PART_LANES,     // bands below that
    PART_MAP        // of the whole run
} hit_part;

// A part of the screen that the mouse can point at.
typedef struct hit_area {
    panel_id panel; // whose it is; PANEL_NONE for nobody's
    hit_part part;
    int index; // as the part says
    area area;
} hit_area;

// What the arm sweeps over in a run.
typedef struct arm_extent {
    unsigned opened;        // of the state
    unsigned long run;      // 0: nothing is known
    size_t rows;            // looked at
    bool whole;             // of a complete run
    double lowest, highest; // of all points of the arm over the run [m]
    double most_angle;      // [rad]
} arm_extent;

// What the linearised arm predicts for a touch at a row.
typedef struct linearised_answer {
    unsigned long run; // 0: nothing was asked
    size_t row;
    prediction_answer answer;
} linearised_answer;

// What a run has for the lanes below its curves.
typedef struct lane_survey {
    unsigned long run; // 0: nothing is known
    size_t rows;       // looked at
    bool sticks, saturates;
} lane_survey;

typedef struct layout {
    hit_area hits[HIT_AREAS]; // the upper ones behind
    int hit_count;
    area plot;                    // where the curves were drawn, no width if nowhere
    value_range axes[PANES];      // of the panes as they were drawn last
    int scroll[PANEL_IDS];        // by panel: the state's, kept within what there is
    int page_lines;               // of the page that are shown at once
    int first_scenario;           // line of the list of scenarios that is shown first
    arm_stage stage;              // where the arm was drawn
    arm_extent extent;            // remembered
    linearised_answer linearised; // remembered
    lane_survey lanes;            // remembered
} layout;

// Begins a picture: nothing is drawn yet, scrolling is as the state has it.
void layout_begin(layout *lay, const explorer_state *st);

// Remembers where a part is. What does not fit is not found by the mouse.
void layout_add_hit(layout *lay, hit_area hit);
// The uppermost part at a cell; one of PANEL_NONE if there is none.
hit_area layout_hit(const layout *lay, int x, int y);

bool area_holds(area a, int x, int y);

// Keeps a panel's scrolling from 0 to `last` lines; returns it.
int layout_keep_scroll(layout *lay, panel_id panel, int last);

// Gives the state what the picture decided: how far panels are scrolled.
void layout_settle(const layout *lay, explorer_state *st);

// A number in at most nine cells; values that are rounding show as 0, those that are none as "-".
void draw_number(char *text, size_t size, double value);

// The first line to show so that the selected one is in the window.
int draw_first_line(int selected, int count, int height);

// A page of at most this size in the middle of what panels have of the screen.
area page_area(area body, int width, int height);
