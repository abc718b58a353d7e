// The lesson of a scenario file.
#include "src/scenario/reader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"
#include "src/tables/summary.h"

#define NEAR_ENOUGH 0.001 // the tolerance of a parameter's value, as a share of it

// --- pieces ----------------------------------------------------------------------------

// The text of a node in one line; NULL after a fault.
static char *read_text(reader *r, const tree_node *node, const char *what)
{
    const size_t length = node_text_length(node);
    if (length == 0) {
        report_node(r, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }

    // line ends and tabs become blanks
    char *text = strndup(node->text, length);
    if (!reader_have_memory(r, text)) {
        return NULL;
    }
    for (char *c = text; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\t') {
            *c = ' ';
        }
    }
    return text;
}

// Reads the texts of a list, `most` of them at most. Returns how many there are.
static int read_texts(reader *r, const tree_node *list, const char *what, char **texts,
                      int most)
{
    // it must be a list
    if (list->kind != TREE_LIST) {
        report_node(r, list, "%s is %s, expected a list", what, node_kind_name(list));
        return 0;
    }

    // its texts; one that cannot be read is left out
    int count = 0;
    for (const tree_node *child = list->first; child != NULL; child = child->next) {
        if (count == most) {
            report_node(r, child, "%s: more than %d of them", what, most);
            return count;
        }
        texts[count] = read_text(r, child, what);
        if (texts[count] != NULL) {
            count++;
        }
    }
    return count;
}

// Reports every key of a map that is not one of `known`, which lists keys with a blank
// before and after each.
static void refuse_other_keys(reader *r, const tree_node *map, const char *known)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        char word[64];
        snprintf(word, sizeof word, " %.60s ", key != NULL ? key : "");
        if (key != NULL && (strchr(key, ' ') != NULL || strstr(known, word) == NULL)) {
            report_node(r, child->key, "unknown key '%.60s', expected some of:%s", key,
                        known);
        }
    }
}

// Whether a map must have a key.
typedef enum key_need { OPTIONAL, REQUIRED } key_need;

// Reads a number of a map, which may not be less than `least`. If an optional key is
// missing, the value stays as it is.
static void read_number(reader *r, const tree_node *map, const char *key, key_need need,
                        double least, double *value)
{
    const tree_node *node = tree_child(map, key);
    if (node != NULL) {
        if (reader_quantity(r, node, key, "", value) && *value < least) {
            report_node(r, node, "%s = %g, expected at least %g", key, *value, least);
        }
    } else if (need == REQUIRED) {
        report_node(r, map, "there is no '%s' here, expected one", key);
    }
}

// A whole number from 1 to `most`; 0 after a fault, whose sentence calls the number
// `what`.
static int read_count(reader *r, const tree_node *node, const char *key, int most,
                      const char *what)
{
    double number;
    if (!reader_quantity(r, node, key, "", &number)) {
        return 0;
    }
    if (number != floor(number) || number < 1 || number > most) {
        report_node(r, node, "%s = %g, expected %s, from 1 to %d", key, number, what,
                    most);
        return 0;
    }
    return (int)number;
}

// Reads the name of a quantity of the summary from a map, as its index.
static void read_quantity(reader *r, const tree_node *map, const char *key, int *index)
{
    const tree_node *node = tree_child(map, key);
    const bool named = node != NULL && node_is_scalar(node);
    if (named) {
        *index = summary_find(node->text);
    } else {
        *index = -1;
    }
    if (*index < 0) {
        report_node(r, node != NULL ? node : map,
                    "%s is no quantity of a run, expected a key of 'run --json'", key);
        *index = 0;
    }
}

// --- checks ----------------------------------------------------------------------------

