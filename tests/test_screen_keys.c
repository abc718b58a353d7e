// Keys of the user's own, the help page that shows them, and the settings that keep them.
#include "tests/lab_on_screen.h"

#include <sys/stat.h>
#include <unistd.h>

static void test_a_key_gets_another_command(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    press(&l, ":key x step 5<Enter>");
    assert_shows(&l, "x does 'step 5' now, no longer 'extend'");
    size_t before = l.session.row;
    press(&l, "x");
    assert_int_equal(l.session.row, before + 5);
    press(&l, ":key \u00e4 seek 0.3<Enter>:key C-t trace 5<Enter>:key F1 seek end<Enter>");
    lab_key(&l, 0xe4);
    check_close(l.session.now, 0.3, 0.002);
    press(&l, "<C-t>");
    assert_true(l.panes[4].shown);
    press(&l, "<F1>");
    check_close(l.session.now, 1, 1e-9);
    press(&l, ":key x<Enter>");
    assert_shows(&l, "x does 'step 5'");
    // taken back, then off, then back again
    press(&l, ":unkey x<Enter>");
    assert_shows(&l, "x does 'extend' again");
    press(&l, ":unkey x<Enter>x");
    assert_shows(&l, "'x' does nothing here");
    check_close(l.session.effective.parameters.run.duration, 1, 0);
    press(&l, ":unkey x<Enter>x");
    check_close(l.session.effective.parameters.run.duration, 2, 0);
    lab_finish(&l);
}

static void test_wrong_keys_are_told(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
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
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_false(lab_carry_out(&l, wrong[i].line));
        if (strstr(l.message, wrong[i].why) == NULL || l.fault_at != wrong[i].at) {
            fail_msg("'%s' at %d: %s", wrong[i].line, l.fault_at, l.message);
        }
    }
    assert_int_equal(l.user_key_count, 0);
    // a full table
    for (int i = 0; i < LAB_USER_KEYS; i++) {
        char line[32];
        snprintf(line, sizeof line, "key %c%c play", i < 32 ? 0xc3 : 0xc4, 0xa0 + i % 32);
        assert_true(lab_carry_out(&l, line));
    }
    assert_false(lab_carry_out(&l, "key x play"));
    assert_true(lab_carry_out(&l, "unkey \u00e4"));
    assert_true(lab_carry_out(&l, "key x play"));
    lab_finish(&l);
}

static void test_the_help_shows_the_keys_that_are(void **state)
{
    (void)state;
    static lab_help_line lines[400];
    lab l;
    open_lab(&l, "corrected/first-impact");
    press(&l, ":key w step 5<Enter>:unkey x<Enter>?<End>");
    assert_shows(&l, "Keys of your own");
    assert_shows(&l, "step 5 (the lab's: focus)");
    assert_shows(&l, "nothing (the lab's: extend)");
    press(&l, "<Home>");
    assert_shows(&l, "w Right l Left h PgDn PgUp");
    // no line is wider than the page, and every command is there, at any width
    for (int width = 26; width < 200; width += 7) {
        int count = lab_write_help(&l, width, lines, 400);
        assert_true(count < 400);
        for (int i = 0; lab_command_name(i) != NULL; i++) {
            char call[32];
            bool found = false;
            snprintf(call, sizeof call, ":%s", lab_command_name(i));
            for (int k = 0; k < count && !found; k++) {
                found = strstr(lines[k].text, call) != NULL;
            }
            if (!found) {
                fail_msg("%s is not in the help at width %d", call, width);
            }
        }
        for (int k = 0; k < count; k++) {
            if ((int)strlen(lines[k].text) > width) {
                fail_msg("wider than %d: '%s'", width, lines[k].text);
            }
        }
    }
    lab_finish(&l);
}

