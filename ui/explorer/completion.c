// Completion of the prompt: commands, parameters, values, signals and files.
#include "ui/explorer/explorer.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "ui/explorer/state/command_list.h"

enum { CANDIDATE = 160, FITTING = 1024 }; // bytes of one, and how many

// The i-th of words with a bar between them; false beyond the last.
static bool word_between_bars(const char *words, int i, char *text)
{
    for (; i > 0; i--) {
        words = strchr(words, '|');
        if (words == NULL) {
            return false;
        }
        words++;
    }
    text_cut(words, "|", text, CANDIDATE);
    return true;
}

// The values that a parameter of a few can have; false beyond the last.
static bool parameter_value(int parameter, int i, char *text)
{
    if (parameter < 0) {
        return false;
    }
    const parameter_info *info = &parameter_table[parameter];
    if (info->type == PARAMETER_CHOICE) {
        return word_between_bars(info->choices, i, text);
    }
    return info->type == PARAMETER_BOOLEAN && word_between_bars("true|false", i, text);
}

// The i-th of the words that a command's argument chooses from; those in capitals stand
// for others.
static bool argument_word(const char *argument, int i, char *text)
{
    char word[CANDIDATE];
    for (int k = 0; word_between_bars(argument, k, word); k++) {
        if (word[0] != '\0' && !isupper((unsigned char)word[0]) && i-- == 0) {
            snprintf(text, CANDIDATE, "%s", word);
            return true;
        }
    }
    return false;
}

// What is being completed: the line's words before the last one.
typedef struct place {
    int word; // 0: the command
    char command[32];
    char first[LINE_TEXT]; // argument, where it is complete
    char
        kind[LINE_TEXT]; // of word, as the command's description has it, without brackets
} place;

// What a command's description says of its n-th argument, from 1; the last one may be
// repeated.
static void read_kind(const char *argument, int n, char *kind)
{
    size_t length = 0;
    while (n-- > 1 && strchr(argument, ' ') != NULL) {
        argument = strchr(argument, ' ') + 1;
    }
    for (; *argument != '\0' && *argument != ' '; argument++) {
        if (*argument != '[' && *argument != ']') {
            kind[length++] = *argument;
        }
    }
    kind[length] = '\0';
}

// What is completed where a word begins in a line.
static place place_in(const char *line, const char *word)
{
    place p = {0};
    for (const char *c = line; c < word; c++) {
        if (*c == ' ' && (c == line || c[-1] != ' ')) {
            p.word++;
        }
    }
    const char *argument = text_cut(line, " ", p.command, sizeof p.command);
    if (p.word > 1) {
        text_cut(argument, " ", p.first, sizeof p.first);
    }

    // what the command's description says of it
    const int index = explorer_command_find(p.command);
    if (p.word > 0 && index >= 0) {
        read_kind(explorer_command_table[index].argument, p.word, p.kind);
    }
    return p;
}

// Whether a kind of argument has this name.
static bool is_of(const place *p, const char *name)
{
    return strstr(p->kind, name) != NULL;
}

// The i-th law that a command takes, "off" behind the last; NULL beyond that.
static const char *law_candidate(int i)
{
    if (i < LAW_COUNT) {
        return control_law_table[i].word;
    }
    if (i == LAW_COUNT) {
        return "off";
    }
    return NULL;
}

// The i-th mode that the law can be held in, then "next" and "off".
static const char *mode_candidate(explorer_model *model, int i)
{
    const law_modes *m = model_law_modes(model);
    if (i < m->count) {
        return m->names[i];
    }
    if (i == m->count) {
        return "next";
    }
    if (i == m->count + 1) {
        return "off";
    }
    return NULL;
}

// The i-th name of one kind, by the command's description or its name; NULL beyond the
// last, or if the word is of no kind that has names.
static const char *name_candidate(explorer_model *model, const explorer_view *view,
                                  const place *p, int i)
{
    if (p->word == 0) {
        return i < explorer_command_count ? explorer_command_table[i].name : NULL;
    }
    if (is_of(p, "PATH")) {
        return i < parameter_count ? parameter_table[i].path : NULL;
    }
    if (is_of(p, "QUANTITY")) {
        return i < summary_count ? summary_table[i].key : NULL;
    }
    if (is_of(p, "SIGNAL")) {
        return i < signal_count ? signal_table[i].name : NULL;
    }
    if (strcmp(p->command, "law") == 0) {
        return law_candidate(i);
    }
    if (is_of(p, "MODE")) {
        return mode_candidate(model, i);
    }
    if (strcmp(p->command, "open") == 0) {
        return i < view->scenarios.count ? view->scenarios.names[i] : NULL;
    }
    return NULL;
}

