// Writes a scenario as a file; reading that file gives the same scenario.
#include <string.h>

#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "src/scenario/scenario.h"
#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"

// The escape sequence of the character at c, if YAML would read that as the end of a line
// or otherwise change it; NULL for any other character. *length is its number of bytes.
static const char *yaml_escape(const char *c, size_t *length)
{
    static const struct {
        const char *bytes, *escape;
    } escapes[] = {{"\n", "\\n"},          {"\t", "\\t"},       {"\"", "\\\""},
                   {"\\", "\\\\"},         {"\xc2\x85", "\\N"}, {"\xe2\x80\xa8", "\\L"},
                   {"\xe2\x80\xa9", "\\P"}};
    for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; i++) {
        *length = strlen(escapes[i].bytes);
        if (strncmp(c, escapes[i].bytes, *length) == 0) {
            return escapes[i].escape;
        }
    }
    return NULL;
}

// Writes the content of a quoted text so that YAML reads the same text. What YAML cannot
// hold is replaced: a control character by a blank, a byte that is no character by "?".
static void write_quoted_content(FILE *stream, const char *text)
{
    size_t length;
    for (const char *c = text; *c != '\0'; c += length) {
        const char *escape = yaml_escape(c, &length);
        const int printable = printable_length(c);
        if (escape != NULL) {
            fputs(escape, stream);
        } else if (printable > 0) {
            length = (size_t)printable;
            fwrite(c, 1, length, stream);
        } else {
            // a control character, or a byte of no character
            length = 1;
            fputc((unsigned char)*c < ' ' ? ' ' : '?', stream);
        }
    }
}

// Writes a text between quotation marks.
static void write_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    write_quoted_content(stream, text);
    fputc('"', stream);
}

// Writes a parameter's value as a scenario file has it: texts quoted, lists in brackets,
// numbers with their unit.
static void write_value(FILE *stream, const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    char text[PARAMETER_VALUE_SIZE];
    parameter_format(p, index, text, sizeof text);
    if (info->type == PARAMETER_TEXT) {
        write_text(stream, text);
    } else if (info->type == PARAMETER_LIST) {
        fprintf(stream, "[%s]", text);
    } else {
        fprintf(stream, "%s%s%s", text, info->unit[0] ? " " : "", info->unit);
    }
}

// Writes the parameters that were given, under the key of their group, in the order of
// the parameter table.
static void write_parameters(FILE *stream, const parameters *p)
{
    const char *group = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        size_t length = strcspn(path, ".");
        if (!p->set[i]) {
            continue;
        }

        // the first one of its group, whose parameters are neighbours in the table
        if (strncmp(group, path, length + 1) != 0) {
            fprintf(stream, "%.*s:\n", (int)length, path);
            group = path;
        }
        fprintf(stream, "  %s: ", path + length + 1);
        write_value(stream, p, i);
        fputc('\n', stream);
    }
}

// Writes the script.
static void write_actions(FILE *stream, const scenario *s)
{
    char text[NUMBER_TEXT];

    // actions after the end of the run, which may have been shortened, are left out: a
    // file may not have them
    int count = s->action_count;
    while (count > 0 && s->actions[count - 1].time > s->parameters.run.duration) {
        count--;
    }

    // each action at its time
    fputs(count > 0 ? "script:\n" : "", stream);
    for (int i = 0; i < count; i++) {
        const action *a = &s->actions[i];
        number_format(text, a->time);
        fprintf(stream, "  - at: %s s\n", text);

        // the value as the parameter table writes it
        if (a->kind == ACTION_SET) {
            parameters scratch = s->parameters;
            char path[ACTION_PATH], value[PARAMETER_VALUE_SIZE];
            action_apply(a, &scratch, NULL);
            fprintf(stream, "    set: {%s: ", action_path(a, path));
            if (parameter_is_text(&parameter_table[a->parameter]) && !action_is_text(a)) {
                action_format_value(a, value, sizeof value);
                fputs(value, stream);
            } else {
                write_value(stream, &scratch, a->parameter);
            }
            fputs("}\n", stream);
        } else {
            number_format(text, a->value);
            fprintf(stream, "    push: %s N s\n", text);
        }
    }
}

// Writes a line for each fitted parameter: its standard error, then its correlations with
// those above.
static void write_fit(FILE *stream, const scenario_fit *fit)
{
    fputs("fit: # of each parameter its standard error, and correlations with those "
          "above\n",
          stream);
    for (int i = 0; i < fit->count; i++) {
        char text[NUMBER_TEXT];
        number_format(text, fit->errors[i]);
        fprintf(stream, "  %s: [%s", parameter_table[fit->parameters[i]].path, text);
        for (int k = 0; k < i; k++) {
            number_format(text, fit->correlation[i * fit->count + k]);
            fprintf(stream, ", %s", text);
        }
        fputs("]\n", stream);
    }
}

// --- lessons ---------------------------------------------------------------------------

