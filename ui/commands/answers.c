#include "ui/commands/answers.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/tables/control_laws.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/explorer/state/command_list.h"
#include "ui/manual/search.h"

enum { MOST_ANSWERS = 6, MOST_MEANINGS = 8 };

// Hits that have less of a question than this do not answer it.
static const double LEAST_SHARE = 0.5;
enum { LINE_WIDTH = 100, INDENT = 4, PASSAGE_BYTES = 330 };

// --- what there is to be found ---------------------------------------------------------

static search_entry section_entry(const void *context, int i)
{
    (void)context;
    const manual_section s = manual_section_at(i);
    const bool aside = strncmp(s.page, "docs/contributors/", 18) == 0;
    return (search_entry){s.heading, s.title, s.texts, s.text_count, s.asked, aside};
}

// A parameter with its description, and its words if it is a choice.
static search_entry parameter_entry(const void *context, int i)
{
    (void)context;
    static const char *texts[3];
    static char unit[64];
    const parameter_info *p = &parameter_table[i];
    int count = 0;
    texts[count++] = p->description;
    if (p->unit[0] != '\0') {
        snprintf(unit, sizeof unit, "unit %s", p->unit);
        texts[count++] = unit;
    }
    if (p->choices != NULL) {
        texts[count++] = p->choices;
    }
    return (search_entry){p->path, "parameter", texts, count};
}

static search_entry quantity_entry(const void *context, int i)
{
    (void)context;
    static const char *texts[1];
    texts[0] = summary_table[i].description;
    return (search_entry){summary_table[i].key, "quantity", texts, 1};
}

static search_entry signal_entry(const void *context, int i)
{
    (void)context;
    static const char *texts[1];
    texts[0] = signal_table[i].description;
    return (search_entry){signal_table[i].name, "signal", texts, 1};
}

static search_entry law_entry(const void *context, int i)
{
    (void)context;
    static const char *texts[3];
    const control_law_info *law = &control_law_table[i];
    int count = 0;
    texts[count++] = law->description;
    if (law->needs != NULL) {
        texts[count++] = law->needs;
        texts[count++] = law->fails;
    }
    return (search_entry){law->word, "law", texts, count};
}

// A command with its summary, its help and what its own options do. The context is the
// list of all.
static search_entry command_entry(const void *context, int i)
{
    enum { TEXTS = COMMAND_OPTIONS + 2 };
    static const char *texts[TEXTS];
    const command *c = ((const command_list *)context)->items[i];
    int count = 0;
    texts[count++] = c->summary;
    texts[count++] = c->help;

    // options that only some commands have say what they are for
    for (int t = 0; c->options[t] != NULL; t++) {
        const option_table *table = c->options[t];
        if (table == &page_options || table == &signal_options ||
            table == &view_options) {
            continue; // every picture has these
        }
        for (int k = 0; k < table->count && count < TEXTS; k++) {
            texts[count++] = table->rows[k].help;
        }
    }
    return (search_entry){c->name, "command", texts, count};
}

// A command of the terminal lab with its keys.
static search_entry lab_entry(const void *context, int i)
{
    (void)context;
    static char texts_of[2][256];
    static const char *const texts[] = {texts_of[0], texts_of[1]};
    const explorer_command *c = &explorer_command_table[i];
    snprintf(texts_of[0], sizeof texts_of[0], "%s", c->help);
    snprintf(texts_of[1], sizeof texts_of[1], "key %s", c->keys);
    return (search_entry){c->name, "lab", texts, c->keys[0] != '\0' ? 2 : 1};
}

enum { SECTIONS, PARAMETERS, QUANTITIES, SIGNALS, LAWS, COMMANDS, LAB, SOURCES };

static void list_sources(const command_list *all, search_source sources[SOURCES])
{
    sources[SECTIONS] = (search_source){manual_sections(), section_entry};
    sources[PARAMETERS] = (search_source){parameter_count, parameter_entry};
    sources[QUANTITIES] = (search_source){summary_count, quantity_entry};
    sources[SIGNALS] = (search_source){signal_count, signal_entry};
    sources[LAWS] = (search_source){LAW_COUNT, law_entry};
    sources[LAB] = (search_source){explorer_command_count, lab_entry};
    sources[COMMANDS] = (search_source){all->count, command_entry, all};
}

// --- how it is shown -------------------------------------------------------------------

