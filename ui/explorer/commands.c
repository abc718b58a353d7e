#include "ui/explorer/commands.h"

#include <assert.h>
#include <ctype.h>
#include <string.h>

static action_function *const functions[] = {
#define COMMAND_FUNCTION(group, name, argument, help, function) function,
    COMMAND_LIST(COMMAND_FUNCTION)
#undef COMMAND_FUNCTION
};

// The command of a line's first word.
static action_result find_command(const char *line, int *index)
{
    char name[32];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(line, " \t"), line);
    *index = explorer_command_find(name);
    if (*index >= 0) {
        return result_done();
    }
    const char *near = explorer_command_suggest(name);
    return result_refused("there is no command '%s'%s%s%s", name, near ? ", did you mean " : "",
                          near ? near : "", near ? "?" : " (? lists them)");
}

action_result explorer_check_command(const char *line)
{
    assert(line != NULL);
    int index;
    return find_command(line, &index);
}

action_result explorer_execute(explorer_state *st, const char *line)
{
    assert(st != NULL && line != NULL);
    char text[LINE_TEXT];
    int begin = (int)strspn(line, " \t:"), index;
    line += begin;
    if (*line == '\0' || *line == '#') {
        return result_done();
    }

    // without the blanks at its end
    snprintf(text, sizeof text, "%s", line);
    for (size_t n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]); n--) {
        text[n - 1] = '\0';
    }

    action_result result = find_command(text, &index);
    if (result_ok(&result)) {
        size_t length = strcspn(text, " \t");
        length += strspn(text + length, " \t");
        result = functions[index](st, text + length);
        result.at += (int)length;
    }
    result.at += begin;
    return result;
}

bool explorer_carry_out(explorer *ex, const char *line)
{
    assert(ex != NULL);
    action_result result = explorer_execute(&ex->state, line);
    act_follow_lesson(&ex->state);
    result_show(&result, &ex->state.message);
    explorer_tell_replay(ex);
    return result_ok(&result);
}