// Writes the i-th candidate for the word that is being typed; false beyond the last.
static bool candidate(explorer_model *model, const explorer_view *view, const place *p,
                      int i, char *text)
{
    const char *name = name_candidate(model, view, p, i);
    if (name != NULL) {
        snprintf(text, CANDIDATE, "%s", name);
        return true;
    }

    // the values of a parameter, or the words of a description
    if (strcmp(p->command, "set") == 0 && p->word == 2) {
        return parameter_value(parameter_of_name(p->first), i, text);
    }
    return is_of(p, "|") && argument_word(p->kind, i, text);
}

// Whether a candidate or its last part (motor.VOLTAGE, thesis/FIG-3-4) begins with what
// is typed.
static bool fits(const char *name, const char *word)
{
    const char *part = strpbrk(name, "./");
    const size_t length = strlen(word);
    return strncmp(name, word, length) == 0 ||
           (part != NULL && length > 0 && strncmp(part + 1, word, length) == 0);
}

// Collects the candidates that fit; returns how many.
static int collect(explorer_model *model, const explorer_view *view, const place *p,
                   const char *word, char fitting[FITTING][CANDIDATE])
{
    int count = 0;
    for (int i = 0; count < FITTING && candidate(model, view, p, i, fitting[count]);
         i++) {
        if (fits(fitting[count], word)) {
            count++;
        }
    }
    return count;
}

// Puts a word in the place of the one that is completed.
static void put_word(prompt *p, const char *word, const char *after)
{
    const size_t at = (size_t)p->stem_at;
    p->replaces = false;
    snprintf(p->text + at, sizeof p->text - at, "%s%s", word, after);
    p->cursor = (int)strlen(p->text);
}

// Cuts the first of some words to what all of them begin with.
static void cut_to_common(char fitting[FITTING][CANDIDATE], int count)
{
    char *common = fitting[0];
    for (int i = 1; i < count; i++) {
        size_t same = 0;
        while (common[same] != '\0' && common[same] == fitting[i][same]) {
            same++;
        }
        common[same] = '\0';
    }
}

// As far as all candidates agree, and what they are if there are several.
static bool complete_common(explorer_input *input, char fitting[FITTING][CANDIDATE],
                            int count)
{
    prompt *p = &input->prompt;
    char listed[512] = "";
    if (count > 1) {
        for (int i = 0; i < count; i++) {
            text_add(listed, sizeof listed, "%s ", fitting[i]);
        }
    }
    cut_to_common(fitting, count);

    // what agrees may be less than what is typed, where last parts fit
    if (strlen(fitting[0]) >= strlen(p->stem)) {
        const char *after = count == 1 ? " " : "";
        put_word(p, fitting[0], after);
    }
    return act_tell(input, "%s", listed);
}

// Where the last word begins: behind a blank, in an expression behind an operator, too.
static int word_begins(const char *text)
{
    const char *space = strrchr(text, ' ');
    const int word = space != NULL ? (int)(space + 1 - text) : 0;
    const place where = place_in(text, text + word);
    int begin = (int)strlen(text);
    while (begin > word &&
           (!is_of(&where, "SIGNAL") || strchr("+-*/(,", text[begin - 1]) == NULL)) {
        begin--;
    }
    return begin;
}

// Completes the word that ends the text.
static bool complete_end(explorer_model *model, const explorer_view *view,
                         explorer_input *input)
{
    static char fitting[FITTING][CANDIDATE];
    prompt *p = &input->prompt;

    // the first time what all agree in, then one after the other
    if (!p->cycling) {
        p->stem_at = word_begins(p->text);
        snprintf(p->stem, sizeof p->stem, "%s", p->replaces ? "" : p->text + p->stem_at);
        p->cycle = -1;
    }
    const place where = place_in(p->text, p->text + p->stem_at);
    const int count = collect(model, view, &where, p->stem, fitting);
    if (p->cycling && count > 0) {
        p->cycle = (p->cycle + 1) % count;
        put_word(p, fitting[p->cycle], "");
        return true;
    }
    p->cycling = count > 1;
    return count == 0 || complete_common(input, fitting, count);
}

bool complete_prompt(explorer_model *model, const explorer_view *view,
                     explorer_input *input)
{
    // what stands behind the cursor stays there
    prompt *p = &input->prompt;
    char behind[LINE_TEXT];
    snprintf(behind, sizeof behind, "%s", p->text + p->cursor);
    p->text[p->cursor] = '\0';
    const bool done = complete_end(model, view, input);
    p->cursor = (int)strlen(p->text);
    text_add(p->text, sizeof p->text, "%s", behind);
    return done;
}
