// What the lab's screens answer at a glance, at four sizes: how hard each run hits, how
// far that is from the reference, and which few values a run is about.
#include "tests/explorer_on_screen.h"

#include <unistd.h>

static const int four_sizes[][2] = {{80, 24}, {100, 30}, {120, 40}, {200, 60}};

// A text is in one of the first ten lines of the screen at every size.
static void assert_at_top(explorer *ex, const char *wanted)
{
    enum { LINES = 10 };
    for (EACH(size, four_sizes)) {
        KEPT_TEXT(text) = picture(ex, (*size)[0], (*size)[1], GLYPHS_BRAILLE);
        char *end = text;
        for (int i = 0; i < LINES && *end != '\0'; i++) {
            end += strcspn(end, "\n") + 1;
        }
        *end = '\0';
        fail_if(strstr(text, wanted) == NULL, "'%s' is not in the first lines of:\n%s",
                wanted, text);
    }
}

// The peak and the impulse of a run are there, and, unless they are NaN, their
// differences from a reference.
static void assert_results(explorer *ex, double peak, double impulse, double from_peak,
                           double from_impulse)
{
    assert_at_top(ex, "peak N");
    assert_at_top(ex, "impulse N s");
    assert_at_top(ex, formatted(" %.4g ", peak));
    assert_at_top(ex, formatted(" %.4g ", impulse));
    if (!isnan(from_peak)) {
        assert_at_top(ex, formatted("%+.3g", peak - from_peak));
    }
    if (!isnan(from_impulse)) {
        assert_at_top(ex, formatted("%+.3g", impulse - from_impulse));
    }
}

// The summary of a shipped scenario with another value ("" for none), by a run without
// the lab.
static summary summary_with(const char *name, const char *change)
{
    KEPT_SCENARIO(s) = shipped_with(name, change);
    KEPT_RUN(run);
    assert_int_equal(run_scenario(&s, false, &run), STATUS_OK);
    return run.summary;
}

TEST(the_first_screen_says_how_hard_it_hits)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const summary m = summary_with("corrected/first-impact", "");
    const double none = (double)NAN;
    assert_results(&ex, m.peak_force_N, m.contact_impulse_Ns, none, none);
    assert_at_top(&ex, "as opened");
    assert_at_top(&ex, "hits at 0.743 m/s");
}

// Watching, then half the voltage: five keys, the value's own digits included.
TEST(a_change_stands_beside_the_run_as_opened)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const summary before = summary_with("corrected/first-impact", "");
    const summary after = summary_with("corrected/first-impact", "motor.voltage=0.5");
    press(&ex, "<Enter>0.5<Enter>");
    assert_results(&ex, after.peak_force_N, after.contact_impulse_Ns, before.peak_force_N,
                   before.contact_impulse_Ns);
    assert_at_top(&ex, "ref");

    // both curves are there, each with a colour of its own; undone there is one again
    assert_int_equal(model_run_count(&ex.model), 2);
    assert_true(run_ink(1) != run_ink(2));
    press(&ex, "u");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    assert_int_equal(model_run_count(&ex.model), 1);
    assert_false(ex.model.session.has_other);
}

// b keeps further runs: the run as opened stays in the strip, and is the reference again
// once they are dropped.
TEST(the_run_as_opened_stays_beside_pinned_runs)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set arm.k2 4<Enter>b:set arm.k2 6<Enter>b:set motor.voltage 2<Enter>b"
               ":set motor.voltage 3<Enter>");
    const double kept = ex.model.pinned.runs[2].run.summary.peak_force_N;
    const summary *m = &ex.model.session.run.summary;
    assert_results(&ex, m->peak_force_N, m->contact_impulse_Ns, kept, (double)NAN);
    assert_int_equal(model_run_count(&ex.model), 5);
    assert_shows(&ex, "as opened", "k2 4", "k2 6", "voltage 2", "voltage 3");
    press(&ex, "BBB");
    assert_string_equal(model_reference_name(&ex.model), "as opened");
    check_close(ex.model.session.other.summary.peak_force_N,
                summary_with("corrected/first-impact", "").peak_force_N, 0);
}

// Where a part of a panel is on a screen of some size, no width if nowhere.
static area part_at(explorer *ex, int width, int height, panel_id id, hit_part part)
{
    free(picture(ex, width, height, GLYPHS_BRAILLE));
    for (int i = 0; i < ex->layout.hit_count; i++) {
        const hit_area *h = &ex->layout.hits[i];
        if (h->panel == id && h->part == part) {
            return h->area;
        }
    }
    return (area){0};
}

