// What --help prints, what the manual, the tables and the commands say about words, and
// the command `help`.
#include "ui/commands/command.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/manual/search.h"

enum { LINE = 100 };

static void print_paragraphs(FILE *stream, const char *text)
{
    paragraph p;
    bool was_literal = false;

    while (next_paragraph(&text, &p)) {
        if (!(p.literal && was_literal)) {
            fprintf(stream, "\n");
        }

        if (p.literal) {
            fprintf(stream, "%.*s\n", p.bytes, p.start);
        } else {
            print_indented(stream, p.start, p.bytes, LINE, 0);
        }

        was_literal = p.literal;
    }
}

static int option_width(const option_row *o)
{
    return (int)(strlen(o->name) + (o->value != NULL ? 1 + strlen(o->value) : 0));
}

void print_help(FILE *stream, const command *self)
{
    fprintf(stream, "impactlab %s%s%s [OPTION]...\n\n%s.\n", self->name,
            self->operands[0] ? " " : "", self->operands, self->summary);
    print_paragraphs(stream, self->help);

    // its options, each table's below the others of its title, in two columns
    const option_table *t;
    const option_row *o;
    const char *title = "";
    int widest = 0;
    for (int i = 0; (o = command_option(self, i)) != NULL; i++) {
        if (option_width(o) > widest) {
            widest = option_width(o);
        }
    }
    for (int i = 0; (t = command_options(self, i)) != NULL; i++) {
        if (strcmp(t->title, title) != 0) {
            fprintf(stream, "\n%s:\n", t->title);
        }
        title = t->title;
        for (o = t->rows; o < t->rows + t->count; o++) {
            const char letter[] = {'-', o->letter, ',', '\0'};
            fprintf(stream, "  %-3s --%s%s%s%*s  %s\n", o->letter != 0 ? letter : "",
                    o->name, o->value ? " " : "", o->value ? o->value : "",
                    widest - option_width(o), "", o->help);
        }
    }
}

void print_commands(FILE *stream, const command_list *all)
{
    static const char *const titles[] = {
#define GROUP_TITLE(group, title) title,
        COMMAND_GROUPS(GROUP_TITLE)
#undef GROUP_TITLE
    };

    fprintf(stream,
            "impactlab %s: impact and force control of a flexible robot arm\n\n"
            "usage: impactlab COMMAND [ARGUMENT]...\n",
            lab_version());

    for (int group = 0; group < COMMAND_GROUP_COUNT; group++) {
        fprintf(stream, "\n%s:\n", titles[group]);
        for (int i = 0; i < all->count; i++) {
            const command *c = all->items[i];
            if ((int)c->group == group) {
                fprintf(stream, "  %-9s  %s\n", c->name, c->summary);
            }
        }
    }

    fprintf(stream, "\nimpactlab COMMAND --help tells more about a command, impactlab "
                    "help QUESTION searches\n"
                    "the manual.\n"
                    "Exit status: 0 done; 1 the run failed or is inaccurate, or a file "
                    "could not be written;\n"
                    "2 bad arguments or a bad scenario; 130 ended by ^C.\n");
}

enum { HITS = 6, PASSAGE = 330, INDENT = 4, MEANINGS = 8, TEXTS = COMMAND_OPTIONS + 2 };

// --- what there is to be found ---------------------------------------------------------

static search_entry section_entry(const void *context, int i)
{
    const manual_section s = manual_section_at(i);
    return (search_entry){s.heading, s.title, s.texts, s.text_count};
}

static search_entry parameter_entry(const void *context, int i)
{
    static const char *texts[2];
    texts[0] = parameter_table[i].description;
    texts[1] = parameter_table[i].choices;
    return (search_entry){parameter_table[i].path, "parameter", texts,
                          texts[1] != NULL ? 2 : 1};
}

static search_entry quantity_entry(const void *context, int i)
{
    static const char *texts[1];
    texts[0] = summary_table[i].description;
    return (search_entry){summary_table[i].key, "quantity", texts, 1};
}

static search_entry signal_entry(const void *context, int i)
{
    static const char *texts[1];
    texts[0] = signal_table[i].description;
    return (search_entry){signal_table[i].name, "signal", texts, 1};
}

