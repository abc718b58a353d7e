#include "src/run/saved_block.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "src/base/random.h"
#include "src/base/shipped.h"

static_assert(sizeof(block_head) == 5 * sizeof(uint64_t), "the head has no padding");

// --- the origin ------------------------------------------------------------------------

// 64-bit FNV-1a, with a byte that ends the text.
uint64_t block_origin_with(uint64_t origin, const char *text)
{
    for (; *text != '\0'; text++) {
        origin = (origin ^ (unsigned char)*text) * 0x100000001b3u;
    }
    return (origin ^ 0xff) * 0x100000001b3u;
}

uint64_t block_origin(const scenario *s)
{
    // version and parameters
    char text[PARAMETER_VALUE_SIZE];
    uint64_t origin = block_origin_with(0xcbf29ce484222325u, lab_version());
    for (int i = 0; i < parameter_count; i++) {
        parameter_format(&s->parameters, i, text, sizeof text);
        origin = block_origin_with(origin, text);
    }

    // the script
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        snprintf(text, sizeof text, "%a %d %d %a", a->time, (int)a->kind, a->parameter,
                 a->value);
        origin = block_origin_with(block_origin_with(origin, text), a->text);
    }
    return origin;
}

// --- the checksum ----------------------------------------------------------------------

// Eight bytes at a time go into the state of splitmix64, whose mixing makes other bytes
// have the same sum by chance only, once in 2^64.
static uint64_t check_of(const char *bytes, size_t size)
{
    uint64_t check = size;
    for (size_t at = sizeof(block_head); at < size; at += sizeof check) {
        uint64_t word = 0;
        memcpy(&word, bytes + at, size - at < sizeof word ? size - at : sizeof word);
        word ^= check;
        check = splitmix64_next(&word);
    }
    return check;
}

void block_seal(void *bytes, size_t size, const block_kind *kind, uint64_t origin)
{
    assert(size >= sizeof(block_head));
    block_head head = {.layout = kind->layout,
                       .size = size,
                       .origin = origin,
                       .check = check_of(bytes, size)};
    memcpy(head.magic, kind->magic, sizeof head.magic);
    memcpy(bytes, &head, sizeof head);
}

status block_check(const void *bytes, size_t size, const block_kind *kind,
                   uint64_t origin, fault *f)
{
    // what it says that it is
    block_head head;
    FAULT_IF(size < sizeof head || memcmp(bytes, kind->magic, sizeof head.magic) != 0, f,
             STATUS_BAD_ARGUMENT, "the bytes are no saved %s", kind->name);
    memcpy(&head, bytes, sizeof head);
    FAULT_IF(head.layout != kind->layout, f, STATUS_BAD_ARGUMENT,
             "the saved %s has layout %llu, expected %llu", kind->name,
             (unsigned long long)head.layout, (unsigned long long)kind->layout);

    // whether it is whole, then whether it belongs here
    FAULT_IF(head.size != size, f, STATUS_BAD_ARGUMENT,
             "the saved %s has %llu bytes, but %zu were given", kind->name,
             (unsigned long long)head.size, size);
    FAULT_IF(head.check != check_of(bytes, size), f, STATUS_BAD_ARGUMENT,
             "the saved %s is damaged, expected the bytes as they were saved",
             kind->name);
    FAULT_IF(head.origin != origin, f, STATUS_BAD_ARGUMENT,
             "the saved %s is of another scenario, another controller or another version",
             kind->name);
    return STATUS_OK;
}
