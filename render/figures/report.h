// The report: every figure and table of the catalogue, or runs and recipes of one's own, with what
// each was made from and how to make it again, as one web page and one PDF.
#pragma once

#include "src/base/fault.h"
#include "src/run/run_result.h"

// Writes FOLDER/report.html, which needs no other file and no network, and FOLDER/report.pdf.
// `names` are `count` scenarios and files of recipes; without any the catalogue is shown. The
// folder is created if it is not there. Returns what the runs and the writing return;
// STATUS_STOPPED if `monitor` (NULL: nobody looks on) asked for it, and then both files are as they
// were before. Counts in it the items that are computed and then, as often, those that are drawn on
// the page.
status report_write(const char *folder, char *const *names, int count, run_monitor *monitor,
                    fault *f);

// Items of a report on `count` names, tables of parameters not counted.
int report_length(int count);
