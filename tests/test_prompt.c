// The prompt: its line is edited as shells do, lines come back in later visits, units are
// converted, and nothing is cut off in silence.
#include "tests/explorer_on_screen.h"

#include "src/base/units.h"
#include "ui/terminal/line_editor.h"

// Each key of the editor, at places with characters of one and of several bytes; ^ is the
// cursor before and after.
TEST(keys_edit_as_in_a_shell)
{
    static const struct {
        const char *before, *keys, *after;
    } cases[] = {
        {"set ^k2 5", "<Left>", "set^ k2 5"},
        {"ab\u00e4^", "<Left>", "ab^\u00e4"},
        {"ab^\u00e4c", "<Right>", "ab\u00e4^c"},
        {"^ab", "<Left><Left>", "^ab"},
        {"ab^", "<Right>", "ab^"},
        {"set ^k2", "<Home>", "^set k2"},
        {"set ^k2", "<C-a>", "^set k2"},
        {"set ^k2", "<End>", "set k2^"},
        {"set ^k2", "<C-e>x", "set k2x^"},
        {"se^t", "<Backspace>", "s^t"},
        {"\u00e4^t", "<Backspace>", "^t"},
        {"^set", "<Backspace>", "^set"},
        {"s^\u00e4t", "<Delete>", "s^t"},
        {"set^", "<Delete>", "set^"},
        {"set ^k2 5", "<C-k>", "set ^"},
        {"set ^k2 5", "<C-u>", "^k2 5"},
        {"set arm.k2  ^5", "<C-w>", "set ^5"},
        {"set arm.k2^", "<M-b>", "set arm.^k2"},
        {"set ^arm.k2", "<M-f>", "set arm^.k2"},
        {"set arm.k2^ 5", "<M-Backspace>", "set arm.^ 5"},
        {"set ^arm.k2 5", "<M-d>", "set ^.k2 5"},
        {"a^c", "b", "ab^c"},
    };
    for (EACH(c, cases)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        prompt *p = &ex.input.prompt;
        press(&ex, ":");
        p->cursor = (int)(strchr(c->before, '^') - c->before);
        snprintf(p->text, sizeof p->text, "%.*s%s", p->cursor, c->before,
                 c->before + p->cursor + 1);
        press(&ex, c->keys);
        const char *got = formatted("%.*s^%s", p->cursor, p->text, p->text + p->cursor);
        fail_if(strcmp(got, c->after) != 0, "%s in '%s' gives '%s', expected '%s'",
                c->keys, c->before, got, c->after);
        assert_true(p->open);
    }
}

// The keys that edit act nowhere else: Alt and a letter are not the letter.
TEST(alt_keys_do_nothing_outside)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<M-b><M-f><M-Backspace><M-d>");
    assert_int_equal(ex.model.pinned.count, 0);
    assert_int_equal(ex.model.session.input_count, 0);
}

// What is put into the middle stands before the cursor, and Tab completes there.
TEST(words_are_completed_in_the_middle)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set  2<Left><Left>motor.voltage_l<Tab>");
    assert_string_equal(ex.input.prompt.text, "set motor.voltage_limit  2");
    press(&ex, "<Enter>");
    check_close(model_parameters(&ex.model).motor.voltage_limit, 2, 0);
}

// A line that is too long is said to be, and what there was stays.
TEST(nothing_is_cut_off_in_silence)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":note ");
    for (int i = 0; i < LINE_TEXT; i++) {
        explorer_paste(&ex, 'a' + i % 26);
    }
    assert_true(ex.input.message.warning);
    assert_non_null(strstr(ex.input.message.text, "at most"));
    assert_memory_equal(ex.input.prompt.text, "note abcdef", 11);
}

// A line of several hundred characters is carried out whole, and what it noted is kept
// whole in a session.
TEST_IN_FOLDER(long_lines_are_whole)
{
    enum { LONG = 600 };
    char words[LONG + 1] = "";
    for (int i = 0; i < LONG; i++) {
        words[i] = (char)('a' + i % 26);
    }
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_text(&ex, ":note %s<Enter>:session save long<Enter>", words);
    assert_string_equal(ex.model.notes[0].text, words);
    OPEN_EXPLORER(next, "corrected/first-impact");
    press(&next, ":session open long<Enter>");
    assert_int_equal(next.model.note_count, 1);
    assert_string_equal(next.model.notes[0].text, words);
}

