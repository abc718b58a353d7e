// The word most similar to a misspelt one, and texts that a terminal may show.
#include "src/base/text_stream.h"
#include "tests/check.h"

#include "src/base/words.h"

TEST(distances_count_single_edits)
{
    assert_int_equal(edit_distance("force", "force", 9), 0);
    assert_int_equal(edit_distance("force", "forces", 9), 1);
    assert_int_equal(edit_distance("force", "fore", 9), 1);
    assert_int_equal(edit_distance("force", "forge", 9), 1);
    assert_int_equal(edit_distance("force", "froce", 9), 1); // a swap of neighbours
    assert_int_equal(edit_distance("", "abc", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 2), 2);
}

TEST(distances_are_symmetric_and_obey_the_triangle)
{
    static const char *const words[] = {"arm.k2", "arm.k1", "wall.angle", "motor.voltage",
                                        ""};
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

static const char *nearest_of(const char *word, const char *const *candidates)
{
    nearest_word nearest = nearest_begin(word);
    for (; *candidates != NULL; candidates++) {
        nearest_try(&nearest, *candidates);
    }
    return nearest.best;
}

TEST(the_nearest_word_is_found_or_none)
{
    static const char *const candidates[] = {"thesis/fig-3-4", "arm.length", "arm.links",
                                             "motor.voltage", NULL};
    assert_string_equal(nearest_of("arm.lenght", candidates), "arm.length");
    assert_string_equal(nearest_of("voltage", candidates), "motor.voltage");
    assert_string_equal(nearest_of("fig-3-4", candidates), "thesis/fig-3-4");
    assert_null(nearest_of("quite another thing", candidates));
}

TEST(of_equally_near_words_the_first_is_kept)
{
    static const char *const candidates[] = {"k1", "k2", NULL};
    assert_string_equal(nearest_of("k3", candidates), "k1");
}

static void check_printable(const char *text, const char *expected)
{
    char *copy = formatted("%s", text);
    make_printable(copy, 0);
    assert_string_equal(copy, expected);
}

TEST(control_characters_and_broken_text_become_question_marks)
{
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

TEST(what_turns_the_direction_of_text_becomes_question_marks)
{
    check_printable("a\u202eb", "a???b");
    check_printable("\u2066x\u2069", "???x???");
    check_printable("\u200e\u061c", "?????");
    check_printable("\u200f", "???");
    check_printable("\u2028\u2029", "??????");
    check_printable("\u200b\u2030", "\u200b\u2030"); // their neighbours stay
}

TEST(lines_keep_their_ends)
{
    char text[] = "one\ntwo\r\n\tthree";
    make_printable(text, '\n');
    assert_string_equal(text, "one\ntwo?\n?three");
}

// U+0080 is a control character; the others of the shortest forms are not, and one less
// is broken.
TEST(the_first_characters_of_each_length_are_whole)
{
    check_printable("\u07ff", "\u07ff");
    check_printable("\xe0\xa0\x80", "\xe0\xa0\x80");
    check_printable("\xe0\x9f\xbf", "???");
    check_printable("\xf0\x90\x80\x80", "\xf0\x90\x80\x80");
    check_printable("\xf0\x8f\xbf\xbf", "????");
    check_printable("\xed\x9f\xbf", "\xed\x9f\xbf");
    check_printable("\xee\x80\x80", "\xee\x80\x80");
    check_printable("\xf4\x8f\xbf\xbf", "\xf4\x8f\xbf\xbf"); // the last of all
    check_printable("\xf4\x8f\xbf\xbd", "\xf4\x8f\xbf\xbd");
}

// Every character there is, written in UTF-8: as long as it is, but for those that a
// terminal must not get; cut short anywhere or with a byte that is none of its own it is
// none.
TEST(every_character_is_whole_or_hidden)
{
    for (uint32_t number = 1; number < 0x110400; number++) {
        const int length = number < 0x80      ? 1
                           : number < 0x800   ? 2
                           : number < 0x10000 ? 3
                                              : 4;
        char text[5] = "";
        for (int i = length - 1, left = (int)number; i >= 0; i--, left >>= 6) {
            const int mark = i > 0 ? 0x80 : length == 1 ? 0 : 0xf00 >> length & 0xff;
            text[i] = (char)(mark | (i > 0 ? left & 0x3f : left));
        }
        const bool control = number < 0x20 || (number >= 0x7f && number <= 0x9f);
        const bool turning = number == 0x61c || number == 0x200e || number == 0x200f ||
                             (number >= 0x202a && number <= 0x202e) ||
                             (number >= 0x2066 && number <= 0x2069);
        const bool hidden = control || turning || number == 0x2028 || number == 0x2029;
        const bool none = (number >= 0xd800 && number <= 0xdfff) || number > 0x10ffff;
        assert_int_equal(is_unprintable(number), hidden);
        fail_if(printable_length(text) != (hidden || none ? 0 : length),
                "U+%04X has %d bytes", number, printable_length(text));

        // of some of them: cut short, and with another byte in each place
        for (int i = 1; i < length && number % 509 == 0; i++) {
            const char was = text[i];
            text[i] = '\0';
            assert_int_equal(printable_length(text), 0);
            text[i] = 'a';
            assert_int_equal(printable_length(text), 0);
            text[i] = (char)0xc3;
            assert_int_equal(printable_length(text), 0);
            text[i] = was;
        }
    }

    // a byte that begins none
    for (int byte = 0x80; byte < 0x100; byte++) {
        const char text[5] = {(char)byte, 'a', 'b', 'c', '\0'};
        assert_int_equal(printable_length(text), 0);
    }
}

// The distance as its definition has it: of the ends, one way or another.
static int distance_of(const char *a, int la, const char *b, int lb)
{
    if (la == 0 || lb == 0) {
        return la + lb;
    }
    int least = distance_of(a, la - 1, b, lb - 1) + (a[la - 1] != b[lb - 1]);
    const int without_a = distance_of(a, la - 1, b, lb) + 1;
    const int without_b = distance_of(a, la, b, lb - 1) + 1;
    least = without_a < least ? without_a : least;
    least = without_b < least ? without_b : least;
    if (la > 1 && lb > 1 && a[la - 1] == b[lb - 2] && a[la - 2] == b[lb - 1]) {
        const int swapped = distance_of(a, la - 2, b, lb - 2) + 1;
        least = swapped < least ? swapped : least;
    }
    return least;
}

// The distance of all pairs of words of up to four letters out of a, b and c is that of
// the plain recursive definition (distance_of), cut at the bound that is asked for. Words
// of 64 letters are compared, longer words are as far apart as the bound.
TEST(all_short_words_have_their_distance)
{
    enum { WORDS = 121 }; // 1 + 3 + 9 + 27 + 81
    char words[WORDS][5] = {""};
    int count = 1;
    for (int length = 1, from = 0; length <= 4; length++) {
        const int until = count;
        for (int i = from; i < until; i++) {
            for (char c = 'a'; c <= 'c' && (int)strlen(words[i]) == length - 1; c++) {
                char *longer = words[count++];
                memcpy(longer, words[i], sizeof words[i]);
                longer[length - 1] = c;
            }
        }
        from = until;
    }
    assert_int_equal(count, WORDS);
    for (int i = 0; i < WORDS; i++) {
        for (int j = 0; j < WORDS; j++) {
            const int distance = distance_of(words[i], (int)strlen(words[i]), words[j],
                                             (int)strlen(words[j]));
            assert_int_equal(edit_distance(words[i], words[j], 9), distance);
            assert_int_equal(edit_distance(words[i], words[j], 2),
                             distance < 2 ? distance : 2);
        }
    }

    // as long as the table has room for, and how far a word may be off
    char longest[66] = "", text[66];
    memset(longest, 'a', 64);
    snprintf(text, sizeof text, "%.63s", longest);
    assert_int_equal(edit_distance(longest, longest, 7), 0);
    assert_int_equal(edit_distance(longest, text, 7), 1);
    assert_int_equal(edit_distance(text, longest, 7), 1);
    longest[64] = 'a';
    assert_int_equal(edit_distance(text, longest, 7), 7);
    assert_int_equal(edit_distance(longest, text, 7), 7);
    assert_int_equal(edit_distance(longest, longest, 7), 7);
    static const int off[] = {1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 5, 5};
    for (int i = 0; i < 12; i++) {
        snprintf(text, sizeof text, "%.*s", i, longest);
        assert_int_equal(nearest_begin(text).distance, off[i]);
        assert_null(nearest_begin(text).best);
    }
}

// What is printed is filtered, and a stream that takes nothing keeps its error.
TEST(what_cannot_be_printed_is_said)
{
    char text[64] = "";
    FILE *into = fmemopen(text, sizeof text, "w"), *full = fopen("/dev/full", "w");
    assert_non_null(into);
    assert_non_null(full);
    print_printable(into, "%d\x1b lines\n", 2);
    print_printable(into, "%s", "");
    fclose(into);
    assert_string_equal(text, "2? lines\n");
    setvbuf(full, NULL, _IONBF, 0);
    print_printable(full, "%d lines\n", 2);
    assert_true(ferror(full));
    assert_false(loss_noted());
    fclose(full);
}