// Reads a question with several answers: the answers, and the number of the right one.
static void read_choice(reader *r, const tree_node *map, lesson_step *step)
{
    const tree_node *of = tree_child(map, "of"), *right = tree_child(map, "right");

    // without answers there is nothing to choose
    const bool answers = of != NULL && (of->kind != TREE_LIST || of->first != NULL);
    if (!answers || right == NULL) {
        report_node(r, map,
                    "a choice has no '%s', expected answers under 'of' and the right "
                    "one's number under 'right'",
                    answers ? "right" : "of");
        return;
    }

    // the file counts them from 1
    step->choice_count = read_texts(r, of, "of", step->choices, LESSON_CHOICES);
    if (step->choice_count > 0) {
        step->right =
            read_count(r, right, "right", step->choice_count, "the number of an answer") -
            1;
    }
}

// Reads the value that a parameter must have: a map of one path and its value.
static void read_value(reader *r, const tree_node *map, lesson_step *step)
{
    // one key, a path
    fault f = {0};
    const tree_node *child = map->first;
    step->within = NEAR_ENOUGH;
    if (child == NULL || child->next != NULL) {
        report_node(r, map, "value takes one parameter, such as {motor.voltage: 0.5}");
        return;
    }
    const char *path = reader_key(r, map, child);
    if (path == NULL) {
        return;
    }

    // the parameter has one value, which a copy of the parameters checks and converts
    step->parameter = parameter_look_up(path, &f);
    const char *text = step->parameter >= 0 ? reader_value_text(r, child, path) : NULL;
    parameters scratch = r->s->parameters;
    status code = STATUS_OK;
    if (!(step->parameter >= 0)) {
        code = STATUS_BAD_ARGUMENT;
    }
    if (code == STATUS_OK && parameter_is_text(&parameter_table[step->parameter])) {
        code = fault_set(&f, STATUS_BAD_ARGUMENT,
                         "%s is a text or a list, expected a parameter with one value",
                         path);
    }
    if (code == STATUS_OK && text != NULL) {
        code = parameter_set_text(&scratch, step->parameter, text, &f);
    }
    if (code != STATUS_OK) {
        report_node(r, child, "%s", f.text);
        step->parameter = 0;
        return;
    }
    step->value = parameter_get(&scratch, step->parameter);
}

// Reads a check, a condition that must hold before a step is done. False if the key names
// no check.
static bool read_check(reader *r, const char *key, const tree_node *node,
                       lesson_step *step)
{
    static const struct {
        const char *key;
        lesson_check check;
        const char *known; // keys of its map, "": any
    } kinds[] = {{"number", LESSON_NUMBER, " quantity within "},
                 {"choice", LESSON_CHOICE, " of right "},
                 {"cursor", LESSON_CURSOR, " at offset within "},
                 {"value", LESSON_VALUE, ""},
                 {"ratio", LESSON_RATIO, " quantity from to "},
                 {"pinned", LESSON_PINNED, ""}};
    enum { KINDS = sizeof kinds / sizeof *kinds };

    // which check it is, the only one of the step
    int kind = 0;
    while (kind < KINDS && strcmp(key, kinds[kind].key) != 0) {
        kind++;
    }
    if (kind == KINDS) {
        return false;
    }
    const lesson_check check = kinds[kind].check;
    if (step->check != LESSON_READ) {
        report_node(r, node->key, "'%s' is a second check of this step, expected one",
                    key);
        return true;
    }

    // `pinned` is a number, any other a map of the keys that it knows
    if (check != LESSON_PINNED &&
        !reader_expect_map(r, node, key, "quantity: peak_force_N")) {
        return true;
    }
    step->check = check;
    if (kinds[kind].known[0] != '\0') {
        refuse_other_keys(r, node, kinds[kind].known);
    }

    // what it asks for
    if (check == LESSON_PINNED) {
        step->pinned =
            read_count(r, node, key, LESSON_PINNED_RUNS, "how many runs are pinned");
    } else if (check == LESSON_CHOICE) {
        read_choice(r, node, step);
    } else if (check == LESSON_VALUE) {
        read_value(r, node, step);
    } else if (check == LESSON_NUMBER) {
        read_quantity(r, node, "quantity", &step->quantity);
        read_number(r, node, "within", REQUIRED, 0, &step->within);
    } else if (check == LESSON_CURSOR) {
        read_quantity(r, node, "at", &step->quantity);
        read_number(r, node, "offset", OPTIONAL, -HUGE_VAL, &step->offset);
        read_number(r, node, "within", REQUIRED, 0, &step->within);
    } else {
        read_quantity(r, node, "quantity", &step->quantity);
        read_number(r, node, "from", REQUIRED, -HUGE_VAL, &step->low);
        read_number(r, node, "to", REQUIRED, step->low, &step->high);
    }
    return true;
}

