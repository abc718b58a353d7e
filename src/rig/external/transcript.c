#include "src/rig/external/transcript.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const size_t most_text = (size_t)64 << 20; // of all questions [bytes]

transcript_node *process_transcript_find(const transcript_node *before, const char *question)
{
    assert(question != NULL);
    transcript_node *after = before != NULL ? before->first_after : NULL;
    while (after != NULL && strcmp(after->question, question) != 0) {
        after = after->next_beside;
    }
    return after;
}

// A new node of the tree; NULL without memory, or where the transcript is full.
static transcript_node *new_node(process_transcript *t, const char *question)
{
    const size_t length = strlen(question);
    transcript_node *node =
        t->size + length <= most_text ? calloc(1, sizeof *node + length + 1) : NULL;
    if (node != NULL) {
        memcpy(node->question, question, length);
        node->made_before = t->last;
        t->last = node;
        t->size += length;
    }
    return node;
}

process_transcript *process_transcript_create(void)
{
    process_transcript *t = calloc(1, sizeof *t);
    if (t != NULL && (t->begin = new_node(t, "")) == NULL) {
        free(t);
        return NULL;
    }
    return t;
}

void process_transcript_destroy(process_transcript *t)
{
    while (t != NULL && t->last != NULL) {
        transcript_node *node = t->last;
        t->last = node->made_before;
        free(node);
    }
    free(t);
}

transcript_node *process_transcript_add(process_transcript *t, transcript_node *before,
                                        const char *question, const controller_output *answer)
{
    assert(question != NULL && answer != NULL);
    transcript_node *node = before != NULL ? new_node(t, question) : NULL;
    if (node != NULL) {
        node->before = before;
        node->answer = *answer;

        // the newest is looked at first
        node->next_beside = before->first_after;
        before->first_after = node;
    }
    return node;
}
