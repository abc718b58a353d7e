// What the lab has beside curves: notes, colours of runs, maps, parameters fitted
// to measured data, residuals, the clipboard, the first visit.
#include "tests/explorer_on_screen.h"

// A pane whose line can be typed is kept whole; a line that cannot be is refused with a
// sentence.
TEST(long_lines_of_a_view_are_kept_whole_or_refused)
{
    const char *path = "long.session";
    char sum[128] = "force";
    while (strlen(sum) < 55) {
        strcat(sum, "+force");
    }
    const char *line = formatted("trace %s,20*%s,30*%s,40*%s", sum, sum, sum, sum);
    {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        assert_true(explorer_execute(&ex.model, &ex.view, &ex.input, line));
        press_text(&ex, ":session save %s<Enter>", path);
        assert_false(ex.input.message.warning);
    }
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_text(&ex, ":session open %s<Enter>", path);
    assert_false(ex.input.message.warning);
    const pane *p = &ex.view.panes.pane[PANES_OF_TABLE];
    assert_int_equal(p->count, 4);
    assert_int_equal(strlen(signal_table[p->signals[3]].name), strlen(sum) + 3);

    // more than a line can have
    assert_false(explorer_execute(&ex.model, &ex.view, &ex.input,
                                  formatted("note %0*d", (int)LINE_TEXT, 0)));
    assert_non_null(strstr(ex.input.message.text, "too long"));
}

TEST(notes_are_kept_in_time_and_in_sessions)
{
    const char *path = "notes.session";
    {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, ":seek 0.4<Enter>:note late<Enter>:note @0.1 early, by "
                   "hand<Enter>:note @0.4 later<Enter>:notes<Enter>");
        assert_int_equal(ex.model.note_count, 2);
        assert_shows_everywhere(&ex, "early, by hand");
        assert_shows_everywhere(&ex, "0.40000 s  later");

        // Enter goes to the selected one
        press(&ex, "<Enter>");
        check_close(ex.model.session.now, 0.1, 1e-3);
        press_warns(&ex, ":note<Enter>:note<Enter>", "takes a text");
        press_warns(&ex, ":note @nan x<Enter>", "no instant");
        press_text(&ex,
                   ":note @0.1 early, by hand<Enter>"
                   ":trace force - voltage<Enter>:axis -1 2 10<Enter>:session "
                   "save %s<Enter>",
                   path);
    }
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_text(&ex, ":session open %s<Enter>", path);
    assert_false(ex.input.message.warning);
    assert_int_equal(ex.model.note_count, 2);
    assert_string_equal(ex.model.notes[0].text, "early, by hand");
    check_close(ex.model.notes[1].time, 0.4, 1e-12);
    assert_true(signal_is_derived(ex.view.panes.pane[PANES_OF_TABLE].signals[0]));
    check_close(ex.view.panes.pane[PANES_OF_TABLE].fixed.high, 2, 0);

    // no more than there is room for, and they can be dropped
    for (int i = 0; i < 40; i++) {
        press_text(&ex, ":note @%d x<Enter>", i + 1);
    }
    assert_non_null(strstr(ex.input.message.text, "are the most"));
    press(&ex, ":notes<Enter>");
    for (int i = 0; i < 40; i++) {
        press(&ex, "jd");
    }
    assert_int_equal(ex.model.note_count, 0);
    free(picture(&ex, 40, 12, GLYPHS_ASCII));
}

// A session of an earlier lab says what the lab no longer has, which is passed over.
TEST(what_an_earlier_lab_had_is_passed_over)
{
    const char *path = "earlier.session";
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_text(&ex, ":note @0.1 x<Enter>:session save %s<Enter>", path);
    KEPT_TEXT(text) = file_text(path);
    const char *line = strstr(text, "note @");
    for (EACH_TEXT(c, "band force 0.1", "axis grow 1", "axis calm 1")) {
        put_file(path, formatted("%.*s%s%s", (int)(line - text), text, *c,
                                 strchr(line, '\n') != NULL ? strchr(line, '\n') : ""));
        OPEN_EXPLORER(again, "compare/hybrid");
        press_text(&again, ":session open %s<Enter>", path);
        fail_if(strstr(again.input.message.text, "passed over") == NULL, "%s: %s", *c,
                again.input.message.text);
        assert_string_equal(again.model.session.base.name, "corrected/first-impact");
    }
}

