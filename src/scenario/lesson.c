#include "src/scenario/scenario.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { STEP_TEXTS = 3 + LESSON_CHOICES + LESSON_COMMANDS };

// Where a step keeps its texts, those that it has not included.
static void text_places(lesson_step *step, char **places[STEP_TEXTS])
{
    int count = 0;
    places[count++] = &step->say;
    places[count++] = &step->then;
    places[count++] = &step->hint;
    for (int k = 0; k < LESSON_CHOICES; k++) {
        places[count++] = &step->choices[k];
    }
    for (int k = 0; k < LESSON_COMMANDS; k++) {
        places[count++] = &step->commands[k];
    }
    assert(count == STEP_TEXTS);
}

void lesson_finish(lesson *l)
{
    char **places[STEP_TEXTS];
    for (int i = 0; i < l->step_count; i++) {
        text_places(&l->steps[i], places);
        for (int k = 0; k < STEP_TEXTS; k++) {
            free(*places[k]);
        }
    }

    // nothing else of a lesson is allocated
    free(l->steps);
    *l = (lesson){0};
}

bool lesson_copy(lesson *copy, const lesson *l)
{
    const size_t count = (size_t)l->step_count;
    lesson_step *steps = count > 0 ? calloc(count, sizeof *steps) : NULL;
    *copy = *l;
    copy->steps = steps;
    if (steps == NULL) {
        copy->step_count = 0;
        return count == 0;
    }

    // all of them, even after a failure: none may still be the original's
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        char **places[STEP_TEXTS];
        steps[i] = l->steps[i];
        text_places(&steps[i], places);
        for (int k = 0; k < STEP_TEXTS; k++) {
            const char *text = *places[k];
            *places[k] = text != NULL ? strdup(text) : NULL;
            good = good && (text == NULL || *places[k] != NULL);
        }
    }
    if (!good) {
        lesson_finish(copy);
    }
    return good;
}
