// The explorer without a terminal: the grid of cells, the panels, keys and commands.
#include "tests/explorer_on_screen.h"

// Texts end at their width and at the screen's edges; characters that are left of the
// screen are not drawn, and a control character or a broken byte becomes a question mark.
TEST(test_text_is_cut_and_cleaned)
{
    SCOPED(screen_finish) screen s = {0};
    screen_resize(&s, 8, 2);
    assert_int_equal(screen_text(&s, 0, 0, 4, INK_TEXT, "\u03b8\tabcdef"), 4);
    screen_text(&s, 6, 1, 10, INK_TEXT, "\xff\x1b[2J");
    screen_text(&s, -2, 1, 4, INK_TEXT, "wxyz");
    screen_put(&s, 0, -1, 'x', INK_TEXT);
    screen_put(&s, 8, 0, 'x', INK_TEXT);
    SCOPED(free_kept) WRITTEN(text, screen_dump(&s, GLYPHS_BRAILLE, stream));
    assert_string_equal(text, "\u03b8?ab\nyz    ??\n");
}

// A horizontal line far beyond the canvas of 4 x 2 cells at (1, 1) fills its second row
// and nothing outside; lines with an end that is no number or out of range draw nothing.
TEST(test_lines_of_dots_stay_within_their_canvas)
{
    SCOPED(screen_finish) screen s = {0};
    screen_resize(&s, 6, 4);
    canvas c = {&s, 1, 1, 4, 2};
    canvas_line(&c, -1e12, 4, 1e12, 4, INK_ARM);
    canvas_line(&c, (double)NAN, 0, 3, 3, INK_ARM);
    canvas_line(&c, 1e300, 1e300, 1e301, 1e301, INK_ARM);
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 6; x++) {
            bool on_line = y == 2 && x >= 1 && x <= 4;
            assert_int_equal(s.cells[y * 6 + x].glyph != ' ', on_line);
        }
    }
}

// Where only ASCII may be drawn, every screen, page and list consists of it.
TEST(test_every_glyph_has_a_twin_in_ascii)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (EACH_TEXT(one, "<End>bp", "?", "<Esc>c", "<Esc>o", "<Esc><Tab><Tab>m")) {
        press(&ex, *one);
        KEPT_TEXT(text) = picture(&ex, 150, 50, GLYPHS_ASCII);
        for (const char *c = text; *c; c++) {
            assert_true((*c >= ' ' && *c < 127) || *c == '\n');
        }
    }
}

// Space plays the run. After two seconds of the clock the arm is at the wall; long after
// the run's end the playing has stopped.
TEST(test_playing_shows_an_impact_within_seconds)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_shows(&ex, "free flight");
    press(&ex, "<Space>");
    act_advance(&ex.model, &ex.view, &ex.input, 2);
    assert_shows(&ex, "44.3 mN s", "in contact");
    act_advance(&ex.model, &ex.view, &ex.input, 100);
    assert_false(ex.view.playback.playing);
    assert_shows(&ex, "end of the run");
}

// A newcomer's way: watch, pause, go back to just before contact, lower the voltage,
// compare.
TEST(test_a_lower_voltage_is_compared_with_the_run_before)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<Space>");
    act_advance(&ex.model, &ex.view, &ex.input, 3);
    press_shows(&ex, "<Space>NNNN<Home>nN:seek 0.2<Enter>b<Enter>",
                ":set motor.voltage 1");
    press_shows(&ex, "<Backspace>0.5<Enter>", "motor.voltage = 0.5 V from 0.2000 s on");
    check_below(ex.model.session.run.summary.peak_force_N,
                ex.model.session.other.summary.peak_force_N);
    press_shows(&ex, "c", "two runs (Esc closes)");
    assert_shows(&ex, formatted("%-30s %11.4g %11.4g", "first pulse peak [N]",
                                ex.model.session.run.summary.first_pulse_peak_N,
                                ex.model.session.other.summary.first_pulse_peak_N));
    press(&ex, "<Esc>u");
    check_close(ex.model.session.run.summary.peak_force_N,
                ex.model.session.other.summary.peak_force_N, 0);
    press(&ex, "U");
    check_below(ex.model.session.run.summary.peak_force_N,
                ex.model.session.other.summary.peak_force_N);
}

// The largest number of cells with dots (braille, U+2800 to U+28FF) that a column of the
// plot has.
static int tallest_column(explorer *ex, int width)
{
    SCOPED(screen_finish) screen s = {0};
    int tallest = 0;
    screen_resize(&s, width, 40);
    explorer_draw(ex, &s);
    for (int x = ex->layout.plot.x; x < ex->layout.plot.x + ex->layout.plot.width; x++) {
        int cells = 0;
        for (int y = ex->layout.plot.y + 1;
             y < ex->layout.plot.y + ex->layout.plot.height - 2; y++) {
            uint32_t glyph = s.cells[(long)y * s.width + x].glyph;
            cells += glyph > 0x2800 && glyph < 0x2900;
        }
        tallest = cells > tallest ? cells : tallest;
    }
    return tallest;
}