// How often a text is in another one.
static int count_in(const char *text, const char *wanted)
{
    int count = 0;
    while ((text = strstr(text, wanted)) != NULL) {
        count++;
        text++;
    }
    return count;
}

// A run that was kept has one row until something changes, however it was named.
TEST(a_kept_run_has_one_row)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set motor.voltage 0.5<Enter>:pin half<Enter><Esc>");
    KEPT_TEXT(text) = picture(&ex, 120, 40, GLYPHS_BRAILLE);
    assert_int_equal(count_in(text, formatted("  %.4g ", peak(&ex))), 1);
    assert_at_top(&ex, "half");
    assert_at_top(&ex, "ref");

    // the row of the next one is there already
    const area curves = part_at(&ex, 120, 40, PANEL_CURVES, PART_BODY);
    press(&ex, ":set motor.voltage 0.6<Enter><Esc>");
    assert_at_top(&ex, "voltage 0.6");
    assert_at_top(&ex, "half");
    assert_int_equal(part_at(&ex, 120, 40, PANEL_CURVES, PART_BODY).y, curves.y);
}

// On a tall screen the knobs end with the arm and the curves have the whole width, unless
// the side has more to show.
TEST(curves_have_the_width_of_a_tall_screen)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_true(part_at(&ex, 200, 60, PANEL_CURVES, PART_BODY).width > 180);
    assert_true(part_at(&ex, 120, 40, PANEL_CURVES, PART_BODY).width < 80);
    assert_shows_at(&ex, 200, 60, "touching now would bring");
    for (int i = 0; i < ex.view.parameters.knob_count; i++) {
        assert_shows_at(&ex, 200, 60, parameter_table[ex.view.parameters.knobs[i]].path);
    }
    press(&ex, "<Tab>");
    assert_true(part_at(&ex, 200, 60, PANEL_CURVES, PART_BODY).width < 140);
}

// Of a map with more lines than there is room for those about the selected run are drawn,
// and a click takes what it points at.
TEST(a_map_of_many_lines_is_drawn_in_part)
{
    enum { ACROSS = 3, UP = 20 };
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex,
          ":set run.duration 0.4<Enter>:sweep arm.k2=4:6:3 motor.voltage=1:2:20<Enter>");
    while (!lab_sweep_is_done(&ex.model.sweep)) {
        explorer_follow(&ex);
    }
    const area low = part_at(&ex, 80, 24, PANEL_SWEEP, PART_CELLS);
    assert_true(low.height > 4 && low.height < UP);
    click_at(&ex, low.x, low.y);
    assert_int_equal(ex.model.sweep.selected, (low.height - 1) * ACROSS);

    // from the last run the first line is seen
    act_select_swept(&ex.model, ACROSS * UP - 1 - ex.model.sweep.selected);
    const area high = part_at(&ex, 80, 24, PANEL_SWEEP, PART_CELLS);
    click_at(&ex, high.x, high.y);
    assert_int_equal(ex.model.sweep.selected, (UP - 1) * ACROSS);
}

// With five runs the strip has as many as there is room for, on each screen the present
// one and the reference with their differences; tall ones have all.
TEST(five_runs_stand_side_by_side)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set arm.k2 4<Enter>b:set arm.k2 6<Enter>b:set motor.voltage 2<Enter>b"
               ":set motor.voltage 3<Enter><End>");
    const summary *m = &ex.model.session.run.summary,
                  *r = &ex.model.session.other.summary;
    assert_int_equal(model_run_count(&ex.model), 5);
    assert_results(&ex, m->peak_force_N, m->contact_impulse_Ns, r->peak_force_N,
                   r->contact_impulse_Ns);
    assert_shows_at(&ex, 80, 24, "2 more: R");
    for (EACH_TEXT(name, "as opened", "k2 4", "k2 6", "voltage 2", "voltage 3")) {
        assert_shows_at(&ex, 120, 40, *name);
        assert_shows_at(&ex, 200, 60, *name);
    }

    // the force keeps its rows, but for one that the smallest strip has for a third run
    const int rows[] = {6, 7, 12, 12};
    for (int i = 0; i < 4; i++) {
        free(picture(&ex, four_sizes[i][0], four_sizes[i][1], GLYPHS_BRAILLE));
        int height = 0;
        for (int k = 0; k < ex.layout.hit_count; k++) {
            const hit_area *h = &ex.layout.hits[k];
            if (h->panel == PANEL_CURVES && h->part == PART_PANE && h->index == 0) {
                height = h->area.height + 1; // and its title
            }
        }
        assert_true(height >= rows[i]);
    }
}

