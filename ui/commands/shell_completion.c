#include "ui/commands/shell_completion.h"

#include <glib.h>
#include <string.h>

#include "src/tables/parameters.h"
#include "src/tables/summary.h"

// What the shell calls for the names of scenarios.
#define SCENARIO_NAMES "impactlab list 2>/dev/null | cut -d' ' -f1"

// What a shell offers for a value.
typedef enum offer {
    OFFER_NOTHING, // numbers and free text cannot be guessed
    OFFER_WORDS,   // of OPTION_CHOICE and OPTION_WORD
    OFFER_FILES,
    OFFER_PARAMETERS,
    OFFER_SCENARIOS, // and files
    OFFER_QUANTITIES,
} offer;

static const offer offers[] = {
    [OPTION_CHOICE] = OFFER_WORDS,
    [OPTION_WORD] = OFFER_WORDS,
    [OPTION_FILE] = OFFER_FILES,
    [OPTION_FILES] = OFFER_FILES,
    [OPTION_RESULT] = OFFER_FILES,
    [OPTION_PICTURE] = OFFER_FILES,
    [OPTION_PLACE] = OFFER_FILES,
    [OPTION_SCENARIO] = OFFER_SCENARIOS,
    [OPTION_PARAMETERS] = OFFER_PARAMETERS,
    [OPTION_QUANTITY] = OFFER_QUANTITIES,
};

// --- lists of words, with blanks between them; to be freed with g_free -----------------

static char *join_and_free(GPtrArray *words)
{
    g_ptr_array_add(words, NULL);
    char *joined = g_strjoinv(" ", (char **)words->pdata);
    g_ptr_array_free(words, TRUE);
    return joined;
}

static char *command_words(const command_list *all)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < all->count; i++) {
        g_ptr_array_add(words, g_strdup(all->items[i]->name));
    }
    return join_and_free(words);
}

// Paths with the sign of equality that follows them.
static char *parameter_words(void)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < parameter_count; i++) {
        g_ptr_array_add(words, g_strconcat(parameter_table[i].path, "=", NULL));
    }
    return join_and_free(words);
}

static char *quantity_words(void)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < summary_count; i++) {
        g_ptr_array_add(words, g_strdup(summary_table[i].key));
    }
    return join_and_free(words);
}

// Options with their dashes.
static char *option_words(const command *c)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    const option_row *o;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        g_ptr_array_add(words, g_strconcat("--", o->name, NULL));
    }
    return join_and_free(words);
}

// What operands may be besides scenarios.
static char *operand_words(const command_list *all, const command *c)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    if (c->operand_word != NULL) {
        const char *word;
        for (int i = 0; (word = c->operand_word(all, i)) != NULL; i++) {
            g_ptr_array_add(words, g_strdup(word));
        }
    }
    return join_and_free(words);
}

// The words of an option's value, "a|b|c".
static char *choice_words(const option_row *o)
{
    return g_strdelimit(g_strdup(o->value), "|", ' ');
}

// Text between single quotes of a shell, with a backslash before special characters; to
// be freed with g_free.
static char *quoted_text(const char *text, const char *special)
{
    GString *quoted = g_string_new(NULL);
    for (const char *c = text; *c != '\0'; c++) {
        if (strchr(special, *c) != NULL) {
            g_string_append_c(quoted, '\\');
        }
        if (*c == '\'') {
            g_string_append(quoted, "'\\''");
        } else {
            g_string_append_c(quoted, *c);
        }
    }
    return g_string_free(quoted, FALSE);
}

// --- bash ------------------------------------------------------------------------------

// The call that offers the values of an option.
static void write_bash_offer(FILE *stream, const option_row *o)
{
    switch (offers[o->type]) {
    case OFFER_NOTHING:
        fprintf(stream, "return");
        return;
    case OFFER_WORDS: {
        g_autofree char *words = choice_words(o);
        fprintf(stream, "_impactlab_words '%s'", words);
        return;
    }
    case OFFER_FILES:
        fprintf(stream, "_impactlab_files");
        return;
    case OFFER_PARAMETERS:
        fprintf(stream, "_impactlab_words \"$parameters\"; compopt -o nospace");
        return;
    case OFFER_SCENARIOS:
        fprintf(stream, "_impactlab_words \"$(" SCENARIO_NAMES ")\"; _impactlab_files");
        return;
    case OFFER_QUANTITIES:
        fprintf(stream, "_impactlab_words \"$quantities\"");
        return;
    }
}

