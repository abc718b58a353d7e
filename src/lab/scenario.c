#include "src/lab/scenario.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/lab/run.h"
#include "src/lab/yaml_tree.h"
#include "src/words.h"

enum { LONGEST_TITLE = 200 }; // bytes

typedef struct place {
    int line, column; // 0 where the file does not mention it
} place;

// A fault found, with its place in the file and among the others.
typedef struct found_fault {
    place at;
    int number;
    char *sentence;
} found_fault;

// What the functions below share while one file is read.
typedef struct reader {
    const char *path;
    found_fault *found; // faults of them
    int faults;
    bool no_memory;
    scenario *s;
    place given[sizeof(((parameters *)0)->set)]; // where each parameter's value stands
    bool duration_known;                         // false if a fault may hide run.duration
} reader;

// ---- faults -------------------------------------------------------------------------------------

// Replaces what could disturb a terminal: control characters and broken UTF-8.
static void make_printable(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c != '\0';) {
        int length = *c < 0x80 ? 1 : *c >= 0xf0 ? 4 : *c >= 0xe0 ? 3 : *c >= 0xc2 ? 2 : 0;
        int have = length > 0;
        while (have > 0 && have < length && (c[have] & 0xc0) == 0x80) {
            have++;
        }
        bool control = *c < 0x20 || *c == 0x7f || (*c == 0xc2 && c[1] < 0xa0);
        if (have < length || length == 0 || control) {
            *c = '?';
            c++;
        } else {
            c += length;
        }
    }
}

__attribute__((format(printf, 4, 5))) static void report_at(reader *r, int line, int column,
                                                            const char *format, ...)
{
    char what[1280];
    found_fault found = {{line, column}, r->faults, NULL};
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    found_fault *grown = realloc(r->found, (size_t)(r->faults + 1) * sizeof *grown);
    if (grown != NULL) {
        r->found = grown;
    }
    if (grown == NULL ||
        asprintf(&found.sentence, "%s:%d:%d: %s", r->path, line, column, what) < 0) {
        r->no_memory = true;
        return;
    }
    make_printable(found.sentence);
    r->found[r->faults++] = found;
}

// By the place in the file; equal places in the order found.
static int compare_places(const void *a, const void *b)
{
    const found_fault *x = a, *y = b;
    int order = (x->at.line > y->at.line) - (x->at.line < y->at.line);
    order = order ? order : (x->at.column > y->at.column) - (x->at.column < y->at.column);
    return order ? order : (x->number > y->number) - (x->number < y->number);
}

// Passes all faults on as somebody who goes through the file meets them, and forgets them.
static void report_all(reader *r, fault_handler report, void *context)
{
    if (r->faults > 0) {
        qsort(r->found, (size_t)r->faults, sizeof *r->found, compare_places);
    }
    for (int i = 0; i < r->faults; i++) {
        report(context, r->found[i].sentence);
        free(r->found[i].sentence);
    }
    free(r->found);
    r->found = NULL;
    if (r->no_memory) {
        report(context, status_text(STATUS_NO_MEMORY));
    }
}

// printf-like, at a node or its key.
#define report_node(r, node, ...) report_at(r, (node)->line, (node)->column, __VA_ARGS__)

// malloc'ed memory is there, or the reader knows that it is not.
static bool have_memory(reader *r, const void *memory)
{
    if (memory == NULL) {
        r->no_memory = true;
    }
    return memory != NULL;
}

// ---- nodes --------------------------------------------------------------------------------------

static bool is_scalar(const tree_node *node)
{
    return node->kind == TREE_SCALAR;
}

static bool is_empty(const tree_node *node)
{
    return is_scalar(node) && node->plain && node->text[0] == '\0';
}

static bool is_null(const tree_node *node)
{
    return is_scalar(node) && node->plain &&
           (strcmp(node->text, "null") == 0 || strcmp(node->text, "~") == 0);
}

static const char *kind_name(const tree_node *node)
{
    static const char *const names[] = {"a single value", "a list", "a map of keys"};
    return is_empty(node) ? "empty" : names[node->kind];
}

