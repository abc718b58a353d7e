// The panels of the explorer: one list that gives each an identity, a place on the screen and the
// description in the panel's own file. A new panel needs one file, one line here and one in
// meson.build.
#pragma once

#include <stdbool.h>

// The places of panels.
typedef enum panel_place {
    PLACE_STRIP, // below the title, while there is a lesson
    PLACE_TOP,   // above the curves
    PLACE_MAIN,  // below that
    PLACE_SIDE,  // on the right; Tab selects one of these
    PLACE_STACK, // below the selected one, as many as have room
    PLACE_PAGE,  // opens over the others
    PLACE_PROMPT // above the prompt while that is open
} panel_place;

// identity, place, description; side panels in the order in which Tab selects them, stacked ones
// from top to bottom
#define PANEL_LIST(X)                                                                              \
    X(PANEL_LESSON, PLACE_STRIP, lesson_panel)                                                     \
    X(PANEL_ARM, PLACE_TOP, arm_panel)                                                             \
    X(PANEL_CURVES, PLACE_MAIN, curves_panel)                                                      \
    X(PANEL_PARAMETERS, PLACE_SIDE, parameters_panel)                                              \
    X(PANEL_VALUES, PLACE_SIDE, values_panel)                                                      \
    X(PANEL_STATISTICS, PLACE_SIDE, statistics_panel)                                              \
    X(PANEL_SWEEP, PLACE_SIDE, sweep_panel)                                                        \
    X(PANEL_RUNS, PLACE_STACK, runs_panel)                                                         \
    X(PANEL_CONTROLLER, PLACE_STACK, controller_panel)                                             \
    X(PANEL_PREDICTORS, PLACE_STACK, predictors_panel)                                             \
    X(PANEL_LOG, PLACE_STACK, log_panel)                                                           \
    X(PANEL_HELP, PLACE_PAGE, help_panel)                                                          \
    X(PANEL_SCENARIOS, PLACE_PAGE, scenarios_panel)                                                \
    X(PANEL_COMPARISON, PLACE_PAGE, comparison_panel)                                              \
    X(PANEL_CHANGES, PLACE_PAGE, changes_panel)                                                    \
    X(PANEL_RUN_LIST, PLACE_PAGE, run_list_panel)                                                  \
    X(PANEL_INFO, PLACE_PAGE, info_panel)                                                          \
    X(PANEL_PALETTE, PLACE_PROMPT, palette_panel)

typedef enum panel_id {
    PANEL_NONE,
#define PANEL_ID(id, place, description) id,
    PANEL_LIST(PANEL_ID)
#undef PANEL_ID
        PANEL_IDS // one more than the last
} panel_id;

// The place of a panel; not for PANEL_NONE.
panel_place panel_place_of(panel_id id);

// The first panel of the side, and the one after a panel of the side; PANEL_NONE after the last.
panel_id panel_first_on_side(void);
panel_id panel_next_on_side(panel_id id);
