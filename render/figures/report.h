// The report: every figure and table of the catalogue, or the given runs and recipes, each with its
// origin and the command that makes it, as one web page and one PDF.
#pragma once

#include "src/base/fault.h"
#include "src/run/run_result.h"

// Writes FOLDER/report.html, which needs no other file and no network, and FOLDER/report.pdf.
// `names` are `count` scenarios and recipe files; without any the catalogue is shown. The folder is
// created if it does not exist. Returns the status of runs and writing; STATUS_STOPPED if `monitor`
// (may be NULL) requested it, with both files unchanged. Counts in the monitor each item when it is
// computed and again when it is drawn on the page.
status report_write(const char *folder, char *const *names, int count, run_monitor *monitor,
                    fault *f);
