// The half that draws, in programs that are linked with it.
#include "render/drawing.h"

status drawing_open(fault *f)
{
    (void)f;
    return STATUS_OK;
}

const drawing_functions *drawing(void)
{
    return &drawing_table;
}
