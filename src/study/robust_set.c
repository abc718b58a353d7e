#include "src/study/robust_set.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

enum { MOST_SET_BYTES = 65536 };

// The whole file as a text on the heap.
static status read_text(const char *path, char **text, fault *f)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return fault_set(f, STATUS_CANNOT_READ, "the set '%s' cannot be opened: %s", path,
                         strerror(errno));
    }

    // all of it, if it is not too long
    *text = calloc(1, MOST_SET_BYTES + 1);
    size_t length = *text != NULL ? fread(*text, 1, MOST_SET_BYTES, file) : 0;
    bool whole = *text != NULL && ferror(file) == 0 && fgetc(file) == EOF;
    fclose(file);

    if (*text == NULL) {
        return fault_no_memory(f);
    }
    if (!whole || strlen(*text) != length) {
        free(*text);
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "'%s' is no set, expected lines PATH=a:b or PATH=v1,v2 of at most %d bytes", path,
            MOST_SET_BYTES);
    }
    return STATUS_OK;
}

// The text without the blanks at both ends, which are cut off.
static char *trimmed(char *text)
{
    while (is_blank(*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

// Reads IMPULSE@TIME, both finite. False if the text is something else.
static bool read_push(robust_case *c, const char *text)
{
    const char *rest;
    double impulse, time;
    if (c->push_count == ROBUST_CASE_PUSHES || !decimal_read(text, &impulse, &rest) ||
        *rest != '@' || !decimal_read(rest + 1, &time, &rest) || *rest != '\0' || time < 0 ||
        !isfinite(impulse) || !isfinite(time)) {
        return false;
    }
    c->push_impulse[c->push_count] = impulse;
    c->push_time[c->push_count++] = time;
    return true;
}

// Takes a case apart: "TITLE: PATH=VALUE; push=IMPULSE@TIME". Its settings go behind those of the
// cases before. False if a piece is neither.
static bool read_case(robust_case *c, char *text, char **settings)
{
    char *rest = strchr(text, ':');
    *c = (robust_case){.settings = settings};
    if (rest == NULL) {
        return false;
    }
    *rest++ = '\0';
    c->title = trimmed(text);

    for (char *piece; (piece = strsep(&rest, ";")) != NULL;) {
        piece = trimmed(piece);
        if (strncmp(piece, "push=", strlen("push=")) == 0) {
            if (!read_push(c, piece + strlen("push="))) {
                return false;
            }
        } else if (*piece != '\0') {
            if (strchr(piece, '=') == NULL) {
                return false;
            }
            settings[c->setting_count++] = piece;
        }
    }
    return c->title[0] != '\0';
}

// Sorts the lines of the text into what is drawn and what is a case.
static status read_lines(robust_set *set, const char *path, fault *f)
{
    static const char word[] = "case ";
    char *rest = set->text, **settings = set->settings;
    int number = 0;
    for (char *line; (line = strsep(&rest, "\n")) != NULL;) {
        number++;
        line = trimmed(line);
        if (line[0] == '\0' || line[0] == '#') {
            continue;
        }
        if (strncmp(line, word, strlen(word)) != 0) {
            set->lines[set->count++] = line;
            continue;
        }

        robust_case *c = &set->cases[set->case_count++];
        if (!read_case(c, line + strlen(word), settings)) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "%s:%d: no case, expected 'case TITLE: PATH=VALUE; PATH=VALUE', or "
                             "push=IMPULSE@TIME for a value",
                             path, number);
        }
        settings += c->setting_count;
    }
    return STATUS_OK;
}

status robust_set_read(robust_set *set, const char *path, fault *f)
{
    assert(set != NULL && path != NULL);
    *set = (robust_set){0};
    status code = read_text(path, &set->text, f);
    if (code != STATUS_OK) {
        return code;
    }

    // a line, a case and a setting have at least one character
    size_t most = strlen(set->text) + 1, cases = 1;
    for (const char *c = set->text; *c != '\0'; c++) {
        cases += *c == '\n';
    }
    set->lines = calloc(most, sizeof *set->lines);
    set->settings = calloc(most, sizeof *set->settings);
    set->cases = calloc(cases, sizeof *set->cases);
    bool room = set->lines != NULL && set->settings != NULL && set->cases != NULL;

    code = room ? read_lines(set, path, f) : fault_no_memory(f);
    if (code == STATUS_OK && set->count == 0) {
        code = fault_set(f, STATUS_BAD_ARGUMENT,
                         "the set '%s' names no parameter, expected lines PATH=a:b or PATH=v1,v2",
                         path);
    }
    if (code != STATUS_OK) {
        robust_set_finish(set);
    }
    return code;
}

void robust_set_finish(robust_set *set)
{
    if (set != NULL) {
        free(set->text);
        free(set->lines);
        free(set->settings);
        free(set->cases);
        *set = (robust_set){0};
    }
}

// Keeps the first sentence of several.
static void keep_first(void *context, const char *sentence)
{
    fault *f = context;
    if (f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_ARGUMENT, "%s", sentence);
    }
}

status robust_case_scenario(scenario *derived, const scenario *base, const robust_case *c, fault *f)
{
    assert(derived != NULL && base != NULL);
    *derived = *base;
    int pushes = c != NULL ? c->push_count : 0;
    derived->actions = calloc((size_t)(base->action_count + pushes + 1), sizeof(action));
    if (derived->actions == NULL) {
        return fault_no_memory(f);
    }
    if (base->action_count > 0) {
        memcpy(derived->actions, base->actions, (size_t)base->action_count * sizeof(action));
    }
    if (c == NULL) {
        return STATUS_OK;
    }

    fault first = {0};
    status code = scenario_override_all(derived, c->settings, c->setting_count, keep_first, &first);
    if (code != STATUS_OK) {
        robust_case_finish(derived);
        return fault_set(f, STATUS_BAD_ARGUMENT, "case '%.60s': %.400s", c->title, first.text);
    }
    for (int i = 0; i < pushes; i++) {
        scenario_insert_action(derived, (action){.time = c->push_time[i],
                                                 .kind = ACTION_PUSH,
                                                 .parameter = -1,
                                                 .value = c->push_impulse[i]});
    }
    return STATUS_OK;
}

void robust_case_finish(scenario *derived)
{
    if (derived != NULL) {
        free(derived->actions);
        derived->actions = NULL;
        derived->action_count = 0;
    }
}