// A message of several lines covers what is below it and moves nothing.
TEST(a_long_message_moves_nothing)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.2<Enter>");
    KEPT_TEXT(before) = picture(&ex, 80, 24, GLYPHS_BRAILLE);
    memset(ex.input.message.text, 'x', 150);
    memcpy(ex.input.message.text + 70, " y ", 3);
    KEPT_TEXT(after) = picture(&ex, 80, 24, GLYPHS_BRAILLE);
    const char *one = before, *other = after;
    int different = 0;
    for (int row = 0; row < 24; row++) {
        const size_t length = strcspn(one, "\n"), wide = strcspn(other, "\n");
        if (length != wide || strncmp(one, other, length) != 0) {
            assert_in_range(row, 21, 22);
            different++;
        }
        one += length + 1;
        other += wide + 1;
    }
    assert_int_equal(different, 2);
}

// A click on a hint does what it says.
TEST(hints_are_clicked)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.2<Enter><Esc>");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    const int help = explorer_command_find("help");
    for (int i = 0; i < ex.layout.hit_count; i++) {
        const hit_area h = ex.layout.hits[i];
        if (h.part == PART_HINT && h.index == help && h.area.width > 0) {
            click_at(&ex, h.area.x + 1, h.area.y);
            break;
        }
    }
    assert_int_equal(ex.view.page, PANEL_HELP);
}

// Another scenario has a reference of its own; on return to a changed one that is back.
TEST(every_scenario_has_its_own_reference)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set motor.voltage 0.5<Enter>:open compare/hybrid<Enter>");
    assert_false(ex.model.session.has_other);
    press(&ex, ":set control.force 2<Enter>");
    check_close(ex.model.session.other.summary.peak_force_N,
                summary_with("compare/hybrid", "").peak_force_N, 0);
    press(&ex, "uu");
    assert_string_equal(ex.model.session.base.name, "corrected/first-impact");
    assert_int_equal(ex.model.session.input_count, 1);
    check_close(ex.model.session.other.summary.peak_force_N,
                summary_with("corrected/first-impact", "").peak_force_N, 0);
}

// With a law overshoot and settling stand there, too, and no reading's spike of 6 N sets
// the range of a force of 1.77 N.
TEST(a_law_is_told_by_overshoot_and_settling)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    const summary m = summary_with("compare/hybrid", "");
    press(&ex, ":seek 0.4<Enter>");
    assert_results(&ex, m.peak_force_N, m.contact_impulse_Ns, (double)NAN, (double)NAN);
    assert_at_top(&ex, formatted(" %.4g ", m.force_overshoot_percent));
    assert_at_top(&ex, formatted(" %.4g", m.settling_time_s));
    assert_shows(&ex, "\u2508command", "44.3 mN s\u2191");
    value_range force;
    assert_true(view_pane_axis(&ex.model, &ex.view, 0, &force));
    check_below(force.high, 2);
}

// Nor does that of a recording in which the force itself stands, too.
TEST_IN_FOLDER(a_recorded_spike_is_no_range)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":save bench.csv<Enter>:data bench.csv<Enter>");
    value_range force;
    assert_true(view_pane_axis(&ex.model, &ex.view, 0, &force));
    check_below(force.high, 2);

    // a knob that another law leaves without effect goes, selected or not
    press(&ex, ":data off<Enter>:open corrected/first-impact<Enter>"
               ":set control.law hybrid<Enter>");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    assert_null(model_inert_reason(&ex.model, ex.view.parameters.parameter));
}

// Of a chain on a rigid wall the largest force has no limit as links are added: the strip
// says what a sensor reads.
TEST(a_chain_is_told_by_what_a_sensor_reads)
{
    OPEN_EXPLORER(ex, "corrected/five-links");
    const summary m = summary_with("corrected/five-links", "");
    assert_at_top(&ex, "peak N of 1 ms");
    assert_at_top(&ex, formatted(" %.4g ", m.sensor_1ms_peak_N));
    press(&ex, ":set wall.contact kelvin-voigt<Enter>");
    assert_at_top(&ex, "peak N  ");
}

