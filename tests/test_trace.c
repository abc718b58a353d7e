// Rows and events of a run: where an instant lies among them, copies, and shared
// beginnings.
#include "src/run/trace.h"

#include "tests/check.h"

enum { ROWS = 5000, ANGLES = 3, EVENTS = 40 };

// Rows at 0, 1, 1, 2, 3, 3, 4 ...: every second instant has one on either side of an
// event.
static double time_of(int row)
{
    return (2 * row + 1) / 3;
}

static void fill(trace *t)
{
    for (int i = 0; i < ROWS; i++) {
        sample row = {.time = time_of(i), .force = i};
        double angles[ANGLES] = {i, -i, 0.5 * i}, velocities[ANGLES] = {1, 2, i};
        assert_int_equal(trace_add_row(t, &row, angles, velocities), STATUS_OK);
    }
    for (int i = 0; i < EVENTS; i++) {
        assert_int_equal(trace_add_event(t, (event){.time = i, .impulse = 0.1 * i}),
                         STATUS_OK);
    }
}

static void check_rows(const trace *t, int rows, int events)
{
    assert_int_equal(t->row_count, rows);
    assert_int_equal(t->event_count, events);
    for (int i = 0; i < rows; i++) {
        check_close(t->rows[i].time, time_of(i), 0);
        check_close(t->rows[i].force, i, 0);
        check_close(t->angles[i * ANGLES + 1], -i, 0);
        check_close(t->velocities[i * ANGLES + 2], i, 0);
    }
    for (int i = 0; i < events; i++) {
        check_close(t->events[i].impulse, 0.1 * i, 0);
    }
}

TEST(an_instant_has_its_place_among_the_rows)
{
    SCOPED(trace_finish) trace t;
    trace_init(&t, ANGLES);
    assert_int_equal(trace_rows_until(&t, 3), 0);
    assert_int_equal(trace_row_at(&t, 3), 0);
    fill(&t);

    // between rows, at rows, before the first and after the last
    for (int k = -2; k <= 2 * ROWS + 2; k++) {
        const double time = 0.5 * k;
        size_t until = 0;
        while (until < ROWS && time_of((int)until) <= time) {
            until++;
        }
        assert_int_equal(trace_rows_until(&t, time), until);
        assert_int_equal(trace_row_at(&t, time), until > 0 ? until - 1 : 0);
    }
    assert_int_equal(trace_rows_until(&t, HUGE_VAL), ROWS);
}

// Of plain arrays.
static void copy_rows(trace *copy, const trace *t)
{
    trace_init(copy, t->angle_count);
    assert_int_equal(trace_share(copy, t, t->row_count, t->event_count), STATUS_OK);
}

TEST(a_copy_outlives_the_original)
{
    trace t, empty;
    SCOPED(trace_finish) trace copy;
    trace_init(&t, ANGLES);
    copy_rows(&empty, &t);
    check_rows(&empty, 0, 0);
    fill(&t);
    copy_rows(&copy, &t);
    trace_finish(&t);
    check_rows(&copy, ROWS, EVENTS);
    trace_finish(&empty);
}

// Rows that stay where they are are shared up to a row, and go on differently.
TEST(a_shared_beginning_goes_on_by_itself)
{
    trace t;
    SCOPED(trace_finish) trace other;
    assert_int_equal(trace_reserve(&t, ANGLES, 10, ROWS), STATUS_OK);
    const sample *first = t.rows;
    fill(&t);
    assert_ptr_equal(t.rows, first);
    assert_int_equal(trace_reserve(&other, ANGLES, 10, ROWS), STATUS_OK);
    assert_int_equal(trace_share(&other, &t, 1234, 7), STATUS_OK);
    check_rows(&other, 1234, 7);
    sample row = {.time = 1e6};
    double zeros[ANGLES] = {0};
    assert_int_equal(trace_add_row(&other, &row, zeros, zeros), STATUS_OK);
    check_close(other.rows[1234].time, 1e6, 0);
    check_rows(&t, ROWS, EVENTS);
    trace_finish(&t);
    other.row_count = 1234;
    check_rows(&other, 1234, 7);
}

// An arm without angles of its own still has all its rows.
TEST(rows_need_no_angles)
{
    trace t;
    SCOPED(trace_finish) trace copy;
    trace_init(&t, 0);
    for (int i = 0; i < ROWS; i++) {
        sample row = {.time = time_of(i)};
        assert_int_equal(trace_add_row(&t, &row, NULL, NULL), STATUS_OK);
    }
    copy_rows(&copy, &t);
    trace_finish(&t);
    assert_int_equal(copy.row_count, ROWS);
    for (int i = 0; i < ROWS; i++) {
        check_close(copy.rows[i].time, time_of(i), 0);
    }
}

// A signal is there if one row has it, whichever.
TEST(a_signal_is_there_if_one_row_has_it)
{
    enum { COUNT = 5 };
    for (int row = 0; row <= COUNT; row++) {
        sample rows[COUNT];
        for (int i = 0; i < COUNT; i++) {
            rows[i] = (sample){.time = i, .force = i == row ? 0 : (double)NAN};
        }
        const trace t = {.rows = rows, .row_count = COUNT};
        assert_int_equal(trace_has(&t, SIGNAL_INDEX(force)), row < COUNT);
    }
}

// Each row of an instant is found again by its side; of a run with fewer rows there, its
// nearest.
TEST(a_row_is_found_by_its_instant_and_side)
{
    enum { COUNT = 6 };
    static const double times[COUNT] = {0, 1, 1, 1 + 1e-13, 2, 3};
    sample rows[COUNT], single[2] = {{.time = 0}, {.time = 4, .force = 4}};
    for (int i = 0; i < COUNT; i++) {
        rows[i] = (sample){.time = times[i], .force = i};
    }
    const trace t = {.rows = rows, .row_count = COUNT},
                pair = {.rows = rows, .row_count = 3};
    const trace line = {.rows = single, .row_count = 2};
    static const int in_pair[COUNT] = {0, 1, 1, 2};
    for (size_t i = 0; i < COUNT; i++) {
        const size_t side = trace_side(&t, i);
        assert_int_equal(trace_row_on_side(&t, times[i], side), i);
        check_close(trace_sample_at(&t, times[i], side).force, (double)i, 0);
        check_close(trace_sample_at(&line, times[i], side).force, times[i], 1e-12);
        if (times[i] < 1.5) {
            assert_int_equal(trace_row_on_side(&pair, times[i], side), in_pair[i]);
        }
    }
    check_close(trace_sample_at(&t, 2.25, 0).force, 4.25, 1e-15);
}