// The key of a map's child as text; NULL, after a fault, if it is no word or was there before.
static const char *key_of(reader *r, const tree_node *map, const tree_node *child)
{
    const tree_node *key = child->key;
    if (!is_scalar(key)) {
        report_node(r, key, "the key is %s, expected a word", kind_name(key));
        return NULL;
    }
    for (const tree_node *other = map->first; other != child; other = other->next) {
        if (is_scalar(other->key) && strcmp(other->key->text, key->text) == 0) {
            report_node(r, key, "'%.60s' is there twice, expected it once (first at line %d)",
                        key->text, other->key->line);
            return NULL;
        }
    }
    return key->text;
}

// True for a map; otherwise a fault that shows an example.
static bool expect_map(reader *r, const tree_node *node, const char *what, const char *example)
{
    if (node->kind != TREE_MAP) {
        report_node(r, node, "%s is %s, expected keys such as '%s'", what, kind_name(node),
                    example);
    }
    return node->kind == TREE_MAP;
}

// Reads a finite number that may carry its unit ("0.4 s"); false after a fault.
static bool read_quantity(reader *r, const tree_node *node, const char *what, const char *unit,
                          double *value)
{
    const char *rest;
    const char *space = unit[0] != '\0' ? " in " : "";
    if (!is_scalar(node) || is_empty(node)) {
        report_node(r, node, "%s is %s, expected a number%s%s", what, kind_name(node), space, unit);
        return false;
    }
    if (!decimal_read(node->text, value, &rest)) {
        report_node(r, node, "%s = '%.60s' is not a finite number, expected a number%s%s", what,
                    node->text, space, unit);
        return false;
    }
    if (*rest != '\0' && strcmp(rest, unit) != 0) {
        report_node(r, node, "%s = '%.60s' carries '%.20s', expected %s", what, node->text, rest,
                    unit[0] != '\0' ? unit : "a number without a unit");
        return false;
    }
    if (!isfinite(*value)) {
        report_node(r, node, "%s = '%.60s' is too large, expected a finite number", what,
                    node->text);
        return false;
    }
    return true;
}

// ---- parameters ---------------------------------------------------------------------------------

// True if the parameter belongs to the group ("arm.k2" to "arm").
static bool in_group(const char *path, const char *group)
{
    size_t length = strlen(group);
    return strncmp(path, group, length) == 0 && path[length] == '.';
}

static bool is_group(const char *word)
{
    for (int i = 0; i < parameter_count; i++) {
        if (in_group(parameter_table[i].path, word)) {
            return true;
        }
    }
    return false;
}

static void report_unknown_parameter(reader *r, const tree_node *key, const char *group)
{
    nearest_word near = nearest_begin(key->text);
    char known[640] = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        if (in_group(path, group)) {
            size_t used = strlen(known);
            const char *tail = path + strlen(group) + 1;
            snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", tail);
            nearest_try(&near, tail);
        }
    }
    if (near.best != NULL) {
        report_node(r, key, "unknown key '%.60s' in %s, did you mean '%s'?", key->text, group,
                    near.best);
        return;
    }
    // a parameter of another group under its own name
    const char *elsewhere = parameter_suggest(key->text);
    const char *tail = elsewhere != NULL ? strchr(elsewhere, '.') + 1 : NULL;
    if (tail != NULL && strcmp(tail, key->text) == 0) {
        report_node(r, key, "unknown key '%.60s' in %s, did you mean %s?", key->text, group,
                    elsewhere);
        return;
    }
    report_node(r, key, "unknown key '%.60s' in %s, expected one of %s", key->text, group, known);
}

// The text of a parameter's value; NULL after a fault.
static const char *value_text(reader *r, const tree_node *node, const char *path)
{
    if (!is_scalar(node) || is_empty(node)) {
        report_node(r, node, "%s is %s, expected a value", path, kind_name(node));
        return NULL;
    }
    return node->text;
}

