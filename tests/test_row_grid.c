// Rows of a run on a uniform grid, against lines whose values are known, and against the
// rows that a run records by itself.
#include "src/run/row_grid.h"

#include "tests/shipped_scenario.h"

// What a grid handed on, as a trace.
static status keep_row(void *context, const sample *row, const double *angles)
{
    trace *kept = context;
    return trace_add_row(kept, row, angles, angles);
}

// The rows of a grid are at its multiples, one each, up to `end` [s].
static void check_instants(const trace *t, double every, double end)
{
    assert_int_equal(t->row_count, (size_t)(end / every * (1 + 1e-12)) + 1);
    for (size_t r = 0; r < t->row_count; r++) {
        check_close(t->rows[r].time, (double)r * every, 0);
    }
}

// --- lines -----------------------------------------------------------------------------

// A force 10 t that jumps by 5 at t = 1, where an impulse acts, and by -3 at t = 2;
// contact from the first jump on.
static double force_at(double time)
{
    return 10 * time + (time >= 1 ? 5 : 0) - (time >= 2 ? 3 : 0);
}

static void add_line_row(trace *t, double time, double force, double contact,
                         double impulse)
{
    const sample row = {.time = time,
                        .force = force,
                        .contact = contact,
                        .impulse = impulse,
                        .encoder = time < 1.5 ? (double)NAN : time};
    const double angles[2] = {-time, 3 * time};
    assert_int_equal(trace_add_row(t, &row, angles, angles), STATUS_OK);
}

static void make_line(trace *t)
{
    trace_init(t, 2);
    add_line_row(t, 0, 0, 0, 0);
    add_line_row(t, 0.7, 7, 0, 0);
    add_line_row(t, 1, 10, 0, 0);
    add_line_row(t, 1, 15, 1, 0.25);
    add_line_row(t, 1.5, 20, 1, 0);
    add_line_row(t, 2, 25, 1, 0);
    add_line_row(t, 2, 24, 1, 0);
    add_line_row(t, 2, 22, 1, 0);
    add_line_row(t, 2.3, 25, 1, 0);
}

TEST(a_line_keeps_its_values_on_any_grid)
{
    static const double every[] = {0.25, 1, 0.1, 0.07, 2.3, 5, 1.0 / 3};
    SCOPED(trace_finish) trace line;
    make_line(&line);
    for (size_t i = 0; i < sizeof every / sizeof every[0]; i++) {
        SCOPED(trace_finish) trace grid;
        trace_init(&grid, 2);
        assert_int_equal(row_grid_of_trace(&line, every[i], keep_row, &grid), STATUS_OK);
        check_instants(&grid, every[i], 2.3);

        for (size_t r = 0; r < grid.row_count; r++) {
            const sample *row = &grid.rows[r];
            const double time = row->time;
            check_close(row->force, force_at(time + 1e-13), 1e-9);
            check_close(row->contact, time + 1e-13 >= 1, 0);
            check_close(row->impulse, fabs(time - 1) < 1e-9 ? 0.25 : 0, 0);
            assert_int_equal(isnan(row->encoder), time < 1.5 - 1e-9);
            check_close(grid.angles[2 * r], -time, 1e-12);
            check_close(grid.angles[2 * r + 1], 3 * time, 1e-12);
        }
    }
}

// A run that ended at once has one row or none.
TEST(few_rows_are_no_trouble)
{
    SCOPED(trace_finish) trace rows;
    SCOPED(trace_finish) trace grid;
    trace_init(&rows, 2);
    trace_init(&grid, 2);
    assert_int_equal(row_grid_of_trace(&rows, 0.1, keep_row, &grid), STATUS_OK);
    assert_int_equal(grid.row_count, 0);

    add_line_row(&rows, 0, 4, 0, 0);
    assert_int_equal(row_grid_of_trace(&rows, 0.1, keep_row, &grid), STATUS_OK);
    assert_int_equal(grid.row_count, 1);
    check_close(grid.rows[0].force, 4, 0);
}

// Whoever takes rows may end it.
static status refuse_row(void *context, const sample *row, const double *angles)
{
    (void)row, (void)angles;
    --*(int *)context;
    return *(int *)context > 0 ? STATUS_OK : STATUS_STOPPED;
}

TEST(a_taker_ends_the_work)
{
    SCOPED(trace_finish) trace line;
    make_line(&line);
    for (int most = 1; most <= 3; most++) {
        int left = most;
        assert_int_equal(row_grid_of_trace(&line, 1, refuse_row, &left), STATUS_STOPPED);
        assert_int_equal(left, 0);
    }
}

