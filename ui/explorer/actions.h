// What the commands and keys of the terminal lab do. The table that names them is in commands.c.
#pragma once

#include "ui/explorer/lab.h"

// Every action takes its argument as text, "" if there is none, says what came of it on the message
// line and returns false if it failed.
bool act_play(lab *l, const char *argument);
bool act_step(lab *l, const char *argument);
bool act_step_event(lab *l, const char *argument);
bool act_step_touch(lab *l, const char *argument);
bool act_seek(lab *l, const char *argument);
bool act_set_speed(lab *l, const char *argument);
bool act_restart(lab *l, const char *argument);
bool act_set(lab *l, const char *argument);
bool act_edit(lab *l, const char *argument);
bool act_nudge(lab *l, const char *argument);
bool act_select_parameter(lab *l, const char *argument);
bool act_push(lab *l, const char *argument);
bool act_law(lab *l, const char *argument);
bool act_lock(lab *l, const char *argument);
bool act_exchange_model(lab *l, const char *argument);
bool act_extend(lab *l, const char *argument);
bool act_branch(lab *l, const char *argument);
bool act_forget(lab *l, const char *argument);
bool act_stop(lab *l, const char *argument);
bool act_compare(lab *l, const char *argument);
bool act_undo(lab *l, const char *argument);
bool act_redo(lab *l, const char *argument);
bool act_set_mark(lab *l, const char *argument);
bool act_other_side(lab *l, const char *argument);
bool act_zoom(lab *l, const char *argument);
bool act_pan(lab *l, const char *argument);
bool act_follow(lab *l, const char *argument);
bool act_axis(lab *l, const char *argument);
bool act_focus(lab *l, const char *argument);
bool act_alone(lab *l, const char *argument);
bool act_trace_pane(lab *l, const char *argument);
bool act_open_scenario_by(lab *l, const char *argument);
bool act_save(lab *l, const char *argument);
bool act_save_scene(lab *l, const char *argument);
bool act_set_glyphs(lab *l, const char *argument);
bool act_set_theme(lab *l, const char *argument);
bool act_set_colours(lab *l, const char *argument);
bool act_set_mouse(lab *l, const char *argument);
bool act_show_panes(lab *l, const char *argument);
bool act_remember(lab *l, const char *argument);
bool act_redraw(lab *l, const char *argument);
bool act_wait_for(lab *l, const char *argument);
bool act_show_help(lab *l, const char *argument);
bool act_bind_key(lab *l, const char *argument);
bool act_unbind_key(lab *l, const char *argument);
bool act_find_scenario(lab *l, const char *argument);
bool act_quit(lab *l, const char *argument);

// Says what was wrong unless the code is STATUS_OK; returns whether it is.
bool lab_complain(lab *l, status code, const fault *f);

// Gives a parameter a new value and says what came of it.
bool lab_change(lab *l, int parameter, const char *text);

// The mouse takes hold of a slider or moves it, lets go of it, turns its wheel on it. The first
// only shows a value, the others give it.
void lab_hold_slider(lab *l, const lab_spot *spot, int x);
void lab_drop_slider(lab *l);
void lab_turn_slider(lab *l, int parameter, int direction);

// Reads a number; false with a message if the text is none.
bool lab_take_number(lab *l, const char *text, double *value);

// The visible part of the run made longer or shorter round an instant, or moved [s].
void lab_zoom_at(lab *l, double factor, double time);
void lab_pan_by(lab *l, double seconds);
// A pane's axis made longer or shorter round a share of its height from the top, or moved up by a
// share of it; it is fixed then.
void lab_scale_axis(lab *l, int pane, double factor, double share);
void lab_shift_axis(lab *l, int pane, double share);
