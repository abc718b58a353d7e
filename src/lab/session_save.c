// Writing the scenario that gives a session's run.
#include "src/lab/session.h"

#include <string.h>

#include "src/lab/export.h"

// A text between double quotes, as YAML reads it back.
static void write_quoted(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            fprintf(stream, "\\%c", c);
        } else if (c == '\n') {
            fputs("\\n", stream);
        } else if (c < ' ') {
            fputc(' ', stream);
        } else {
            fputc(c, stream);
        }
    }
    fputc('"', stream);
}

static void write_value(FILE *stream, const parameters *p, int index)
{
    char text[256];
    parameter_format(p, index, text, sizeof text);
    if (parameter_table[index].type == PARAMETER_TEXT) {
        write_quoted(stream, text);
    } else {
        fputs(text, stream);
    }
}

// The parameters that were given, group by group.
static void write_parameters(const parameters *p, FILE *stream)
{
    const char *group = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        size_t length = strcspn(path, ".");
        if (!p->set[i]) {
            continue;
        }
        if (strncmp(group, path, length + 1) != 0) {
            fprintf(stream, "%.*s:\n", (int)length, path);
            group = path;
        }
        fprintf(stream, "  %s: ", path + length + 1);
        write_value(stream, p, i);
        fputc('\n', stream);
    }
}

void session_write_scenario(const session *s, FILE *stream)
{
    const scenario *e = &s->effective;
    char number[NUMBER_TEXT];
    fputs("title: ", stream);
    write_quoted(stream, e->title ? e->title : "");
    if (e->description != NULL && e->description[0] != '\0') {
        fputs("\ndescription: ", stream);
        write_quoted(stream, e->description);
    }
    fputc('\n', stream);
    write_parameters(&e->parameters, stream);
    // what a shorter run no longer comes to is no part of it, and a file must not ask for it
    int count = e->action_count;
    while (count > 0 && e->actions[count - 1].time > e->parameters.run.duration) {
        count--;
    }
    if (count > 0) {
        fputs("script:\n", stream);
    }
    for (int i = 0; i < count; i++) {
        const action *a = &e->actions[i];
        number_format(number, a->time);
        fprintf(stream, "  - at: %s\n", number);
        if (a->kind == ACTION_PUSH) {
            number_format(number, a->value);
            fprintf(stream, "    push: %s\n", number);
            continue;
        }
        parameters p = e->parameters;
        parameter_set_number(&p, a->parameter, a->value, NULL);
        fprintf(stream, "    set: {%s: ", parameter_table[a->parameter].path);
        write_value(stream, &p, a->parameter);
        fputs("}\n", stream);
    }
}
