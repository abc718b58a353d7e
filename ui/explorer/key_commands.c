// The commands that give keys another meaning.
#include <string.h>

#include "ui/explorer/commands.h"
#include "ui/terminal/keys.h"

// Reads the key that begins an argument, and where the rest of it does.
static action_result read_key(const char *argument, int *key, const char **rest)
{
    int length = (int)strcspn(argument, " \t");
    *key = key_of_name(argument, (size_t)length);
    *rest = argument + length + strspn(argument + length, " \t");

    // what cannot be bound
    if (length == 0) {
        return result_refused("a key is a character or a name such as Space, PgUp, F1, S-Left "
                              "or C-r");
    }
    if (*key == 0) {
        return result_refused("there is no key '%.*s'", length, argument);
    }
    if (*key == ':' || *key == KEY_CODE_ESCAPE || *key == ('c' & 0x1f)) {
        return result_refused("%.*s keeps its meaning: the way to the prompt, back or out", length,
                              argument);
    }
    return result_done();
}

static action_result no_room(void)
{
    return result_refused("there are %d keys of your own already, no more fit", USER_KEYS);
}

action_result act_bind_key(explorer_state *st, const char *argument)
{
    const char *line;
    char name[KEY_NAME], before[LINE_TEXT] = "";
    int key;
    action_result read = read_key(argument, &key, &line);
    if (!result_ok(&read)) {
        return read;
    }

    // without a command it is asked what the key does
    key_name(key, name, sizeof name);
    const char *old = key_line(&st->keys, key);
    if (line[0] == '\0') {
        return old ? result_news("%s does '%s'", name, old) : result_news("%s does nothing", name);
    }
    action_result checked = explorer_check_command(line);
    if (!result_ok(&checked)) {
        checked.at += (int)(line - argument);
        return checked;
    }

    // a copy of the old meaning: its place gets the new one
    snprintf(before, sizeof before, "%s", old ? old : "");
    user_key *own = key_add_own(&st->keys, key);
    if (own == NULL) {
        action_result full = no_room();
        full.at += (int)(line - argument);
        return full;
    }
    snprintf(own->line, sizeof own->line, "%s", line);
    if (before[0] != '\0' && strcmp(before, line) != 0) {
        return result_news("%s does '%s' now, no longer '%s'", name, line, before);
    }
    return result_news("%s does '%s' now", name, line);
}

action_result act_unbind_key(explorer_state *st, const char *argument)
{
    const char *rest;
    char name[KEY_NAME];
    int key;
    action_result read = read_key(argument, &key, &rest);
    if (!result_ok(&read)) {
        return read;
    }
    if (rest[0] != '\0') {
        action_result refused = result_refused("unkey takes one key, what is '%s' for?", rest);
        refused.at = (int)(rest - argument);
        return refused;
    }

    // the user's key goes, the explorer's own comes back
    key_name(key, name, sizeof name);
    const char *built_in = key_built_in_line(key);
    user_key *own = key_find_own(&st->keys, key);
    if (own != NULL) {
        key_remove_own(&st->keys, own);
        return built_in ? result_news("%s does '%s' again", name, built_in)
                        : result_news("%s does nothing now", name);
    }

    // one of the explorer's own does nothing then
    if (built_in == NULL) {
        return result_refused("%s does nothing as it is", name);
    }
    own = key_add_own(&st->keys, key);
    if (own == NULL) {
        return no_room();
    }
    own->line[0] = '\0';
    return result_news("%s does nothing now, no longer '%s' (unkey it again to have that back)",
                       name, built_in);
}
