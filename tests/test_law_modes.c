// The control law in the explorer: its mode in the status, the lock on a mode, the log of
// its modes.
#include "tests/explorer_on_screen.h"

static void assert_pictured(explorer *ex, int width, int height, glyph_set set,
                            const char *wanted)
{
    KEPT_TEXT(text) = picture(ex, width, height, set);
    fail_if(strstr(text, wanted) == NULL, "'%s' is not on the screen of %d x %d:\n%s",
            wanted, width, height, text);
}

TEST(test_law_and_mode_stand_on_every_screen)
{
    static const int sizes[][2] = {{80, 24}, {100, 30}, {120, 40}, {200, 60}};
    OPEN_EXPLORER(ex, "compare/hybrid");
    for (EACH_TEXT(c, "hybrid", "recovering", "force-pd", "force-integral",
                   "discontinuous", "speed-limit", "open-loop", "bang-bang",
                   "reverse-torque")) {
        char mode[MODE_NAME_SIZE];
        assert_true(explorer_carry_out(&ex, formatted("law %s", *c)));
        session_seek(&ex.model.session, 0.9);
        law_mode_name(model_law_modes(&ex.model),
                      session_sample(&ex.model.session)->controller_mode, mode,
                      sizeof mode);
        for (int k = 0; k < 8; k++) {
            int width = sizes[k / 2][0], height = sizes[k / 2][1];
            glyph_set set = k % 2 ? GLYPHS_ASCII : GLYPHS_BRAILLE;
            assert_pictured(&ex, width, height, set, formatted("%s: %s", *c, mode));
        }
    }
    press_shows(&ex, ":law off<Enter>", "!reverse-torque:");
}

TEST(test_one_key_goes_through_the_modes)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.9<Enter>");
    for (EACH_TEXT(c, "approach", "impact", "force")) {
        press(&ex, "L");
        // going on replaces the lock made at the same instant
        assert_int_equal(ex.model.session.input_count, 1);
        assert_shows(&ex, formatted("hybrid: %s, locked", *c));
    }
    press(&ex, "L");
    assert_int_equal(ex.model.session.input_count, 0);
    assert_shows(&ex, "!, locked");
    press(&ex, ":lock approach<Enter>:seek 1.1<Enter>F");
    assert_int_equal(ex.model.session.input_count, 2);
    assert_shows(&ex, "!, locked");
    press_shows(&ex, ":seek 1<Enter>", "approach, locked");
    press_shows(&ex, "uu", "!, locked");
    press_shows(&ex, "U", "approach, locked");
}

TEST(test_a_lock_is_saved_and_run_again_byte_for_byte)
{
    OPEN_EXPLORER(ex, "compare/recovering");
    press(&ex,
          ":seek 0.4<Enter>:lock approach<Enter>:seek 0.6<Enter>LLb:seek 0.8<Enter>F");
    assert_false(ex.input.message.warning);
    KEPT_TEXT(text) = save_and_compare(&ex.model.session);
    assert_non_null(strstr(text, "set: {control.lock: \"approach\"}"));
}

TEST(test_laws_and_modes_are_completed_and_checked)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_prompts(&ex, ":lock app<Tab>", "lock approach ");
    press_shows(&ex, "<C-u>law rec<Tab><Enter>", "recovering: ");
    press_warns(&ex, ":seek 0.5<Enter>:lock press<Enter>", "");
    assert_shows(&ex, "expected none, approach, impact, force or recover");
    press_warns(&ex, ":lock recover<Enter>:law hybrid<Enter>", "");
    assert_shows(&ex, "undo the lock first", "recovering: ");
    press_shows(&ex, "u:law inverse-dynamics<Enter>L",
                "this law cannot be held in a mode");
    press_shows(&ex, "C", "!inverse-dynamics:");
    press_shows(&ex, "L", "no law is on");
    press_shows(&ex, "C", "inverse-dynamics: ");
    // the parameter itself can be nudged
    press_shows(&ex, ":law hybrid<Enter>:seek 0.5<Enter>:set control.lock<Enter><lt>",
                ": force, locked");
    press_shows(&ex, ">", "!, locked");
}

TEST(test_events_name_modes)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, "nn");
    check_close(ex.model.session.now, 0.295, 0);
    assert_shows(&ex, "goes into its mode 'impact' at 0.295000 s");
    press_shows(&ex, "<End>N", "goes into its mode 'force'");
}
