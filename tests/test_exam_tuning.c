// Numbers of a law found on an exam: the search itself on functions whose least is known,
// and a law that was spoilt.
#include "src/study/robust/exam_tuning.h"
#include "tests/shipped_scenario.h"

enum { NUMBERS = 10 };

// 10^(6 i/(n - 1)) (x_i - c_i)^2 in turned coordinates, neighbours mixed: badly scaled,
// and no coordinate is a way down by itself.
static double turned_ellipsoid(const double *x)
{
    double sum = 0;
    for (int i = 0; i < NUMBERS; i++) {
        const double here = x[i] - 0.3 - 0.04 * i;
        const double next = x[(i + 1) % NUMBERS] - 0.3 - 0.04 * ((i + 1) % NUMBERS);
        const double along = 0.8 * here + 0.6 * next;
        sum += pow(10, 6.0 * i / (NUMBERS - 1)) * along * along;
    }
    return sum;
}

TEST(the_search_finds_the_least_of_a_turned_ellipsoid)
{
    double start[NUMBERS], drawn[EVOLUTION_MOST * NUMBERS], losses[EVOLUTION_MOST];
    for (int i = 0; i < NUMBERS; i++) {
        start[i] = 0.5;
    }
    SCOPED(evolution_finish) evolution e;
    DONE(evolution_init(&e, NUMBERS, start, 0.1, 1, &f));
    for (int generation = 0; generation < 800; generation++) {
        evolution_draw(&e, drawn);
        for (int p = 0; p < e.points; p++) {
            losses[p] = turned_ellipsoid(drawn + p * NUMBERS);
        }
        assert_true(evolution_take(&e, drawn, losses));
    }
    for (int i = 0; i < NUMBERS; i++) {
        check_close(e.mean[i], 0.3 + 0.04 * i, 1e-6);
    }
}

// A least outside of the ranges is sought at their border.
TEST(the_search_stays_within_the_ranges)
{
    const double start[2] = {0.5, 0.5};
    double drawn[EVOLUTION_MOST * 2], losses[EVOLUTION_MOST];
    SCOPED(evolution_finish) evolution e;
    DONE(evolution_init(&e, 2, start, 0.2, 3, &f));
    for (int generation = 0; generation < 100; generation++) {
        evolution_draw(&e, drawn);
        for (int p = 0; p < e.points; p++) {
            const double *x = drawn + 2 * p;
            assert_true(x[0] >= 0 && x[0] <= 1 && x[1] >= 0 && x[1] <= 1);
            losses[p] = (x[0] - 2) * (x[0] - 2) + (x[1] - 0.25) * (x[1] - 0.25);
        }
        assert_true(evolution_take(&e, drawn, losses));
    }
    check_close(e.mean[0], 1, 1e-3);
    check_close(e.mean[1], 0.25, 1e-2);
}

// A touch that is four times too fast is slowed down, and the same is found twice.
TEST(a_law_that_was_spoilt_is_mended)
{
    static char *vary[] = {(char *)"control.settings.touch_speed=0.03:0.5:log",
                           (char *)"control.settings.growth=2:30:log"};
    KEPT_SCENARIO(s) = shipped_with("compare/touch", "control.settings=touch_speed=0.45");
    const exam_request asked = {.base = &s,
                                .laws = {LAW_TOUCH},
                                .law_count = 1,
                                .forces = {1},
                                .force_count = 1,
                                .cases = 24,
                                .seed = 100};
    const exam_options options = {.jobs = 2};
    double found[2][2];
    for (int i = 0; i < 2; i++) {
        SCOPED(exam_tuning_finish) exam_tuning t;
        DONE(exam_tuning_init(&t, &asked, vary, 2, 40, &f));
        DONE(exam_tuning_run(&t, &options, &f));
        check_below(t.found_loss, 0.8 * t.given_loss);
        check_below(t.found[0], 0.25);
        memcpy(found[i], t.found, sizeof found[i]);
    }
    assert_memory_equal(found[0], found[1], sizeof found[0]);
}

TEST(what_cannot_be_varied_is_said)
{
    static char *none[] = {(char *)"control.settings.nonsense=1:2"};
    static char *wide[] = {(char *)"control.settings.growth=2:1e6"};
    static char *list[] = {(char *)"control.settings.growth=1,2"};
    KEPT_SCENARIO(s) = shipped("compare/touch");
    const exam_request asked = {.base = &s,
                                .laws = {LAW_TOUCH},
                                .law_count = 1,
                                .forces = {1},
                                .force_count = 1,
                                .cases = 1};
    exam_tuning t;
    REFUSED(STATUS_BAD_SCENARIO, "nonsense",
            exam_tuning_init(&t, &asked, none, 1, 1, &f));
    exam_tuning_finish(&t);
    REFUSED(STATUS_BAD_SCENARIO, "growth", exam_tuning_init(&t, &asked, wide, 1, 1, &f));
    exam_tuning_finish(&t);
    REFUSED(STATUS_BAD_ARGUMENT, "range", exam_tuning_init(&t, &asked, list, 1, 1, &f));
    exam_tuning_finish(&t);
}
