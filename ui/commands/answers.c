#include "ui/commands/answers.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/shipped.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/commands/command.h"
#include "ui/manual/search.h"

enum { HITS = 6, PASSAGE = 330, LINE = 100, INDENT = 4, MEANINGS = 8, TEXTS = COMMAND_OPTIONS + 2 };

// --- what there is to be found ------------------------------------------------------------------

static search_entry section_entry(int i)
{
    const manual_section s = manual_section_at(i);
    return (search_entry){s.heading, s.title, s.texts, s.text_count};
}

static search_entry parameter_entry(int i)
{
    static const char *texts[2];
    texts[0] = parameter_table[i].description;
    texts[1] = parameter_table[i].choices;
    return (search_entry){parameter_table[i].path, "parameter", texts, texts[1] != NULL ? 2 : 1};
}

static search_entry quantity_entry(int i)
{
    static const char *texts[1];
    texts[0] = summary_table[i].description;
    return (search_entry){summary_table[i].key, "quantity", texts, 1};
}

static search_entry signal_entry(int i)
{
    static const char *texts[1];
    texts[0] = signal_table[i].description;
    return (search_entry){signal_table[i].name, "signal", texts, 1};
}

// A command with its summary, its help and what its own options do.
static search_entry command_entry(int i)
{
    static const char *texts[TEXTS];
    const command *c = command_table[i];
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

static void list_sources(search_source sources[SOURCES])
{
    sources[SECTIONS] = (search_source){manual_sections(), section_entry};
    sources[PARAMETERS] = (search_source){parameter_count, parameter_entry};
    sources[QUANTITIES] = (search_source){summary_count, quantity_entry};
    sources[SIGNALS] = (search_source){signal_count, signal_entry};
    sources[COMMANDS] = (search_source){command_count, command_entry};
}

// --- how it is shown ----------------------------------------------------------------------------

// Name of a thing, without its explanation.
static void print_name(FILE *stream, int source, int index, const search_entry *e)
{
    const char *unit = source == PARAMETERS   ? parameter_table[index].unit
                       : source == QUANTITIES ? summary_table[index].unit
                       : source == SIGNALS    ? signal_table[index].unit
                                              : "";
    if (source == SECTIONS) {
        fprintf(stream, "%s, \"%s\"\n", manual_section_at(index).page, e->title);
    } else {
        fprintf(stream, "%s %s%s%s%s\n", source == COMMANDS ? "impactlab" : e->above, e->title,
                unit[0] != '\0' ? " [" : "", unit, unit[0] != '\0' ? "]" : "");
    }
}

// How to go on from a thing, before and behind its name; nothing for a page.
static const char *const ways_on[SOURCES][2] = {
    [PARAMETERS] = {"impactlab show SCENARIO lists it, --set ", "=VALUE changes it"},
    [QUANTITIES] = {"impactlab run SCENARIO --json - has it, sweep --quantity ", " draws it"},
    [SIGNALS] = {"impactlab run SCENARIO --csv FILE has it, --plot FILE --signals ", " draws it"},
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
    const search_entry e = sources[hit->source].entry(hit->index);
    const char *text = hit->text >= 0 ? e.texts[hit->text] : "";

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

int print_answers(FILE *stream, const char *question)
{
    search_source sources[SOURCES];
    search_hit hits[HITS];
    list_sources(sources);
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

int print_meanings(FILE *stream, const char *words)
{
    search_source sources[SOURCES];
    int count = 0;
    list_sources(sources);
    for (int s = 0; s < SOURCES; s++) {
        for (int i = 0; i < sources[s].count && count < MEANINGS; i++) {
            const search_entry e = sources[s].entry(i);
            if (!search_names(e.title, words)) {
                continue;
            }
            fprintf(stream, "%s", count++ == 0 ? "it may mean\n" : "");
            fprintf(stream, "  ");
            print_name(stream, s, i, &e);
            print_indented(stream, e.texts[0], cut_length(e.texts[0], PASSAGE), LINE, INDENT);
        }
    }
    return count;
}
