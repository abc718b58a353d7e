// What one did in the lab is kept: scenarios that are opened, pinned runs, leaving. And
// what matters is on the screen, at three sizes.
#include "tests/explorer_on_screen.h"

// Each way of opening another scenario keeps the changes and the pins; u brings them
// back, U leaves again.
TEST(test_opening_loses_nothing)
{
    for (EACH_TEXT(c, "]", "[", "o/three<Enter>", ":open thesis/fig-3-4<Enter>",
                   ":lesson hybrid-law<Enter>")) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, ":seek 0.1<Enter>:set motor.voltage 0.5<Enter>b:seek 0.3<Enter>");
        const double changed = peak(&ex);
        press(&ex, *c);
        assert_string_not_equal(ex.model.session.base.name, "corrected/first-impact");
        assert_int_equal(ex.model.session.input_count, 0);
        assert_int_equal(ex.model.pinned.count, 1);
        const double other = peak(&ex);

        // the run that is compared with is still the pinned one
        assert_true(ex.model.session.has_other);
        check_close(ex.model.session.other.summary.peak_force_N, changed, 0);
        press_opens(&ex, "u", "corrected/first-impact");
        check_close(peak(&ex), changed, 0);
        check_close(ex.model.session.now, 0.3, 1e-12);
        press(&ex, "U");
        check_close(peak(&ex), other, 0);
        press(&ex, "uuU");
        check_close(peak(&ex), changed, 0);
    }
}

// As many openings as are kept, and more, are undone one by one; a new one forgets what
// was undone.
TEST(test_openings_are_undone_one_by_one)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (int i = 0; i < VISITS + 3; i++) {
        press(&ex, i % 2 ? ":open corrected/first-impact<Enter>"
                         : ":open thesis/fig-3-4<Enter>");
    }
    for (int i = 0; i < VISITS - 1; i++) {
        const bool was_printed =
            strcmp(ex.model.session.base.name, "thesis/fig-3-4") == 0;
        press(&ex, "u");
        assert_int_equal(strcmp(ex.model.session.base.name, "thesis/fig-3-4") == 0,
                         !was_printed);
    }
    press_shows(&ex, "u", "nothing to undo");
    press_shows(&ex, "UU:open corrected/three-links<Enter>U", "nothing to redo");
}

// Two scenarios side by side: two keys, of at most six.
TEST(test_a_pinned_run_of_another_scenario_is_drawn_and_taken)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const double first = peak(&ex);
    press(&ex, "b]");
    assert_int_equal(model_run_count(&ex.model), 2);
    assert_shows_everywhere(&ex, " first-impact");
    const double second = peak(&ex);
    press_shows(&ex, "R", "of corrected/first-impact");
    press_opens(&ex, "<Enter>", "corrected/first-impact");
    check_close(peak(&ex), first, 0);
    check_close(ex.model.session.other.summary.peak_force_N, second, 0);
    press(&ex, "u");
    check_close(peak(&ex), second, 0);
}

// Pins of another scenario do not do a lesson's step.
TEST(test_a_lesson_wants_a_pin_of_its_own)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:lesson beta-and-gamma<Enter>y");
    assert_int_equal(ex.model.lesson.step, 0);
    press(&ex, "by");
    assert_int_equal(ex.model.lesson.step, 1);

    // and is where it was on return
    press(&ex, "]u");
    assert_int_equal(ex.model.lesson.step, 1);
}

TEST(test_leaving_asks_for_everything_that_would_be_lost)
{
    static const struct {
        const char *keys, *lost;
    } cases[] = {{"b", "1 pinned run would"},
                 {"b:set arm.k2 5<Enter>b", "1 change and 2 pinned runs would"},
                 {":set arm.k2 5<Enter>]", "1 change would"},
                 {":note hard<Enter>", "notes, marks"},
                 {"m", "marks"},
                 {":limit force 2<Enter>", "panes"},
                 {":panes 12<Enter>", "panes"},
                 {":sweep arm.k2=4:6:2<Enter>", "sweep"}};
    for (EACH(c, cases)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, c->keys);
        press_quits(&ex, "q", false);
        assert_shows(&ex, c->lost);
        press_quits(&ex, "q", true);
    }
}

