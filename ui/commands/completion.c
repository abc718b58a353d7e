// Completions for bash, zsh and fish from the tables of commands, options, parameters and
// quantities. The names of scenarios are asked of the program when they are wanted.
#include "ui/commands/command.h"

#include <assert.h>
#include <string.h>

#include "src/tables/parameters.h"

#define SCENARIO_NAMES "impactlab list 2>/dev/null | cut -d' ' -f1"

// What a shell offers for a value or an operand.
typedef enum offer {
    OFFER_NOTHING,
    OFFER_WORDS, // of OPTION_CHOICE and OPTION_WORD
    OFFER_FILES,
    OFFER_PARAMETERS,
    OFFER_SCENARIOS, // and files
    OFFER_QUANTITIES
} offer;

static offer offer_of(const option_row *o)
{
    switch (o->type) {
    case OPTION_CHOICE:
    case OPTION_WORD:
        return OFFER_WORDS;
    case OPTION_FILE:
    case OPTION_FILES:
    case OPTION_RESULT:
    case OPTION_PICTURE:
    case OPTION_PLACE:
        return OFFER_FILES;

    // what the program knows by name
    case OPTION_PARAMETERS:
        return OFFER_PARAMETERS;
    case OPTION_SCENARIO:
        return OFFER_SCENARIOS;
    case OPTION_QUANTITY:
        return OFFER_QUANTITIES;

    // numbers and free text cannot be guessed
    case OPTION_FLAG:
    case OPTION_TEXT:
    case OPTION_NUMBER:
    case OPTION_LENGTH:
    case OPTION_WHOLE:
    case OPTION_SIZE:
    case OPTION_NUMBERS:
        break;
    }
    return OFFER_NOTHING;
}

// The words of a choice with a blank between them.
static void put_choices(FILE *stream, const option_row *o)
{
    for (const char *c = o->value; *c != '\0'; c++) {
        fputc(*c == '|' ? ' ' : *c, stream);
    }
}

static void put_parameters(FILE *stream)
{
    for (int i = 0; i < parameter_count; i++) {
        fprintf(stream, "%s%s=", i > 0 ? " " : "", parameter_table[i].path);
    }
}

static void put_quantities(FILE *stream)
{
    for (int i = 0; i < summary_count; i++) {
        fprintf(stream, "%s%s", i > 0 ? " " : "", summary_table[i].key);
    }
}

static void put_commands(FILE *stream)
{
    for (int i = 0; i < command_count; i++) {
        fprintf(stream, "%s%s", i > 0 ? " " : "", command_table[i]->name);
    }
}

// The words other than scenarios that an operand of the command may be.
static void put_operand_words(FILE *stream, const command *c)
{
    for (int i = 0; c->operand_word != NULL && c->operand_word(i) != NULL; i++) {
        fprintf(stream, "%s%s", i > 0 ? " " : "", c->operand_word(i));
    }
}

// Text between single quotes of a shell; `escaped` are characters that get a backslash.
static void put_quoted(FILE *stream, const char *text, const char *escaped)
{
    for (; *text != '\0'; text++) {
        if (strchr(escaped, *text) != NULL) {
            fputc('\\', stream);
        }
        fprintf(stream, *text == '\'' ? "'\\''" : "%c", *text);
    }
}

// What a shell offers for an option's value: its words between two texts, else the text of the
// offer.
static void put_offer(FILE *stream, const option_row *o, const char *const texts[],
                      const char *open, const char *close)
{
    if (offer_of(o) != OFFER_WORDS) {
        fputs(texts[offer_of(o)], stream);
        return;
    }
    fputs(open, stream);
    put_choices(stream, o);
    fputs(close, stream);
}

// --- bash -----------------------------------------------------------------------------------

static void put_bash_offer(FILE *stream, const option_row *o)
{
    static const char *const calls[] = {
        [OFFER_NOTHING] = "return",
        [OFFER_FILES] = "_impactlab_files",
        [OFFER_PARAMETERS] = "_impactlab_words \"$parameters\"; compopt -o nospace",
        [OFFER_SCENARIOS] = "_impactlab_words \"$(" SCENARIO_NAMES ")\"; _impactlab_files",
        [OFFER_QUANTITIES] = "_impactlab_words \"$quantities\"",
    };

    fprintf(stream, "        '--%s'", o->name);
    if (o->letter != 0) {
        fprintf(stream, "|'-%c'", o->letter);
    }
    fprintf(stream, ") ");

    put_offer(stream, o, calls, "_impactlab_words '", "'");
    fprintf(stream, "; return ;;\n");
}

