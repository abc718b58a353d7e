// Internal to the report: its items, and the two formats in which they are written.
#pragma once

#include <glib.h>

#include "render/figures/artwork.h"
#include "src/run/run_result.h"

// One thing the report shows.
typedef struct report_item {
    const char *scenario, *model; // scenario may be NULL
    char *command;                // NULL: no command
    artwork drawn;
    int page; // of the PDF, counted from 1
} report_item;

typedef struct report {
    GArray *items;       // of report_item
    const char *preface; // description of the report, a sentence or two
    char *heading;
    run_monitor *monitor; // NULL: nobody looks on
} report;

report_item *report_item_at(const report *r, guint index);

// Counts a finished item; STATUS_STOPPED if the report is to end here.
status report_item_done(const report *r, fault *f);

// FOLDER/report.html: report_html.c. FOLDER/report.pdf: report_pdf.c. Both return the status of
// painting and writing.
status report_write_html(const report *r, const char *path, fault *f);
status report_write_pdf(const report *r, const char *path, fault *f);