static void read_group(reader *r, const tree_node *map, const char *group)
{
    fault f;
    int first = 0;
    while (!in_group(parameter_table[first].path, group)) {
        first++;
    }
    char example[64];
    snprintf(example, sizeof example, "%s: ...", strchr(parameter_table[first].path, '.') + 1);
    if (!expect_map(r, map, group, example)) {
        return;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = key_of(r, map, child);
        if (key == NULL) {
            continue;
        }
        char path[128];
        snprintf(path, sizeof path, "%s.%s", group, key);
        int index = parameter_find(path);
        if (index < 0) {
            report_unknown_parameter(r, child->key, group);
            continue;
        }
        const char *text = value_text(r, child, path);
        if (text != NULL && parameter_set_text(&r->s->parameters, index, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
            text = NULL;
        }
        if (text != NULL) {
            r->given[index] = (place){child->line, child->column};
        }
    }
}

// Position of a parameter's path in a sentence, as a whole word; NULL if it is not there.
static const char *mention(const char *sentence, const char *path)
{
    size_t length = strlen(path);
    for (const char *at = strstr(sentence, path); at != NULL; at = strstr(at + 1, path)) {
        char next = at[length];
        bool goes_on = next == '_' || (next >= 'a' && next <= 'z') || (next >= '0' && next <= '9');
        if (!goes_on) {
            return at;
        }
    }
    return NULL;
}

// The parameter given in the file that a sentence mentions first, or -1.
static int blamed_parameter(const reader *r, const parameters *p, const char *sentence)
{
    int blamed = -1;
    const char *first = NULL;
    for (int i = 0; i < parameter_count; i++) {
        const char *at = mention(sentence, parameter_table[i].path);
        if (at != NULL && p->set[i] && r->given[i].line > 0 && (first == NULL || at < first)) {
            blamed = i;
            first = at;
        }
    }
    return blamed;
}

// Resolves the parameters. To report every fault, a blamed one is put back to its default and the
// rest is resolved again.
static void resolve(reader *r)
{
    fault f;
    parameters trial = r->s->parameters;
    while (parameters_resolve(&trial, &f) != STATUS_OK) {
        int blamed = blamed_parameter(r, &trial, f.text);
        place at = {1, 1};
        if (blamed >= 0) {
            at = r->given[blamed];
        } else if (r->given[parameter_find("arm.model")].line > 0) {
            at = r->given[parameter_find("arm.model")];
        }
        report_at(r, at.line, at.column, "%s", f.text);
        if (blamed < 0) {
            break;
        }
        trial.set[blamed] = 0;
    }
    r->s->parameters = trial;
}

// ---- script -------------------------------------------------------------------------------------

// Puts the action behind all that are not later; false without memory.
static bool add_action(reader *r, action a)
{
    scenario *s = r->s;
    action *grown = realloc(s->actions, (size_t)(s->action_count + 1) * sizeof *grown);
    if (!have_memory(r, grown)) {
        return false;
    }
    s->actions = grown;
    int i = s->action_count++;
    for (; i > 0 && grown[i - 1].time > a.time; i--) {
        grown[i] = grown[i - 1];
    }
    grown[i] = a;
    return true;
}

static void read_set(reader *r, const tree_node *map, bool timed, double time)
{
    if (!expect_map(r, map, "set", "motor.voltage: 2 V")) {
        return;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        fault f;
        const char *path = key_of(r, map, child);
        if (path == NULL) {
            continue;
        }
        int index = parameter_find(path);
        if (index < 0) {
            const char *near = parameter_suggest(path);
            report_node(r, child->key, "unknown parameter '%.60s'%s%s%s", path,
                        near ? ", did you mean '" : ", expected one that 'show' lists",
                        near ? near : "", near ? "'?" : "");
            continue;
        }
        if (!parameter_table[index].timed) {
            report_node(r, child->key,
                        "%s cannot change during a run, expected it at the top of the file", path);
            continue;
        }
        // a scratch copy checks and converts the value
        parameters scratch = r->s->parameters;
        const char *text = value_text(r, child, path);
        if (text == NULL) {
            continue;
        }
        if (parameter_set_text(&scratch, index, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
        } else if (timed) {
            add_action(r, (action){.time = time,
                                   .kind = ACTION_SET,
                                   .parameter = index,
                                   .value = parameter_get(&scratch, index)});
        }
    }
}

static void read_push(reader *r, const tree_node *node, bool timed, double time)
{
    double impulse;
    if (r->s->parameters.arm.model == ARM_PRINTED) {
        report_node(r, node->key,
                    "push: the printed model takes no pushes, expected 'set' or arm.model = "
                    "corrected");
    }
    if (read_quantity(r, node, "push", "N s", &impulse) && timed) {
        add_action(r,
                   (action){.time = time, .kind = ACTION_PUSH, .parameter = -1, .value = impulse});
    }
}

// Reads the instant of an action and checks it against the run's duration.
static bool read_time(reader *r, const tree_node *node, double *time)
{
    double duration = r->s->parameters.run.duration;
    if (!read_quantity(r, node, "at", "s", time)) {
        return false;
    }
    if (*time < 0 || (r->duration_known && *time > duration)) {
        report_node(r, node, "at = %g s is outside the run, expected 0 to %g s (run.duration)",
                    *time, duration);
        return false;
    }
    return true;
}

// Finds the time of an action and what it does; NULL for what is missing.
static void find_action_parts(reader *r, const tree_node *map, const tree_node **at,
                              const tree_node **deed)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = key_of(r, map, child);
        if (key == NULL) {
            continue;
        }
        if (strcmp(key, "at") == 0) {
            *at = child;
        } else if (strcmp(key, "set") != 0 && strcmp(key, "push") != 0) {
            nearest_word near = nearest_begin(key);
            nearest_try(&near, "at");
            nearest_try(&near, "set");
            nearest_try(&near, "push");
            report_node(r, child->key, "unknown key '%.60s' in an action, %s%s%s", key,
                        near.best ? "did you mean '" : "expected at, set or push",
                        near.best ? near.best : "", near.best ? "'?" : "");
        } else if (*deed != NULL) {
            report_node(r, child->key,
                        "'%s' after '%s' in one action, expected one of them (begin a new '- at:')",
                        key, (*deed)->key->text);
        } else {
            *deed = child;
        }
    }
}

