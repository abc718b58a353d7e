// The manual's pages, section by section, as they were when the program was built.
#pragma once

// A heading with what stands below it, up to the next heading.
typedef struct manual_section {
    const char *page;         // its path in the tree, "docs/start.md"
    const char *title;        // of the page
    const char *heading;      // the page's title at its beginning
    const char *const *texts; // paragraphs, items, rows of tables, examples
    int text_count;
} manual_section;

// How many sections there are.
int manual_sections(void);

// The section with that index, in the order of pages and headings.
manual_section manual_section_at(int index);
