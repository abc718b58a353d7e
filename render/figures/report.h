// The report: every figure and table of the catalogue, with what it was made from and how to make
// it again, as one web page and one PDF.
#pragma once

#include "src/base/fault.h"

// Writes FOLDER/report.html, which needs no other file and no network, and FOLDER/report.pdf. The
// folder is created if it is not there. Returns what the runs and the writing return.
status report_write(const char *folder, fault *f);
