// What drawing stores besides the screen: the positions of parts, for the mouse; how far panels can
// be scrolled; and what is kept from one picture to the next. Drawing does not change the state.
#pragma once

#include "src/predict/predictors.h"
#include "ui/explorer/state/state.h"

enum { LABEL_WIDTH = 9 };                     // of an axis of values [cells]
enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 12 }; // of a screen that shows the explorer [cells]
enum { HIT_AREAS = 160 };

typedef struct area {
    int x, y, width, height; // [cells]
} area;

// The kinds of parts of a panel that the mouse distinguishes.
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
    panel_id panel; // its panel, or PANEL_NONE
    hit_part part;
    int index; // its meaning depends on the part
    area area;
} hit_area;

// The region that the arm covers in a run.
typedef struct arm_extent {
    unsigned opened;        // of the state
    unsigned long run;      // 0: nothing is known
    size_t rows;            // looked at
    bool whole;             // of a complete run
    double lowest, highest; // of all points of the arm over the run [m]
    double most_angle;      // [rad]
} arm_extent;

// The linearised predictor's answer for a touch at a row.
typedef struct linearised_answer {
    unsigned long run; // 0: not computed
    size_t row;
    prediction_answer answer;
} linearised_answer;

// What a run contains for the lanes below its curves.
typedef struct lane_survey {
    unsigned long run; // 0: nothing is known
    size_t rows;       // looked at
    bool sticks, saturates;
} lane_survey;

typedef struct layout {
    hit_area hits[HIT_AREAS]; // later ones are on top
    int hit_count;
    area plot;                    // where the curves were drawn, no width if nowhere
    value_range axes[PANES];      // of the panes as they were drawn last
    int scroll[PANEL_IDS];        // by panel: the state's, limited to the existing lines
    int page_lines;               // lines of the page that are shown at once
    int first_scenario;           // line of the list of scenarios that is shown first
    arm_stage stage;              // where the arm was drawn
    arm_extent extent;            // remembered
    linearised_answer linearised; // remembered
    lane_survey lanes;            // remembered
} layout;

// Begins a picture: no parts yet, scrolling as in the state.
void layout_begin(layout *lay, const explorer_state *st);

// Stores the position of a part. Parts beyond the capacity are not found by the mouse.
void layout_add_hit(layout *lay, hit_area hit);
// The uppermost part at a cell; one of PANEL_NONE if there is none.
hit_area layout_hit(const layout *lay, int x, int y);

bool area_holds(area a, int x, int y);

// Keeps a panel's scrolling from 0 to `last` lines; returns it.
int layout_keep_scroll(layout *lay, panel_id panel, int last);

// Copies to the state what drawing has decided: how far panels are scrolled.
void layout_settle(const layout *lay, explorer_state *st);

// A number in at most nine cells; values that are only rounding are shown as 0, NaN as "-".
void draw_number(char *text, size_t size, double value);

// The first line to show so that the selected one is visible.
int draw_first_line(int selected, int count, int height);

// The area of a page of at most this size, centred in the area of the panels.
area page_area(area body, int width, int height);
