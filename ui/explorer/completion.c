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
    for (; i > 0 && words != NULL; i--) {
        words = strchr(words, '|');
        if (words != NULL) {
            words = words + 1;
        } else {
            words = NULL;
        }
    }
    text_cut(words != NULL ? words : "", "|", text, CANDIDATE);
    return words != NULL;
}

// The values that a parameter of a few can have; false beyond the last.
static bool parameter_value(int parameter, int i, char *text)
{
    const parameter_info *info = parameter >= 0 ? &parameter_table[parameter] : NULL;
    return info != NULL &&
           (info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN) &&
           word_between_bars(info->type == PARAMETER_CHOICE ? info->choices
                                                            : "true|false",
                             i, text);
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

static place place_in(const char *line, const char *word)
{
    place p = {0};
    for (const char *c = line; c < word; c++) {
        p.word += *c == ' ' && (c == line || c[-1] != ' ');
    }
    const char *argument = text_cut(line, " ", p.command, sizeof p.command);
    text_cut(p.word > 1 ? argument : "", " ", p.first, sizeof p.first);
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

// Writes the i-th candidate for the word that is being typed; false beyond the last.
static bool candidate(explorer_model *model, const explorer_view *view, const place *p,
                      int i, char *text)
{
    const char *name = NULL;

    // names of one kind, by the command's description or its name
    if (p->word == 0) {
        if (i < explorer_command_count) {
            name = explorer_command_table[i].name;
        } else {
            name = NULL;
        }
    } else if (is_of(p, "PATH")) {
        if (i < parameter_count) {
            name = parameter_table[i].path;
        } else {
            name = NULL;
        }
    } else if (is_of(p, "QUANTITY")) {
        if (i < summary_count) {
            name = summary_table[i].key;
        } else {
            name = NULL;
        }
    } else if (is_of(p, "SIGNAL")) {
        if (i < signal_count) {
            name = signal_table[i].name;
        } else {
            name = NULL;
        }
    } else if (strcmp(p->command, "set") == 0) {
        return p->word == 2 && parameter_value(parameter_of_name(p->first), i, text);
    } else if (strcmp(p->command, "law") == 0) {
        if (i < LAW_COUNT) {
            name = control_law_table[i].word;
        } else if (i == LAW_COUNT) {
            name = "off";
        } else {
            name = NULL;
        }
    } else if (is_of(p, "MODE")) {
        const law_modes *m = model_law_modes(model);
        if (i < m->count) {
            name = m->names[i];
        } else if (i == m->count) {
            name = "next";
        } else if (i == m->count + 1) {
            name = "off";
        } else {
            name = NULL;
        }
    } else if (strcmp(p->command, "open") == 0) {
        if (i < view->scenarios.count) {
            name = view->scenarios.names[i];
        } else {
            name = NULL;
        }
    } else {
        return is_of(p, "|") && argument_word(p->kind, i, text);
    }

    snprintf(text, CANDIDATE, "%s", name != NULL ? name : "");
    return name != NULL;
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
        count += fits(fitting[count], word);
    }
    return count;
}

// Puts a word in the place of the one that is completed.
static void put_word(prompt *p, const char *word, const char *after)
{
    const size_t at = (size_t)p->stem_at;
    p->replaces = false;
    snprintf(p->text + at, sizeof p->text - at, "%s%s", word, after);
}

// As far as all candidates agree, and what they are.
static bool complete_common(explorer_input *input, char fitting[FITTING][CANDIDATE],
                            int count)
{
    prompt *p = &input->prompt;
    char listed[512] = "", *common = fitting[0];
    for (int i = 0; i < count; i++) {
        text_add(listed, sizeof listed, "%s ", fitting[i]);
    }
    for (int i = 1; i < count; i++) {
        size_t same = 0;
        while (common[same] != '\0' && common[same] == fitting[i][same]) {
            same++;
        }
        common[same] = '\0';
    }

    // what agrees may be less than what is typed, where last parts fit
    if (strlen(common) >= strlen(p->stem)) {
        put_word(p, common, count == 1 ? " " : "");
    }
    return act_tell(input, "%s", count > 1 ? listed : "");
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

bool complete_prompt(explorer_model *model, const explorer_view *view,
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
