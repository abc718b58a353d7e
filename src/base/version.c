#include "src/base/version.h"

#include "src/base/build_config.h"

const char *lab_version(void)
{
    return IMPACTLAB_VERSION;
}
