#include "ui/explorer/completion.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "ui/explorer/state/command_list.h"

// The i-th control law, then "off"; NULL beyond it.
static const char *law_name(int i)
{
    return i < LAW_COUNT ? control_law_table[i].word : i == LAW_COUNT ? "off" : NULL;
}

// The i-th mode of the law that is on, then the other words that lock takes.
static const char *lock_word(explorer_state *st, int i)
{
    static const char *const others[] = {"next", "off"};
    const law_modes *m = state_law_modes(st);
    return i < m->count ? m->names[i] : i < m->count + 2 ? others[i - m->count] : NULL;
}

// Candidates for the word that is being typed: the i-th, or NULL. `command` is NULL while the
// command itself is typed.
static const char *candidate(explorer_state *st, const char *command, int i)
{
    if (command == NULL) {
        return i < explorer_command_count ? explorer_command_table[i].name : NULL;
    }
    if (strcmp(command, "set") == 0) {
        return i < parameter_count ? parameter_table[i].path : NULL;
    }
    if (strcmp(command, "trace") == 0) {
        return i < signal_count ? signal_table[i].name : NULL;
    }
    if (strcmp(command, "law") == 0) {
        return law_name(i);
    }
    if (strcmp(command, "lock") == 0) {
        return lock_word(st, i);
    }
    if (strcmp(command, "open") == 0) {
        return i < st->scenarios.count ? st->scenarios.names[i] : NULL;
    }
    return NULL;
}

// Shortens a text to what it has in common with another one.
static void keep_common(char *text, const char *other)
{
    size_t same = 0;
    while (text[same] != '\0' && text[same] == other[same]) {
        same++;
    }
    text[same] = '\0';
}

action_result complete_prompt(explorer_state *st)
{
    assert(st != NULL);
    char *line = st->prompt.text;
    char *space = strrchr(line, ' '), *word = space ? space + 1 : line;
    char command[32] = "", common[LINE_TEXT] = "", listed[512] = "";
    snprintf(command, sizeof command, "%.*s", (int)strcspn(line, " "), line);

    // all that begin with what is typed, and how far they agree
    const char *name;
    size_t used = 0;
    int count = 0;
    for (int i = 0; (name = candidate(st, space ? command : NULL, i)) != NULL; i++) {
        if (strncmp(name, word, strlen(word)) != 0) {
            continue;
        }
        if (count++ == 0) {
            snprintf(common, sizeof common, "%s", name);
        }
        keep_common(common, name);
        if (used < sizeof listed) {
            used += (size_t)snprintf(listed + used, sizeof listed - used, "%s ", name);
        }
    }
    if (count == 0) {
        return result_done();
    }
    size_t room = sizeof st->prompt.text - (size_t)(word - line);
    snprintf(word, room, "%s%s", common, count == 1 ? " " : "");
    return result_news("%s", count > 1 ? listed : "");
}
