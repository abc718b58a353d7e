// The report: every figure and table of the catalogue, or the given runs and recipes, each with its
// origin and the command that makes it, as one web page and one PDF.
#pragma once

#include <glib.h>

#include "render/figures/artwork.h"
#include "src/run/run_result.h"

// Writes FOLDER/report.html, which needs no other file and no network, and FOLDER/report.pdf.
// `names` are `count` scenarios and recipe files; without any the catalogue is shown. The folder is
// created if it does not exist. Returns the status of runs and writing; STATUS_STOPPED if `monitor`
// (may be NULL) requested it, with both files unchanged. Counts in the monitor each item when it is
// computed and again when it is drawn on the page.
status report_write(const char *folder, char *const *names, int count, run_monitor *monitor,
                    fault *f);

// --- its items, and its web page: report_html.c

// One thing the report shows.
typedef struct report_item {
    const char *scenario, *model; // scenario may be NULL
    char *command;                // NULL: no command
    artwork drawn;
    int page; // of the PDF, counted from 1
} report_item;

typedef struct report_content {
    GArray *items;       // of report_item
    const char *preface; // description of the report, a sentence or two
    char *heading;
    run_monitor *monitor; // NULL: nobody looks on
} report_content;

static inline report_item *report_item_at(const report_content *r, guint index)
{
    return &g_array_index(r->items, report_item, index);
}

// Counts a finished item; STATUS_STOPPED if the report is to end here.
status report_item_done(const report_content *r, fault *f);

// Appends what an item is made of, and the command for it in an element of its own.
void report_add_facts(GString *out, const report_item *item, const char *gap, const char *tag);

// Writes FOLDER/report.html. Returns the status of painting and writing.
status report_write_html(const report_content *r, const char *path, fault *f);
