// The report: every figure and table of the catalogue, or runs and recipes of one's own, with what
// each was made from and how to make it again, as one web page and one PDF.
#pragma once

#include "src/base/fault.h"

// Writes FOLDER/report.html, which needs no other file and no network, and FOLDER/report.pdf.
// `names` are `count` scenarios and files of recipes; without any the catalogue is shown. The
// folder is created if it is not there. Returns what the runs and the writing return.
status report_write(const char *folder, char *const *names, int count, fault *f);