// Writes a key and a list of at least one text.
static void write_texts(FILE *stream, const char *key, char *const *texts, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(stream, i == 0 ? "%s[" : ", ", key);
        write_text(stream, texts[i]);
    }
    fputc(']', stream);
}

// Writes a key and its number.
static void write_entry(FILE *stream, const char *key, double value)
{
    char text[NUMBER_TEXT];
    number_format(text, value);
    fprintf(stream, "%s: %s", key, text);
}

// Writes the condition that must hold before a step is done; a step that is only read has
// none.
static void write_check(FILE *stream, const parameters *p, const lesson_step *step)
{
    parameters scratch = *p;
    const char *quantity = summary_table[step->quantity].key;
    switch (step->check) {
    case LESSON_READ:
        return;
    case LESSON_NUMBER:
        fprintf(stream, "      number: {quantity: %s, ", quantity);
        write_entry(stream, "within", step->within);
        break;
    case LESSON_CHOICE:
        write_texts(stream, "      choice: {of: ", step->choices, step->choice_count);
        write_entry(stream, ", right", step->right + 1);
        break;
    case LESSON_CURSOR:
        fprintf(stream, "      cursor: {at: %s, ", quantity);
        write_entry(stream, "offset", step->offset);
        write_entry(stream, ", within", step->within);
        break;
    case LESSON_VALUE:
        parameter_set_number(&scratch, step->parameter, step->value, NULL);
        fprintf(stream, "      value: {%s: ", parameter_table[step->parameter].path);
        write_value(stream, &scratch, step->parameter);
        break;
    case LESSON_PINNED:
        fprintf(stream, "      pinned: %d\n", step->pinned);
        return;
    default:
        fprintf(stream, "      ratio: {quantity: %s, ", quantity);
        write_entry(stream, "from", step->low);
        write_entry(stream, ", to", step->high);
    }
    fputs("}\n", stream);
}

// Writes a step of the lesson: what it says, its check, and what may be left out.
static void write_step(FILE *stream, const parameters *p, const lesson_step *step)
{
    fputs("    - say: ", stream);
    write_text(stream, step->say);
    fputc('\n', stream);
    write_check(stream, p, step);

    // texts and commands that may be left out
    const char *const keys[] = {"hint", "then"}, *const texts[] = {step->hint,
                                                                   step->then};
    for (int i = 0; i < 2; i++) {
        if (texts[i][0] != '\0') {
            fprintf(stream, "      %s: ", keys[i]);
            write_text(stream, texts[i]);
            fputc('\n', stream);
        }
    }
    if (step->command_count > 0) {
        write_texts(stream, "      do: ", step->commands, step->command_count);
        fputc('\n', stream);
    }
}

// Writes the lesson: the parameters that matter, then the steps.
static void write_lesson(FILE *stream, const scenario *s)
{
    const lesson *l = &s->lesson;
    if (l->step_count == 0) {
        return;
    }

    // a list of parameters in brackets, if there are any
    fputs("lesson:\n", stream);
    for (int i = 0; i < l->parameter_count; i++) {
        fprintf(stream, "%s%s%s", i == 0 ? "  parameters: [" : ", ",
                parameter_table[l->parameters[i]].path,
                i == l->parameter_count - 1 ? "]\n" : "");
    }

    // the steps
    fputs("  steps:\n", stream);
    for (int i = 0; i < l->step_count; i++) {
        write_step(stream, &s->parameters, &l->steps[i]);
    }
}

void scenario_write(FILE *stream, const scenario *s)
{
    // the title with the changes behind it, as far as a title may be long, and
    // description
    char changes[SCENARIO_TITLE + 1];
    const size_t length = strlen(s->title);
    const size_t room = length < SCENARIO_TITLE ? SCENARIO_TITLE + 1 - length : 1;
    fputs("title: \"", stream);
    write_quoted_content(stream, s->title);
    write_quoted_content(stream, scenario_changes_within(s, changes, room));
    fputc('"', stream);
    if (s->description[0] != '\0') {
        fputs("\ndescription: ", stream);
        write_text(stream, s->description);
    }
    fputc('\n', stream);

    // the signals of the panes
    for (int i = 0; i < s->pane_count; i++) {
        fprintf(stream, "%s%s%s", i == 0 ? "panes: [" : ", ",
                signal_table[s->panes[i]].name, i == s->pane_count - 1 ? "]\n" : "");
    }

    // parameters, script and lesson; expectations are left out, as they hold for the
    // scenario in its original file
    write_parameters(stream, &s->parameters);
    if (s->fit != NULL) {
        write_fit(stream, s->fit);
    }
    write_actions(stream, s);
    write_lesson(stream, s);
}

char *scenario_as_text(const scenario *s)
{
    text_stream text;
    char *written = NULL;
    if (text_stream_open(&text)) {
        scenario_write(text.stream, s);
        written = text_stream_close(&text, NULL);
    }
    loss_unless(written != NULL);
    return written;
}
