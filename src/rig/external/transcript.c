#include "src/rig/external/transcript.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROOM = 256 };
static const size_t most_text = (size_t)64 << 20; // of all questions [bytes]

// A question after another one; places are indices.
typedef struct transcript_place {
    char *question;
    controller_output answer;
    int before, first_after, next_beside; // TRANSCRIPT_NONE where there is none
} transcript_place;

struct process_transcript {
    transcript_place *places; // places[0] is TRANSCRIPT_BEGIN
    int count, room;
    size_t text; // of all questions [bytes]
    process_replay replay;
};

process_transcript *process_transcript_create(void)
{
    process_transcript *t = calloc(1, sizeof *t);
    transcript_place *places = calloc(FIRST_ROOM, sizeof *places);
    if (t == NULL || places == NULL) {
        free(t);
        free(places);
        return NULL;
    }
    places[TRANSCRIPT_BEGIN] = (transcript_place){
        .before = TRANSCRIPT_NONE, .first_after = TRANSCRIPT_NONE, .next_beside = TRANSCRIPT_NONE};
    *t = (process_transcript){.places = places, .count = 1, .room = FIRST_ROOM};
    return t;
}

void process_transcript_destroy(process_transcript *t)
{
    if (t != NULL) {
        for (int i = 0; i < t->count; i++) {
            free(t->places[i].question);
        }
        free(t->places);
        free(t);
    }
}

int process_transcript_find(const process_transcript *t, int place, const char *question)
{
    assert(question != NULL);
    if (t == NULL || place == TRANSCRIPT_NONE) {
        return TRANSCRIPT_NONE;
    }
    int after = t->places[place].first_after;
    while (after != TRANSCRIPT_NONE && strcmp(t->places[after].question, question) != 0) {
        after = t->places[after].next_beside;
    }
    return after;
}

// Room for one more place. False without memory.
static bool make_room(process_transcript *t)
{
    if (t->count < t->room) {
        return true;
    }
    transcript_place *places = realloc(t->places, 2 * (size_t)t->room * sizeof *places);
    if (places != NULL) {
        t->places = places;
        t->room *= 2;
    }
    return places != NULL;
}

int process_transcript_add(process_transcript *t, int place, const char *question,
                           const controller_output *answer)
{
    assert(question != NULL && answer != NULL);
    if (t == NULL || place == TRANSCRIPT_NONE) {
        return TRANSCRIPT_NONE;
    }

    // a transcript that is full stays as it is
    const size_t length = strlen(question);
    char *copy = t->text + length <= most_text && make_room(t) ? malloc(length + 1) : NULL;
    if (copy == NULL) {
        return TRANSCRIPT_NONE;
    }
    memcpy(copy, question, length + 1);
    t->text += length;

    // the newest is looked at first
    transcript_place *before = &t->places[place];
    t->places[t->count] = (transcript_place){.question = copy,
                                             .answer = *answer,
                                             .before = place,
                                             .first_after = TRANSCRIPT_NONE,
                                             .next_beside = before->first_after};
    before->first_after = t->count;
    return t->count++;
}

static const transcript_place *place_at(const process_transcript *t, int place)
{
    assert(t != NULL && place > TRANSCRIPT_BEGIN && place < t->count);
    return &t->places[place];
}

const char *process_transcript_question(const process_transcript *t, int place)
{
    return place_at(t, place)->question;
}

controller_output process_transcript_answer(const process_transcript *t, int place)
{
    return place_at(t, place)->answer;
}

int process_transcript_before(const process_transcript *t, int place)
{
    return place_at(t, place)->before;
}

void process_transcript_note(process_transcript *t, int samples, double time)
{
    if (t != NULL) {
        t->replay = (process_replay){.restarted = true, .samples = samples, .time = time};
    }
}

process_replay process_transcript_take_replay(process_transcript *t)
{
    process_replay taken = {.restarted = false};
    if (t != NULL) {
        taken = t->replay;
        t->replay = (process_replay){.restarted = false};
    }
    return taken;
}