TEST(test_a_spike_of_one_row_is_drawn)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "134:extend 19<Enter><End>:trace impulse<Enter>");
    // the impulse is one row of twenty thousand, and its line goes up the whole pane
    assert_true(tallest_column(&ex, 120) >= ex.layout.plot.height - 4);
}

// With a mark (m) the page of values (Tab) shows differences to it; Escape takes it away.
TEST(test_values_show_the_difference_to_the_mark)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":seek 0.2<Enter>m<Tab><Tab>:seek 0.25<Enter>", "values, minus mark",
                "from mark 0.05 s");
    press_shows(&ex, "<Esc>", "!from mark");
}

// In the list of scenarios (o) a slash filters and Enter opens; a name that does not
// exist leaves the scenario open, and [ opens the one before it in the list.
TEST(test_the_list_filters_and_opens)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "o/three", "corrected/three-links",
                "Three links against a flat wall", "!five-links");
    press_opens(&ex, "<Enter>", "corrected/three-links");
    press_opens(&ex, ":open thesis/fig-3-4<Enter>", "thesis/fig-3-4");
    assert_shows(&ex, "printed");
    press_warns(&ex, ":open nowhere<Enter>", "");
    assert_string_equal(ex.model.session.base.name, "thesis/fig-3-4");
    press(&ex, "[");
    assert_string_not_equal(ex.model.session.base.name, "thesis/fig-3-4");
}

TEST(test_what_is_typed_is_completed)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_prompts(&ex, ":comp<Tab>", "compare ");
    press_prompts(&ex, "<C-u>set motor.vol<Tab>", "set motor.voltage");
    assert_shows(&ex, "motor.voltage_limit");
    press_shows(&ex, "<Esc>:set motor.voltgae 2<Enter>", "did you mean 'motor.voltage'?");
    press_shows(&ex, ":brunch<Enter>", "did you mean branch?");
}

TEST(test_help_lists_every_key)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "?", ":branch");
    press_shows(&ex, "<End>", "leave the lab");
    press_shows(&ex, "<Esc>", "!leave the lab");
    assert_false(ex.input.quit);
    press_quits(&ex, "q", true);
}

TEST(test_pages_scroll_to_their_ends)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "?GGjj", ":quit");
    press_shows(&ex, "gkk", ":play");

    // keys that are pressed without drawing in between do not scroll past the ends
    press_shows(&ex, "<Esc>cGjjjgk", "this run");
}

TEST_IN_FOLDER(test_saved_scenario_and_screen)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    ex.view.size.width = 100;
    ex.view.size.height = 30;
    press(&ex, ":seek 0.2<Enter>");
    assert_true(explorer_carry_out(&ex, "set motor.voltage 0.5"));
    static const char *const endings[] = {"csv", "yaml", "txt", "svg"};
    for (EACH(one, endings)) {
        const char *line = formatted("save run.%s", *one);
        fail_if(!explorer_carry_out(&ex, line), "%s: %s", line, ex.input.message.text);
    }
    assert_false(explorer_carry_out(&ex, "save /nowhere/run.csv"));
    assert_false(explorer_carry_out(&ex, "save run.doc"));
    double peak = ex.model.session.run.summary.peak_force_N;
    assert_true(explorer_carry_out(&ex, "open ./run.yaml"));
    check_close(ex.model.session.run.summary.peak_force_N, peak, 0);
    for (EACH(one, endings)) {
        assert_int_equal(access(formatted("run.%s", *one), F_OK), 0);
    }
}

// A click in the middle of the plot moves the cursor to half of the run of 1 s, within a
// cell; a click outside of the plot or of the screen moves nothing.
TEST(test_a_click_moves_the_cursor)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    click_at(&ex, ex.layout.plot.x + ex.layout.plot.width / 2, ex.layout.plot.y + 3);
    check_close(ex.model.session.now, 0.5, 0.02);
    click_at(&ex, 119, 39);
    click_at(&ex, -5, 1000);
    check_close(ex.model.session.now, 0.5, 0.02);
}

