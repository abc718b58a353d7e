// What the parts of the scenario reader share while one file is read.
#pragma once

#include "src/scenario/scenario.h"
#include "src/scenario/yaml_tree.h"

typedef struct place {
    int line, column; // from 1; 0 where the file does not mention it
} place;

// A fault found, with its place in the file and among the others.
typedef struct found_fault {
    place at;
    const char *about; // path of the parameter, NULL if it is of none
    int number;        // in the order found
    char *sentence;    // with path and place
} found_fault;

// What the functions below share while one file is read.
typedef struct reader {
    const char *path;
    found_fault *found;
    int faults; // how many were found
    bool no_memory;
    scenario *s;
    const char *about;   // path of the parameter that is being read, NULL if none is
    fault_place refused; // of the first fault, once all are reported
    place given[sizeof(((parameters *)0)->set)]; // where each parameter's value stands
    bool duration_known;                         // false if a fault may hide run.duration
} reader;

// --- faults and nodes: reader.c

// Whether an allocation succeeded; the reader remembers one that did not.
bool reader_have_memory(reader *r, const void *memory);

// Records a fault at a place of the file; printf-like. Always false.
bool reader_report_at(reader *r, int line, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// The same at a node or its key.
#define report_node(r, node, ...)                                                        \
    reader_report_at(r, (node)->line, (node)->column, __VA_ARGS__)

// Reports all faults in the order of their places, and frees them.
void reader_report_all(reader *r, fault_handler report, void *context);

// Whether a node is a single value; nothing at all.
bool node_is_scalar(const tree_node *node);
bool node_is_empty(const tree_node *node);

// Bytes of a node's text without the blanks at its end; 0 if it holds none.
size_t node_text_length(const tree_node *node);
// "a list", as a sentence names what stands there.
const char *node_kind_name(const tree_node *node);

// The key of a map's child as text; NULL, after a fault, if it is no word or was there
// before.
const char *reader_key(reader *r, const tree_node *map, const tree_node *child);

// True for a map; otherwise a fault that shows an example.
bool reader_expect_map(reader *r, const tree_node *node, const char *what,
                       const char *example);

// Parses a finite number that may carry its unit ("0.4 s"); false after a fault.
bool reader_quantity(reader *r, const tree_node *node, const char *what, const char *unit,
                     double *value);

// --- the parts of a file

// True if the parameter belongs to the group ("arm.k2" to "arm").
bool parameter_in_group(const char *path, const char *group);

// Whether a word is the name of a group of parameters.
bool reader_is_group(const char *word);

// The text of a parameter's value; NULL after a fault.
const char *reader_value_text(reader *r, const tree_node *node, const char *path);

// Parses the values of a group into the scenario.
void reader_group(reader *r, const tree_node *map, const char *group);

// Resolves the parameters. To report every fault, the one to blame (fault.path) is put
// back to its default and the rest is resolved again.
void reader_resolve(reader *r);

// Reports, at a place, that control.lock names a mode which the law does not have.
void reader_check_lock(reader *r, const parameters *p, place at);

// Parses what a fit leaves open of the parameters.
void reader_fit(reader *r, const tree_node *map);

// Parses the script's actions; the parameters must have been resolved.
void reader_script(reader *r, const tree_node *list);

// Parses the lesson; the parameters must have been resolved.
void reader_lesson(reader *r, const tree_node *map);

// Parses what is expected of the run.
void reader_expectations(reader *r, const tree_node *map);