// A command's branch of the case: what follows an option that has a value, and the words
// among which it is chosen otherwise.
static void write_bash_command(FILE *stream, const command_list *all, const command *c)
{
    fprintf(stream, "    %s)\n        case $before in\n", c->name);

    // options that have a value
    const option_row *o;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        if (o->type == OPTION_FLAG) {
            continue;
        }
        fprintf(stream, "        '--%s'", o->name);
        if (o->letter != 0) {
            fprintf(stream, "|'-%c'", o->letter);
        }
        fprintf(stream, ") ");
        write_bash_offer(stream, o);
        fprintf(stream, "; return ;;\n");
    }

    // what stands there else
    g_autofree char *options = option_words(c);
    g_autofree char *operands = operand_words(all, c);
    const char *scenarios = "";
    if (c->takes_scenarios) {
        scenarios = "yes";
    }
    fprintf(stream,
            "        esac\n"
            "        options='%s'\n"
            "        operands='%s'\n"
            "        scenarios=%s ;;\n",
            options, operands, scenarios);
}

// A function with one case over all commands.
static void write_bash(FILE *stream, const command_list *all)
{
    g_autofree char *commands = command_words(all);
    g_autofree char *paths = parameter_words();
    g_autofree char *quantities = quantity_words();
    fprintf(
        stream,
        "# bash completion for impactlab\n"
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
        "    local parameters='%s'\n"
        "    local quantities='%s'\n"
        "    COMPREPLY=()\n"
        "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
        "        _impactlab_words '%s --help --version'\n"
        "        return\n"
        "    fi\n"
        "    case $command in\n",
        paths, quantities, commands);

    // each command with its options
    for (int i = 0; i < all->count; i++) {
        write_bash_command(stream, all, all->items[i]);
    }

    // what all commands share
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

// --- zsh -------------------------------------------------------------------------------

// Characters that mean something to _arguments and _describe.
static const char zsh_special[] = "[]:\\";

// The action of _arguments that offers the values of an option.
static void write_zsh_offer(FILE *stream, const option_row *o)
{
    switch (offers[o->type]) {
    case OFFER_NOTHING:
        fprintf(stream, " ");
        return;
    case OFFER_WORDS: {
        g_autofree char *words = choice_words(o);
        fprintf(stream, "(%s)", words);
        return;
    }
    case OFFER_FILES:
        fprintf(stream, "_files");
        return;
    case OFFER_PARAMETERS:
        fprintf(stream, "_impactlab_parameters");
        return;
    case OFFER_SCENARIOS:
        fprintf(stream, "_impactlab_scenarios");
        return;
    case OFFER_QUANTITIES:
        fprintf(stream, "_impactlab_quantities");
        return;
    }
}

// One spelling of an option, as _arguments takes it: '*--set=[help]:VALUE:offer'.
static void write_zsh_spelling(FILE *stream, const option_row *o, const char *spelling,
                               const char *equals)
{
    const char *repeated = "";
    if (option_is_list(o->type)) {
        repeated = "*";
    }
    g_autofree char *help = quoted_text(o->help, zsh_special);
    fprintf(stream, " \\\n            '%s%s%s[%s]", repeated, spelling, equals, help);
    if (o->type != OPTION_FLAG) {
        g_autofree char *value = quoted_text(o->value, zsh_special);
        fprintf(stream, ":%s:", value);
        write_zsh_offer(stream, o);
    }
    fprintf(stream, "'");
}

// An option for _arguments, in its short form and its long one.
static void write_zsh_option(FILE *stream, const option_row *o)
{
    if (o->letter != 0) {
        const char letter[] = {'-', o->letter, '\0'};
        write_zsh_spelling(stream, o, letter, "");
    }

    const char *equals = "=";
    if (o->type == OPTION_FLAG) {
        equals = "";
    }
    g_autofree char *name = g_strconcat("--", o->name, NULL);
    write_zsh_spelling(stream, o, name, equals);
}

// The branch of a command: one call of _arguments.
static void write_zsh_command(FILE *stream, const command_list *all, const command *c)
{
    fprintf(stream, "        %s)\n            _arguments", c->name);
    const option_row *o;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        write_zsh_option(stream, o);
    }

    // words stand before scenarios where there are both
    if (c->operand_word != NULL) {
        g_autofree char *words = operand_words(all, c);
        const char *place = "*";
        if (c->takes_scenarios) {
            place = "1";
        }
        fprintf(stream, " \\\n            '%s:word:(%s)'", place, words);
    }
    if (c->takes_scenarios) {
        fprintf(stream, " \\\n            '*:scenario:_impactlab_scenarios'");
    }
    fprintf(stream, " ;;\n");
}