TEST(a_map_gives_what_single_runs_give)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":sweep control.transition_time=0.1:0.3:3 arm.k2=4:6:2<Enter>");
    const lab_sweep *m = &ex.model.sweep;
    assert_true(lab_sweep_is_map(m) && lab_sweep_is_done(m));
    assert_int_equal(m->count, 6);
    assert_int_equal(model_run_count(&ex.model), 1);
    assert_shows_everywhere(&ex, "6 of 6");

    // one up, one to the right; beyond the edge there is nothing
    press(&ex, "<Up><Up>><lt><lt>>");
    assert_int_equal(m->selected, 4);
    assert_shows_everywhere(&ex, "transition_time 0.2, k2 6");
    const double peak = lab_sweep_metric(m, 4, SUMMARY_INDEX(peak_force_N));
    const hit_area cells = part_on_screen(&ex, PANEL_SWEEP, PART_CELLS);
    click_at(&ex, cells.area.x, cells.area.y + cells.area.height - 1);
    assert_int_equal(m->selected, 0);
    click_at(&ex, cells.area.x + cells.area.width / 2, cells.area.y);
    assert_int_equal(m->selected, 4);

    // Enter opens the run of the cell
    press(&ex, "<Enter>");
    check_close(ex.model.session.run.summary.peak_force_N, peak, 0);
    check_close(ex.model.session.effective.parameters.control.transition_time, 0.2, 0);
    check_close(ex.model.session.effective.parameters.arm.k2, 6, 0);

    press_warns(&ex, ":sweep arm.k2=1:2:40 motor.voltage=1:2:40<Enter>", "too many");
    press_warns(&ex, ":sweep arm.k2=1:2:4294967300<Enter>", "too many");
    press_warns(&ex, ":sweep arm.k2=1:2:4 arm.k2=1:2:4<Enter>", "different");
    press_warns(&ex, ":sweep arm.k2=1:2:4 motor.voltage<Enter>", "for a map two");
    press(&ex, "<Esc>");
    assert_false(lab_sweep_is_on(m));
}

// A table of what the sensors of a run read, as a bench records them, its clock from
// `begin` [s].
static void write_recording(explorer *ex, const char *path, double begin)
{
    const trace *t = &ex->model.session.run.trace;
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("time[s],command[V],encoder[rad],tachometer[rad/s],force_reading[N]\n", file);
    for (int k = 0; k < 280; k++) {
        const sample *row = &t->rows[trace_row_at(t, (k + 0.6) / 200)];
        fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g\n", begin + k / 200.0, row->command,
                row->encoder, row->tachometer, row->force_reading);
    }
    assert_int_equal(fclose(file), 0);
}

TEST(the_arm_that_was_measured_is_found)
{
    const char *path = "data.csv";
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":set arm.k2 5.5<Enter>");
    write_recording(&ex, path, 0);
    press_warns(&ex, "u:identify k2<Enter>", ":data");
    press(&ex, formatted(":data %s<Enter>:residual force_reading, encoder<Enter>", path));

    // what was measured less what this run reads, at the rows of the table
    assert_shows_everywhere(&ex, "force");
    assert_shows(&ex, "data minus run");
    const trace *rest = &ex.model.residual.trace;
    assert_true(rest->row_count > 200);
    check_close(trace_statistics(rest, SIGNAL_INDEX(encoder), 0.2, 1).mean, 0, 0.02);
    assert_true(trace_statistics(rest, SIGNAL_INDEX(encoder), 0.2, 1).maximum > 1e-3);

    // the fit finds 5.5, and its run is pinned
    press(&ex, ":identify k2<Enter>");
    assert_false(ex.input.message.warning);
    assert_int_equal(ex.model.pinned.count, 1);
    assert_string_equal(ex.model.pinned.runs[0].name, "identified");
    double found = 0;
    assert_int_equal(sscanf(ex.input.message.text, "k2 %lf", &found), 1);
    check_close(found, 5.5, 0.05);
    press_warns(&ex, ":identify nosuch<Enter>", "nosuch");
    press_warns(&ex, ":identify<Enter>", "takes parameters");
    press_shows(&ex, ":data off<Enter>", "no measured data (:data");
}

