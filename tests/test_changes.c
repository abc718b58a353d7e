// What the explorer must never do: change something that was not requested, lose
// something, or leave one in the dark about what has an effect and when.
#include "tests/explorer_on_screen.h"

TEST(test_typing_replaces_the_value)
{
    const int voltage = PARAMETER_INDEX(motor.voltage);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.2<Enter><Enter>0.5<Enter>");
    check_close(value_of(&ex, voltage), 0.5, 0);

    // Right keeps it and continues after it
    press(&ex, "<Enter><Right>5<Enter>");
    check_close(value_of(&ex, voltage), 0.55, 1e-15);

    // C-u clears the value only, then the line
    press_prompts(&ex, "<Enter><Right><C-u>", "set motor.voltage ");
    press(&ex, "<C-u>");
    assert_string_equal(ex.input.prompt.text, "");
    press(&ex, "<Esc><Enter><Backspace>2<Enter>");
    check_close(value_of(&ex, voltage), 2, 0);

    // more than the amplifier gets is said
    press_shows(&ex, "<Enter>20<Enter>", "the command saturates at 10 V");
    assert_true(ex.input.message.warning);
}

// Time [s] of the first event of a kind at or after an instant; fails if there is none.
static double event_after(const explorer *ex, event_kind kind, double time)
{
    const trace *t = &ex->model.session.run.trace;
    for (EACH_EVENT(e, t)) {
        if (e->kind == kind && e->time >= time) {
            return e->time;
        }
    }
    fail_msg("no such event");
    return 0;
}

static void change_before_contact(const char *name, const char *setting)
{
    OPEN_EXPLORER(ex, name);
    press(&ex, "<End>II");
    const session *s = &ex.model.session;
    const double instant = s->now;
    const size_t row = s->row;
    assert_int_equal(session_sample(s)->contact, 0);
    const double touched = event_after(&ex, EVENT_IMPACT, instant);
    press_text(&ex, ":set %s<Enter>", setting);

    // from the row shown on, before what comes; the cursor stays in free flight
    const double changed = event_after(&ex, EVENT_CHANGE, 0);
    const double touches = event_after(&ex, EVENT_IMPACT, changed);
    assert_true(changed <= instant && changed > instant - 1e-6);
    assert_true(touches > changed);
    check_close(touches, touched, 1e-6);
    assert_int_equal(session_sample(s)->contact, 0);
    check_close(s->now, instant, 1e-6);

    // undoing leads back to that very row
    press(&ex, ":seek 0.1<Enter>u");
    assert_int_equal(s->row, row);
    check_close(s->now, instant, 0);
    press(&ex, "U");
    check_close(s->now, changed, 1e-12);
}

TEST(test_a_change_comes_before_the_contact_it_was_made_before)
{
    change_before_contact("corrected/first-impact", "motor.voltage 0.5");
    change_before_contact("corrected/restitution", "wall.restitution 0.1");
    change_before_contact("corrected/five-links", "motor.voltage 0.5");
    change_before_contact("compare/hybrid", "control.lock approach");
}

TEST(test_what_has_no_effect_says_why)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    assert_int_equal(ex.view.parameters.parameter, PARAMETER_INDEX(control.force));
    press_shows(&ex, ":set motor.voltage 2<Enter>",
                "without effect: the control law commands the voltage");
    assert_true(ex.input.message.warning);
    press_shows(&ex, ":set<Enter>",
                "set takes a parameter and a value, such as arm.k2 10");
    press_shows(&ex, ":set sensor.film_gain<Enter>",
                "no piezo film is fitted (sensor.film)");
    press(&ex, ":open corrected/first-impact<Enter>");
    assert_int_equal(ex.view.parameters.parameter, PARAMETER_INDEX(motor.voltage));
    assert_null(model_inert_reason(&ex.model, PARAMETER_INDEX(motor.voltage)));
    press_shows(&ex, ":set printed.newton_iterations<Enter>",
                "it belongs to arm.model = printed");

    // a parameter that is called inert is: the run is the same to the last bit
    press(&ex, ":seek end<Enter>");
    const double end = session_sample(&ex.model.session)->hub_angle;
    press(&ex, ":set printed.newton_iterations 5<Enter>:set control.kp 3<Enter>:set "
               "arm.k1 100<Enter>:seek end<Enter>");
    check_close(session_sample(&ex.model.session)->hub_angle, end, 0);
}

