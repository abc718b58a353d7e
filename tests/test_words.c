// The word nearest to a misspelt one, and texts that a terminal may show.
#include "tests/check.h"

#include <string.h>

#include "src/base/words.h"

static void distances_count_single_edits(void **state)
{
    (void)state;
    assert_int_equal(edit_distance("force", "force", 9), 0);
    assert_int_equal(edit_distance("force", "forces", 9), 1);
    assert_int_equal(edit_distance("force", "fore", 9), 1);
    assert_int_equal(edit_distance("force", "forge", 9), 1);
    assert_int_equal(edit_distance("force", "froce", 9), 1); // a swap of neighbours
    assert_int_equal(edit_distance("", "abc", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 2), 2);
}

static void distances_are_symmetric_and_obey_the_triangle(void **state)
{
    (void)state;
    static const char *const words[] = {"arm.k2", "arm.k1", "wall.angle", "motor.voltage", ""};
    enum { COUNT = sizeof words / sizeof words[0] };
    for (int i = 0; i < COUNT; i++) {
        for (int j = 0; j < COUNT; j++) {
            int direct = edit_distance(words[i], words[j], 99);
            assert_int_equal(direct, edit_distance(words[j], words[i], 99));
            for (int k = 0; k < COUNT; k++) {
                assert_true(direct <= edit_distance(words[i], words[k], 99) +
                                          edit_distance(words[k], words[j], 99));
            }
        }
    }
}

static void words_too_long_for_the_table_are_far(void **state)
{
    (void)state;
    char word[66];
    memset(word, 'a', sizeof word - 1);
    word[sizeof word - 1] = '\0';
    assert_int_equal(edit_distance(word, word, 7), 7);
}

static const char *nearest_of(const char *word, const char *const *candidates)
{
    nearest_word nearest = nearest_begin(word);
    for (; *candidates != NULL; candidates++) {
        nearest_try(&nearest, *candidates);
    }
    return nearest.best;
}

static void the_nearest_word_is_found_or_none(void **state)
{
    (void)state;
    static const char *const candidates[] = {"thesis/fig-3-4", "arm.length", "arm.links",
                                             "motor.voltage", NULL};
    assert_string_equal(nearest_of("arm.lenght", candidates), "arm.length");
    assert_string_equal(nearest_of("voltage", candidates), "motor.voltage");
    assert_string_equal(nearest_of("fig-3-4", candidates), "thesis/fig-3-4");
    assert_null(nearest_of("quite another thing", candidates));
}

static void of_equally_near_words_the_first_is_kept(void **state)
{
    (void)state;
    static const char *const candidates[] = {"k1", "k2", NULL};
    assert_string_equal(nearest_of("k3", candidates), "k1");
}

static void check_printable(const char *text, const char *expected)
{
    char copy[64];
    snprintf(copy, sizeof copy, "%s", text);
    make_printable(copy);
    assert_string_equal(copy, expected);
}

static void control_characters_and_broken_text_become_question_marks(void **state)
{
    (void)state;
    check_printable("plain, with \xc3\xa4 and \xe2\x86\x92",
                    "plain, with \xc3\xa4 and \xe2\x86\x92");
    check_printable("\x1b[2J\n", "?[2J?");
    check_printable("\x7f", "?");
    check_printable("\xc2\x9b", "??"); // a control character beyond ASCII
    check_printable("a\xc3", "a?");    // cut off
    check_printable("\xc0\x80", "??"); // no character begins with these
    check_printable("\xe2\x86"
                    "a",
                    "??a");                      // cut short in the middle
    check_printable("\xed\xa0\x80", "???");      // half of a pair
    check_printable("\xf4\x90\x80\x80", "????"); // beyond the last character
    check_printable("\xe0\x80\x8a", "???");      // a line feed written longer than it is
}

static void what_turns_the_direction_of_text_becomes_question_marks(void **state)
{
    (void)state;
    check_printable("a\u202eb", "a???b");
    check_printable("\u2066x\u2069", "???x???");
    check_printable("\u200e\u061c", "?????");
    check_printable("\u200f", "???");
    check_printable("\u2028\u2029", "??????");
    check_printable("\u200b\u2030", "\u200b\u2030"); // their neighbours stay
}

static void lines_keep_their_ends(void **state)
{
    (void)state;
    char text[] = "one\ntwo\r\n\tthree";
    make_lines_printable(text);
    assert_string_equal(text, "one\ntwo?\n?three");
}

static void distances_of_words(void **state)
{
    (void)state;
    assert_int_equal(edit_distance("", "", 9), 0);
    assert_int_equal(edit_distance("abc", "", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 9), 3);
    assert_int_equal(edit_distance("sitting", "kitten", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 2), 2);
}

// U+0080 is a control character; the others of the shortest forms are not, and one less is broken.
static void the_first_characters_of_each_length_are_whole(void **state)
{
    (void)state;
    check_printable("\u07ff", "\u07ff");
    check_printable("\xe0\xa0\x80", "\xe0\xa0\x80");
    check_printable("\xe0\x9f\xbf", "???");
    check_printable("\xf0\x90\x80\x80", "\xf0\x90\x80\x80");
    check_printable("\xf0\x8f\xbf\xbf", "????");
    check_printable("\xed\x9f\xbf", "\xed\x9f\xbf");
    check_printable("\xed\xa0\x80", "???");
    check_printable("\xee\x80\x80", "\xee\x80\x80");
    check_printable("\xf4\x8f\xbf\xbf", "\xf4\x8f\xbf\xbf"); // the last of all
    check_printable("\xf4\x8f\xbf\xbd", "\xf4\x8f\xbf\xbd");
    check_printable("\xf4\x90\x80\x80", "????");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_characters_of_each_length_are_whole),
        cmocka_unit_test(distances_of_words),
        cmocka_unit_test(distances_count_single_edits),
        cmocka_unit_test(distances_are_symmetric_and_obey_the_triangle),
        cmocka_unit_test(words_too_long_for_the_table_are_far),
        cmocka_unit_test(the_nearest_word_is_found_or_none),
        cmocka_unit_test(of_equally_near_words_the_first_is_kept),
        cmocka_unit_test(control_characters_and_broken_text_become_question_marks),
        cmocka_unit_test(what_turns_the_direction_of_text_becomes_question_marks),
        cmocka_unit_test(lines_keep_their_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