static void read_action(reader *r, const tree_node *map)
{
    const tree_node *at = NULL, *deed = NULL;
    double time = 0;
    if (!expect_map(r, map, "an action", "at: 0.4 s")) {
        return;
    }
    // a misspelt key already explains what is missing
    int faults = r->faults;
    find_action_parts(r, map, &at, &deed);
    if (at == NULL && r->faults == faults) {
        report_node(r, map, "an action without a time, expected 'at: 0.4 s'");
    }
    if (deed == NULL && r->faults == faults) {
        report_node(r, map, "an action that does nothing, expected 'set:' or 'push:'");
    }
    bool timed = at != NULL && read_time(r, at, &time);
    if (deed != NULL && strcmp(deed->key->text, "set") == 0) {
        read_set(r, deed, timed, time);
    } else if (deed != NULL) {
        read_push(r, deed, timed, time);
    }
}

static void read_script(reader *r, const tree_node *list)
{
    if (list->kind != TREE_LIST) {
        report_node(r, list, "script is %s, expected a list of actions '- at: ...'",
                    kind_name(list));
        return;
    }
    for (const tree_node *child = list->first; child != NULL; child = child->next) {
        read_action(r, child);
    }
}

// ---- expectations -------------------------------------------------------------------------------

static const summary_info *find_quantity(const char *key)
{
    for (int i = 0; i < summary_count; i++) {
        if (strcmp(summary_table[i].key, key) == 0) {
            return &summary_table[i];
        }
    }
    return NULL;
}

// True if a run's summary has the quantity and two machines agree about it.
static bool check_quantity(reader *r, const tree_node *key)
{
    const summary_info *info = find_quantity(key->text);
    if (info != NULL && info->timing) {
        report_node(r, key, "%s depends on the computer, expected a quantity of the arm",
                    key->text);
        return false;
    }
    if (info == NULL) {
        nearest_word near = nearest_begin(key->text);
        for (int i = 0; i < summary_count; i++) {
            nearest_try(&near, summary_table[i].key);
        }
        report_node(r, key, "unknown quantity '%.60s', %s%s%s", key->text,
                    near.best ? "did you mean '" : "expected a key of 'run --json'",
                    near.best ? near.best : "", near.best ? "'?" : "");
    }
    return info != NULL;
}