// A parameter is called inert (without effect) exactly where nothing depends on it. One
// link has no spring k2 between links, but a beam at the hub uses it, and a spring at the
// hub has damping. The motor of the scenario is driven by a voltage: its current is
// limited, and there is no transconductance.
TEST(test_inert_is_what_has_no_effect)
{
    const struct {
        const char *lines;
        int parameter;
        bool inert;
    } cases[] = {{":set arm.links 1<Enter>", PARAMETER_INDEX(arm.k2), true},
                 {":set arm.links 1<Enter>", PARAMETER_INDEX(arm.damping_ratio), true},
                 {":set arm.links 1<Enter>:set arm.hub_joint spring<Enter>",
                  PARAMETER_INDEX(arm.k2), true},
                 {":set arm.links 1<Enter>:set arm.hub_joint spring<Enter>",
                  PARAMETER_INDEX(arm.damping_ratio), false},
                 {":set arm.links 1<Enter>:set arm.hub_joint beam<Enter>",
                  PARAMETER_INDEX(arm.k2), false},
                 {"", PARAMETER_INDEX(motor.current_limit), false},
                 {"", PARAMETER_INDEX(motor.transconductance), true}};
    for (EACH(c, cases)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, c->lines);
        assert_int_equal(model_inert_reason(&ex.model, c->parameter) != NULL, c->inert);
    }
}

// Under a control law the setting motor.voltage has no effect: the law commands 1 V in
// the approach. After the parameter is set to 0 the predictions at the next impact (key
// i) are those of the row's voltage of 1 V.
TEST(test_predictors_take_the_voltage_in_force)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":set motor.voltage 0<Enter>i");
    const session *s = &ex.model.session;
    const sample *row = session_sample(s);
    parameters p = session_parameters_at(s, s->now);
    check_close(row->voltage, 1, 0.01);
    p.motor.voltage = row->voltage;
    const three_body_state bodies = {{row->hub_angle, row->first_angle, row->last_angle},
                                     {row->hub_velocity, row->first_velocity,
                                      row->last_velocity}};
    const prediction_question question = {.parameters = &p, .bodies = bodies};
    const prediction_answer answer = predict_with(PREDICTOR_IMPACT_DYNAMICS, &question);
    assert_true(answer.prediction.holds);
    assert_shows(&ex, formatted("impact dynamics %.3f N in %.0f ms",
                                answer.prediction.force, 1e3 * answer.prediction.delay));
}

// The first two predictors know two links only, and none knows the printed model's arm
// linearised: those that know nothing are not named.
TEST(test_predictors_that_know_nothing_are_silent)
{
    OPEN_EXPLORER(ex, "corrected/five-links");
    press_shows(&ex, "i", "linearised 2.614 N");
    press_shows(&ex, ":set arm.links 2<Enter>i", "energy 1.25", "impact dynamics 1.66");
    OPEN_EXPLORER(printed, "thesis/fig-3-4");
    press_shows(&printed, "i", "energy ", "!linearised");
}

TEST(test_values_that_have_no_room_are_cut_visibly)
{
    OPEN_EXPLORER(springs, "corrected/known-springs");
    press_shows(&springs, "/link_lengths<Enter>", "0.3, 0.25, 0.25, 0.2");
    assert_shows_at(&springs, 80, 24, "link_lengths  0.3, 0.25, 0..");

    // a word is shown in whole where there is room
    OPEN_EXPLORER(word, "compare/inverse-dynamics");
    press(&word, "/law<Enter>");
    assert_shows_at(&word, 80, 24, "law          inverse-dynamics");

    // the cut lies between characters, not bytes, and the value stays right-aligned
    OPEN_EXPLORER(ex, "compare/inverse-dynamics");
    press(&ex, ":set control.command ./xééééééééééééééééééé<Enter>/command<Enter>");
    assert_shows_at(&ex, 80, 24, "command  ./xééééééééééééééé.. │");
}

TEST(test_changes_to_come_are_seen_edited_and_dropped)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":seek 0.5<Enter>:set motor.voltage 2<Enter>:seek 0.7<Enter>p<Home>",
                "\u25cf 2 changes, \u25cb 2 later");
    press_shows(&ex, ":changes<Enter>", "1 \u25cb   0.50000 s     motor.voltage = 2 V",
                "2 \u25cb   0.70000 s     push 0.01 N s");

    // the push goes, and comes back
    press(&ex, "d");
    assert_int_equal(ex.model.session.input_count, 1);
    press(&ex, "U");
    assert_int_equal(ex.model.session.input_count, 2);

    // another value at the same instant, which undoing takes back
    press(&ex, "k<Enter>3<Enter><Esc>");
    check_close(session_parameters_at(&ex.model.session, 0.5).motor.voltage, 3, 0);
    check_close(session_parameters_at(&ex.model.session, 0.49).motor.voltage, 1, 0);
    check_close(ex.model.session.now, 0.7, 1e-15);
    press(&ex, "u");
    check_close(session_parameters_at(&ex.model.session, 0.5).motor.voltage, 2, 0);
    press(&ex, ":drop 1<Enter>");
    check_close(session_parameters_at(&ex.model.session, 0.5).motor.voltage, 1, 0);
    press_warns(&ex, ":drop 7<Enter>", "");
}

