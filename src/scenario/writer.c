// Writing a scenario as a file that gives it again.
#include <assert.h>
#include <string.h>

#include "src/quantities/signals.h"
#include "src/scenario/scenario.h"
#include "src/base/numbers.h"

// A text between quotation marks as YAML reads it back.
static void write_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\t') {
            fputs(*c == '\n' ? "\\n" : "\\t", stream);
        } else if ((unsigned char)*c < ' ') {
            fputc(' ', stream);
        } else {
            fprintf(stream, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
        }
    }
    fputc('"', stream);
}

static void write_value(FILE *stream, const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    char text[PARAMETER_TEXT_SIZE];
    parameter_format(p, index, text, sizeof text);
    if (info->type == PARAMETER_TEXT) {
        write_text(stream, text);
    } else if (info->type == PARAMETER_LIST) {
        fprintf(stream, "[%s]", text);
    } else {
        fprintf(stream, "%s%s%s", text, info->unit[0] ? " " : "", info->unit);
    }
}

// The groups of the table in its order, each with those of its parameters that were given.
static void write_parameters(FILE *stream, const parameters *p)
{
    const char *group = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        size_t length = strcspn(path, ".");
        if (!p->set[i]) {
            continue;
        }

        // the table has the parameters of a group side by side
        if (strncmp(group, path, length + 1) != 0) {
            fprintf(stream, "%.*s:\n", (int)length, path);
            group = path;
        }
        fprintf(stream, "  %s: ", path + length + 1);
        write_value(stream, p, i);
        fputc('\n', stream);
    }
}

static void write_actions(FILE *stream, const scenario *s)
{
    char text[NUMBER_TEXT];

    // what a shortened run no longer comes to is no part of it, and a file must not ask for it
    int count = s->action_count;
    while (count > 0 && s->actions[count - 1].time > s->parameters.run.duration) {
        count--;
    }

    fputs(count > 0 ? "script:\n" : "", stream);
    for (int i = 0; i < count; i++) {
        const action *a = &s->actions[i];
        number_format(text, a->time);
        fprintf(stream, "  - at: %s s\n", text);

        // the value as the parameter table writes it
        if (a->kind == ACTION_SET) {
            parameters scratch = s->parameters;
            action_apply(a, &scratch, NULL);
            fprintf(stream, "    set: {%s: ", parameter_table[a->parameter].path);
            write_value(stream, &scratch, a->parameter);
            fputs("}\n", stream);
        } else {
            number_format(text, a->value);
            fprintf(stream, "    push: %s N s\n", text);
        }
    }
}

void scenario_write(FILE *stream, const scenario *s)
{
    assert(stream != NULL && s != NULL);

    // prose
    fputs("title: ", stream);
    write_text(stream, s->title != NULL ? s->title : "");
    if (s->description != NULL && s->description[0] != '\0') {
        fputs("\ndescription: ", stream);
        write_text(stream, s->description);
    }
    fputc('\n', stream);

    // what to look at
    for (int i = 0; i < s->pane_count; i++) {
        fprintf(stream, "%s%s%s", i == 0 ? "panes: [" : ", ", signal_table[s->panes[i]].name,
                i == s->pane_count - 1 ? "]\n" : "");
    }

    // what runs; expectations hold for the scenario as it was, and are left out
    write_parameters(stream, &s->parameters);
    write_actions(stream, s);
}