TEST(test_every_scenario_and_every_size_draws)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    static const int sizes[][2] = {{1, 1},   {300, 100}, {40, 12}, {41, 13}, {72, 20},
                                   {99, 29}, {100, 30},  {39, 50}, {200, 5}};
    for (EACH(one, sizes)) {
        for (EACH_TEXT(c, "", "?", "<Esc>o", "<Esc>c", "<Esc>:set ", "<Esc><Tab>")) {
            press(&ex, *c);
            free(picture(&ex, (*one)[0], (*one)[1], GLYPHS_BLOCKS));
        }
    }
    free(picture(&ex, 20, 3, GLYPHS_ASCII));
    for (int i = 0; i < ex.view.scenarios.count; i++) {
        press(&ex, "]");
        session_seek(&ex.model.session, 0.6 * session_end(&ex.model.session));
        assert_shows(&ex, ex.model.session.base.name);
    }
}

// Beneath a lesson the arm may be left a row, or none, also from near by.
TEST(test_a_lesson_leaves_the_arm_any_height)
{
    OPEN_EXPLORER(ex, "lessons/hybrid-law");
    press(&ex, ":seek 0.5<Enter>");
    for (int height = 1; height <= 40; height++) {
        free(picture(&ex, 110, height, GLYPHS_BRAILLE));
    }
}

// At the last row before a touch the linearised arm predicts what "impactlab predict"
// prints (2.614 N in 7 ms), for as many links as there are. While the run plays nothing
// is predicted: the line shows a dash.
TEST(test_many_links_are_predicted_while_the_run_rests)
{
    OPEN_EXPLORER(ex, "corrected/five-links");
    press(&ex, "i");
    const trace *t = &ex.model.session.run.trace;
    const sample *row = session_sample(&ex.model.session);
    const double *w = t->velocities + ex.model.session.row * (size_t)t->angle_count;
    check_close(w[0], row->hub_velocity, 0);
    check_close(w[1], row->first_velocity, 0); // behind the beam's root
    check_close(w[t->angle_count - 1], row->last_velocity, 0);
    assert_shows(&ex, "linearised 2.614 N in 7 ms");
    press_shows(&ex, ":seek 0.1<Enter><Space>", "no predictor knows it");
}

static int chance(random_generator *r, int limit)
{
    return (int)random_below(r, (uint64_t)limit);
}

// A key to press at random: in two of three cases a printable character, else one of the
// list. Escape takes the place of what would take long or write a file: a command that
// begins with "s" like "save" ("set" may be entered), and x, which lengthens the run.
static int random_key(random_generator *r, const explorer *ex)
{
    static const int keys[] = {KEY_CODE_LEFT,
                               KEY_CODE_RIGHT,
                               KEY_CODE_UP,
                               KEY_CODE_DOWN,
                               KEY_CODE_HOME,
                               KEY_CODE_END,
                               KEY_CODE_PAGE_UP,
                               KEY_CODE_PAGE_DOWN,
                               KEY_CODE_TAB,
                               KEY_CODE_ESCAPE,
                               KEY_CODE_ENTER,
                               KEY_CODE_BACKSPACE,
                               KEY_CODE_F1,
                               KEY_CODE_DELETE,
                               0x3b8,
                               0};
    int key;
    if (chance(r, 3) > 0) {
        key = ' ' + chance(r, 95);
    } else {
        key = keys[chance(r, 16)];
    }

    const char *command = ex->input.prompt.text;
    const bool saves = ex->input.prompt.open && strncmp(command, "s", 1) == 0 &&
                       strncmp(command, "set ", 4) != 0;
    const bool is_long = ex->model.session.effective.parameters.run.duration > 3;
    if (saves || (is_long && key == 'x')) {
        return KEY_CODE_ESCAPE;
    }
    return key;
}

TEST(test_random_keys_do_no_harm)
{
    random_generator r = seeded(6);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (int i = 0; i < 4000; i++) {
        explorer_key(&ex, random_key(&r, &ex));
        ex.input.quit = false;

        // now and then time passes, the mouse clicks, and a screen of any size is drawn
        if (i % 7 == 0) {
            act_advance(&ex.model, &ex.view, &ex.input, random_uniform(&r));
            click_at(&ex, chance(&r, 130), chance(&r, 45));
            explorer_key(&ex, chance(&r, 2) ? KEY_CODE_DOWN : KEY_CODE_UP);
            free(picture(&ex, 1 + chance(&r, 160), 1 + chance(&r, 60),
                         (glyph_set)chance(&r, GLYPH_SETS)));
        }
    }

    // what was done can be saved, and gives the same run
    free(save_and_compare(&ex.model.session));
}