// While the lab searches it shows how far it is, its cursor moves, and Esc ends it with
// nothing pinned; what comes out is about the run as it was when the search began.
TEST(a_search_leaves_the_lab_to_its_user)
{
    SCOPED(explorer_finish) explorer ex;
    open_changed(&ex, "corrected/first-impact", "", HUGE_VAL);
    ex.model.session.patience = 0;
    press(&ex, ":solve voltage peak_force_N<lt>2<Enter>");
    assert_non_null(ex.model.search);
    assert_shows_at(&ex, 80, 24, "solving, ");
    press(&ex, ":seek 0.1<Enter><Right>");
    check_close(ex.model.session.now, 0.101, 1e-12);
    press_warns(&ex, ":solve voltage peak_force_N<lt>2<Enter>", "a search goes on");
    assert_true(explorer_is_busy(&ex));
    press(&ex, "<Esc>");
    while (explorer_is_busy(&ex)) {
        explorer_follow(&ex);
    }
    assert_non_null(strstr(ex.input.message.text, "nothing is pinned"));
    assert_int_equal(ex.model.pinned.count, 0);

    // another one, and the run is changed meanwhile
    press(&ex, ":solve voltage peak_force_N<lt>2<Enter>:set arm.k2 20<Enter>");
    while (explorer_is_busy(&ex)) {
        explorer_follow(&ex);
    }
    assert_int_equal(ex.model.pinned.count, 1);
    const run_result *limit = &ex.model.pinned.runs[0].run;
    check_relative(limit->summary.peak_force_N, 2.0, 1e-6);
    assert_int_equal(ex.model.pinned.runs[0].from.input_count, 1);

    // a search that goes on is ended with the lab
    press(&ex, ":solve voltage peak_force_N<lt>3<Enter>");
    assert_non_null(ex.model.search);
}

// The run that a fit pins is the one that was compared: with the start, the command and
// the clock of the recording, which are not those of the lab's run. So it moves as the
// recorded arm did.
TEST(the_pinned_fit_is_the_run_that_was_compared)
{
    enum { INSTANTS = 27 };
    const char *path = "data.csv";
    double angle[INSTANTS];
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":set arm.k2 5.5<Enter>:set initial.angle -0.15<Enter>:set control.force "
               "1.3<Enter>");
    write_recording(&ex, path, 7.25);
    for (int i = 0; i < INSTANTS; i++) {
        const trace *t = &ex.model.session.run.trace;
        angle[i] = t->rows[trace_row_at(t, 0.05 * i)].hub_angle;
    }
    press(&ex, "uuu");
    press_text(&ex, ":data %s<Enter>:residual encoder<Enter>:identify k2<Enter>", path);
    fail_if(ex.input.message.warning, "%s", ex.input.message.text);
    press_draws(&ex, "R<Enter>");
    const trace *t = &ex.model.session.run.trace;
    for (int i = 0; i < INSTANTS; i++) {
        check_close(t->rows[trace_row_at(t, 0.05 * i)].hub_angle, angle[i], 1e-3);
    }
    check_close(ex.model.measured.rows[0].time, 0, 1e-3);
}