// --- on the screen ---------------------------------------------------------------------

// What a line of keys makes the lab say, and what it must not.
TEST(test_sentences_are_whole_and_numbers_short)
{
    static const struct {
        const char *keys, *says, *never;
    } cases[] = {
        {":set arm.k2 2.8000000000000003<Enter>", "arm.k2 = 2.8 N m/rad from the start",
         "000003"},
        {":set arm.k2 2.8000000000000003<Enter>bR", "k2 2.8 ", "000003"},
        {":set arm.k2 2.8000000000000003<Enter>H", "arm.k2 = 2.8 N", "000003"},
        {":set arm.k2 2.8000000000000003<Enter>:edit arm.k2<Enter>", ":set arm.k2 2.8",
         "000003"},
        {":law nosuch<Enter>", "there is no control law 'nosuch'", "|"},
        {":law hybird<Enter>", "did you mean 'hybrid'?", "|"},
        {":seek 99<Enter>", "the run goes from 0 to 1 s", "|"},
        {":seek end<Enter>", "in contact", "the run goes"},
    };
    for (EACH(c, cases)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, c->keys);
        assert_shows_everywhere(&ex, c->says);
        assert_shows_everywhere(&ex, formatted("!%s", c->never));
    }

    // a title that is too long ends in a sign
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set arm.k2 5<Enter>");
    assert_shows_at(&ex, 66, 24, "First impact at\u2026");
}

// The lines of parameters between the edges of their panel.
static int parameter_rows(explorer *ex, int width, int height)
{
    int rows = 0;
    free(picture(ex, width, height, GLYPHS_BRAILLE));
    for (int y = 0; y < height; y++) {
        bool found = false;
        for (int i = 0; i < ex->layout.hit_count; i++) {
            const hit_area *h = &ex->layout.hits[i];
            found = found || (h->panel == PANEL_PARAMETERS && h->area.y == y);
        }
        rows += found;
    }
    return rows;
}

// With a law and pinned runs the parameters keep five lines.
TEST(test_parameters_keep_their_rows)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, "b:set control.force 2<Enter>b:set control.force 3<Enter>");
    for (EACH(size, screen_sizes)) {
        assert_true(parameter_rows(&ex, (*size)[0], (*size)[1]) >= 5);
    }
    press(&ex, ":seek 0.35<Enter>");
    assert_shows_at(&ex, 80, 24, "impact dynamics");

    // a tall screen gives its rows to the curves
    free(picture(&ex, 200, 60, GLYPHS_BRAILLE));
    assert_true(ex.layout.plot.height >= 30);
}

// One key hides a signal, and a click on its legend; neither moves the cursor.
TEST(test_a_signal_is_hidden_by_a_key_or_a_click)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.5<Enter>K");
    assert_int_equal(ex.view.panes.pane[0].hidden, 4);
    press(&ex, "K");
    assert_int_equal(ex.view.panes.pane[0].hidden, 2);
    press(&ex, "KK");
    assert_int_equal(ex.view.panes.pane[0].hidden, 0);
    const hit_area legend = part_on_screen(&ex, PANEL_CURVES, PART_LEGEND);
    click_at(&ex, legend.area.x, legend.area.y);
    assert_int_equal(ex.view.panes.pane[legend.index / PANE_SIGNALS].hidden,
                     1u << legend.index % PANE_SIGNALS);
    check_close(ex.model.session.now, 0.5, 1e-12);

    // the axis is that of what is shown
    value_range all, fewer;
    press(&ex, ":panes 6<Enter>:signal all<Enter>");
    assert_true(view_pane_axis(&ex.model, &ex.view, 5, &all));
    press(&ex, ":signal motor_work<Enter>");
    assert_true(view_pane_axis(&ex.model, &ex.view, 5, &fewer));
    check_below(fewer.high, all.high);
}

// --- what is asked for -----------------------------------------------------------------