TEST(test_nudges_are_one_change_and_reversible)
{
    const int voltage = PARAMETER_INDEX(motor.voltage);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.2<Enter><lt>");
    check_close(value_of(&ex, voltage), 0.9, 1e-15);
    press(&ex, "<lt><lt>");
    check_close(value_of(&ex, voltage), 0.7, 1e-15);
    assert_int_equal(ex.model.session.input_count, 1);
    press(&ex, "u");
    check_close(value_of(&ex, voltage), 1, 0);
    press(&ex, "<lt>>");
    check_close(value_of(&ex, voltage), 1, 0);
    assert_int_equal(ex.model.session.input_count, 0);

    // for any number, the same number of steps back leads to the former value
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const double before = value_of(&ex, i);
        const bool leaves =
            strncmp(info->path, "run.", 4) == 0 || strncmp(info->path, "method.", 7) == 0;
        if (info->type != PARAMETER_REAL || leaves || !(before > info->minimum)) {
            continue;
        }
        ex.view.parameters.parameter = i;
        press(&ex, "<lt><lt><lt>>>>");
        fail_if(fabs(value_of(&ex, i) - before) > 1e-5 * fabs(before),
                "%s: %.17g and then %.17g", info->path, before, value_of(&ex, i));
    }
}

TEST_IN_FOLDER(test_saving_never_replaces_a_file_unasked)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":save run.csv<Enter>", formatted("saved %s/run.csv", test_folder));
    assert_false(explorer_carry_out(&ex, "save run.csv"));
    assert_non_null(strstr(ex.input.message.text, "is there already"));
    assert_true(explorer_carry_out(&ex, "save! run.csv"));

    // names that are proposed say what changed, and count
    press_prompts(&ex, ":seek 0.2<Enter>:set motor.voltage 0.5<Enter>s",
                  "save first-impact-voltage-0.5.png");
    press_prompts(&ex, "<Enter>s", "save first-impact-voltage-0.5-2.png");
    press(&ex, "<Esc>");
    assert_true(access("run.csv", F_OK) == 0 &&
                access("first-impact-voltage-0.5.png", F_OK) == 0);
}

TEST(test_everything_that_is_listed_can_be_filtered)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "/stic", "parameters /stic", "stiction", "!amplifier_gain");

    // Enter continues with the selection
    press_prompts(&ex, "<Enter>", "set motor.stiction 0.045");
    press_shows(&ex, "<Esc><Esc>", "stiction", "!parameters /");
    press_shows(&ex, "<Tab><Tab>/loss<Enter>", "friction_loss", "!hub_acceleration");
    press_shows(&ex, "<Esc>", "hub_acceleration");
    press_shows(&ex, "?/scenario<Enter>", ":open", "!:zoom");
    press(&ex, "<Esc><Esc>");

    // a filtered list of scenarios opens at once
    press_opens(&ex, "o/five<Enter>", "corrected/five-links");
}

TEST(test_a_group_is_found_by_its_name)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "/motor.amp", "amplifier_gain", "!coulomb");
    press_shows(&ex, "<Esc>:set film_gain<Enter>", "film_gain");
}

TEST(test_values_and_last_parts_are_completed_in_turn)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":set wall.kind p<Tab>", "point plane");
    press_prompts(&ex, "<Tab>", "set wall.kind point");
    press_prompts(&ex, "<Tab>", "set wall.kind plane");
    press_prompts(&ex, "<Tab>", "set wall.kind point");
    press_prompts(&ex, "<C-u>set stic<Tab>", "set motor.stiction ");
    press(&ex, "0.01<Enter>:set resti 0.5<Enter>");
    check_close(ex.model.session.effective.parameters.motor.stiction, 0.01, 0);
    check_close(ex.model.session.effective.parameters.wall.restitution, 0.5, 0);
    press_prompts(&ex, ":open three<Tab>", "open corrected/three-links ");
    press_prompts(&ex, "<C-u>theme l<Tab>", "theme light ");
}

TEST(test_descriptions_are_shown)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_shows(&ex, ":info<Enter>", "The thesis's three modes with");

    // the list of what can be opened has the present one selected, and words narrow it
    press_shows(&ex, "<Esc>o", "Hybrid, corrected coefficients");
    press(&ex, "<Down><Up><Enter>");
    assert_string_equal(ex.model.session.base.name, "compare/hybrid");
    press_shows(&ex, "otwenty", "corrected/twenty-links", "!compare/hybrid-printed");
    press(&ex, "<Enter>");
    assert_string_equal(ex.model.session.base.name, "corrected/twenty-links");
    press_shows(&ex, ":lesson<Enter>", "lessons/step-size", "!compare/touch");
    press(&ex, "<PgDn><Enter>");
    assert_true(ex.model.lesson.on);
}