// Data that were laid to the run's touch stay there when that moves; given a shift they
// keep it.
TEST(data_follow_the_touch_of_a_changed_run)
{
    const char *path = "data.csv";
    OPEN_EXPLORER(ex, "compare/hybrid");
    write_recording(&ex, path, 7.25);
    press_text(&ex, ":data %s<Enter>", path);
    press_draws(&ex, ":set initial.angle -0.15<Enter>");
    const trace *data = &ex.model.measured;
    size_t r = 0;
    while (!(data->rows[r].force_reading > 0.2)) {
        r++;
    }
    check_close(data->rows[r].time, ex.model.session.run.summary.first_contact_s, 0.006);
    press_text(&ex, ":data %s@-7<Enter>", path);
    press_draws(&ex, "u");
    check_close(data->rows[0].time, 0.25, 1e-12);
}

// What a sensor read lies under the force of a run without sensors, touching when that
// does; that their commands differed is said, and not where they are the same.
TEST(readings_lie_under_the_force)
{
    const char *path = "readings.csv";
    OPEN_EXPLORER(recorded, "compare/hybrid");
    write_recording(&recorded, path, 0);
    press_text(&recorded, ":data %s<Enter>", path);
    assert_null(strstr(recorded.input.message.text, "another"));
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_text(&ex, ":data %s<Enter>", path);
    assert_non_null(strstr(ex.input.message.text, "command was another than the run's"));
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));

    shown_run runs[SHOWN_RUNS];
    const pane *force = &ex.view.panes.pane[0];
    const int count = model_runs(&ex.model, force, runs);
    assert_int_equal(runs[count - 1].kind, SHOWN_MEASURED);
    assert_int_equal(shown_signal(&runs[count - 1], force, 0),
                     SIGNAL_INDEX(force_reading));
    assert_int_equal(shown_signal(&runs[0], force, 0), SIGNAL_INDEX(force));
    const trace *data = &ex.model.measured;
    double largest = 0, touch = (double)NAN;
    for (size_t r = 0; r < data->row_count; r++) {
        largest = fmax(largest, data->rows[r].force_reading);
    }
    for (size_t r = data->row_count; r-- > 0;) {
        if (data->rows[r].force_reading > largest / 10) {
            touch = data->rows[r].time;
        }
    }
    const trace *t = &ex.model.session.run.trace;
    size_t first = 0;
    while (t->rows[first].force <= largest / 10) {
        first++;
    }
    check_close(touch, t->rows[first].time, 1e-9);
}

// A long recording is read while the lab goes on; of its rows the peaks are kept, however
// short they are.
TEST(a_long_recording_keeps_its_peaks)
{
    enum { ROWS = 300000, SPIKE = 123457 };
    FILE *file = fopen("long.csv", "w");
    assert_non_null(file);
    fputs("time[s],encoder[rad],force_reading[N]\n", file);
    for (int k = 0; k < ROWS; k++) {
        fprintf(file, "%.6f,%g,%g\n", 1e-6 * k, k % 7 * 1e-3, k == SPIKE ? 5.25 : 0);
    }
    assert_int_equal(fclose(file), 0);

    SCOPED(explorer_finish) explorer ex;
    open_changed(&ex, "corrected/first-impact", "", 60);
    ex.model.session.patience = 0;
    press(&ex, ":data long.csv@0<Enter>");
    assert_shows(&ex, "reading data");
    while (ex.model.reading != NULL) {
        press(&ex, "<Right>");
        explorer_follow(&ex);
    }
    assert_true(session_sample(&ex.model.session)->time > 0);
    const trace *data = &ex.model.measured;
    assert_in_range(data->row_count, 1000, 200000);
    assert_non_null(strstr(ex.input.message.text, "300000 rows, of which"));
    double largest = 0, at = 0;
    for (size_t r = 0; r < data->row_count; r++) {
        if (data->rows[r].force_reading > largest) {
            largest = data->rows[r].force_reading;
            at = data->rows[r].time;
        }
    }
    check_close(largest, 5.25, 0);
    check_close(at, 1e-6 * SPIKE, 1e-12);

    // the lab ends while it reads
    press(&ex, ":data long.csv@0<Enter>");
}

