// Keys bound by the user, the help page that shows them, and the settings that store
// them.
#include "tests/explorer_on_screen.h"

TEST(test_a_key_gets_another_command)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":key x step 5<Enter>", "x does 'step 5' now, no longer 'extend'");
    size_t before = ex.model.session.row;
    press(&ex, "x");
    assert_int_equal(ex.model.session.row, before + 5);
    press(&ex,
          ":key \u00e4 seek 0.3<Enter>:key C-t trace 5<Enter>:key F1 seek end<Enter>");
    explorer_key(&ex, 0xe4);
    check_close(ex.model.session.now, 0.3, 0.002);
    press(&ex, "<C-t>");
    assert_true(ex.view.panes.pane[4].shown);
    press(&ex, "<F1>");
    check_close(ex.model.session.now, 1, 1e-9);
    press_shows(&ex, ":key x<Enter>", "x does 'step 5'");
    // taken back, then off, then back again
    press_shows(&ex, ":unkey x<Enter>", "x does 'extend' again");
    press_shows(&ex, ":unkey x<Enter>x", "'x' does nothing here");
    check_close(ex.model.session.effective.parameters.run.duration, 1, 0);
    press(&ex, ":unkey x<Enter>x");
    check_close(ex.model.session.effective.parameters.run.duration, 2, 0);
}

TEST(test_wrong_keys_are_told)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    static const struct {
        const char *line, *why;
        int at; // characters before the fault
    } wrong[] = {
        {"key", "a key is a character or a name", 3},
        {"key Spac play", "there is no key 'Spac'", 4},
        {"key x stepp 5", "there is no command 'stepp', did you mean step?", 6},
        {"key : play", "keeps its meaning", 4},
        {"key Esc play", "keeps its meaning", 4},
        {"  key C-c play", "keeps its meaning", 6},
        {"unkey", "a key is a character or a name", 5},
        {"unkey x y", "what is 'y' for?", 8},
        {"unkey \u00e4", "does nothing as it is", 6},
        {"kex x play", "did you mean key?", 0},
    };
    for (EACH(c, wrong)) {
        assert_false(explorer_execute(&ex.model, &ex.view, &ex.input, c->line));
        const message_line result = ex.input.message;
        fail_if(strstr(result.text, c->why) == NULL || result.at != c->at,
                "'%s' at %d: %s", c->line, result.at, result.text);
    }
    assert_int_equal(ex.view.keys.count, 0);
    // a full table
    for (int i = 0; i < USER_KEYS; i++) {
        assert_true(
            explorer_carry_out(&ex, formatted("key %c%c play", i < 32 ? 0xc3 : 0xc4,
                                              0xa0 + i % 32)));
    }
    assert_false(explorer_carry_out(&ex, "key x play"));
    assert_true(explorer_carry_out(&ex, "unkey \u00e4"));
    assert_true(explorer_carry_out(&ex, "key x play"));
}

TEST(test_the_help_shows_the_keys_that_are)
{
    static help_line lines[600];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":key w step 5<Enter>:unkey x<Enter>?<End>", "Keys of your own",
                "step 5 (the lab's: focus)", "nothing (the lab's: extend)");
    press_shows(&ex, "<Home>", "w Right l Left h PgDn PgUp");
    // no line is wider than the page, and every command is there, at any width
    for (int width = 26; width < 200; width += 7) {
        int count = help_write(&ex.view.keys, width, lines, 600);
        assert_true(count < 600);
        for (int i = 0; i < explorer_command_count; i++) {
            bool found = false;
            const char *call = formatted(":%s", explorer_command_table[i].name);
            for (int k = 0; k < count && !found; k++) {
                found = strstr(lines[k].text, call) != NULL;
            }
            fail_if(!found, "%s is not in the help at width %d", call, width);
        }
        for (int k = 0; k < count; k++) {
            fail_if((int)strlen(lines[k].text) > width, "wider than %d: '%s'", width,
                    lines[k].text);
        }
    }
}

// A folder of settings of its own, with a file of them if there is text.
static void make_settings(const char *text)
{
    assert_int_equal(setenv("XDG_CONFIG_HOME", test_folder, 1), 0);
    assert_int_equal(mkdir("impactlab", 0700), 0);
    if (text != NULL) {
        put_file("impactlab/lab", text);
    }
}

TEST_IN_FOLDER(test_settings_keep_looks_axes_and_keys)
{
    make_settings(NULL);
    OPEN_EXPLORER(keeps, "corrected/first-impact");
    press(&keeps, ":theme light<Enter>:glyphs blocks<Enter>:axis -0.5 2.25 1<Enter>");
    press_shows(&keeps,
                ":axis -1 1 3<Enter>:key <lt> step -5<Enter>:key C-t trace "
                "5<Enter>:unkey x<Enter>:key Space step 3<Enter>:key # "
                "mark<Enter>:remember<Enter>",
                "settings kept");
    OPEN_EXPLORER(ex, "corrected/first-impact");
    explorer_load_settings(&ex.model, &ex.view, &ex.input);
    assert_string_equal(ex.input.message.text, "");
    assert_int_equal(ex.view.looks.theme, COLOURS_LIGHT);
    assert_int_equal(ex.view.looks.glyphs, GLYPHS_BLOCKS);
    assert_true(ex.view.panes.pane[0].is_fixed);
    check_close(ex.view.panes.pane[0].fixed.low, -0.5, 0);
    check_close(ex.view.panes.pane[0].fixed.high, 2.25, 0);
    assert_true(ex.view.panes.pane[2].is_fixed);
    assert_false(ex.view.panes.pane[3].is_fixed);
    assert_int_equal(ex.view.keys.count, 5);
    assert_string_equal(key_line(&ex.view.keys, '<'), "step -5");
    assert_string_equal(key_line(&ex.view.keys, ' '), "step 3");
    assert_string_equal(key_line(&ex.view.keys, '#'), "mark");
    assert_string_equal(key_line(&ex.view.keys, 't' & 0x1f), "trace 5");
    assert_null(key_line(&ex.view.keys, 'x'));
    // without a choice of panes a controlled run shows its own
    assert_false(ex.view.panes.chosen);
}

TEST_IN_FOLDER(test_faults_in_settings_are_told_with_their_place)
{
    make_settings("# mine\n"
                  "key x step 5\n"
                  "key y stepp 5\n"
                  "quit\n"
                  "\n"
                  "axis 2 1 1\n"
                  "theme light\n");
    OPEN_EXPLORER(ex, "corrected/first-impact");
    explorer_load_settings(&ex.model, &ex.view, &ex.input);
    assert_false(ex.input.quit);
    assert_int_equal(ex.view.looks.theme, COLOURS_LIGHT);
    assert_string_equal(key_line(&ex.view.keys, 'x'), "step 5");
    assert_true(ex.input.message.warning);
    assert_non_null(
        strstr(ex.input.message.text,
               formatted("%s/impactlab/lab:3:7 is ignored: there is no command 'stepp'",
                         test_folder)));
    assert_non_null(strstr(ex.input.message.text, "(and 2 more)"));
    assert_false(explorer_carry_out(&ex, "remember"));
    assert_non_null(strstr(ex.input.message.text, "left alone"));
}
