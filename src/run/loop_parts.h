// What a loop holds, for the files of src/run/loop.h.
#pragma once

#include "src/run/driver.h"

struct run_loop {
    scenario scenario; // a copy of one's own
    run_options options;
    given_law law;
    process_transcript *transcript; // NULL unless control.law is a process
    run_result result;
    recording recording;
    run_driver driver;
    bool opened;  // the run is to be closed
    double volts; // commanded [V]
    bool ended;
    status failed; // what stopped it
    fault fault;
    uint64_t fingerprint; // of what a saved state must agree with
};