// --- runs ------------------------------------------------------------------------------

// The rows that a run of the scenario hands on every so often [s], while it keeps rows
// (into result) or not.
static void run_on_grid(const scenario *s, double every, bool keep, trace *grid,
                        run_result *result)
{
    SCOPED(row_grid_finish) row_grid g;
    const int angles =
        s->parameters.arm.links + (s->parameters.arm.hub_joint != HUB_RIGID);
    trace_init(grid, angles);
    assert_int_equal(row_grid_begin(&g, every, angles, keep_row, grid), STATUS_OK);
    const run_options options = {.keep_trace = keep,
                                 .take_row = row_grid_taker,
                                 .row_context = &g,
                                 .rows_every = every};
    fail_if(run_scenario_with(s, &options, result) != STATUS_OK, "%s",
            result->summary.message);
    assert_int_equal(row_grid_end(&g), STATUS_OK);
}

static const char *const names[] = {"corrected/first-impact",     "compare/hybrid",
                                    "corrected/wall-with-a-face", "compare/twelve-links",
                                    "corrected/newmark",          "thesis/fig-3-4"};
enum { NAMES = sizeof names / sizeof names[0] };

// Whether rows are kept as well changes nothing of what is handed on, and nothing of the
// summary.
TEST(a_grid_is_the_same_beside_other_rows)
{
    for (int i = 0; i < NAMES; i++) {
        KEPT_SCENARIO(s) = shipped_with(names[i], "run.duration=0.6");
        KEPT_RUN(plain) = run_done(&s, true);
        const double every[] = {20 * s.parameters.method.step, 3.3e-3, 0.1};
        for (int k = 0; k < 3; k++) {
            SCOPED(trace_finish) trace alone, beside;
            KEPT_RUN(first) = {0};
            KEPT_RUN(second) = {0};
            run_on_grid(&s, every[k], false, &alone, &first);
            run_on_grid(&s, every[k], true, &beside, &second);
            check_instants(&alone, every[k], 0.6);
            check_instants(&beside, every[k], 0.6);
            assert_int_equal(first.trace.row_count, 0);
            assert_same_summary(&first.summary, &plain.summary);
            assert_same_summary(&second.summary, &plain.summary);
            assert_memory_equal(alone.rows, beside.rows,
                                alone.row_count * sizeof *alone.rows);
            assert_memory_equal(alone.angles, beside.angles,
                                alone.row_count * (size_t)alone.angle_count *
                                    sizeof *alone.angles);
        }
    }
}

// Where the grid's instants are those of the run's own rows, these are its rows.
TEST(rows_on_the_grid_are_those_of_the_run)
{
    for (int i = 0; i < NAMES; i++) {
        KEPT_SCENARIO(s) = shipped_with(names[i], "run.duration=0.6");
        KEPT_RUN(plain) = run_done(&s, true);
        KEPT_RUN(r) = {0};
        SCOPED(trace_finish) trace grid;
        const double every = 5 * s.parameters.method.step;
        run_on_grid(&s, every, false, &grid, &r);
        for (size_t k = 0; k < grid.row_count; k++) {
            sample own =
                plain.trace.rows[trace_row_on_side(&plain.trace, grid.rows[k].time, 0)];
            check_close(own.time, grid.rows[k].time, 1e-9 * every);
            own.time = grid.rows[k].time;
            assert_memory_equal(&own, &grid.rows[k], sizeof own);
        }
    }
}

// Between its own rows a run computes what it is asked for, where a line between rows
// would be wrong: the arm rings at hundreds of hertz. The same rows come from a run whose
// steps of the grid are these.
TEST(rows_between_rows_are_computed)
{
    KEPT_SCENARIO(s) = shipped_with("corrected/first-impact", "method.step=0.005");
    KEPT_SCENARIO(fine) = shipped_with("corrected/first-impact", "method.step=0.0007");
    KEPT_RUN(r) = {0};
    KEPT_RUN(reference) = run_done(&fine, true);
    SCOPED(trace_finish) trace grid;
    run_on_grid(&s, 0.0007, false, &grid, &r);
    double largest = 0;
    for (size_t k = 0; k < grid.row_count; k++) {
        const sample *own =
            &reference.trace
                 .rows[trace_row_on_side(&reference.trace, grid.rows[k].time, 0)];
        largest = fmax(largest, own->force);
        check_close(grid.rows[k].force, own->force, 1e-7);
        check_close(grid.rows[k].last_angle, own->last_angle, 1e-11);
    }
    assert_true(largest > 1);
}
