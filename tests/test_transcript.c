// Questions to a program and its answers: found again in any number, on every way that
// was gone, and not without a transcript.
#include "src/rig/external/process_lines.h"

#include "tests/check.h"

static controller_output volts(double command)
{
    return (controller_output){.command = command};
}

TEST(long_ways_are_found_again)
{
    enum { SAMPLES = 3000 };
    process_transcript *t = process_transcript_create();
    assert_non_null(t);
    transcript_node *place = t->begin, *places[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        const char *question = formatted("sample %d", i);
        assert_null(process_transcript_find(place, question));
        const controller_output answer = volts(i);
        place = places[i] = process_transcript_add(t, place, question, &answer);
        assert_non_null(place);
    }

    // forth and back again
    place = t->begin;
    for (int i = 0; i < SAMPLES; i++) {
        const char *question = formatted("sample %d", i);
        assert_ptr_equal(process_transcript_find(place, question), places[i]);
        assert_ptr_equal(places[i]->before, place);
        place = places[i];
        check_close(place->answer.command, i, 0);
        assert_string_equal(place->question, question);
    }

    // another way from the middle leaves the first one
    const controller_output other = volts(-1);
    transcript_node *beside = process_transcript_add(t, places[99], "another", &other);
    assert_ptr_equal(process_transcript_find(places[99], "another"), beside);
    assert_ptr_equal(process_transcript_find(places[99], "sample 100"), places[100]);
    assert_null(process_transcript_find(beside, "sample 101"));
    process_transcript_destroy(t);
}

// A transcript that is full stays as it is: what comes after it has no place.
TEST(a_full_transcript_stays_as_it_is)
{
    process_transcript *t = process_transcript_create();
    const size_t length = (size_t)8 << 20;
    KEPT_TEXT(question) = malloc(length + 1);
    assert_true(t != NULL && question != NULL);
    memset(question, 'x', length);
    question[length] = '\0';
    const controller_output answer = volts(1);
    transcript_node *place = t->begin, *last = t->begin;
    int count = 0;
    while (place != NULL && count < 100) {
        question[0] = (char)('a' + count++ % 26);
        last = place;
        place = process_transcript_add(t, place, question, &answer);
    }
    assert_null(place);
    assert_true(count > 4 && count < 20);
    assert_null(process_transcript_find(NULL, question));
    assert_null(process_transcript_add(t, NULL, "short", &answer));
    assert_int_equal(strlen(last->question), length);
    process_transcript_destroy(t);
    process_transcript_destroy(NULL);
}