// Reads {value: ..., tolerance: ...}; false after a fault.
static bool read_value_and_tolerance(reader *r, const tree_node *map, expectation *e)
{
    const tree_node *value = NULL, *tolerance = NULL;
    int faults = r->faults;
    if (map->kind != TREE_MAP) {
        report_node(r, map, "%s is %s, expected {value: ..., tolerance: ...} or null", e->quantity,
                    kind_name(map));
        return false;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = key_of(r, map, child);
        if (key == NULL) {
            continue;
        }
        if (strcmp(key, "value") == 0) {
            value = child;
        } else if (strcmp(key, "tolerance") == 0) {
            tolerance = child;
        } else {
            report_node(r, child->key, "unknown key '%.60s' in %s, expected value and tolerance",
                        key, e->quantity);
        }
    }
    if (value == NULL || tolerance == NULL) {
        report_node(r, map, "%s has no %s, expected {value: ..., tolerance: ...}", e->quantity,
                    value == NULL ? "value" : "tolerance");
    }
    if (value != NULL) {
        read_quantity(r, value, "value", "", &e->value);
    }
    if (tolerance != NULL && read_quantity(r, tolerance, "tolerance", "", &e->tolerance) &&
        e->tolerance < 0) {
        report_node(r, tolerance, "tolerance = %g is negative, expected 0 or more", e->tolerance);
    }
    return r->faults == faults;
}

static void read_expect(reader *r, const tree_node *map)
{
    scenario *s = r->s;
    int most = 0;
    if (!expect_map(r, map, "expect", "impacts: {value: 3, tolerance: 0}")) {
        return;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        most++;
    }
    s->expectations = calloc((size_t)most + 1, sizeof *s->expectations);
    if (!have_memory(r, s->expectations)) {
        return;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = key_of(r, map, child);
        if (key == NULL || !check_quantity(r, child->key)) {
            continue;
        }
        expectation e = {.line = child->key->line, .column = child->key->column};
        snprintf(e.quantity, sizeof e.quantity, "%s", key);
        e.is_null = is_null(child);
        if (e.is_null || read_value_and_tolerance(r, child, &e)) {
            s->expectations[s->expectation_count++] = e;
        }
    }
}

// ---- the whole file -----------------------------------------------------------------------------

// Copies prose; only the description may have several lines. NULL after a fault.
static char *read_prose(reader *r, const tree_node *node, const char *what, bool many_lines)
{
    if (!is_scalar(node) || node->text[0] == '\0') {
        report_node(r, node, "%s is %s, expected text", what, kind_name(node));
        return NULL;
    }
    size_t length = strlen(node->text);
    while (length > 0 && strchr(" \t\r\n", node->text[length - 1]) != NULL) {
        length--;
    }
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)node->text[i];
        bool control =
            c < 0x20 || c == 0x7f || (c == 0xc2 && (unsigned char)node->text[i + 1] < 0xa0);
        if (control && !(many_lines && (c == '\n' || c == '\t'))) {
            report_node(r, node, "%s holds %s, expected %s", what,
                        c == '\n' ? "several lines" : "a control character",
                        many_lines ? "text" : "one line of text");
            return NULL;
        }
    }
    if (!many_lines && length > LONGEST_TITLE) {
        report_node(r, node, "%s has %zu bytes, expected at most %d", what, length, LONGEST_TITLE);
        return NULL;
    }
    char *copy = strndup(node->text, length);
    have_memory(r, copy);
    return copy;
}

static void report_unknown_top(reader *r, const tree_node *key)
{
    static const char *const others[] = {"title", "description", "script", "expect"};
    nearest_word near = nearest_begin(key->text);
    int index = parameter_find(key->text);
    if (index >= 0) {
        const char *dot = strchr(key->text, '.');
        report_node(r, key, "unknown key '%s', expected '%s:' under '%.*s:'", key->text, dot + 1,
                    (int)(dot - key->text), key->text);
        return;
    }
    char groups[256] = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        char group[64];
        snprintf(group, sizeof group, "%.*s", (int)strcspn(path, "."), path);
        if (i == 0 || !in_group(parameter_table[i - 1].path, group)) {
            size_t used = strlen(groups);
            snprintf(groups + used, sizeof groups - used, ", %s", group);
        }
        // the group's name is compared where it lasts: as the beginning of its path
        if (edit_distance(key->text, group, near.distance) < near.distance) {
            near.distance = edit_distance(key->text, group, near.distance);
            near.best = path;
        }
    }
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        nearest_try(&near, others[i]);
    }
    if (near.best != NULL) {
        report_node(r, key, "unknown key '%.60s', did you mean '%.*s'?", key->text,
                    (int)strcspn(near.best, "."), near.best);
        return;
    }
    report_node(r, key, "unknown key '%.60s', expected title, description%s, script or expect",
                key->text, groups);
}