// The unit of what was found, "" if it has none.
static const char *unit_of_hit(const search_hit *hit)
{
    switch (hit->source) {
    case PARAMETERS:
        return parameter_table[hit->index].unit;
    case QUANTITIES:
        return summary_table[hit->index].unit;
    case SIGNALS:
        return signal_table[hit->index].unit;
    default:
        return "";
    }
}

// A line with the name of what was found.
static void print_name(FILE *stream, const search_hit *hit, const search_entry *e)
{
    const char *unit = unit_of_hit(hit);
    if (hit->source == SECTIONS) {
        fprintf(stream, "%s, \"%s\"\n", manual_section_at(hit->index).page, e->title);
    } else if (hit->source == LAB) {
        fprintf(stream, "lab :%s\n", e->title);
    } else if (hit->source == COMMANDS) {
        fprintf(stream, "impactlab %s\n", e->title);
    } else if (unit[0] != '\0') {
        fprintf(stream, "%s %s [%s]\n", e->above, e->title, unit);
    } else {
        fprintf(stream, "%s %s\n", e->above, e->title);
    }
}

// Where to read on, before and behind the name of what was found; nothing for a page.
static const struct {
    const char *before, *behind;
} ways_on[SOURCES] = {
    [PARAMETERS] = {"impactlab show SCENARIO lists it, --set ", "=VALUE changes it"},
    [QUANTITIES] = {"impactlab run SCENARIO --json - has it, sweep --quantity ",
                    " draws it"},
    [SIGNALS] = {"impactlab run SCENARIO --csv FILE has it, --plot FILE --signals ",
                 " draws it"},
    [LAWS] = {"--set control.law=", " takes it, docs/reference/laws.md compares all"},
    [COMMANDS] = {"impactlab ", " --help"},
    [LAB] = {"in the terminal lab; :", " by its name"},
};

// The first whole words of a text, as far as they fit a passage. Returns whether that is
// all of it.
static bool print_passage(FILE *stream, const char *text)
{
    int length = (int)strlen(text);
    if (length > PASSAGE_BYTES) {
        length = PASSAGE_BYTES;
        while (length > 0 && text[length] != ' ') {
            length--;
        }
    }
    print_indented(stream, text, length, LINE_WIDTH, INDENT);
    return text[length] == '\0';
}

// A hit: its name, the passage that fits, and how to go on from there.
static void print_answer(FILE *stream, const search_source *sources,
                         const search_hit *hit)
{
    const search_entry e = search_entry_of(&sources[hit->source], hit->index);
    const char *passage = "";
    if (hit->text < e.text_count) {
        passage = e.texts[hit->text];
    }

    // its name, the passage, and where to read on
    fprintf(stream, "\n");
    print_name(stream, hit, &e);
    if (!print_passage(stream, passage)) {
        fprintf(stream, "    ...\n");
    }
    if (ways_on[hit->source].before != NULL) {
        fprintf(stream, "    %s%s%s\n", ways_on[hit->source].before, e.title,
                ways_on[hit->source].behind);
    }
}

int print_answers(FILE *stream, const command_list *all, const char *question)
{
    search_source sources[SOURCES];
    search_hit hits[MOST_ANSWERS];
    list_sources(all, sources);
    const int count = search_find(sources, SOURCES, question, hits, MOST_ANSWERS);
    if (count > 0 && hits[0].share < LEAST_SHARE) {
        fprintf(stream, "no passage says it; these have some of its words\n");
    }
    for (int i = 0; i < count; i++) {
        print_answer(stream, sources, &hits[i]);
    }
    if (count == 0) {
        return 0;
    }

    // where the pages are
    char *folder = shipped_path(SHIPPED_MANUAL);
    loss_unless(folder != NULL);
    if (folder != NULL) {
        fprintf(stream, "\nThe pages are in %s\n", folder);
    }
    free(folder);
    return count;
}

int print_meanings(FILE *stream, const command_list *all, const char *words)
{
    search_source sources[SOURCES];
    search_hit hits[MOST_MEANINGS];
    list_sources(all, sources);
    const int count = search_titles(sources, SOURCES, words, hits, MOST_MEANINGS);

    // each with its explanation
    if (count > 0) {
        fprintf(stream, "it may mean\n");
    }
    for (int i = 0; i < count; i++) {
        const search_entry e = search_entry_of(&sources[hits[i].source], hits[i].index);
        fprintf(stream, "  ");
        print_name(stream, &hits[i], &e);
        print_passage(stream, e.texts[0]);
    }
    return count;
}