// --- steps -----------------------------------------------------------------------------

// Reads a step of the lesson: its texts, commands and check.
static void read_step(reader *r, const tree_node *map, lesson_step *step)
{
    static const char *const texts[] = {"say", "then", "hint"}; // as in lesson_step
    if (!reader_expect_map(r, map, "a step", "say: ...")) {
        return;
    }

    // every key is a check, a text or the list of commands
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        if (key == NULL || read_check(r, key, child, step)) {
            continue;
        }
        const int which = name_find(texts, sizeof *texts, 3, key);
        if (which >= 0) {
            step->texts[which] = read_text(r, child, key);
        } else if (strcmp(key, "do") == 0) {
            step->command_count =
                read_texts(r, child, key, step->commands, LESSON_COMMANDS);
        } else {
            report_node(r, child->key,
                        "unknown key '%.60s' in a step, expected say, then, hint, do, "
                        "number, choice, cursor, value, pinned or ratio",
                        key);
        }
    }

    // `say` is needed; texts that are left out are empty
    if (tree_child(map, "say") == NULL) {
        report_node(r, map, "a step has no 'say', expected text");
    }
    if (step->then == NULL) {
        step->then = strdup("");
    }
    if (step->hint == NULL) {
        step->hint = strdup("");
    }
    reader_have_memory(r, step->then);
    reader_have_memory(r, step->hint);
}

// Reads the paths of the parameters that matter in the lesson.
static void read_parameters(reader *r, const tree_node *list, lesson *l)
{
    char *paths[LESSON_PARAMETERS] = {0};
    const int count = read_texts(r, list, "parameters", paths, LESSON_PARAMETERS);

    // one that does not exist is reported, the others stay
    for (int i = 0; i < count; i++) {
        fault f = {0};
        const int index = parameter_look_up(paths[i], &f);
        if (index < 0) {
            report_node(r, list, "%s", f.text);
        } else {
            l->parameters[l->parameter_count++] = index;
        }
        free(paths[i]);
    }
}

void reader_lesson(reader *r, const tree_node *map)
{
    lesson *l = &r->s->lesson;
    if (!reader_expect_map(r, map, "lesson", "steps: [...]")) {
        return;
    }

    // its keys
    refuse_other_keys(r, map, " steps parameters ");
    const tree_node *steps = tree_child(map, "steps");
    const tree_node *parameters_that_matter = tree_child(map, "parameters");
    if (steps == NULL || steps->kind != TREE_LIST || steps->first == NULL) {
        report_node(r, map, "the lesson has no steps, expected a list under 'steps'");
        return;
    }
    if (parameters_that_matter != NULL) {
        read_parameters(r, parameters_that_matter, l);
    }

    // memory for all steps, then one after the other
    int most = 0;
    for (const tree_node *child = steps->first; child != NULL; child = child->next) {
        most++;
    }
    l->steps = calloc((size_t)most, sizeof *l->steps);
    if (!reader_have_memory(r, l->steps)) {
        return;
    }
    for (const tree_node *child = steps->first; child != NULL; child = child->next) {
        read_step(r, child, &l->steps[l->step_count++]);
    }
}