// A folder of settings of its own, with a file of them if there is text.
static void make_settings(char *folder, const char *text)
{
    char path[128];
    assert_non_null(mkdtemp(folder));
    assert_int_equal(setenv("XDG_CONFIG_HOME", folder, 1), 0);
    snprintf(path, sizeof path, "%s/impactlab", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof path, "%s/impactlab/lab", folder);
    FILE *stream = text != NULL ? fopen(path, "w") : NULL;
    if (stream != NULL) {
        fputs(text, stream);
        fclose(stream);
    }
}

static void remove_settings(const char *folder)
{
    char path[128];
    snprintf(path, sizeof path, "%s/impactlab/lab", folder);
    unlink(path);
    snprintf(path, sizeof path, "%s/impactlab", folder);
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(rmdir(folder), 0);
}

static void test_settings_keep_looks_axes_and_keys(void **state)
{
    (void)state;
    char folder[] = "/tmp/impactlab-settings-XXXXXX";
    lab l;
    make_settings(folder, NULL);
    open_lab(&l, "corrected/first-impact");
    press(&l, ":theme light<Enter>:glyphs blocks<Enter>:colours 16<Enter>:axis -0.5 2.25 1<Enter>");
    press(&l, ":axis grow 3<Enter>:key <lt> step -5<Enter>:key C-t trace 5<Enter>:unkey x<Enter>");
    press(&l, ":key Space step 3<Enter>:key # mark<Enter>:remember<Enter>");
    assert_shows(&l, "settings kept");
    lab_finish(&l);
    open_lab(&l, "corrected/first-impact");
    lab_settings_load(&l);
    assert_string_equal(l.message, "");
    assert_int_equal(l.theme, COLOURS_LIGHT);
    assert_int_equal(l.glyphs, GLYPHS_BLOCKS);
    assert_int_equal(l.depth, DEPTH_16);
    assert_int_equal(l.panes[0].axis, AXIS_FIXED);
    check_close(l.panes[0].low, -0.5, 0);
    check_close(l.panes[0].high, 2.25, 0);
    assert_int_equal(l.panes[2].axis, AXIS_GROW);
    assert_int_equal(l.panes[3].axis, AXIS_AUTO);
    assert_int_equal(l.user_key_count, 5);
    assert_string_equal(lab_bound_line(&l, '<'), "step -5");
    assert_string_equal(lab_bound_line(&l, ' '), "step 3");
    assert_string_equal(lab_bound_line(&l, '#'), "mark");
    assert_string_equal(lab_bound_line(&l, 't' & 0x1f), "trace 5");
    assert_null(lab_bound_line(&l, 'x'));
    // nobody chose panes, so a controlled run shows its own
    assert_false(l.panes_chosen);
    lab_finish(&l);
    remove_settings(folder);
}

static void test_faults_in_settings_are_told_with_their_place(void **state)
{
    (void)state;
    char folder[] = "/tmp/impactlab-settings-XXXXXX", wanted[128];
    lab l;
    make_settings(folder, "# mine\n"
                          "key x step 5\n"
                          "key y stepp 5\n"
                          "quit\n"
                          "\n"
                          "axis 2 1 1\n"
                          "theme light\n");
    open_lab(&l, "corrected/first-impact");
    lab_settings_load(&l);
    assert_false(l.quit);
    assert_int_equal(l.theme, COLOURS_LIGHT);
    assert_string_equal(lab_bound_line(&l, 'x'), "step 5");
    assert_true(l.warning);
    snprintf(wanted, sizeof wanted, "%s/impactlab/lab:3:7 is ignored: there is no command 'stepp'",
             folder);
    assert_non_null(strstr(l.message, wanted));
    assert_non_null(strstr(l.message, "(and 2 more)"));
    assert_false(lab_settings_save(&l));
    assert_non_null(strstr(l.message, "left alone"));
    lab_finish(&l);
    remove_settings(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_key_gets_another_command),
        cmocka_unit_test(test_wrong_keys_are_told),
        cmocka_unit_test(test_the_help_shows_the_keys_that_are),
        cmocka_unit_test(test_settings_keep_looks_axes_and_keys),
        cmocka_unit_test(test_faults_in_settings_are_told_with_their_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
