// The control law in the terminal lab: its panel, the lock on a mode, the log of its modes.
#include "tests/lab_on_screen.h"

static void assert_pictured(lab *l, int width, int height, glyph_set set, const char *wanted)
{
    char *text = picture(l, width, height, set);
    if (strstr(text, wanted) == NULL) {
        fail_msg("'%s' is not on the screen of %d x %d:\n%s", wanted, width, height, text);
    }
    free(text);
}

static void test_the_panel_is_whole_on_every_screen(void **state)
{
    (void)state;
    static const int sizes[][2] = {{80, 24}, {100, 30}, {120, 40}, {200, 60}};
    static const char *const laws[] = {
        "hybrid",     "recovering",  "force-pd",  "force-integral", "discontinuous", "optimal",
        "predictive", "speed-limit", "open-loop", "bang-bang",      "reverse-torque"};
    lab l;
    open_lab(&l, "compare/hybrid");
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        char line[64], mode[MODE_NAME_SIZE], wanted[64];
        snprintf(line, sizeof line, "law %s", laws[i]);
        assert_true(lab_carry_out(&l, line));
        session_seek(&l.session, 0.9);
        lab_mode_name(&l, session_sample(&l.session)->controller_mode, mode, sizeof mode);
        for (int k = 0; k < 8; k++) {
            int width = sizes[k / 2][0], height = sizes[k / 2][1];
            glyph_set set = k % 2 ? GLYPHS_ASCII : GLYPHS_BRAILLE;
            snprintf(wanted, sizeof wanted, "%s %s, 200 Hz ", k % 2 ? "-" : "\u2500", laws[i]);
            assert_pictured(&l, width, height, set, wanted);
            snprintf(wanted, sizeof wanted, "[%s]", mode);
            assert_pictured(&l, width, height, set, wanted);
            assert_pictured(&l, width, height, set, " command ");
            assert_pictured(&l, width, height, set, " V ");
            assert_pictured(&l, width, height, set,
                            strcmp(laws[i], "open-loop") ? "not locked (L locks)"
                                                         : "takes no lock on a mode");
            assert_pictured(&l, width, height, set, height < 40 ? "of 1 N" : "force commanded");
        }
    }
    press(&l, ":law off<Enter>");
    assert_hides(&l, "200 Hz");
    lab_finish(&l);
}

static void test_a_narrow_screen_shows_the_panel_beside_the_parameters(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    free(picture(&l, 60, 24, GLYPHS_BRAILLE));
    press(&l, ":seek 0.5<Enter><Tab>");
    assert_pictured(&l, 60, 24, GLYPHS_BRAILLE, "approach [impact] force");
    lab_finish(&l);
}

static void test_a_command_beyond_the_limit_is_marked(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/bang-bang");
    session_seek(&l.session, 0.02);
    assert_shows(&l, "saturated");
    session_seek(&l.session, 1.4);
    assert_hides(&l, "saturated");
    lab_finish(&l);
}

static void test_one_key_goes_through_the_modes(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    press(&l, ":seek 0.9<Enter>");
    static const char *const modes[] = {"approach", "impact", "force"};
    for (int i = 0; i < 3; i++) {
        char wanted[64];
        press(&l, "L");
        // going on replaces the lock made at the same instant
        assert_int_equal(l.session.input_count, 1);
        snprintf(wanted, sizeof wanted, "locked: %s (F frees)", modes[i]);
        assert_shows(&l, wanted);
        snprintf(wanted, sizeof wanted, "[%s]", modes[i]);
        assert_shows(&l, wanted);
    }
    press(&l, "L");
    assert_int_equal(l.session.input_count, 0);
    assert_shows(&l, "not locked");
    press(&l, ":lock approach<Enter>:seek 1.1<Enter>F");
    assert_int_equal(l.session.input_count, 2);
    assert_shows(&l, "not locked");
    press(&l, ":seek 1<Enter>");
    assert_shows(&l, "locked: approach");
    press(&l, "uu");
    assert_shows(&l, "not locked");
    press(&l, "U");
    assert_shows(&l, "locked: approach");
    lab_finish(&l);
}