// Reads everything; script and expect come after the parameters that they depend on.
static void read_root(reader *r, const tree_node *root)
{
    const tree_node *script = NULL, *expect = NULL;
    if (!expect_map(r, root, "the file", "title: ...")) {
        return;
    }
    for (const tree_node *child = root->first; child != NULL; child = child->next) {
        const char *key = key_of(r, root, child);
        if (key == NULL) {
            continue;
        }
        if (strcmp(key, "title") == 0) {
            r->s->title = read_prose(r, child, "title", false);
        } else if (strcmp(key, "description") == 0) {
            r->s->description = read_prose(r, child, "description", true);
        } else if (strcmp(key, "script") == 0) {
            script = child;
        } else if (strcmp(key, "expect") == 0) {
            expect = child;
        } else if (is_group(key)) {
            read_group(r, child, key);
        } else {
            report_unknown_top(r, child->key);
        }
    }
    r->duration_known = r->given[parameter_find("run.duration")].line > 0 || r->faults == 0;
    resolve(r);
    if (script != NULL) {
        read_script(r, script);
    }
    if (expect != NULL) {
        read_expect(r, expect);
    }
}

// Fills in name, file and what the file left out.
static void complete(reader *r, const char *name)
{
    scenario *s = r->s;
    s->name = strdup(name != NULL ? name : r->path);
    s->file = strdup(r->path);
    if (s->title == NULL) {
        s->title = strdup(name != NULL ? name : r->path);
    }
    if (s->description == NULL) {
        s->description = strdup("");
    }
    have_memory(r, s->name);
    have_memory(r, s->file);
    have_memory(r, s->title);
    have_memory(r, s->description);
}

status scenario_parse(scenario *s, const char *text, size_t length, const char *path,
                      const char *name, fault_handler report, void *context)
{
    tree_fault f;
    reader r = {.path = path, .s = s};
    *s = (scenario){0};
    parameters_defaults(&s->parameters, ARM_CORRECTED);
    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        r.no_memory = f.no_memory;
        report_at(&r, f.line, f.column, "%s", f.text);
    } else {
        read_root(&r, root);
        tree_free(root);
    }
    if (r.faults == 0 && !r.no_memory) {
        complete(&r, name);
    }
    report_all(&r, report, context);
    if (r.no_memory || r.faults > 0) {
        scenario_finish(s);
        return r.no_memory ? STATUS_NO_MEMORY : STATUS_BAD_SCENARIO;
    }
    return STATUS_OK;
}

void scenario_finish(scenario *s)
{
    free(s->name);
    free(s->file);
    free(s->title);
    free(s->description);
    free(s->actions);
    free(s->expectations);
    *s = (scenario){0};
}

// Sets one parameter of p and resolves all; f holds the sentence without its beginning.
static status override_parameter(const scenario *s, parameters *p, const char *assignment, fault *f)
{
    char path[128];
    size_t length = strcspn(assignment, "=");
    if (assignment[length] == '\0' || length == 0 || length >= sizeof path) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "not an assignment, expected PATH=VALUE such as arm.k2=49.2");
    }
    snprintf(path, sizeof path, "%.*s", (int)length, assignment);
    int index = parameter_find(path);
    if (index < 0) {
        const char *near = parameter_suggest(path);
        return fault_set(f, STATUS_BAD_ARGUMENT, "unknown parameter '%.60s'%s%s%s", path,
                         near ? ", did you mean '" : ", expected one that 'show' lists",
                         near ? near : "", near ? "'?" : "");
    }
    status result = parameter_set_text(p, index, assignment + length + 1, f);
    if (result == STATUS_OK) {
        result = parameters_resolve(p, f);
    }
    for (int i = 0; i < s->action_count && result == STATUS_OK; i++) {
        if (s->actions[i].kind == ACTION_PUSH && p->arm.model == ARM_PRINTED) {
            result = fault_set(f, STATUS_BAD_SCENARIO,
                               "the printed model takes no pushes, but the script has one at %g s",
                               s->actions[i].time);
        }
    }
    return result;
}

status scenario_override(scenario *s, const char *assignment, fault *f)
{
    fault inner;
    parameters p = s->parameters;
    status result = override_parameter(s, &p, assignment, &inner);
    if (result != STATUS_OK) {
        fault_set(f, result, "--set %.200s: %.700s", assignment, inner.text);
        if (f != NULL) {
            make_printable(f->text);
        }
        return result;
    }
    s->parameters = p;
    return STATUS_OK;
}
