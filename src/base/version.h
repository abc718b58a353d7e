// The version of the program.
#pragma once

// "0.2.0".
const char *lab_version(void);