static void test_a_lock_is_saved_and_run_again_byte_for_byte(void **state)
{
    (void)state;
    lab l;
    char *text = NULL;
    size_t size = 0;
    open_lab(&l, "compare/recovering");
    press(&l, ":seek 0.4<Enter>:lock approach<Enter>:seek 0.6<Enter>LLb:seek 0.8<Enter>F");
    assert_false(l.warning);
    FILE *stream = open_memstream(&text, &size);
    scenario_write(stream, &l.session.effective);
    fclose(stream);
    assert_non_null(strstr(text, "set: {control.lock: \"approach\"}"));
    scenario saved;
    run_result again;
    assert_int_equal(scenario_parse(&saved, text, size, "saved", NULL, fail_on_fault, NULL),
                     STATUS_OK);
    run_scenario(&saved, true, &again);
    const trace *t = &l.session.run.trace;
    assert_int_equal(again.trace.row_count, t->row_count);
    assert_memory_equal(again.trace.rows, t->rows, t->row_count * sizeof *t->rows);
    run_finish(&again);
    scenario_finish(&saved);
    free(text);
    lab_finish(&l);
}

static void test_laws_and_modes_are_completed_and_checked(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    press(&l, ":lock app<Tab>");
    assert_string_equal(l.prompt, "lock approach ");
    press(&l, "<C-u>law rec<Tab><Enter>");
    assert_shows(&l, "recovering, 200 Hz");
    press(&l, ":seek 0.5<Enter>:lock press<Enter>");
    assert_true(l.warning);
    assert_shows(&l, "expected none, approach, impact, force or recover");
    press(&l, ":lock recover<Enter>:law hybrid<Enter>");
    assert_true(l.warning);
    assert_shows(&l, "undo the lock first");
    assert_shows(&l, "recovering, 200 Hz");
    press(&l, "u:law inverse-dynamics<Enter>L");
    assert_shows(&l, "this law cannot be held in a mode");
    press(&l, "C");
    assert_hides(&l, "200 Hz");
    press(&l, "L");
    assert_shows(&l, "no law is on");
    press(&l, "C");
    assert_shows(&l, "inverse-dynamics, 200 Hz");
    // the parameter itself can be nudged
    press(&l, ":law hybrid<Enter>:seek 0.5<Enter>:set control.lock<Enter><lt>");
    assert_shows(&l, "locked: force");
    press(&l, ">");
    assert_shows(&l, "not locked");
    lab_finish(&l);
}

static void test_the_log_names_modes(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    press(&l, "nn");
    check_close(l.session.now, 0.295, 0);
    assert_shows(&l, "goes into its mode 'impact' at 0.295000 s");
    assert_shows(&l, "0.29500 s  mode impact");
    press(&l, "<End>");
    assert_shows(&l, "mode force");
    press(&l, "N");
    press(&l, ":seek 0.7<Enter>:lock approach<Enter>");
    assert_shows(&l, "change lock approach");
    press(&l, "n");
    assert_shows(&l, "0.70000 s  mode approach");
    // a click on a line goes there
    for (int i = 0; i < l.spot_count; i++) {
        if (l.spots[i].part == PART_LOG) {
            lab_point(&l, (pointer_event){.kind = POINTER_PRESS,
                                          .x = l.spots[i].x + 3,
                                          .y = l.spots[i].y + 2 - l.spots[i].index});
        }
    }
    check_close(l.session.now, 0.295, 0);
    lab_finish(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_panel_is_whole_on_every_screen),
        cmocka_unit_test(test_a_narrow_screen_shows_the_panel_beside_the_parameters),
        cmocka_unit_test(test_a_command_beyond_the_limit_is_marked),
        cmocka_unit_test(test_one_key_goes_through_the_modes),
        cmocka_unit_test(test_a_lock_is_saved_and_run_again_byte_for_byte),
        cmocka_unit_test(test_laws_and_modes_are_completed_and_checked),
        cmocka_unit_test(test_the_log_names_modes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