// A command with its summary, its help and what its own options do; the context is the
// list of all.
static search_entry command_entry(const void *context, int i)
{
    const command_list *all = context;
    static const char *texts[TEXTS];
    const command *c = all->items[i];
    int count = 0;
    texts[count++] = c->summary;
    texts[count++] = c->help;
    for (int t = 0; c->options[t] != NULL; t++) {
        const option_table *o = c->options[t];
        const bool shared = o == &page_options || o == &view_options;
        for (int k = 0; k < o->count && !shared && count < TEXTS; k++) {
            texts[count++] = o->rows[k].help;
        }
    }
    return (search_entry){c->name, "command", texts, count};
}

enum { SECTIONS, PARAMETERS, QUANTITIES, SIGNALS, COMMANDS, SOURCES };

static void list_sources(const command_list *all, search_source sources[SOURCES])
{
    sources[SECTIONS] = (search_source){manual_sections(), section_entry};
    sources[PARAMETERS] = (search_source){parameter_count, parameter_entry};
    sources[QUANTITIES] = (search_source){summary_count, quantity_entry};
    sources[SIGNALS] = (search_source){signal_count, signal_entry};
    sources[COMMANDS] = (search_source){all->count, command_entry, all};
}

// --- how it is shown -------------------------------------------------------------------

// Name of a thing, without its explanation.
static void print_name(FILE *stream, int source, int index, const search_entry *e)
{
    const char *unit;
    if (source == PARAMETERS) {
        unit = parameter_table[index].unit;
    } else if (source == QUANTITIES) {
        unit = summary_table[index].unit;
    } else if (source == SIGNALS) {
        unit = signal_table[index].unit;
    } else {
        unit = "";
    }
    if (source == SECTIONS) {
        fprintf(stream, "%s, \"%s\"\n", manual_section_at(index).page, e->title);
    } else if (source == COMMANDS) {
        fprintf(stream, "impactlab %s\n", e->title);
    } else if (unit[0] != '\0') {
        fprintf(stream, "%s %s [%s]\n", e->above, e->title, unit);
    } else {
        fprintf(stream, "%s %s\n", e->above, e->title);
    }
}

// How to go on from a thing, before and behind its name; nothing for a page.
static const char *const ways_on[SOURCES][2] = {
    [PARAMETERS] = {"impactlab show SCENARIO lists it, --set ", "=VALUE changes it"},
    [QUANTITIES] = {"impactlab run SCENARIO --json - has it, sweep --quantity ",
                    " draws it"},
    [SIGNALS] = {"impactlab run SCENARIO --csv FILE has it, --plot FILE --signals ",
                 " draws it"},
    [COMMANDS] = {"impactlab ", " --help"},
};

// Bytes of a text up to `most`, whole words.
static int cut_length(const char *text, int most)
{
    int length = (int)strlen(text);
    if (length <= most) {
        return length;
    }
    for (length = most; length > 0 && text[length] != ' ';) {
        length--;
    }
    return length;
}

static void print_hit(FILE *stream, const search_source *sources, const search_hit *hit)
{
    const search_entry e = search_entry_of(&sources[hit->source], hit->index);
    const char *text = hit->text < e.text_count ? e.texts[hit->text] : "";

    fprintf(stream, "\n");
    print_name(stream, hit->source, hit->index, &e);
    const int length = cut_length(text, PASSAGE);
    print_indented(stream, text, length, LINE, INDENT);
    if (text[length] != '\0') {
        fprintf(stream, "    ...\n");
    }
    const char *const *way = ways_on[hit->source];
    if (way[0] != NULL) {
        fprintf(stream, "    %s%s%s\n", way[0], e.title, way[1]);
    }
}

// Prints what answers a question best: each hit with the passage that fits, and where to
// read on. Returns how many hits there are.
static int print_answers(FILE *stream, const command_list *all, const char *question)
{
    search_source sources[SOURCES];
    search_hit hits[HITS];
    list_sources(all, sources);
    const int count = search_find(sources, SOURCES, question, hits, HITS);
    for (int i = 0; i < count; i++) {
        print_hit(stream, sources, &hits[i]);
    }

    // where the pages are
    char *folder = count > 0 ? shipped_path(SHIPPED_MANUAL) : NULL;
    loss_unless(count == 0 || folder != NULL);
    if (folder != NULL) {
        fprintf(stream, "\nThe pages are in %s\n", folder);
    }
    free(folder);
    return count;
}