TEST(data_without_a_command_say_what_is_missing_and_what_for)
{
    const char *path = "no_command.csv";
    OPEN_EXPLORER(ex, "compare/hybrid");
    put_file(path, "time[s],encoder[rad]\n0,0\n0.1,0.01\n0.2,0.02\n");
    press_text(&ex, ":data %s<Enter>", path);
    press_warns(&ex, ":identify k2<Enter>",
                "no column 'command', the voltage [V] with which");
    assert_non_null(strstr(ex.input.message.text, "record it, or rename its heading"));
}

TEST(a_page_says_how_much_of_it_is_shown)
{
    static const char *const pages[] = {"?", "c", "<F1>", ":poles<Enter>"};
    for (EACH(keys, pages)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        press(&ex, *keys);
        assert_shows_at(&ex, 80, 16, " of ");
        assert_shows_at(&ex, 80, 16, " lines ");
    }

    // and what it shows besides
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":poles<Enter>");
    assert_shows_at(&ex, 80, 24, "free, 5.48 Hz");
}

TEST(what_is_copied_gives_the_run_again)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set arm.k2 5<Enter>:copy run<Enter>");
    assert_string_equal(ex.input.copied,
                        "impactlab run 'corrected/first-impact' --set 'arm.k2=5'\n");
    press(&ex, ":edit motor.voltage<Enter><Esc>:copy<Enter>");
    assert_non_null(strstr(ex.input.copied, "motor.voltage="));

    // a change at an instant is no option: the scenario itself is copied
    press(&ex, ":seek 0.4<Enter>:push 0.01<Enter>:copy run<Enter>");
    assert_non_null(strstr(ex.input.copied, "script"));
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    press(&ex, ":copy screen<Enter>");
    assert_non_null(strstr(ex.input.copied, "impactlab"));
    press_warns(&ex, ":copy all<Enter>", "value, run or screen");
}

TEST_IN_FOLDER(the_first_visit_is_the_only_one)
{
    assert_int_equal(setenv("XDG_CONFIG_HOME", test_folder, 1), 0);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    explorer_welcome(&ex);
    assert_shows_everywhere(&ex, "Space pauses, Enter changes the voltage");

    // the first key acts
    press_shows(&ex, "b", "!Space pauses");
    assert_int_equal(ex.model.pinned.count, 1);
    press(&ex, "<Esc>");
    explorer_welcome(&ex);
    assert_shows(&ex, "!Space pauses");
    assert_int_equal(access("impactlab/visited", F_OK), 0);
}

TEST_IN_FOLDER(what_could_not_be_kept_is_not_told_of_another_command)
{
    assert_int_equal(setenv("XDG_CONFIG_HOME", test_folder, 1), 0);
    assert_int_equal(mkdir("impactlab", 0700), 0);
    assert_int_equal(mkdir("impactlab/allowed", 0700), 0);
    put_file("asks.yaml", "control: {law: process, command: \"false\", rate: 100 Hz}\n"
                          "run: {duration: 0.1 s}\n");
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_warns(&ex, ":open asks.yaml<Enter>y", "ended without an answer");
    press_warns(&ex, ":open nosuch<Enter>", "'nosuch' is neither");
}

TEST(predictors_and_modes_are_explained)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, "<F1>", "linearised constrained arm:");
    press(&ex, "<Esc>:poles<Enter>");
    assert_shows_at(&ex, 80, 24, "nothing is left that could move");
    assert_shows(&ex, "0 Hz");
    press(&ex, "<Esc>:rate 200<Enter>");
    check_close(ex.view.looks.rate, 200, 0);
    press_warns(&ex, ":rate 0.1<Enter>", "at least 1 kB/s");
}

