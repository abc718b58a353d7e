// The tip pulled by the mouse, and slow motion near impacts.
#include "tests/explorer_on_screen.h"

enum { WIDTH = 120, HEIGHT = 40 };

// The cell of the tip as it is drawn.
static void find_tip(explorer *ex, int *x, int *y)
{
    const session *s = &ex->model.session;
    plane_vector tip, across;
    free(picture(ex, WIDTH, HEIGHT, GLYPHS_BRAILLE));
    recorded_tip(&s->run.trace, &s->effective.parameters.arm, s->row, &tip, &across);
    stage_cell(&ex->view.drawn.stage, tip, x, y);
}

// Takes hold of the tip, pulls `down` cells for some time of the run, and lets go.
static void pull(explorer *ex, int down, double seconds)
{
    int x, y;
    find_tip(ex, &x, &y);
    explorer_point(ex, (pointer_event){.kind = POINTER_PRESS, .x = x, .y = y});
    explorer_point(ex, (pointer_event){.kind = POINTER_DRAG, .x = x, .y = y + down});
    for (double t = 0; t < seconds; t += 0.01) {
        act_advance(&ex->model, &ex->view, &ex->input, 0.01 / ex->view.playback.speed);
        free(picture(ex, WIDTH, HEIGHT, GLYPHS_BRAILLE));
    }
    assert_shows(ex, "pulled with");
    explorer_point(ex, (pointer_event){.kind = POINTER_RELEASE, .x = x, .y = y + down});
}

TEST(test_a_place_is_in_its_cell)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    free(picture(&ex, WIDTH, HEIGHT, GLYPHS_BRAILLE));
    const arm_stage *g = &ex.view.drawn.stage;
    for (int x = g->x; x < g->x + g->width; x++) {
        for (int y = g->y; y < g->y + g->height; y++) {
            int column, row;
            stage_cell(g, stage_place(g, x, y), &column, &row);
            assert_int_equal(column, x);
            assert_int_equal(row, y);
        }
    }
}

TEST(test_a_pull_gives_the_spring_s_impulse)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":slow off<Enter>:set motor.voltage 0<Enter>");
    const session *s = &ex.model.session;
    pull(&ex, 3, 0.1);
    assert_false(ex.view.pull.held);
    assert_false(ex.view.playback.playing);

    // towards the pointer, each push as large as the spring's force over its step
    double impulse = 0;
    int pushes = 0;
    for (int i = 0; i < s->input_count; i++) {
        const session_input *in = &s->inputs[i];
        if (in->kind != SESSION_INPUT_PUSH) {
            continue;
        }
        plane_vector tip, across;
        const size_t row = trace_row_at(&s->run.trace, in->time - 1e-9);
        recorded_tip(&s->run.trace, &s->effective.parameters.arm, row, &tip, &across);
        const double force = pull_force(&ex.view.pull, tip, across);
        assert_true(in->value < 0);
        assert_true(fabs(in->value - PULL_STEP * force) < 0.02 * fabs(in->value));
        impulse += in->value;
        pushes++;
    }
    assert_in_range(pushes, 15, 25);

    // and the arm, at rest before, has gone that way by the work of the pushes
    const sample *row = session_sample(s);
    assert_true(impulse < 0 && row->last_angle < s->run.trace.rows[0].last_angle);
    assert_true(row->external_work > 0);
    check_close(row->energy_residual, 0, 1e-9);
}

TEST_IN_FOLDER(test_a_pull_is_one_change_and_comes_again)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.1<Enter>");
    const size_t rows = ex.model.session.run.trace.row_count;
    pull(&ex, 2, 0.05);
    const session *s = &ex.model.session;
    const int pushes = s->input_count;
    assert_true(pushes > 5);

    // the saved scenario gives the same rows
    assert_true(explorer_carry_out(&ex, "save pull.yaml"));
    KEPT_SCENARIO(again) = shipped("./pull.yaml");
    KEPT_RUN(result) = run_done(&again, true);
    assert_same_trace(&result.trace, &s->run.trace);

    // taken back at once, and put in again
    press(&ex, "u");
    assert_int_equal(s->input_count, 0);
    assert_int_equal(s->run.trace.row_count, rows);
    press(&ex, "U");
    assert_int_equal(s->input_count, pushes);
}

TEST(test_what_is_far_from_the_tip_holds_nothing)
{
    int x, y;
    OPEN_EXPLORER(ex, "corrected/first-impact");
    find_tip(&ex, &x, &y);
    explorer_point(&ex, (pointer_event){.kind = POINTER_PRESS, .x = x - 20, .y = y});
    assert_false(ex.view.pull.held);
    explorer_point(&ex, (pointer_event){.kind = POINTER_RELEASE, .x = x - 20, .y = y});
    press(&ex, ":model<Enter>");
    find_tip(&ex, &x, &y);
    explorer_point(&ex, (pointer_event){.kind = POINTER_PRESS, .x = x, .y = y});
    assert_false(ex.view.pull.held);
}

TEST(test_impacts_are_slow_and_the_rest_is_not)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    session *s = &ex.model.session;
    playback *play = &ex.view.playback;
    const trace *t = &s->run.trace;
    const double duration = s->effective.parameters.run.duration;
    const double impact = s->run.summary.first_contact_s;
    assert_true(playback_slowness(play, t, duration, 0.3 * impact) == 1);
    assert_true(playback_slowness(play, t, duration, impact) == 8);

    // an eighth of the run passes in the same time; off, all of it
    press(&ex, ":speed 0.1<Enter>");
    session_seek(s, impact);
    play->playing = true;
    act_advance(&ex.model, &ex.view, &ex.input, 0.01);
    check_close(s->now - impact, 0.001 / 8, 1e-12);
    press(&ex, ":slow off<Enter>");
    session_seek(s, impact);
    act_advance(&ex.model, &ex.view, &ex.input, 0.01);
    check_close(s->now - impact, 0.001, 1e-12);
}
