#include "ui/explorer/state/command_list.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "src/base/words.h"

const explorer_command explorer_command_table[] = {
#define COMMAND_INFO(group, name, argument, help, function) {group, name, argument, help},
    COMMAND_LIST(COMMAND_INFO)
#undef COMMAND_INFO
};
const int explorer_command_count = sizeof explorer_command_table / sizeof explorer_command_table[0];

int explorer_command_find(const char *name)
{
    assert(name != NULL);
    int found = -1, matches = 0;

    // the whole name, else the only one that begins with it
    for (int i = 0; i < explorer_command_count; i++) {
        if (strcmp(explorer_command_table[i].name, name) == 0) {
            return i;
        }

        // a beginning never means the one that asks no questions
        const char *own = explorer_command_table[i].name;
        if (strncmp(own, name, strlen(name)) == 0 && own[strlen(own) - 1] != '!') {
            found = i;
            matches++;
        }
    }
    return matches == 1 ? found : -1;
}

const char *explorer_command_suggest(const char *name)
{
    assert(name != NULL);
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < explorer_command_count; i++) {
        nearest_try(&near, explorer_command_table[i].name);
    }
    return near.best;
}