// Lines come back by Up, the typed one by Down, and in the next visit, too; of many the
// latest are kept.
TEST_IN_FOLDER(lines_come_back)
{
    {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        prompt_use_history(&ex.input.prompt, "history");
        press(&ex, ":seek 0.1<Enter>:seek 0.2<Enter>:seek 0.2<Enter>");
        press_prompts(&ex, ":set k<Up>", "seek 0.2");
        press_prompts(&ex, "<Up><Up>", "seek 0.1");
        press_prompts(&ex, "<Down>", "seek 0.2");
        press_prompts(&ex, "<Down>", "set k");
        press(&ex, "<Esc>");
    }
    OPEN_EXPLORER(next, "corrected/first-impact");
    prompt_use_history(&next.input.prompt, "history");
    press_prompts(&next, ":<Up><Up>", "seek 0.1");
    press(&next, "<Esc>");
    for (int i = 0; i < 3 * HISTORY_LINES; i++) {
        prompt_remember(&next.input.prompt, formatted("seek %d", i));
    }
    OPEN_EXPLORER(last, "corrected/first-impact");
    prompt_use_history(&last.input.prompt, "history");
    assert_int_equal(last.input.prompt.history_count, HISTORY_LINES);
    press_prompts(&last, ":<Up>", formatted("seek %d", 3 * HISTORY_LINES - 1));
    KEPT_TEXT(kept) = file_text("history");
    int lines = 0;
    for (const char *c = kept; *c != '\0'; c++) {
        lines += *c == '\n';
    }
    assert_int_equal(lines, HISTORY_LINES);
}

// ~ is the home folder where a file is named.
TEST_IN_FOLDER(tilde_is_home)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_int_equal(setenv("HOME", test_folder, 1), 0);
    press(&ex, ":save ~/mine.yaml<Enter>:note ~/x<Enter>");
    assert_int_equal(access("mine.yaml", F_OK), 0);
    assert_string_equal(ex.model.notes[0].text, "~/x");
}

// Units of the same quantity are converted, others are refused.
TEST(units_are_converted)
{
    const double degree = acos(-1) / 180;
    static const struct {
        const char *from, *to;
        double factor;
    } cases[] = {{"ms", "s", 1e-3},  {"s", "s", 1},         {"mV", "V", 1e-3},
                 {"kHz", "Hz", 1e3}, {"g", "kg", 1e-3},     {"um", "m", 1e-6},
                 {"mm", "cm", 0.1},  {"mN s", "N s", 1e-3}, {"kg", "kg", 1}};
    for (EACH(c, cases)) {
        double factor = 0;
        assert_true(unit_factor(c->from, c->to, &factor));
        check_close(factor, c->factor, 1e-15);
    }
    double factor;
    assert_true(unit_factor("deg", "rad", &factor));
    check_close(factor, degree, 1e-15);
    assert_true(unit_factor("N m/deg", "N m/rad", &factor));
    check_close(factor, 1 / degree, 1e-15);
    for (EACH_TEXT(c, "V", "m", "", "N", "sm", "rad/s")) {
        assert_false(unit_factor(*c, "s", &factor));
    }

    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set wall.angle 5 deg<Enter>");
    check_close(model_parameters(&ex.model).wall.angle, 5 * degree, 1e-15);
    press(&ex, ":set motor.voltage 500 mV<Enter>");
    check_close(model_parameters(&ex.model).motor.voltage, 0.5, 1e-15);
    press(&ex, ":seek 300 ms<Enter>");
    check_close(ex.model.session.now, 0.3, 1e-12);
    press_warns(&ex, ":seek 3 V<Enter>", "expected s");
    press_warns(&ex, ":set wall.angle 5 mm<Enter>", "rad");

    // a quantity by the beginning of its name
    press(&ex, ":solve voltage=0.2:1 peak<lt>1<Enter>");
    fail_if(ex.input.message.warning, "%s", ex.input.message.text);
    check_close(ex.model.pinned.runs[0].run.summary.peak_force_N, 1, 1e-3);
}