// How many keys are pressed: a name in brackets is one.
static int key_count(const char *keys)
{
    int count = 0;
    for (; *keys != '\0'; keys += *keys == '<' ? strcspn(keys, ">") + 1 : 1) {
        count++;
    }
    return count;
}

// Questions and the keys they take, with completion; each answer is on a screen of any
// size.
TEST(what_is_wanted_takes_few_keys)
{
    static const struct {
        const char *before, *keys;
        int most;
        const char *shows;
    } cases[] = {
        {"", ":sol<Tab>vol<Tab> pea<Tab>N<lt>2<Enter>", 25, "1.4441 V: 2.0000 N"},
        {":trace gap<Enter>", ":tr<Tab>force - vol<Tab><Enter>", 18, "pane 11"},
        {":trace gap<Enter>", ":tr<Tab>for<Tab><Enter>", 12, "pane 11"},
        {":open compare/hybrid<Enter>", "b]", 6, "hybrid-printed"},
        {":open compare/hybrid<Enter>", "K", 1, "is hidden"},
        {":edit control.transition_time<Enter><Esc>", "<lt><lt><lt>", 5, "0.32 s"},
    };
    for (EACH(c, cases)) {
        OPEN_EXPLORER(ex, "compare/hybrid");
        press(&ex, ":open corrected/first-impact<Enter>");
        press(&ex, c->before);
        press(&ex, c->keys);
        assert_in_range(key_count(c->keys), 1, c->most);
        assert_shows_everywhere(&ex, c->shows);
    }
}

// A command's description tells which words Tab finds, in expressions behind each
// operator.
TEST(arguments_are_completed_by_their_kind)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_prompts(&ex, ":trace 2*(force-volt<Tab>", "trace 2*(force-voltage ");
    press_prompts(&ex, "<C-u>limit volt<Tab>", "limit voltage ");
    press_prompts(&ex, "<Tab>", "limit voltage off ");
    press_prompts(&ex, "<C-u>phase gap hub_v<Tab>", "phase gap hub_velocity ");
    press_prompts(&ex, "<C-u>solve motor.voltage set<Tab>",
                  "solve motor.voltage settling_time_s ");
    press_prompts(&ex, "<C-u>session o<Tab>", "session open ");
    press_prompts(&ex, "<C-u>sweep arm.k2=4:6:3 motor.voltage_<Tab>",
                  "sweep arm.k2=4:6:3 motor.voltage_limit ");
    press_prompts(&ex, "<C-u>speed x<Tab>", "speed x");
    press_prompts(&ex, "<C-u>panes <Tab>", "panes ");
}

// The first visit of the lab's page, key by key, at three sizes.
TEST_IN_FOLDER(the_walk_through_does_what_it_says)
{
    static const struct {
        const char *keys, *shows;
    } steps[] = {
        {"<Space>i<PgUp>", "t 0.27"},
        {"b", "first-impact"},
        {"<Enter><C-u>0.5<Enter>", "motor.voltage = 0.5 V from 0.27"},
        {"c", "two runs"},
        {"<Esc>s<Enter>", "saved "},
        {"o/hybrid<Enter>", "compare/hybrid"},
        {":save mine.yaml<Enter>", "saved "},
    };
    for (EACH(size, screen_sizes)) {
        OPEN_EXPLORER(ex, "corrected/first-impact");
        unlink("mine.yaml");
        for (EACH(step, steps)) {
            press(&ex, step->keys);
            assert_shows_at(&ex, (*size)[0], (*size)[1], step->shows);
        }

        // what was saved gives the run again
        free(save_and_compare(&ex.model.session));
        KEPT_SCENARIO(saved);
        assert_int_equal(scenario_open(&saved, "mine.yaml", NULL, NULL), STATUS_OK);
        KEPT_RUN(again);
        run_scenario(&saved, true, &again);
        assert_same_trace(&ex.model.session.run.trace, &again.trace);
    }
}

ALL_BETWEEN(enter_folder, leave_folder)
