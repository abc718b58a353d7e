// The passages of the manual, from the table that passages.sh makes of its pages.
#include "ui/manual/search.h"

#include <assert.h>
#include <stddef.h>

// A row of the generated table; its texts are `count` from `first` on.
struct section {
    const char *page, *title, *heading, *asked;
    int first, count;
};

#include "ui/manual/passages.inc"

int manual_sections(void)
{
    return (int)(sizeof sections / sizeof sections[0]);
}

manual_section manual_section_at(int index)
{
    assert(index >= 0 && index < manual_sections());
    const struct section *s = &sections[index];
    return (manual_section){.page = s->page,
                            .title = s->title,
                            .heading = s->heading,
                            .asked = s->asked,
                            .texts = texts + s->first,
                            .text_count = s->count};
}