int print_meanings(FILE *stream, const command_list *all, const char *words)
{
    search_source sources[SOURCES];
    search_hit hits[MEANINGS];
    list_sources(all, sources);
    const int count = search_titles(sources, SOURCES, words, hits, MEANINGS);
    fprintf(stream, "%s", count > 0 ? "it may mean\n" : "");
    for (int i = 0; i < count; i++) {
        const search_entry e = search_entry_of(&sources[hits[i].source], hits[i].index);
        fprintf(stream, "  ");
        print_name(stream, hits[i].source, hits[i].index, &e);
        print_indented(stream, e.texts[0], cut_length(e.texts[0], PASSAGE), LINE, INDENT);
    }
    return count;
}

// --- the command -----------------------------------------------------------------------

// A man page: of all commands, or of the one that it is about.
typedef struct man_page {
    const command_list *all;
    const command *about; // NULL: impactlab itself
} man_page;

RESULT_WRITER(write_page, man_page, write_man_page(stream, found->all, found->about))

// All man pages, FOLDER/impactlab.1 and FOLDER/impactlab-COMMAND.1. The folder is made if
// it is not there.
static int write_pages(const command_list *all, const char *folder)
{
    int result = EXIT_DONE;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        complain("the folder '%s' cannot be made: %s", folder, strerror(errno));
        return EXIT_FAILED;
    }
    for (int i = -1; i < all->count; i++) {
        man_page page = {.all = all};
        char path[4096];
        int length;
        if (i < 0) {
            length = snprintf(path, sizeof path, "%s/impactlab.1", folder);
        } else {
            page.about = all->items[i];
            length = snprintf(path, sizeof path, "%s/impactlab-%s.1", folder,
                              page.about->name);
        }
        if (length >= (int)sizeof path) {
            return complain("--man-pages %s: the name is too long", folder);
        }
        result = worse(result, write_file(path, write_page, NULL, &page));
    }
    return result;
}

// Answers a question, given as one word or several.
static int answer(const arguments *a)
{
    char question[512] = "";
    size_t length = 0;
    for (int i = 0; i < a->operand_count && length < sizeof question; i++) {
        length += (size_t)snprintf(question + length, sizeof question - length, "%s ",
                                   a->operands[i]);
    }
    if (print_answers(stdout, a->commands, question) > 0) {
        return EXIT_DONE;
    }
    fault f = {0};
    if (loss_noted()) {
        if (fault_no_memory(&f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    if (a->operand_count == 1 && strchr(a->operands[0], ' ') == NULL) {
        return complain_command(a->commands, a->operands[0]);
    }
    return complain("nothing is known of these words, expected some that the manual, a "
                    "parameter, a quantity or a command has");
}

static int help(const arguments *a)
{
    const command *about = NULL;
    if (a->operand_count == 1) {
        about = command_find(a->commands, a->operands[0]);
    }

    if (a->operand_count > 0 && about == NULL) {
        if (a->man) {
            return complain_command(a->commands, a->operands[0]);
        }
        return answer(a);
    }

    if (a->completion != NULL) {
        write_completion(stdout, a->commands, a->completion);
        return EXIT_DONE;
    }
    if (a->man_pages != NULL) {
        return write_pages(a->commands, a->man_pages);
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
    CALLED("help", PROGRAM, "The commands, how to call one, or an answer to a question"),
    OPERANDS("[COMMAND|QUESTION...]", 0, 32),
    .help = "A QUESTION is some words, as in: impactlab help settling time. It "
            "is looked up in the pages of the\nmanual, the parameters, the "
            "quantities and signals of a run, and the commands; the best hits "
            "are\nprinted with the passage that fits and where to read on.\n",
    .operand_word = command_word,
    .options = {OWN_OPTIONS(rows)},
    .run = help,
};
