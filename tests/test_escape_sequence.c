// Sequences that terminals send, whole and in pieces.
#include "tests/check.h"

#include "ui/terminal/escape_sequence.h"

typedef struct meant {
    sequence_result result;
    pointer_event mouse;
    int taken; // characters after the escape
} meant;

// Feeds what follows an escape until the sequence is over or the text is.
static meant feed(escape_sequence *e, const char *text)
{
    meant m = {.result = SEQUENCE_CONTINUES};
    for (; *text && m.result == SEQUENCE_CONTINUES; text++, m.taken++) {
        m.result = escape_sequence_take(e, (unsigned char)*text, &m.mouse);
    }
    return m;
}

static meant feed_fresh(const char *text)
{
    escape_sequence e = {.state = SEQUENCE_ESCAPED};
    return feed(&e, text);
}

TEST(test_mouse_reports_are_understood)
{
    meant m = feed_fresh("[<0;45;30M");
    assert_int_equal(m.result, SEQUENCE_MOUSE);
    assert_int_equal(m.mouse.kind, POINTER_PRESS);
    assert_int_equal(m.mouse.x, 44);
    assert_int_equal(m.mouse.y, 29);
    assert_int_equal(feed_fresh("[<32;1;1M").mouse.kind, POINTER_DRAG);
    assert_int_equal(feed_fresh("[<0;45;30m").mouse.kind, POINTER_RELEASE);
    m = feed_fresh("[<16;1;1M");
    assert_int_equal(m.mouse.kind, POINTER_PRESS);
    assert_true(m.mouse.control && !m.mouse.shift);
    m = feed_fresh("[<68;10;10M");
    assert_int_equal(m.result, SEQUENCE_MOUSE);
    assert_int_equal(m.mouse.kind, POINTER_WHEEL_UP);
    assert_true(m.mouse.shift && !m.mouse.control);
    assert_int_equal(feed_fresh("[<65;10;10M").mouse.kind, POINTER_WHEEL_DOWN);
    m = feed_fresh("[M !\"");
    assert_int_equal(m.result, SEQUENCE_MOUSE);
    assert_int_equal(m.mouse.kind, POINTER_PRESS);
    assert_int_equal(m.mouse.x, 0);
    assert_int_equal(m.mouse.y, 1);
    assert_int_equal(feed_fresh("[M#!\"").mouse.kind, POINTER_RELEASE);
}

TEST(test_what_means_nothing_is_passed_over)
{
    for (EACH_TEXT(c, "[<64;45;30m", "[<2;45;30M", "[<35;45;30M", "[<0;45M", "[<;;M",
                   "[1;5C", "OQ", "[202~", "[?1;2c", "[<0;1;2;3M")) {
        meant m = feed_fresh(*c);
        assert_int_equal(m.result, SEQUENCE_OVER);
        assert_int_equal(m.taken, strlen(*c));
    }
    // longer than any sequence there is
    char digits[200];
    memset(digits, '1', sizeof digits);
    digits[0] = '[';
    digits[sizeof digits - 2] = 'M';
    digits[sizeof digits - 1] = '\0';
    assert_int_equal(feed_fresh(digits).result, SEQUENCE_OVER);
}

TEST(test_pasted_text_has_marks)
{
    assert_int_equal(feed_fresh("[200~").result, SEQUENCE_PASTE);
    assert_int_equal(feed_fresh("[201~").result, SEQUENCE_PASTED);

    // also while answers of the terminal are awaited
    escape_sequence e = {.state = SEQUENCE_ESCAPED, .awaits_answers = true};
    assert_int_equal(feed(&e, "[200~").result, SEQUENCE_PASTE);
}

TEST(test_a_sequence_may_come_in_pieces)
{
    escape_sequence e = {.state = SEQUENCE_ESCAPED};
    assert_int_equal(feed(&e, "[<0;4").result, SEQUENCE_CONTINUES);
    assert_int_equal(feed(&e, "5;30").result, SEQUENCE_CONTINUES);
    assert_int_equal(feed(&e, "M").result, SEQUENCE_MOUSE);
    assert_int_equal(e.state, SEQUENCE_NONE);
}

TEST(test_other_keys_end_it)
{
    escape_sequence e = {.state = SEQUENCE_ESCAPED};
    assert_int_equal(feed(&e, "x").result, SEQUENCE_OTHER_KEY);
    assert_int_equal(e.state, SEQUENCE_NONE);
    // broken off by another escape
    meant m = feed_fresh("[<0;4\033");
    assert_int_equal(m.result, SEQUENCE_OTHER_KEY);
    assert_int_equal(m.taken, 6);
}