static void put_bash_command(FILE *stream, const command *c)
{
    const option_row *o;

    // values by the option before the cursor
    fprintf(stream, "    %s)\n        case $before in\n", c->name);
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        if (o->type != OPTION_FLAG) {
            put_bash_offer(stream, o);
        }
    }

    // words that need none
    fprintf(stream, "        esac\n        options='");
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        fprintf(stream, "%s--%s", i > 0 ? " " : "", o->name);
    }
    fprintf(stream, "'\n        operands='");
    put_operand_words(stream, c);
    fprintf(stream, "'\n        scenarios=%s ;;\n", c->takes_scenarios ? "yes" : "");
}

void write_bash_completion(FILE *stream)
{
    assert(stream != NULL);
    fprintf(stream, "# bash completion for impactlab\n"
                    "_impactlab_words() {\n"
                    "    COMPREPLY+=($(compgen -W \"$1\" -- \"$word\"))\n"
                    "}\n"
                    "_impactlab_files() {\n"
                    "    local IFS=$'\\n'\n"
                    "    compopt -o filenames\n"
                    "    COMPREPLY+=($(compgen -f -- \"$word\"))\n"
                    "}\n"
                    "_impactlab() {\n"
                    "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
                    "    local command=${COMP_WORDS[1]} options='' operands='' scenarios=''\n"
                    "    local parameters='");

    put_parameters(stream);
    fprintf(stream, "'\n    local quantities='");
    put_quantities(stream);
    fprintf(stream, "'\n    COMPREPLY=()\n"
                    "    if [ \"$COMP_CWORD\" = 1 ]; then\n        _impactlab_words '");
    put_commands(stream);

    fprintf(stream, " --help --version'\n        return\n    fi\n    case $command in\n");
    for (int i = 0; i < command_count; i++) {
        put_bash_command(stream, command_table[i]);
    }

    fprintf(stream, "    esac\n"
                    "    case $word in\n"
                    "    -*) _impactlab_words \"$options\"; return ;;\n"
                    "    esac\n"
                    "    _impactlab_words \"$operands\"\n"
                    "    if [ -n \"$scenarios\" ]; then\n"
                    "        _impactlab_words \"$(" SCENARIO_NAMES ")\"\n"
                    "        _impactlab_files\n"
                    "    fi\n"
                    "}\n"
                    "complete -F _impactlab impactlab\n");
}

// --- zsh ------------------------------------------------------------------------------------

static void put_zsh_option(FILE *stream, const option_row *o)
{
    static const char *const actions[] = {
        [OFFER_NOTHING] = " ",
        [OFFER_FILES] = "_files",
        [OFFER_PARAMETERS] = "_impactlab_parameters",
        [OFFER_SCENARIOS] = "_impactlab_scenarios",
        [OFFER_QUANTITIES] = "_impactlab_quantities",
    };

    bool repeats = option_is_text_list(o->type) || o->type == OPTION_NUMBERS;

    // the short form, then the long one
    for (int form = o->letter != 0 ? 0 : 1; form < 2; form++) {
        fprintf(stream, " \\\n            '%s", repeats ? "*" : "");
        if (form == 0) {
            fprintf(stream, "-%c", o->letter);
        } else {
            fprintf(stream, "--%s%s", o->name, o->type == OPTION_FLAG ? "" : "=");
        }

        fprintf(stream, "[");
        put_quoted(stream, o->help, "[]:\\");
        fprintf(stream, "]");

        if (o->type != OPTION_FLAG) {
            fprintf(stream, ":");
            put_quoted(stream, o->value, "[]:\\");
            fprintf(stream, ":");
            put_offer(stream, o, actions, "(", ")");
        }

        fprintf(stream, "'");
    }
}

static void put_zsh_command(FILE *stream, const command *c)
{
    const option_row *o;
    fprintf(stream, "        %s)\n            _arguments", c->name);

    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        put_zsh_option(stream, o);
    }

    if (c->operand_word != NULL) {
        fprintf(stream, " \\\n            '%s:word:(", c->takes_scenarios ? "1" : "*");
        put_operand_words(stream, c);
        fprintf(stream, ")'");
    }

    if (c->takes_scenarios) {
        fprintf(stream, " \\\n            '*:scenario:_impactlab_scenarios'");
    }
    fprintf(stream, " ;;\n");
}