TEST(test_leaving_asks_if_changes_would_be_lost)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_quits(&ex, ":seek 0.2<Enter><lt>q", false);
    assert_shows(&ex, "1 change would be lost");
    press_quits(&ex, "<Right>q", false);
    press_quits(&ex, "q", true);
    ex.input.quit = false;
    press_quits(&ex, "<C-c>", false);
    press_quits(&ex, "<C-c>", true);
    ex.input.quit = false;
    press_quits(&ex, "u<C-c>", true);
}

TEST(test_an_interrupt_stops_a_computation_first)
{
    SCOPED(explorer_finish) explorer ex;
    open_changed(&ex, "corrected/twenty-links", "run.duration=20", 0);
    assert_non_null(ex.model.session.computing);
    press(&ex, "<C-c>");
    assert_null(ex.model.session.computing);
    assert_false(ex.input.quit);
    press_quits(&ex, "<C-c>", true);
}

// The numbers of the panes that are shown on a screen of 120 columns.
static void assert_panes(explorer *ex, int height, const char *wanted)
{
    char shown[PANES + 1] = "";
    free(picture(ex, 120, height, GLYPHS_BRAILLE));
    for (int i = 0, n = 0; i < PANES; i++) {
        if (ex->view.panes.pane[i].shown) {
            shown[n++] = (char)('0' + (i + 1) % 10);
            shown[n] = '\0';
        }
    }
    assert_string_equal(shown, wanted);
}

TEST(test_panes_follow_scenario_and_height)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_panes(&ex, 24, "14");
    assert_panes(&ex, 60, "1234");
    press(&ex, ":open thesis/fig-3-2<Enter>");
    assert_panes(&ex, 24, "123");
    press(&ex, ":open thesis/fig-3-5<Enter>");
    assert_panes(&ex, 24, "140");
    press(&ex, ":open thesis/fig-5-5<Enter>");
    assert_panes(&ex, 24, "135");

    // what the user chose stays
    press(&ex, "7");
    assert_panes(&ex, 60, "1357");
    press(&ex, ":open corrected/first-impact<Enter>");
    assert_panes(&ex, 24, "1357");
}

TEST(test_setpoints_and_limits_are_lines)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    assert_shows(&ex, "!\u2508force_limit", "\u2508command");
    press_shows(
        &ex,
        ":open compare/touch<Enter>:axis 0 2 1<Enter>:set control.force_limit 1.5<Enter>",
        "\u2508force_limit");
    press(&ex, "u");
    press_opens(&ex, "u", "compare/hybrid");
    press_shows(&ex, ":axis -12 12 5<Enter>", "\u2508voltage_limit");
    press_shows(&ex, ":open corrected/first-impact<Enter>2", "\u2508angle",
                "!\u2508force");
}

TEST(test_ticks_are_even_and_names_whole)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.35<Enter>");

    // the force's axis in three rows: no tick is left out between two others
    assert_shows_at(&ex, 80, 24, "!rad/s\u2524");
    press(&ex, ":law off<Enter>");
    KEPT_TEXT(text) = picture(&ex, 80, 24, GLYPHS_BRAILLE);
    assert_false(strstr(text, "1.2\u2524") && strstr(text, "0.8\u2524") &&
                 !strstr(text, "0.4\u2524"));
    press_shows(&ex, "<Tab><Tab>", "first_acceleration", "\u25c6 contact point");

    // keys reach the last value
    assert_shows_at(&ex, 120, 30, "!energy_residual");
    for (int i = 0; i < 60; i++) {
        press(&ex, "j");
    }
    assert_shows_at(&ex, 120, 30, "energy_residual");
}

// The head of the arrow stands in the column of its shaft, wherever the tip is.
TEST(test_the_arrow_has_its_head_on)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.65<Enter>");
    for (int width = 90; width < 160; width++) {
        SCOPED(screen_finish) screen s = {0};
        screen_resize(&s, width, 40);
        explorer_draw(&ex, &s);
        int heads = 0;
        for (int i = width; i < width * 20; i++) {
            if (s.cells[i].glyph == 0x25bc && s.cells[i].ink == INK_FORCE) {
                const uint32_t above = s.cells[i - width].glyph;
                assert_true(above > 0x2800 && above < 0x2900);
                heads++;
            }
        }
        assert_int_equal(heads, width < 110 ? 1 : 2); // the tip from near by, too
    }
}

TEST(test_a_filter_selects_what_has_an_effect)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    // motor.transconductance stands before control.transition_time, but the drive has
    // none
    press_shows(&ex, "/trans<Enter>", ":set control.transition_time");
}
