// A program with the rendering libraries.
#include "ui/rendering.h"

#include "render/page/picture_file.h"
#include "render/page/text.h"

void rendering_begin(char **argv, void (*end)(const char *reason))
{
    (void)argv;
    text_when_giving_up(end);
}

void rendering_needed(void)
{
}

bool rendering_in_libraries(void)
{
    return text_in_fonts() || picture_is_stroking();
}
