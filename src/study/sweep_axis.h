// One parameter that a sweep varies, and the grammar of --vary that says over which
// values.
#pragma once

#include "src/scenario/scenario.h"

enum { SWEEP_VALUE_TEXT = 128, SWEEP_NAME = 64 };

// As many runs as have a number of their own in a double.
#define SWEEP_MOST_RUNS ((size_t)1 << 53)

// One varied parameter, or one number of a list or of control.settings. Words and truth
// values are numbers here, as in parameter_get.
typedef struct sweep_axis {
    int parameter; // index in parameter_table, that of control.settings for one of them
    int element;   // the number of a list that is varied, counted from 1; 0: no list
    char name[SWEEP_NAME]; // path of the parameter, of a list's number
                           // "arm.joint_stiffness[2]"
    double *values;        // of a list, NULL for a range
    size_t count;          // of values, 0 for a range to draw from
    double low, high;      // of a range, as given; low may be the larger one
    bool is_range;
    bool together; // drawn at the share of the axis before it, so that the values go in
                   // pairs
    bool logarithmic; // a range spaced evenly in the logarithm
    char *text; // what is varied, in one way of writing: "1:10:5", "0.1:10:3:log", "a,b"
} sweep_axis;

// Finds what is varied by its name, PATH, LIST[k] or control.settings.NAME, up to an
// equals sign, and writes it into an axis of zeroes. On failure f says what was expected.
status sweep_axis_find(sweep_axis *axis, const char *name, fault *f);

// Gives the parameters a value of the axis; f says what does not fit, such as a list too
// short.
status sweep_axis_apply(const sweep_axis *axis, double value, parameters *p, fault *f);

// The scenario with a value for each of `count` axes; it borrows everything but its
// parameters from the base. Fails, with the reason in f, if the values do not go
// together.
status sweep_axes_scenario(const sweep_axis *axes, int count, const double *values,
                           const scenario *base, scenario *derived, fault *f);

// Reads the values "a:b:n", "a:b:n:log" or "v1,v2,v3" of the axis, whose parameter is
// set; n may be left out if values are drawn from a range, and a list to draw from may
// have a value several times. On failure f says what was expected; sweep_axis_finish in
// either case.
status sweep_axis_parse(sweep_axis *axis, const char *text, bool drawn, fault *f);

// The same of a range to draw from, "a:b" or "a:b:log", and nothing else.
status sweep_axis_parse_range(sweep_axis *axis, const char *text, fault *f);

void sweep_axis_finish(sweep_axis *axis);

// The varied parameter; setting_info for control.settings.NAME.
const parameter_info *sweep_axis_parameter(const sweep_axis *axis);

// Whether its values are written as words.
bool sweep_axis_has_words(const sweep_axis *axis);

// The value that the parameters have; NaN if they have none, as of a setting that is not
// given.
double sweep_axis_get(const sweep_axis *axis, const parameters *p);

// Point number i < n of n >= 2 that span a range evenly, or in equal ratios if it is
// logarithmic.
double sweep_axis_point(const sweep_axis *axis, size_t i, size_t n);

// Value number i < axis->count, of a list or of a range in a grid.
double sweep_axis_value(const sweep_axis *axis, size_t i);

// A value of the axis as a scenario file would give it, exact ("newmark", "0.1").
void sweep_axis_format(const sweep_axis *axis, double value, char *text, size_t size);

// The value at share u of the axis, 0 <= u < 1: equal shares for the values of a list,
// equal lengths (or ratios, if logarithmic) for a range.
double sweep_axis_value_at(const sweep_axis *axis, double share);
