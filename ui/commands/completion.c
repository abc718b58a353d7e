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

// Text between single quotes of a shell.
static void put_quoted(FILE *stream, const shell *h, const char *text)
{
    for (; *text != '\0'; text++) {
        if (h->escaped != NULL && strchr(h->escaped, *text) != NULL) {
            fputc('\\', stream);
        }
        fprintf(stream, *text == '\'' ? "'\\''" : "%c", *text);
    }
}

// The i-th word of a list of the whole program, NULL after the last.
static const char *listed_word(char list, const command *c, int i)
{
    const option_row *o = list == 'O' ? command_option(c, i) : NULL;
    switch (list) {
    case 'C':
        if (i < command_count) {
            return command_table[i]->name;
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
        if (o != NULL) {
            return o->name;
        }
        return NULL;
    default:
        if (c->operand_word != NULL) {
            return c->operand_word(i);
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

// A text of the shell (NULL: none), of a command and an option of it (NULL where there is
// none).
static void put(FILE *stream, const shell *h, const char *text, const command *c,
                const option_row *o)
{
    const char *word;
    for (; text != NULL && *text != '\0'; text++) {
        const char letter = *text == '%' ? *++text : '\0';
        if (letter == '\0') {
            fputc(*text, stream);
        } else if ((word = letter_text(letter, c, o)) != NULL) {
            fputs(word, stream);
        } else if (strchr("shv", letter) != NULL) {
            put_quoted(stream, h,
                       letter == 's'   ? c->summary
                       : letter == 'h' ? o->help
                                       : o->value);
        } else if (letter == 'l') {
            fputc(o->letter, stream);
        } else if (letter == 'L') {
            put(stream, h, o->letter != 0 ? h->letter : NULL, c, o);
        } else if (letter == 'V') {
            put(stream, h, o->type != OPTION_FLAG ? h->value : NULL, c, o);
        } else if (letter == 'x') {
            put(stream, h, h->offers[offers[o->type]], c, o);
        } else if (letter == 'w') {
            for (word = o->value; *word != '\0'; word++) {
                fputc(*word == '|' ? ' ' : *word, stream);
            }
        } else {
            for (int i = 0; (word = listed_word(letter, c, i)) != NULL; i++) {
                fprintf(stream, "%s%s%s%s", i > 0 ? " " : "", letter == 'O' ? "--" : "",
                        word, letter == 'P' ? "=" : "");
            }
        }
    }
}

static void put_operands(FILE *stream, const shell *h, const command *c)
{
    put(stream, h, c->operand_word != NULL ? h->words : NULL, c, NULL);
    put(stream, h, c->takes_scenarios ? h->scenarios : NULL, c, NULL);
}

void write_completion(FILE *stream, const char *name)
{
    const shell *h = shells;
    while (strcmp(h->name, name) != 0) {
        h++;
    }
    put(stream, h, h->head, NULL, NULL);
    for (int i = 0; i < command_count; i++) {
        put(stream, h, h->listed, command_table[i], NULL);
    }
    put(stream, h, h->commands, NULL, NULL);

    // each command with its options
    for (int i = 0; i < command_count; i++) {
        const command *c = command_table[i];
        const option_row *o;
        put(stream, h, h->begin, c, NULL);
        if (h->words_first) {
            put_operands(stream, h, c);
        }
        for (int k = 0; (o = command_option(c, k)) != NULL; k++) {
            put(stream, h, h->option, c, o);
        }
        if (!h->words_first) {
            put_operands(stream, h, c);
        }
        put(stream, h, h->end, c, NULL);
    }
    put(stream, h, h->tail, NULL, NULL);
}