// The lab draws and takes keys while a long run is computed; what it shows in the end is
// what a lab that waits for its runs shows.
TEST(test_a_long_run_is_drawn_while_it_is_computed)
{
    SCOPED(explorer_finish) explorer ex;
    open_changed(&ex, "corrected/twenty-links", "run.duration=20", 0);
    assert_shows(&ex, "computing", "of 20 s (Esc stops)");
    press_shows(&ex, ":save never-written.csv<Enter>",
                "wait for its end, or stop it with Esc");
    press_shows(&ex, "b", "wait for its end, or stop it");
    press(&ex, "<Esc>");
    assert_null(ex.model.session.computing);
    assert_shows(&ex, "stopped at", "!computing");
    // Space at the end of the rows continues when there are more
    press(&ex, "<End><Space>");
    assert_true(ex.view.playback.playing);
    assert_shows(&ex, "computing");
    press(&ex, ":set run.duration 3<Enter>:stop<Enter>:set run.duration 4<Enter>");
    while (ex.model.session.computing != NULL) {
        act_advance(&ex.model, &ex.view, &ex.input, 0.01);
        explorer_follow(&ex);
        free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    }
    OPEN_EXPLORER(patient, "corrected/twenty-links");
    press(&patient, ":set run.duration 20<Enter>:set run.duration 3<Enter>:set "
                    "run.duration 4<Enter>");
    patient.view.playback.playing = ex.view.playback.playing = false;
    patient.view.playback.speed = ex.view.playback.speed;
    press(&ex, ":seek 2<Enter>");
    press(&patient, ":seek end<Enter>:seek 2<Enter>");
    free(picture(&patient, 150, 50, GLYPHS_BRAILLE));
    ex.model.session.seen = patient.model.session.seen;
    ex.model.session.base.parameters = patient.model.session.base.parameters;
    ex.model.session.input_count = patient.model.session.input_count = 0;
    KEPT_TEXT(one) = picture(&ex, 150, 50, GLYPHS_BRAILLE);
    KEPT_TEXT(other) = picture(&patient, 150, 50, GLYPHS_BRAILLE);
    assert_string_equal(one, other);
    ex.model.session.input_count = 0;
}

// Legends, values and what is subtracted from them are of one row: before an impact
// nothing has a force, and a run changed later equals the one before it on either side.
TEST(test_both_sides_of_an_impact_are_told_apart)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.5<Enter>b:set motor.voltage 2<Enter>:panes 1<Enter>I<Tab><Tab>");
    const sample before = *session_sample(&ex.model.session);
    press_shows(&ex, "<Right>",
                formatted("force %.4g ", session_sample(&ex.model.session)->force));
    check_close(session_sample(&ex.model.session)->time, before.time, 0);
    press_shows(&ex, "<Left>", "force 0 ", "hub_velocity             0.5851         0 ",
                "last_velocity            0.9001         0 ");
    press_shows(&ex, "<Right>", "hub_velocity             0.9061         0 ");

    // a mark keeps its side
    press_shows(&ex, "<Left>m<Right>", "last_velocity           -0.9056    -1.806 ");
}

// A mark before or after the run of 1 s is refused; with one at its very end a part of
// 0.1 us can be drawn.
TEST(test_marks_lie_in_the_run)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (EACH_TEXT(c, "1e9", "-1e300", "1.0001")) {
        press_text(&ex, ":mark %s<Enter>", *c);
        assert_shows(&ex, "the run goes from 0 to 1 s");
        assert_false(ex.view.mark.set);
    }
    press_shows(&ex, ":mark 1<Enter>", "mark set");
    press_draws(&ex, ":zoom 0.1 0.1000001<Enter>");
}

// Whatever number is typed at the prompt, each command refuses it or limits it to the
// range that exists, and the screen is drawn. The sanitizers of the build would report an
// overflow or an access outside of memory.
TEST(test_numbers_of_any_size_are_survived)
{
    static const char *const lines[] = {
        "step %s",        "seek %s",        "speed %s",        "slow %s",
        "mark %s",        "pan %s",         "drop %s",         "take %s",
        "hide %s",        "baseline %s",    "rename %s a",     "unpin %s",
        "rate %s",        "bending %s",     "trace %s",        "panes %s",
        "difference %s",  "difference off", "select %s",       "note @%s far",
        "limit force %s", "zoom %s 1",      "zoom 0 %s",       "axis 0 %s",
        "axis %s 1",      "axis 0 1 %s",    "signal force %s", "data rows.csv@%s",
        "residual force", "statistics",     "notes",           "zoom 0.1 0.1000001",
        "zoom all"};
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":save! rows.csv<Enter>");
    for (EACH_TEXT(number, "1e300", "-1e300", "1e9", "nan", "4294967297",
                   "-9223372036854775809", "1e-320", "0", "-1")) {
        press(&ex, ":seek 0.3<Enter>");
        for (EACH(line, lines)) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
            press(&ex, ":");
            press(&ex, formatted(*line, *number));
#pragma GCC diagnostic pop
            press_draws(&ex, "<Enter>");
            free(picture(&ex, 80, 24, GLYPHS_ASCII));
            press(&ex, "<Esc>");
        }
        press(&ex, "<Esc>:data off<Enter>:forget<Enter>");
    }
    unlink("rows.csv");
}