// A function with the list of commands, and one case over all of them.
static void write_zsh(FILE *stream, const command_list *all)
{
    g_autofree char *paths = parameter_words();
    g_autofree char *quantities = quantity_words();

    // what several commands offer, and the names of all
    fprintf(stream,
            "#compdef impactlab\n"
            "_impactlab_scenarios() {\n"
            "    compadd -- $(" SCENARIO_NAMES ")\n"
            "    _files\n"
            "}\n"
            "_impactlab_parameters() {\n"
            "    compadd -S '' -- %s\n"
            "}\n"
            "_impactlab_quantities() {\n"
            "    compadd -- %s\n"
            "}\n"
            "_impactlab() {\n"
            "    local context state line\n"
            "    _arguments -C '1:command:->command' '*::argument:->argument'\n"
            "    case $state in\n"
            "    command)\n"
            "        local -a commands=(",
            paths, quantities);
    for (int i = 0; i < all->count; i++) {
        const command *c = all->items[i];
        g_autofree char *described = quoted_text(c->summary, zsh_special);
        fprintf(stream, "\n            '%s:%s'", c->name, described);
    }

    // each command with its options
    fprintf(stream, "\n        )\n"
                    "        _describe command commands ;;\n"
                    "    argument)\n"
                    "        case $words[1] in\n");
    for (int i = 0; i < all->count; i++) {
        write_zsh_command(stream, all, all->items[i]);
    }

    // a file that is sourced instead of loaded registers itself
    fprintf(stream, "        esac ;;\n"
                    "    esac\n"
                    "}\n"
                    "if [ \"$funcstack[1]\" = _impactlab ]; then\n"
                    "    _impactlab \"$@\"\n"
                    "else\n"
                    "    compdef _impactlab impactlab\n"
                    "fi\n");
}

// --- fish ------------------------------------------------------------------------------

// The beginning of a line that holds behind a command's name.
#define FISH_OF_COMMAND "complete -c impactlab -n '__fish_seen_subcommand_from %s'"

// The switches of complete that offer the values of an option.
static void write_fish_offer(FILE *stream, const option_row *o)
{
    switch (offers[o->type]) {
    case OFFER_NOTHING:
        fprintf(stream, " -x");
        return;
    case OFFER_WORDS: {
        g_autofree char *words = choice_words(o);
        fprintf(stream, " -x -a '%s'", words);
        return;
    }
    case OFFER_FILES:
        fprintf(stream, " -r -F");
        return;
    case OFFER_PARAMETERS: {
        g_autofree char *words = parameter_words();
        fprintf(stream, " -x -a '%s'", words);
        return;
    }
    case OFFER_SCENARIOS:
        fprintf(stream, " -r -F -a '(__impactlab_scenarios)'");
        return;
    case OFFER_QUANTITIES: {
        g_autofree char *words = quantity_words();
        fprintf(stream, " -x -a '%s'", words);
        return;
    }
    }
}

// An option of a command, a line.
static void write_fish_option(FILE *stream, const command *c, const option_row *o)
{
    fprintf(stream, FISH_OF_COMMAND " -l %s", c->name, o->name);
    if (o->letter != 0) {
        fprintf(stream, " -s %c", o->letter);
    }
    if (o->type != OPTION_FLAG) {
        write_fish_offer(stream, o);
    }
    g_autofree char *help = quoted_text(o->help, "");
    fprintf(stream, " -d '%s'\n", help);
}

// A command, what its operands may be, and its options.
static void write_fish_command(FILE *stream, const command_list *all, const command *c)
{
    g_autofree char *described = quoted_text(c->summary, "");
    fprintf(stream, "complete -c impactlab -n __fish_use_subcommand -f -a %s -d '%s'\n",
            c->name, described);

    // operands
    if (c->operand_word != NULL) {
        g_autofree char *words = operand_words(all, c);
        fprintf(stream, FISH_OF_COMMAND " -a '%s'\n", c->name, words);
    }
    if (c->takes_scenarios) {
        fprintf(stream, FISH_OF_COMMAND " -F -a '(__impactlab_scenarios)'\n", c->name);
    }

    // options
    const option_row *o;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        write_fish_option(stream, c, o);
    }
}

// A line for each command and each option.
static void write_fish(FILE *stream, const command_list *all)
{
    fprintf(stream, "# fish completion for impactlab\n"
                    "function __impactlab_scenarios\n"
                    "    " SCENARIO_NAMES "\n"
                    "end\n"
                    "complete -c impactlab -f\n"
                    "complete -c impactlab -n __fish_use_subcommand -l version -d "
                    "'Print the version'\n");
    for (int i = 0; i < all->count; i++) {
        write_fish_command(stream, all, all->items[i]);
    }
}

void write_completion(FILE *stream, const command_list *all, const char *shell)
{
    if (strcmp(shell, "bash") == 0) {
        write_bash(stream, all);
    } else if (strcmp(shell, "zsh") == 0) {
        write_zsh(stream, all);
    } else {
        write_fish(stream, all);
    }
}
