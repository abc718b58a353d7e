// The numbers of control.settings, each of which is a path of its own:
// control.settings.NAME.
//
// They are one text, "NAME=VALUE NAME=VALUE": which of them a control law, a plug-in or a
// program has is known when the run starts, so that any NAME takes any finite number
// here.
#pragma once

#include "src/tables/parameters.h"

// The row under which any control.settings.NAME stands, but for its name.
extern const parameter_info setting_info;

// The NAME of control.settings.NAME as it stands in the path; NULL of any other path.
const char *settings_name(const char *path);

// The index of a parameter by its path, as parameter_look_up, or of control.settings by
// that of one of them: *name is then its NAME, within the path, else NULL. -1, with a
// sentence in f, if there is no such parameter.
int settings_look_up(const char *path, const char **name, fault *f);

// As parameter_look_up, and what gives the parameter a value: of a path
// control.settings.NAME the index is that of control.settings, and *value ".NAME=VALUE",
// which stands in `room`.
int settings_look_up_value(const char *path, const char **value,
                           char room[PARAMETER_TEXT_SIZE], fault *f);

// The number of that name. False if the text has none of the name, or one that is no
// number.
bool settings_get(const parameters *p, const char *name, double *value);

// Gives one of them a value, in its place or behind the others; f says what was expected.
status settings_set(parameters *p, const char *name, double value, fault *f);
status settings_set_text(parameters *p, const char *name, const char *text, fault *f);

// One of the words NAME=VALUE of a text of settings, which spaces separate.
typedef struct setting {
    const char *word; // where it stands in the text
    size_t length;
    char name[PARAMETER_TEXT_SIZE];  // the whole word if it has no '='
    char value[PARAMETER_TEXT_SIZE]; // empty without '='
} setting;

// Reads the first setting of *rest, a text shorter than PARAMETER_TEXT_SIZE, and moves
// *rest behind it. Returns false if there is none.
bool settings_next(const char **rest, setting *s);

// Reads the value of a setting; false if it is no number.
bool setting_number(const setting *s, double *value);
