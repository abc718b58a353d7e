// Questions to a program and its answers: found again in any number, on every way that was gone,
// and not without a transcript.
#include "src/rig/external/transcript.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/check.h"

static controller_output volts(double command)
{
    return (controller_output){.command = command};
}

static void long_ways_are_found_again(void **state)
{
    (void)state;
    enum { SAMPLES = 3000 };
    process_transcript *t = process_transcript_create();
    int place = TRANSCRIPT_BEGIN, places[SAMPLES];
    assert_non_null(t);
    for (int i = 0; i < SAMPLES; i++) {
        char question[32];
        snprintf(question, sizeof question, "sample %d", i);
        assert_int_equal(process_transcript_find(t, place, question), TRANSCRIPT_NONE);
        const controller_output answer = volts(i);
        place = places[i] = process_transcript_add(t, place, question, &answer);
        assert_true(place > TRANSCRIPT_BEGIN);
    }

    // forth and back again
    place = TRANSCRIPT_BEGIN;
    for (int i = 0; i < SAMPLES; i++) {
        char question[32];
        snprintf(question, sizeof question, "sample %d", i);
        assert_int_equal(process_transcript_find(t, place, question), places[i]);
        assert_int_equal(process_transcript_before(t, places[i]), place);
        place = places[i];
        check_close(process_transcript_answer(t, place).command, i, 0);
        assert_string_equal(process_transcript_question(t, place), question);
    }

    // another way from the middle leaves the first one
    const controller_output other = volts(-1);
    const int beside = process_transcript_add(t, places[99], "another", &other);
    assert_int_equal(process_transcript_find(t, places[99], "another"), beside);
    assert_int_equal(process_transcript_find(t, places[99], "sample 100"), places[100]);
    assert_int_equal(process_transcript_find(t, beside, "sample 101"), TRANSCRIPT_NONE);
    process_transcript_destroy(t);
}

// A transcript that is full stays as it is: what comes after it has no place.
static void a_full_tape_stays_as_it_is(void **state)
{
    (void)state;
    process_transcript *t = process_transcript_create();
    const size_t length = (size_t)8 << 20;
    char *question = malloc(length + 1);
    assert_true(t != NULL && question != NULL);
    memset(question, 'x', length);
    question[length] = '\0';
    const controller_output answer = volts(1);
    int place = TRANSCRIPT_BEGIN, count = 0, last = TRANSCRIPT_BEGIN;
    while (place != TRANSCRIPT_NONE && count < 100) {
        question[0] = (char)('a' + count++ % 26);
        last = place;
        place = process_transcript_add(t, place, question, &answer);
    }
    assert_int_equal(place, TRANSCRIPT_NONE);
    assert_true(count > 4 && count < 20);
    assert_int_equal(process_transcript_find(t, TRANSCRIPT_NONE, question), TRANSCRIPT_NONE);
    assert_int_equal(process_transcript_add(t, TRANSCRIPT_NONE, "short", &answer), TRANSCRIPT_NONE);
    assert_int_equal(strlen(process_transcript_question(t, last)), length);
    process_transcript_destroy(t);
    free(question);
}

static void without_a_tape_nothing_is_kept(void **state)
{
    (void)state;
    const controller_output answer = volts(1);
    assert_int_equal(process_transcript_find(NULL, TRANSCRIPT_BEGIN, "a"), TRANSCRIPT_NONE);
    assert_int_equal(process_transcript_add(NULL, TRANSCRIPT_BEGIN, "a", &answer), TRANSCRIPT_NONE);
    process_transcript_note(NULL, 3, 0.1);
    process_transcript_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_ways_are_found_again),
        cmocka_unit_test(a_full_tape_stays_as_it_is),
        cmocka_unit_test(without_a_tape_nothing_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