TEST_IN_FOLDER(data_and_maps_leave_the_results_in_place)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const summary m = summary_with("corrected/first-impact", "");
    press(&ex, ":save bench.csv<Enter>:data bench.csv<Enter>");
    assert_results(&ex, m.peak_force_N, m.contact_impulse_Ns, (double)NAN, (double)NAN);
    assert_at_top(&ex, "bench.csv");
    press(&ex, ":data off<Enter>:sweep arm.k2=4:6:3 motor.voltage=1:2:2<Enter>");
    while (!lab_sweep_is_done(&ex.model.sweep)) {
        explorer_follow(&ex);
    }
    assert_results(&ex, m.peak_force_N, m.contact_impulse_Ns, (double)NAN, (double)NAN);
    for (EACH(size, four_sizes)) {
        assert_shows_at(&ex, (*size)[0], (*size)[1], "6 of 6");
    }

    // what a limit was asked for has a column
    press(&ex, ":sweep off<Enter>:solve voltage first_pulse_peak_N<lt>2<Enter>");
    assert_at_top(&ex, "first pulse peak N");
}

// Five to nine values a run is about, each with an effect; all others are behind them,
// and / finds any.
TEST(knobs_are_few_and_lead_to_all)
{
    for (EACH_TEXT(name, "corrected/first-impact", "compare/hybrid", "compare/observer",
                   "corrected/twenty-links", "thesis/fig-3-4")) {
        OPEN_EXPLORER(ex, *name);
        press(&ex, ":set wall.angle 0.05<Enter>");
        free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
        const parameter_list *list = &ex.view.parameters;
        assert_in_range(list->knob_count, 5, 9);
        for (int i = 0; i < list->knob_count; i++) {
            assert_null(model_inert_reason(&ex.model, list->knobs[i]));
        }

        // all of them behind Tab, Esc goes back; headings are passed over
        for (int i = 0; i < MOST_KNOBS + 1; i++) {
            press(&ex, "<Down>");
        }
        press_shows(&ex, "<Tab>", "parameters (Tab");
        for (int i = 0; i < parameter_count; i++) {
            press(&ex, "<Up>");
        }
        assert_int_equal(list->parameter, 0);
        for (int i = 1; i < parameter_count; i++) {
            press(&ex, "<Down>");
            assert_int_equal(list->parameter, i);
        }
        press_shows(&ex, "<Esc>", "knobs (/ all");
        press_shows(&ex, "/seed", "parameters /seed");
        press(&ex, "<Esc>");
    }
}

// The instants of touches and releases stand beside their marks, as far as they were
// seen.
TEST(touches_and_releases_are_told_on_the_axis)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const event *e = ex.model.session.run.trace.events;
    press(&ex, ":seek 0.4<Enter>");
    const char *hit = formatted("hit %.4g\u25b2", e[0].time);
    assert_shows(&ex, hit, "!off 0.");
    for (EACH(size, four_sizes)) {
        assert_shows_at(&ex, (*size)[0], (*size)[1], hit);
    }

    // of a release where the flight behind it is long enough for the words
    press(&ex, "<End>");
    assert_shows_at(&ex, 200, 60, "off 0.4775");
}

// --- walks -----------------------------------------------------------------------------

// The keys of what people come for, from the first screen on.
TEST_IN_FOLDER(walks_take_few_keys)
{
    // half the voltage, and the difference
    static const char halves[] = "<Enter>0.5<Enter>";
    assert_true(count_keys(halves) <= 8);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const double before = peak(&ex);
    press(&ex, halves);
    assert_at_top(&ex, formatted("%+.3g", peak(&ex) - before));

    // the picture of that, with its recipe
    static const char saves[] = "s<Enter>";
    assert_true(count_keys(saves) <= 6);
    press(&ex, saves);
    assert_int_equal(access("first-impact-voltage-0.5.png", R_OK), 0);
    assert_int_equal(access("first-impact-voltage-0.5.yaml", R_OK), 0);

    // the voltage for a peak below 2 N
    static const char asks[] = ":so<Tab>vo<Tab> pea<Tab>N<lt>2<Enter>";
    assert_true(count_keys(asks) <= 20);
    press(&ex, asks);
    check_close(ex.model.pinned.runs[ex.model.pinned.count - 1].run.summary.peak_force_N,
                2, 1e-6);

    // data under the run, their command played: besides the path
    OPEN_EXPLORER(recorded, "compare/hybrid");
    press(&recorded, ":save bench.csv<Enter>");
    static const char searches[] = "<C-p>", plays[] = "<Down><Enter>";
    assert_true(count_keys(searches) + count_keys(plays) <= 5);
    press_text(&ex, "u%sbench.csv%s", searches, plays);
    assert_int_equal(ex.model.session.effective.parameters.control.law, LAW_PLAYBACK);
    assert_true(ex.model.measured.row_count > 0);
}
