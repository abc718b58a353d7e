// Where the parts that belong to the program lie: in the tree it was built in, or where
// it was installed, also after the installation has moved.
#pragma once

typedef enum shipped_part {
    SHIPPED_SCENARIOS, // the folder of the scenarios that ship
    SHIPPED_MANUAL,    // the folder with README.md and docs
    SHIPPED_PROGRAM,   // impactlab
    SHIPPED_PAGE,      // the lab's page for a browser in one file, if it was built
    SHIPPED_DRAWING,   // the module that draws
} shipped_part;

// The part's path, to be freed, whether it is there or not; NULL without memory. The
// prefix is looked for above the file that this code was loaded from (a build folder is
// laid out as one), and where no prefix has the part it is the place that the build was
// set up for.
char *shipped_path(shipped_part part);

// The version of the program, "0.2.0".
const char *lab_version(void);
