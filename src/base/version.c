#include "src/base/version.h"

const char *lab_version(void)
{
    return IMPACTLAB_VERSION;
}
