// impactlab help: how to call a command, an answer to a question, and the pages that are
// made from the program's tables.
#include "ui/commands/command.h"

#include <errno.h>
#include <glib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/page/text.h"
#include "src/base/text_stream.h"
#include "ui/commands/answers.h"
#include "ui/commands/help_pages.h"
#include "ui/commands/reference.h"
#include "ui/commands/results.h"
#include "ui/commands/shell_completion.h"

// --- man pages as files ----------------------------------------------------------------

// A man page: of all commands, or of the one that it is about.
typedef struct man_page {
    const command_list *all;
    const command *about; // NULL: impactlab itself
} man_page;

static void write_page(FILE *stream, const void *found)
{
    const man_page *page = found;
    write_man_page(stream, page->all, page->about);
}

// All man pages, FOLDER/impactlab.1 and FOLDER/impactlab-COMMAND.1. The folder is made if
// it is not there.
static int write_all_man_pages(const command_list *all, const char *folder)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        complain("the folder '%s' cannot be made: %s", folder, strerror(errno));
        return EXIT_FAILED;
    }

    // the program, then each command
    const man_page overview = {.all = all};
    g_autofree char *overview_path = text_printf("%s/impactlab.1", folder);
    int result = write_file(overview_path, write_page, &overview);

    for (int i = 0; i < all->count; i++) {
        const man_page page = {.all = all, .about = all->items[i]};
        g_autofree char *path =
            text_printf("%s/impactlab-%s.1", folder, page.about->name);
        result = worse(result, write_file(path, write_page, &page));
    }
    return result;
}

// --- the command -----------------------------------------------------------------------

// Answers a question, given as one word or several.
static int answer_question(const arguments *a)
{
    // the operands end with NULL, as argv does
    g_autofree char *question = g_strjoinv(" ", a->operands);
    const int answers = print_answers(stdout, a->commands, question);
    if (loss_noted()) {
        return complain_fault(&(fault){.code = STATUS_NO_MEMORY});
    }
    if (answers > 0) {
        return EXIT_DONE;
    }

    // a misspelt command, perhaps
    const char *near = command_nearest(a->commands, question);
    if (near != NULL) {
        return complain("no passage says '%s', did you mean '%s'?", question, near);
    }
    return complain("no passage says '%s', expected words that the manual, a parameter, "
                    "a quantity, a law or a command has",
                    question);
}

// The command: writes what is asked for, by default the list of commands.
static int help(const arguments *a)
{
    // a command that is named, or a question
    const command *about = NULL;
    if (a->operand_count == 1) {
        about = command_find(a->commands, a->operands[0]);
    }
    if (a->operand_count > 0 && about == NULL) {
        if (a->man) {
            return complain_command(a->commands, a->operands[0]);
        }
        return answer_question(a);
    }

    // what is made for other programs
    if (a->completion != NULL) {
        write_completion(stdout, a->commands, a->completion);
        return EXIT_DONE;
    }
    if (a->man_pages != NULL) {
        return write_all_man_pages(a->commands, a->man_pages);
    }
    if (a->reference != NULL) {
        write_reference(stdout, a->reference);
        return EXIT_DONE;
    }

    if (a->man) {
        write_man_page(stdout, a->commands, about);
    } else if (about != NULL) {
        print_help(stdout, about);
    } else {
        print_commands(stdout, a->commands);
    }
    return EXIT_DONE;
}

static const char *command_word(const command_list *all, int i)
{
    if (i < all->count) {
        return all->items[i]->name;
    }
    return NULL;
}

static const option_row rows[] = {
    OPTION(FLAG, "man", NULL,
           "write the man page instead, of the command or of impactlab", PLACE(man)),
    OPTION(PLACE, "man-pages", "FOLDER", "write the man pages of all commands as files",
           PLACE(man_pages)),
    OPTION(CHOICE, "completion", "bash|zsh|fish",
           "write what this shell needs to complete commands and options",
           PLACE(completion)),
    OPTION(
        CHOICE, "reference", REFERENCE_PAGES,
        "write a chapter of the manual from the program's tables, the last as a man page",
        PLACE(reference)),
};

const command help_command = {
    .name = "help",
    .group = GROUP_PROGRAM,
    .summary = "The commands, how to call one, or an answer to a question",
    .operands = "[COMMAND|QUESTION...]",
    .least = 0,
    .most = 32,
    .help =
        "A QUESTION is some words, as in: impactlab help settling time. It is looked up "
        "in the pages of the\n"
        "manual, the parameters, quantities, signals, control laws and commands; "
        "the best hits are\n"
        "printed with the passage that fits and where to read on.\n",
    .operand_word = command_word,
    .options = {OWN_OPTIONS(rows)},
    .run = help,
};
