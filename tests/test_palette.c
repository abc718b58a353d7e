// The palette: every entry is found by words, and does what it shows.
#include "tests/explorer_on_screen.h"

#include <glib.h>

TEST(test_words_find_things_of_every_kind)
{
    static palette_entry entries[PALETTE_ENTRIES];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<C-p>");
    static const struct {
        const char *words, *first;
        palette_kind kind;
    } cases[] = {{"branch", "branch", PALETTE_COMMAND},
                 {"motor.stiction", "motor.stiction", PALETTE_PARAMETER},
                 {"stic", "motor.stiction", PALETTE_PARAMETER},
                 {"energy_residual", "energy_residual", PALETTE_SIGNAL},
                 {"fig-3-4", "thesis/fig-3-4", PALETTE_SCENARIO}};
    for (EACH(c, cases)) {
        assert_true(palette_find(&ex.model, &ex.view, c->words, entries) > 0);
        const palette_text text = palette_describe(&ex.model, &ex.view, entries[0]);
        assert_string_equal(text.name, c->first);
        assert_int_equal(entries[0].kind, c->kind);
    }

    // words that stand only in what is said of a thing, in any order; and none
    assert_true(palette_find(&ex.model, &ex.view, "frict COULOMB", entries) > 0);
    assert_int_equal(palette_find(&ex.model, &ex.view, "no such thing at all", entries),
                     0);

    // all of it without words, each once: with the pin, the events and the help's topics
    press(&ex, "<Esc><End>b<C-p>");
    int topics = 0;
    for (int i = 0; i < explorer_command_count; i++) {
        topics += explorer_command_table[i].group[0] != '\0';
    }
    const int all = palette_find(&ex.model, &ex.view, "", entries);
    assert_int_equal(all, explorer_command_count + parameter_count + signal_count +
                              summary_count + ex.view.scenarios.count + 1 +
                              (int)ex.model.session.run.trace.event_count + topics);
}

// Runs, events, files and topics of the help are found and do what they are for.
TEST_IN_FOLDER(runs_events_files_and_topics_are_found)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":save bench.csv<Enter><End>");
    press(&ex, ":pin weak wall<Enter>:set motor.voltage 2<Enter><C-p>weak wall<Enter>");
    check_close(value_of(&ex, PARAMETER_INDEX(motor.voltage)), 1, 0);
    press(&ex, "<End><C-p>release<Enter>");
    const event *there = session_event(&ex.model.session);
    assert_non_null(there);
    press_shows(&ex, "<C-p>Lessons<Enter>", "keys and commands /Lessons", ":answer",
                "!:branch");

    // a file lies under the run, and its command is played, by three keys besides its
    // name; a path from elsewhere is taken as it is typed
    press(&ex, "<Esc><Esc><C-p>bench.csv<Enter>");
    assert_true(ex.model.measured.row_count > 0);
    press(&ex, ":data off<Enter>:open compare/hybrid<Enter>:save law.csv<Enter>"
               ":open corrected/first-impact<Enter>");
    g_autofree char *path = g_canonicalize_filename("law.csv", NULL);
    press_text(&ex, "<C-p>%s<Down><Enter>", path);
    assert_int_equal(ex.model.session.effective.parameters.control.law, LAW_PLAYBACK);

    // one undo takes all of that back, one redo puts it in again
    press(&ex, "u");
    assert_int_equal(ex.model.session.effective.parameters.control.law, LAW_NONE);
    assert_string_equal(ex.model.session.effective.parameters.control.playback_file, "");
    press(&ex, "U");
    assert_int_equal(ex.model.session.effective.parameters.control.law, LAW_PLAYBACK);
}

// Words of other programs find what is meant: in the palette, in the help and as the
// number that they name.
TEST(test_other_words_find_what_is_meant)
{
    static palette_entry entries[PALETTE_ENTRIES];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<C-p>");
    static const struct {
        const char *word, *meant;
    } cases[] = {{"figure", "save"},
                 {"overshoot", "force_over_command_N"},
                 {"settling", "settling_time_s"},
                 {"history", "changes"},
                 {"undo", "undo"},
                 {"fft", "spectrum"}};
    for (EACH(c, cases)) {
        const int count = palette_find(&ex.model, &ex.view, c->word, entries);
        bool found = false;
        for (int i = 0; i < count && i < 12; i++) {
            const palette_text text = palette_describe(&ex.model, &ex.view, entries[i]);
            found = found || strcmp(text.name, c->meant) == 0;
        }
        fail_if(!found, "'%s' does not find %s", c->word, c->meant);
    }
    press_shows(&ex, "<Esc>?/figure<Enter>", ":save", "!:undo");

    // a quantity tells its value
    press(&ex, "<Esc><Esc><C-p>peak_force_N<Enter>");
    double value = 0;
    assert_int_equal(sscanf(ex.input.message.text, "peak_force_N = %lf N", &value), 1);
    check_close(value, peak(&ex), 1e-4);
    press_warns(&ex, ":quantity nosuch<Enter>", "no number");
}

TEST(test_enter_does_what_the_entry_is_for)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");

    // a parameter opens the prompt for its value, which typing replaces
    press_prompts(&ex, ":seek 0.2<Enter><C-p>stiction<Enter>",
                  "set motor.stiction 0.045");
    press(&ex, "0.01<Enter>");
    const parameters p = model_parameters(&ex.model);
    check_close(p.motor.stiction, 0.01, 0);

    // a command that takes something waits for it, another is carried out
    press_prompts(&ex, "<C-p>seek<Enter>", "seek ");
    press(&ex, "0.1<Enter>");
    check_close(ex.model.session.now, 0.1, 1e-12);
    press(&ex, "<C-p>branch<Enter>");
    assert_true(ex.model.session.has_other);

    // a signal gets a pane, a scenario opens
    press(&ex, "<C-p>energy_residual<Enter>");
    assert_int_equal(ex.view.panes.pane[PANES_OF_TABLE].signals[0],
                     SIGNAL_INDEX(energy_residual));
    press_opens(&ex, "<C-p>fig-3-4<Enter>", "thesis/fig-3-4");
}

TEST(test_the_prompt_has_it_too)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":bra", ":branch", "pin this run");

    // nothing is selected until Down is pressed, Up leaves the list again
    press(&ex, "<Down>");
    assert_int_equal(ex.view.palette.selected, 0);
    press(&ex, "<Up>");
    assert_int_equal(ex.view.palette.selected, -1);
    press(&ex, "<Down><Enter>");
    assert_true(ex.model.session.has_other);

    // the input continues as words
    press_prompts(&ex, ":voltage_limit<C-p><Enter>", "set motor.voltage_limit 10");
    press(&ex, "<Esc>");
    assert_false(ex.input.prompt.open);
}

TEST(test_a_click_takes_an_entry)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<C-p>forget");
    free(picture(&ex, 100, 30, GLYPHS_BRAILLE));
    for (int i = 0; i < ex.layout.hit_count; i++) {
        const hit_area h = ex.layout.hits[i];
        if (h.panel == PANEL_PALETTE && h.part == PART_LINES) {
            const pointer_event down = {POINTER_PRESS, h.area.x + 3, h.area.y, false,
                                        false};
            explorer_point(&ex, down);
        }
    }
    assert_false(ex.input.prompt.open);
}