void write_zsh_completion(FILE *stream)
{
    assert(stream != NULL);
    fprintf(stream, "#compdef impactlab\n"
                    "_impactlab_scenarios() {\n"
                    "    compadd -- $(" SCENARIO_NAMES ")\n    _files\n}\n"
                    "_impactlab_parameters() {\n    compadd -S '' -- ");
    put_parameters(stream);

    fprintf(stream, "\n}\n_impactlab_quantities() {\n    compadd -- ");
    put_quantities(stream);

    fprintf(stream, "\n}\n"
                    "_impactlab() {\n"
                    "    local context state line\n"
                    "    _arguments -C '1:command:->command' '*::argument:->argument'\n"
                    "    case $state in\n"
                    "    command)\n"
                    "        local -a commands=(");

    for (int i = 0; i < command_count; i++) {
        fprintf(stream, "\n            '%s:", command_table[i]->name);
        put_quoted(stream, command_table[i]->summary, ":\\");
        fprintf(stream, "'");
    }

    fprintf(stream, "\n        )\n"
                    "        _describe command commands ;;\n"
                    "    argument)\n"
                    "        case $words[1] in\n");
    for (int i = 0; i < command_count; i++) {
        put_zsh_command(stream, command_table[i]);
    }

    fprintf(stream, "        esac ;;\n    esac\n}\n"
                    "if [ \"$funcstack[1]\" = _impactlab ]; then\n"
                    "    _impactlab \"$@\"\n"
                    "else\n"
                    "    compdef _impactlab impactlab\n"
                    "fi\n");
}

// --- fish -----------------------------------------------------------------------------------

static void put_fish_option(FILE *stream, const command *c, const option_row *o)
{
    static const char *const no_value[] = {[OFFER_NOTHING] = ""};
    static const char *const values[] = {
        [OFFER_NOTHING] = " -x",         [OFFER_FILES] = " -r -F",
        [OFFER_PARAMETERS] = " -x -a '", [OFFER_SCENARIOS] = " -r -F -a '(__impactlab_scenarios)'",
        [OFFER_QUANTITIES] = " -x -a '",
    };
    fprintf(stream, "complete -c impactlab -n '__fish_seen_subcommand_from %s' -l %s", c->name,
            o->name);

    if (o->letter != 0) {
        fprintf(stream, " -s %c", o->letter);
    }

    // the lists that have no function of their own stand in the text
    put_offer(stream, o, o->type == OPTION_FLAG ? no_value : values, " -x -a '", "'");
    if (offer_of(o) == OFFER_PARAMETERS) {
        put_parameters(stream);
    } else if (offer_of(o) == OFFER_QUANTITIES) {
        put_quantities(stream);
    }
    fputs(offer_of(o) == OFFER_PARAMETERS || offer_of(o) == OFFER_QUANTITIES ? "'" : "", stream);

    fprintf(stream, " -d '");
    put_quoted(stream, o->help, "");
    fprintf(stream, "'\n");
}

static void put_fish_command(FILE *stream, const command *c)
{
    const option_row *o;
    fprintf(stream, "complete -c impactlab -n __fish_use_subcommand -f -a %s -d '", c->name);
    put_quoted(stream, c->summary, "");
    fprintf(stream, "'\n");

    if (c->operand_word != NULL) {
        fprintf(stream, "complete -c impactlab -n '__fish_seen_subcommand_from %s' -a '", c->name);
        put_operand_words(stream, c);
        fprintf(stream, "'\n");
    }

    if (c->takes_scenarios) {
        fprintf(stream,
                "complete -c impactlab -n '__fish_seen_subcommand_from %s' -F -a "
                "'(__impactlab_scenarios)'\n",
                c->name);
    }

    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        put_fish_option(stream, c, o);
    }
}

void write_fish_completion(FILE *stream)
{
    assert(stream != NULL);
    fprintf(stream, "# fish completion for impactlab\n"
                    "function __impactlab_scenarios\n"
                    "    " SCENARIO_NAMES "\n"
                    "end\n"
                    "complete -c impactlab -f\n"
                    "complete -c impactlab -n __fish_use_subcommand -l version -d 'Print the "
                    "version'\n");
    for (int i = 0; i < command_count; i++) {
        put_fish_command(stream, command_table[i]);
    }
}
