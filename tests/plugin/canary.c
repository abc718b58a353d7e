// A plug-in that records that it was loaded: it writes the file named by CANARY.
#include <stdio.h>
#include <stdlib.h>

__attribute__((constructor)) static void sing(void)
{
    const char *path = getenv("CANARY");
    FILE *file = path != NULL ? fopen(path, "w") : NULL;
    if (file != NULL) {
        fclose(file);
    }
}
