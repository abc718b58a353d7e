// In the place of stdin, which no JSON of the library is read from (meson.build).
#include <stdio.h>

extern FILE *impactlab_no_file;
FILE *impactlab_no_file;