// How much voltage so that the peak stays below 2 N? At most 20 keys, with completion.
TEST(test_a_limit_is_asked_for_in_few_keys)
{
    static const char keys[] = ":so<Tab>vo<Tab> pea<Tab>N<lt>2<Enter>";
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.3<Enter>");
    const double before = peak(&ex);
    assert_true(count_keys(keys) <= 20);
    press(&ex, keys);
    assert_shows_everywhere(&ex, "up to motor.voltage = 1.4441 V: 2.0000 N");
    assert_shows_everywhere(&ex, "limit");

    // the answer is pinned, the present run stays
    const pinned_run *p = &ex.model.pinned.runs[0];
    assert_int_equal(ex.model.pinned.count, 1);
    assert_string_equal(p->name, "voltage 1.4441");
    check_close(p->run.summary.peak_force_N, 2, 1e-9);
    assert_true(p->run.summary.peak_force_N < 2);
    check_close(peak(&ex), before, 0);
    check_close(ex.model.session.now, 0.3, 1e-12);

    // none, nonsense, and a range of one's own
    press_shows(&ex, ":solve voltage=0.1:0.2 peak_force_N<lt>2<Enter>",
                "no limit of motor.voltage from 0.1 to 0.2 V");
    press_shows(&ex, ":solve voltage peak_froce_N<lt>2<Enter>",
                "did you mean 'peak_force_N'?");
    press_warns(&ex, ":solve control.law peak_force_N<lt>2<Enter>", "");
    press_shows(&ex, ":solve voltage<Enter>", "solve takes");
    assert_int_equal(ex.model.pinned.count, 1);
}

// Why a run is as it is, whole at every size.
TEST(test_why_is_answered_on_the_screen)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "W");
    for (EACH_TEXT(c, "Driven by 1 V the arm touches", "controller", "0.3662")) {
        assert_shows_everywhere(&ex, *c);
    }
    press_shows(&ex, "<Esc>", "!Driven by");
}

// F1 explains what one stands on; the palette knows other words for it.
TEST(test_help_is_where_one_stands)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>NNNN<Home>n<F1>");
    for (EACH_TEXT(c, "motor.voltage", ":sweep and :solve vary it",
                   "the event at the cursor")) {
        assert_shows_everywhere(&ex, *c);
    }
    press(&ex, "<Esc>");
    static const char *const words[][2] = {
        {"export", ":save"}, {"picture", ":save"}, {"bounce", "wall.restitution"},
        {"goal", ":solve"},  {"below", ":solve"},
    };
    for (EACH(c, words)) {
        press(&ex, formatted("<C-p>%s", (*c)[0]));
        assert_shows(&ex, (*c)[1]);
        press(&ex, "<Esc>");
    }
}

// Panes of one's own, any number: a second one takes at most twelve keys.
TEST(test_own_panes_stand_side_by_side)
{
    static const char keys[] = ":tr gap<Enter>";
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":trace impulse<Enter>");
    assert_true(count_keys(keys) <= 12);
    press(&ex, keys);
    press(&ex, ":spectrum force<Enter>:phase gap force<Enter>:panes 1<Enter>:trace "
               "10<Enter>:trace 11<Enter>:trace 12<Enter>:trace 13<Enter>");
    const pane *own = &ex.view.panes.pane[PANES_OF_TABLE];
    assert_true(own[0].shown && own[1].shown && own[2].shown && own[3].shown);
    assert_int_equal(own[0].signals[0], SIGNAL_INDEX(impulse));
    assert_int_equal(own[1].signals[0], SIGNAL_INDEX(gap));
    assert_int_equal(own[2].view, VIEW_SPECTRUM);
    assert_int_equal(own[3].view, VIEW_PHASE);
    assert_shows_at(&ex, 200, 60, "impulse");
    assert_shows_at(&ex, 200, 60, "amplitudes of force");
    assert_shows_at(&ex, 200, 60, "gap over force");
    for (int i = 0; i < PANES + 5; i++) {
        press(&ex, ":trace force<Enter>");
    }
    press_shows(&ex, ":trace 25<Enter>", "panes are numbered from 1 to 24");
}

// t_f three steps shorter: at most five keys.
TEST(test_the_transition_is_three_steps_shorter_in_few_keys)
{
    static const char keys[] = "<lt><lt><lt>";
    OPEN_EXPLORER(ex, "lessons/hybrid-law");
    press(&ex, keys);
    assert_true(count_keys(keys) <= 5);
    check_close(ex.model.session.effective.parameters.control.transition_time, 0.32,
                1e-9);
}
