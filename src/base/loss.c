#include "src/base/loss.h"

static _Thread_local bool lost;

void loss_unless(bool kept)
{
    lost = lost || !kept;
}

bool loss_noted(void)
{
    const bool since = lost;
    lost = false;
    return since;
}

void loss_forget(void)
{
    lost = false;
}
