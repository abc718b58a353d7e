#include "src/rig/process_tape.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_ROOM = 256 };
static const size_t most_text = (size_t)64 << 20; // of all questions [bytes]

// A question after another one; places are indices.
typedef struct tape_place {
    char *question;
    controller_output answer;
    int before, first_after, next_beside; // TAPE_NONE where there is none
} tape_place;

struct process_tape {
    tape_place *places; // places[0] is TAPE_BEGIN
    int count, room;
    size_t text; // of all questions [bytes]
    process_replay replay;
};

process_tape *process_tape_create(void)
{
    process_tape *t = calloc(1, sizeof *t);
    tape_place *places = calloc(FIRST_ROOM, sizeof *places);
    if (t == NULL || places == NULL) {
        free(t);
        free(places);
        return NULL;
    }
    places[TAPE_BEGIN] =
        (tape_place){.before = TAPE_NONE, .first_after = TAPE_NONE, .next_beside = TAPE_NONE};
    *t = (process_tape){.places = places, .count = 1, .room = FIRST_ROOM};
    return t;
}

void process_tape_destroy(process_tape *t)
{
    if (t != NULL) {
        for (int i = 0; i < t->count; i++) {
            free(t->places[i].question);
        }
        free(t->places);
        free(t);
    }
}

int process_tape_find(const process_tape *t, int place, const char *question)
{
    assert(question != NULL);
    if (t == NULL || place == TAPE_NONE) {
        return TAPE_NONE;
    }
    int after = t->places[place].first_after;
    while (after != TAPE_NONE && strcmp(t->places[after].question, question) != 0) {
        after = t->places[after].next_beside;
    }
    return after;
}

// Room for one more place. False without memory.
static bool make_room(process_tape *t)
{
    if (t->count < t->room) {
        return true;
    }
    tape_place *places = realloc(t->places, 2 * (size_t)t->room * sizeof *places);
    if (places != NULL) {
        t->places = places;
        t->room *= 2;
    }
    return places != NULL;
}

int process_tape_add(process_tape *t, int place, const char *question,
                     const controller_output *answer)
{
    assert(question != NULL && answer != NULL);
    if (t == NULL || place == TAPE_NONE) {
        return TAPE_NONE;
    }

    // a tape that is full stays as it is
    const size_t length = strlen(question);
    char *copy = t->text + length <= most_text && make_room(t) ? malloc(length + 1) : NULL;
    if (copy == NULL) {
        return TAPE_NONE;
    }
    memcpy(copy, question, length + 1);
    t->text += length;

    // the newest is looked at first
    tape_place *before = &t->places[place];
    t->places[t->count] = (tape_place){.question = copy,
                                       .answer = *answer,
                                       .before = place,
                                       .first_after = TAPE_NONE,
                                       .next_beside = before->first_after};
    before->first_after = t->count;
    return t->count++;
}

static const tape_place *place_at(const process_tape *t, int place)
{
    assert(t != NULL && place > TAPE_BEGIN && place < t->count);
    return &t->places[place];
}

const char *process_tape_question(const process_tape *t, int place)
{
    return place_at(t, place)->question;
}

controller_output process_tape_answer(const process_tape *t, int place)
{
    return place_at(t, place)->answer;
}

int process_tape_before(const process_tape *t, int place)
{
    return place_at(t, place)->before;
}

void process_tape_note(process_tape *t, int samples, double time)
{
    if (t != NULL) {
        t->replay = (process_replay){.restarted = true, .samples = samples, .time = time};
    }
}

process_replay process_tape_take_replay(process_tape *t)
{
    process_replay taken = {.restarted = false};
    if (t != NULL) {
        taken = t->replay;
        t->replay = (process_replay){.restarted = false};
    }
    return taken;
}
