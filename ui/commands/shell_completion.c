// Completions for bash, zsh and fish from the tables of commands, options, parameters and
// quantities. The names of scenarios are asked of the program when they are wanted.
#include "ui/commands/command.h"

#include <string.h>

#include "src/tables/parameters.h"

#define SCENARIO_NAMES "impactlab list 2>/dev/null | cut -d' ' -f1"

// What a shell offers for a value.
typedef enum offer {
    OFFER_NOTHING, // numbers and free text cannot be guessed
    OFFER_WORDS,   // of OPTION_CHOICE and OPTION_WORD
    OFFER_FILES,
    OFFER_PARAMETERS,
    OFFER_SCENARIOS, // and files
    OFFER_QUANTITIES,
    OFFERS
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

// The texts of a shell. In each of them stands
//   of a command:  %c its name, %s its summary, %W the words that an operand may be, %O
//   its options,
//                  %1 the place of the word among the operands, %y "yes" if it takes
//                  scenarios
//   of an option:  %o its name, %l its letter, %h its help, %v the name of its value, %w
//   its words,
//                  %= "=" if it has a value, %* "*" if it may be repeated,
//                  %L `letter` if it has one, %V `value` if it has one, %x what is
//                  offered for it
//   of all:        %C the commands, %P the parameters, %Q the quantities
typedef struct shell {
    const char *name;
    const char *escaped; // characters of helps that get a backslash
    const char *head, *listed,
        *commands;                    // before all, for each command, before the commands
    const char *begin, *option, *end; // of a command
    const char *letter, *value;       // of an option
    const char *words, *scenarios;    // of a command whose operands are these
    bool words_first;                 // before the options
    const char *tail;
    const char *offers[OFFERS];
} shell;

static const shell shells[] = {
    {.name = "bash",
     .head =
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
         "    local parameters='%P'\n"
         "    local quantities='%Q'\n"
         "    COMPREPLY=()\n"
         "    if [ \"$COMP_CWORD\" = 1 ]; then\n"
         "        _impactlab_words '%C --help --version'\n"
         "        return\n"
         "    fi\n"
         "    case $command in\n",
     .begin = "    %c)\n        case $before in\n",
     .option = "%V",
     .value = "        '--%o'%L) %x; return ;;\n",
     .letter = "|'-%l'",
     .end = "        esac\n"
            "        options='%O'\n"
            "        operands='%W'\n"
            "        scenarios=%y ;;\n",
     .tail = "    esac\n"
             "    case $word in\n"
             "    -*) _impactlab_words \"$options\"; return ;;\n"
             "    esac\n"
             "    _impactlab_words \"$operands\"\n"
             "    if [ -n \"$scenarios\" ]; then\n"
             "        _impactlab_words \"$(" SCENARIO_NAMES ")\"\n"
             "        _impactlab_files\n"
             "    fi\n"
             "}\n"
             "complete -F _impactlab impactlab\n",
     .offers = {[OFFER_NOTHING] = "return",
                [OFFER_WORDS] = "_impactlab_words '%w'",
                [OFFER_FILES] = "_impactlab_files",
                [OFFER_PARAMETERS] =
                    "_impactlab_words \"$parameters\"; compopt -o nospace",
                [OFFER_SCENARIOS] =
                    "_impactlab_words \"$(" SCENARIO_NAMES ")\"; _impactlab_files",
                [OFFER_QUANTITIES] = "_impactlab_words \"$quantities\""}},
    {.name = "zsh",
     .escaped = "[]:\\",
     .head = "#compdef impactlab\n"
             "_impactlab_scenarios() {\n"
             "    compadd -- $(" SCENARIO_NAMES ")\n"
             "    _files\n"
             "}\n"
             "_impactlab_parameters() {\n"
             "    compadd -S '' -- %P\n"
             "}\n"
             "_impactlab_quantities() {\n"
             "    compadd -- %Q\n"
             "}\n"
             "_impactlab() {\n"
             "    local context state line\n"
             "    _arguments -C '1:command:->command' '*::argument:->argument'\n"
             "    case $state in\n"
             "    command)\n"
             "        local -a commands=(",
     .listed = "\n            '%c:%s'",
     .commands = "\n        )\n"
                 "        _describe command commands ;;\n"
                 "    argument)\n"
                 "        case $words[1] in\n",
     .begin = "        %c)\n            _arguments",
     .option = "%L \\\n            '%*--%o%=[%h]%V'",
     .letter = " \\\n            '%*-%l[%h]%V'",
     .value = ":%v:%x",
     .words = " \\\n            '%1:word:(%W)'",
     .scenarios = " \\\n            '*:scenario:_impactlab_scenarios'",
     .end = " ;;\n",
     .tail = "        esac ;;\n"
             "    esac\n"
             "}\n"
             "if [ \"$funcstack[1]\" = _impactlab ]; then\n"
             "    _impactlab \"$@\"\n"
             "else\n"
             "    compdef _impactlab impactlab\n"
             "fi\n",
     .offers = {[OFFER_NOTHING] = " ",
                [OFFER_WORDS] = "(%w)",
                [OFFER_FILES] = "_files",
                [OFFER_PARAMETERS] = "_impactlab_parameters",
                [OFFER_SCENARIOS] = "_impactlab_scenarios",
                [OFFER_QUANTITIES] = "_impactlab_quantities"}},
    {.name = "fish",
     .head = "# fish completion for impactlab\n"
             "function __impactlab_scenarios\n"
             "    " SCENARIO_NAMES "\n"
             "end\n"
             "complete -c impactlab -f\n"
             "complete -c impactlab -n __fish_use_subcommand -l version -d 'Print the "
             "version'\n",
     .begin = "complete -c impactlab -n __fish_use_subcommand -f -a %c -d '%s'\n",
     .words = "complete -c impactlab -n '__fish_seen_subcommand_from %c' -a '%W'\n",
     .scenarios = "complete -c impactlab -n '__fish_seen_subcommand_from %c' -F -a "
                  "'(__impactlab_scenarios)'\n",
     .words_first = true,
     .option =
         "complete -c impactlab -n '__fish_seen_subcommand_from %c' -l %o%L%V -d '%h'\n",
     .letter = " -s %l",
     .value = "%x",
     .offers = {[OFFER_NOTHING] = " -x",
                [OFFER_WORDS] = " -x -a '%w'",
                [OFFER_FILES] = " -r -F",
                [OFFER_PARAMETERS] = " -x -a '%P'",
                [OFFER_SCENARIOS] = " -r -F -a '(__impactlab_scenarios)'",
                [OFFER_QUANTITIES] = " -x -a '%Q'"}},
};

// What is written: for which shell, of which commands.
typedef struct completion {
    FILE *stream;
    const shell *shell;
    const command_list *all;
} completion;

// Text between single quotes of a shell.
static void put_quoted(const completion *w, const char *text)
{
    const char *escaped = w->shell->escaped;
    for (; *text != '\0'; text++) {
        if (escaped != NULL && strchr(escaped, *text) != NULL) {
            fputc('\\', w->stream);
        }
        if (*text == '\'') {
            fputs("'\\''", w->stream);
        } else {
            fputc(*text, w->stream);
        }
    }
}

// The i-th word of a list of the whole program, NULL after the last.
static const char *listed_word(const command_list *all, char list, const command *c,
                               int i)
{
    const option_row *o;
    switch (list) {
    case 'C':
        if (i < all->count) {
            return all->items[i]->name;
        }
        return NULL;
    case 'P':
        if (i < parameter_count) {
            return parameter_table[i].path;
        }
        return NULL;
    case 'Q':
        if (i < summary_count) {
            return summary_table[i].key;
        }
        return NULL;
    case 'O':
        o = command_option(c, i);
        if (o != NULL) {
            return o->name;
        }
        return NULL;
    default:
        if (c->operand_word != NULL) {
            return c->operand_word(all, i);
        }
        return NULL;
    }
}

// What stands for a letter of a shell's text as it is, NULL for all others.
static const char *letter_text(char letter, const command *c, const option_row *o)
{
    switch (letter) {
    case 'c':
        return c->name;
    case '1':
        if (c->takes_scenarios) {
            return "1";
        }
        return "*";
    case 'y':
        if (c->takes_scenarios) {
            return "yes";
        }
        return "";
    case 'o':
        return o->name;
    case '=':
        if (o->type != OPTION_FLAG) {
            return "=";
        }
        return "";
    case '*':
        if (option_is_list(o->type)) {
            return "*";
        }
        return "";
    default:
        return NULL;
    }
}

// The words of a list of the whole program, with blanks between them: options with their
// dashes, parameters with the sign of equality that follows them.
static void put_list(const completion *w, char list, const command *c)
{
    const char *word, *before = "", *behind = "";
    if (list == 'O') {
        before = "--";
    } else if (list == 'P') {
        behind = "=";
    }
    for (int i = 0; (word = listed_word(w->all, list, c, i)) != NULL; i++) {
        if (i > 0) {
            fputc(' ', w->stream);
        }
        fprintf(w->stream, "%s%s%s", before, word, behind);
    }
}

// The words of an option's value, "a|b|c", with blanks between them.
static void put_choices(FILE *stream, const char *words)
{
    for (; *words != '\0'; words++) {
        if (*words == '|') {
            fputc(' ', stream);
        } else {
            fputc(*words, stream);
        }
    }
}

static void put(const completion *w, const char *text, const command *c,
                const option_row *o);

// What stands for a letter of a shell's text.
static void put_letter(const completion *w, char letter, const command *c,
                       const option_row *o)
{
    const char *word = letter_text(letter, c, o);
    if (word != NULL) {
        fputs(word, w->stream);
        return;
    }

    switch (letter) {
    // texts
    case 's':
        put_quoted(w, c->summary);
        return;
    case 'h':
        put_quoted(w, o->help);
        return;
    case 'v':
        put_quoted(w, o->value);
        return;
    case 'l':
        fputc(o->letter, w->stream);
        return;
    case 'w':
        put_choices(w->stream, o->value);
        return;

    // other texts of the shell, in which letters stand in their turn
    case 'L':
        if (o->letter != 0) {
            put(w, w->shell->letter, c, o);
        }
        return;
    case 'V':
        if (o->type != OPTION_FLAG) {
            put(w, w->shell->value, c, o);
        }
        return;
    case 'x':
        put(w, w->shell->offers[offers[o->type]], c, o);
        return;

    default:
        put_list(w, letter, c);
        return;
    }
}

// A text of the shell (NULL: none), of a command and an option of it (NULL where there is
// none).
static void put(const completion *w, const char *text, const command *c,
                const option_row *o)
{
    if (text == NULL) {
        return;
    }
    for (; *text != '\0'; text++) {
        if (*text == '%') {
            text++;
            put_letter(w, *text, c, o);
        } else {
            fputc(*text, w->stream);
        }
    }
}

static void put_operands(const completion *w, const command *c)
{
    if (c->operand_word != NULL) {
        put(w, w->shell->words, c, NULL);
    }
    if (c->takes_scenarios) {
        put(w, w->shell->scenarios, c, NULL);
    }
}

void write_completion(FILE *stream, const command_list *all, const char *name)
{
    const shell *h = shells;
    while (strcmp(h->name, name) != 0) {
        h++;
    }

    // the names of all commands
    const completion w = {.stream = stream, .shell = h, .all = all};
    put(&w, h->head, NULL, NULL);
    for (int i = 0; i < all->count; i++) {
        put(&w, h->listed, all->items[i], NULL);
    }
    put(&w, h->commands, NULL, NULL);

    // each command with its options
    for (int i = 0; i < all->count; i++) {
        const command *c = all->items[i];
        const option_row *o;
        put(&w, h->begin, c, NULL);
        if (h->words_first) {
            put_operands(&w, c);
        }
        for (int k = 0; (o = command_option(c, k)) != NULL; k++) {
            put(&w, h->option, c, o);
        }
        if (!h->words_first) {
            put_operands(&w, c);
        }
        put(&w, h->end, c, NULL);
    }
    put(&w, h->tail, NULL, NULL);
}
