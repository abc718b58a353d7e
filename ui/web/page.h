// The lab as the page in a browser calls it: one scenario, its changes, one run.
//
// Texts go in and come out, most of them JSON; numbers are read from the module's memory.
// What a call returns stays as it is until the next one that returns a text (of
// page_signal: a signal). NULL stands for a text that there is no memory for.
#pragma once

// The tables: {parameters: [{path, unit, choices, about, timed, text, switch, whole}],
// signals: [{name, unit, about}], numbers: [{key, label, unit, about}]}; `choices` is
// empty but for a choice.
const char *page_tables(void);

// Reads a scenario from the text of its file; `name` is that of a shipped one or any
// other. Returns what it is: {title, description, panes, values, given, sliders: [{path,
// low, high, logarithmic}], law: {settings: [{name, unit, about, initial, minimum,
// maximum}], shared: [path]}, without_effect}; or {faults: [sentence], line}, the line
// being that of the first one, 0 if it is of none.
const char *page_read(const char *name, const char *text);

// Changes the scenario that was read: "PATH=VALUE" in each line of `assignments`, all
// that differs from its text. Returns the same; on a fault there is nothing to be run.
const char *page_change(const char *assignments);

// The changed scenario as a file; the run as `run --csv` writes it. Empty if there is
// none.
const char *page_yaml(void);
const char *page_csv(void);

// Runs the changed scenario, for `seconds` at most, with its rows (1) or without (0).
// Returns what `run --json` writes, an empty text if there is nothing to run.
const char *page_run(double seconds, int with_rows);

// What `predict --json` writes, null if the arm never touches after a flight.
const char *page_predictions(void);

// What happened in the run, for people: {line, sentences}, the line for beside its
// numbers.
const char *page_account(void);

// Rows of the run, degrees of freedom of the arm, and their angles row by row [rad].
int page_rows(void);
int page_freedoms(void);
const double *page_angles(void);

// The values of a signal in all rows; NULL if there is no such signal or no memory.
const double *page_signal(const char *name);
