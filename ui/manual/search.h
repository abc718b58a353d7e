// Search by words over things with a title and some paragraphs: sections of the manual,
// parameters, quantities, commands.
#pragma once

#include <stdbool.h>

// Something that can be found. Texts last until the next one is asked for.
typedef struct search_entry {
    const char *title;        // words in it count most
    const char *above;        // title of what it is part of, "" if of nothing
    const char *const *texts; // paragraphs
    int text_count;
    const char
        *asked; // questions that it answers, in readers' words; NULL if none are said
    bool aside; // for few readers: words in its title count as those in its texts
} search_entry;

// Things of one kind: how many there are, and what the i-th of them is.
typedef struct search_source {
    int count;
    search_entry (*entry)(const void *context, int index);
    const void *context;
} search_source;

// The thing with that index.
static inline search_entry search_entry_of(const search_source *source, int index)
{
    return source->entry(source->context, index);
}

// A thing that was found.
typedef struct search_hit {
    int source, index; // which it is
    int text; // the paragraph that fits best, the first where only the title does
    double
        share; // of the question that the thing has, from 0 to 1: rare words weigh more
} search_hit;

// Finds what fits a question, the best first: at most `most` hits; returns how many.
// Words are compared without their usual endings, misspelt ones are corrected, synonyms
// (synonyms.h) found, too; words such as "how" and "the" do not count beside others.
// Without memory a loss is noted (text_stream.h).
int search_find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most);

// Finds the things in whose titles all the words stand, in order of the sources; returns
// how many.
int search_titles(const search_source *sources, int source_count, const char *words,
                  search_hit *hits, int most);

// The manual's pages, section by section, as they were when the program was built.

// A heading with what stands below it, up to the next heading.
typedef struct manual_section {
    const char *page;         // its path in the tree, "docs/start.md"
    const char *title;        // of the page
    const char *heading;      // the page's title at its beginning
    const char *asked;        // questions that it answers, "" if the page says none
    const char *const *texts; // paragraphs, items, rows of tables, examples
    int text_count;
} manual_section;

// How many sections there are.
int manual_sections(void);

// The section with that index, in the order of pages and headings.
manual_section manual_section_at(int index);
