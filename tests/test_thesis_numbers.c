// The numbers of docs/explanation/thesis.md and claims.tsv are those that the program
// computes: each is computed anew and, in their own words and digits, looked up in them.
#include "src/study/thesis_tables.h"
#include "tests/session_fixture.h"

static char *page; // the text of both

// Fails unless the page has these words.
static void must_say(const char *words)
{
    fail_if(strstr(page, words) == NULL, "neither thesis.md nor claims.tsv says '%s'",
            words);
}
#define page_says(...) must_say(formatted(__VA_ARGS__))

typedef struct computed {
    scenario scenario;
    run_result result;
} computed;

// Runs a scenario with changes "PATH=VALUE ...".
static computed run_of(const char *name, const char *changes)
{
    computed c = {.scenario = shipped_with(name, changes)};
    run_scenario(&c.scenario, true, &c.result);
    return c;
}
#define run_with(name, ...) run_of(name, formatted(__VA_ARGS__))

static void forget(computed *c)
{
    run_finish(&c->result);
    scenario_finish(&c->scenario);
}

// A number of a run's summary.
static double number(const char *name, const char *changes, const char *key)
{
    SCOPED(forget) computed c = run_of(name, changes);
    return summary_value(&c.result.summary, summary_index(key));
}

// ---- chapters 1 to 4

TEST(numbers_of_the_first_chapters)
{
    const double pulse = number("corrected/first-impact", "", "first_pulse_s");
    const double stiff = number("corrected/stiff-beam", "", "first_pulse_s");
    page_says("lasts %.0f times as long as that of one a hundred times as stiff",
              pulse / stiff);
    page_says("agrees: %.0f ms at the nominal $k_2$, %.1f ms at a hundred times that",
              1e3 * pulse,
              1e3 * number("corrected/first-impact", "arm.k2=492", "first_pulse_s"));
    page_says(
        "it loses contact once and hits with %.2f N, a constant voltage with %.2f N",
        number("compare/reverse-torque", "", "peak_force_N"),
        number("corrected/first-impact", "", "peak_force_N"));
    check_close(number("compare/reverse-torque", "", "separations"), 1, 0);

    // where the hub turns back
    SCOPED(forget) computed first = run_of("corrected/first-impact", "");
    const summary *m = &first.result.summary;
    const event *turns = find_event(&first.result, EVENT_REVERSAL, 0);
    page_says("(%.1f ms after the touch; the hub turns at %.1f ms)",
              1e3 * m->first_pulse_time_to_peak_s,
              1e3 * (turns->time - m->first_contact_s));
}

// ---- the single run of 3.1.3

TEST(the_table_of_the_single_run)
{
    static const char *const pairs[][2] = {{"0.2", "0.5"}, {"0.3", "0.5"}, {"0.4", "0.5"},
                                           {"0.4", "0.6"}, {"0.5", "0.5"}, {"0.5", "0.7"},
                                           {"0.6", "0.5"}, {"0.6", "0.9"}, {"0.7", "0.5"},
                                           {"0.7", "0.9"}};
    for (EACH(one, pairs)) {
        const char *row = formatted("| %s, %s |", (*one)[0], (*one)[1]);
        for (EACH_TEXT(each, "1e-3", "1e-4", "1e-5")) {
            SCOPED(forget)
            computed c =
                run_with("thesis/fig-3-4",
                         "printed.reevaluation=none run.duration=0.6 method.beta=%s "
                         "method.gamma=%s method.step=%s",
                         (*one)[0], (*one)[1], *each);
            const summary *m = &c.result.summary;
            row = m->status == STATUS_OK ? formatted("%s %.0f |", row, m->peak_force_N)
                                         : formatted("%s fails |", row);
        }
        page_says("%s", row);
    }
    page_says("agrees: %.0f N where two runs give %.2f N",
              number("thesis/fig-3-4", "printed.reevaluation=none", "peak_force_N"),
              number("thesis/fig-3-4", "", "peak_force_N"));
}

// ---- tables 4.1 to 4.3

static const char *const tables[] = {"thesis/table-4-1", "thesis/table-4-2",
                                     "thesis/table-4-3"};

// Largest force of the printed model within 0.12 s of the touch, and its delay from
// there.
static void run_cell(const char *table, const char *more, double voltage, double *peak,
                     double *delay)
{
    SCOPED(forget)
    computed c = run_with(table, "motor.voltage=%g run.duration=1.2 %s", voltage, more);
    const trace *t = &c.result.trace;
    double touch = -1;
    *peak = 0;
    for (EACH_ROW(row, t)) {
        touch = touch < 0 && row->contact > 0 ? row->time : touch;
        if (touch >= 0 && row->time - touch < 0.12 + 1e-9 && row->force > *peak) {
            *peak = row->force;
            *delay = row->time - touch;
        }
    }
}

// Mean |relative error| of forces and delays against what the thesis prints, over some
// tables.
static void errors_of(int from, int to, const char *sets, double later, double error[2])
{
    static const double voltages[TABLE_VOLTAGES] = {1, 2, 5, 10};
    int cells = 0;
    error[0] = error[1] = 0;
    for (int k = from; k <= to; k++) {
        const char *name = formatted("4.%d", k + 1);
        double forces[TABLE_VOLTAGES], delays[TABLE_VOLTAGES];
        assert_true(tables_printed(name, "max_force_simulation", forces));
        assert_true(tables_printed(name, "delay_simulation", delays));
        for (int v = 0; v < TABLE_VOLTAGES; v++) {
            double peak = 0, delay = 0;
            run_cell(tables[k], sets, voltages[v], &peak, &delay);
            error[0] += fabs(peak - forces[v]) / forces[v];
            error[1] += fabs(delay + later - delays[v]) / delays[v];
            cells++;
        }
    }
    error[0] *= 100.0 / cells;
    error[1] *= 100.0 / cells;
}

static const table_row *row_of(const thesis_tables *t, const char *table,
                               const char *model, const char *quantity)
{
    for (int i = 0; i < t->row_count; i++) {
        const table_row *r = &t->rows[i];
        if (strcmp(r->table, table) == 0 && strcmp(r->model, model) == 0 &&
            strcmp(r->quantity, quantity) == 0) {
            return r;
        }
    }
    fail_msg("no row %s of table %s", quantity, table);
    return NULL;
}

TEST(errors_of_the_tables)
{
    thesis_tables printed, fitted;
    DONE(tables_compute(&printed, &f));
    tables_compute_fitted(&fitted);
    double error[2], mean = tables_mean_error(&printed, "printed", "delay_simulation");
    page_says("delays of the simulation do not, %.1f %% off on average", 100 * mean);
    page_says("agrees with %.1f %% of the table; signs",
              100 * tables_mean_error(&printed, "printed", "max_force_dynamics"));
    page_says("agrees with %.1f %% of the tables",
              100 * tables_mean_error(&printed, "printed", "max_force_energy"));
    page_says("**The delays of the impact dynamics** are %.1f %% off on average",
              100 * tables_mean_error(&printed, "printed", "delay_dynamics"));

    // the cells run one by one are those of the tables
    errors_of(0, 2, "", 0, error);
    check_close(error[0],
                100 * tables_mean_error(&printed, "printed", "max_force_simulation"),
                0.05);
    check_close(error[1], 100 * mean, 0.05);
    errors_of(0, 2, "", 1e-3, error);
    page_says("and the mean error is %.0f %%.", error[1]);
    errors_of(0, 2, "arm.hub_inertia=1.078e-3", 1e-3, error);
    page_says("the forces are %.1f %% and the delays %.1f %% off.", error[0], error[1]);
    errors_of(1, 1, "arm.k1=50", 0, error);
    page_says("with $k_1$ = 50 within %.0f %%", ceil(error[0]));
    errors_of(2, 2, "arm.k1=120", 0, error);
    page_says("with $k_1$ = 120 within %.0f %%", ceil(error[0]));

    // one set for all, and the factor of the impact dynamics
    page_says("forces %.1f %% and delays %.1f %% off:",
              100 * tables_mean_error(&fitted, "fitted", "max_force_simulation"),
              100 * tables_mean_error(&fitted, "fitted", "delay_simulation"));
    double off = 0, bias = 0;
    int outside = 0, outside_best = 0;
    for (EACH_TEXT(c, "4.1", "4.2", "4.3")) {
        const table_row *r = row_of(&fitted, *c, "fitted", "delay_dynamics");
        const table_row *force = row_of(&fitted, *c, "fitted", "max_force_simulation");
        const table_row *delay = row_of(&fitted, *c, "fitted", "delay_simulation");
        for (int v = 0; v < TABLE_VOLTAGES; v++) {
            const double error_of_cell = (r->computed[v] - r->printed[v]) / r->printed[v];
            off += fabs(error_of_cell) / 12;
            bias += error_of_cell / 12;
            outside += fabs(r->computed[v] - r->printed[v]) > 0.5e-3;
            outside_best +=
                fabs(r->computed[v] * 0.865 / (sqrt(3) / 2) - r->printed[v]) > 0.5e-3;
            page_says("%.0f / %.1f ms", 1e3 * r->printed[v], 1e3 * r->computed[v]);
            page_says("%.2f N, %.0f ms", force->computed[v], 1e3 * delay->computed[v]);
        }
    }
    page_says("are %.1f %% off on average, with hardly any bias (%.1f %%)", 100 * off,
              100 * bias);
    assert_int_equal(outside, 8);
    assert_int_equal(outside_best, 7);
    page_says("but eight of the twelve cells are further off than their rounding "
              "to a millisecond, and seven with the factor");
}

// The listing's slips, one by one and both: one switch stands for two, and what it
// changes is said.
TEST(what_equations_and_listing_differ_in)
{
    static const struct {
        const char *name, *sets;
    } rows[] = {{"equations", "printed.program=equations"},
                {"C5, `printed.feed_newmark_acceleration=true`",
                 "printed.program=listing printed.reevaluation=rhs"},
                {"C3, `printed.reevaluation=listing`",
                 "printed.program=listing printed.feed_newmark_acceleration=false"},
                {"listing, both", "printed.program=listing"}};
    static const struct {
        int table;
        double voltage;
    } cells[] = {{2, 5}, {2, 10}, {1, 10}};
    for (EACH(row, rows)) {
        double error[2];
        errors_of(0, 2, row->sets, 0, error);
        const char *line =
            formatted("| %s | %.1f %% | %.1f %% |", row->name, error[0], error[1]);
        for (EACH(c, cells)) {
            double peak = 0, delay = 0;
            run_cell(tables[c->table], row->sets, c->voltage, &peak, &delay);
            line = formatted("%s %.2f N, %.0f ms |", line, peak, 1e3 * delay);
        }
        page_says("%s", line);
    }
    page_says("shows %.0f N in a later bounce",
              number("thesis/table-4-1", "motor.voltage=5 printed.program=listing",
                     "peak_force_N"));

    // a peak is one of the program's samples
    SCOPED(forget) computed c = run_of("thesis/table-4-2", "");
    double most = 0;
    for (EACH_ROW(row, &c.result.trace)) {
        most = fmax(most, row->force);
    }
    check_close(c.result.summary.peak_force_N, most, 0);
}

// What was tried to explain the delays of the impact dynamics.
TEST(what_was_tried_on_the_delays)
{
    thesis_tables t;
    DONE(tables_compute(&t, &f));
    double error[7] = {0};
    for (int k = 0; k < 12; k++) {
        const char *name = formatted("4.%d", 1 + k / 4);
        const table_row *r = row_of(&t, name, "printed", "delay_dynamics");
        const double T = r->computed[k % 4], wanted = r->printed[k % 4];
        const double tried[] = {floor(1e3 * T) / 1e3, T - 1e-3,  T - 2e-3,   M_PI / 4 * T,
                                M_PI / 4 * T + 1e-3,  2 * T / 3, T / sqrt(2)};
        for (int i = 0; i < 7; i++) {
            error[i] += 100 * fabs(tried[i] - wanted) / wanted / 12;
        }
    }
    const double *off = error;
    for (EACH_TEXT(tried, "$T$ cut to whole steps", "$T$ less one step",
                   "$T$ less two steps",
                   "$\\frac{\\pi}{4}T$, the true quarter oscillation",
                   "$\\frac{\\pi}{4}T$ and a step", "$\\frac23T$", "$T/\\sqrt2$")) {
        page_says("| %s | %.1f %% |", *tried, *off++);
    }
}

// ---- chapter 5

// Root mean square of a signal less the plan's while the impact mode lasts, in percent of
// what the plan spans.
static double off_the_plan(const trace *t, size_t signal, size_t plan)
{
    double low = HUGE_VAL, high = -HUGE_VAL, squares = 0, time = 0;
    for (size_t i = 0; i + 1 < t->row_count; i++) {
        const char *row = (const char *)&t->rows[i],
                   *next = (const char *)&t->rows[i + 1];
        double a[2], b[2];
        memcpy(&a[0], row + signal, sizeof a[0]);
        memcpy(&a[1], next + signal, sizeof a[1]);
        memcpy(&b[0], row + plan, sizeof b[0]);
        memcpy(&b[1], next + plan, sizeof b[1]);
        if (t->rows[i].controller_mode != 1 || t->rows[i + 1].controller_mode != 1) {
            continue;
        }
        const double width = t->rows[i + 1].time - t->rows[i].time;
        const double mean = (fabs(a[0] - b[0]) + fabs(a[1] - b[1])) / 2;
        low = fmin(low, fmin(b[0], b[1]));
        high = fmax(high, fmax(b[0], b[1]));
        squares += width * mean * mean;
        time += width;
    }
    return 100 * sqrt(squares / time) / (high - low);
}

// From the first contact until the force first reaches nine tenths of the steady one.
static double rise_time(const computed *c)
{
    const trace *t = &c->result.trace;
    const double goal = 0.9 * c->result.summary.steady_force_N;
    const double touch = c->result.summary.first_contact_s;
    size_t i = 1;
    while (t->rows[i].time <= touch || t->rows[i].force < goal) {
        i++;
    }
    const sample *a = &t->rows[i - 1], *b = &t->rows[i];
    return a->time + (goal - a->force) / (b->force - a->force) * (b->time - a->time) -
           touch;
}

TEST(figures_of_the_hybrid_controller)
{
    double off[2][2];
    for (int i = 0; i < 2; i++) {
        SCOPED(forget)
        computed c = run_with("thesis/fig-5-2", "arm.links=%d", i == 0 ? 2 : 8);
        const trace *t = &c.result.trace;
        off[i][0] =
            off_the_plan(t, offsetof(sample, encoder), offsetof(sample, desired_angle));
        off[i][1] = off_the_plan(t, offsetof(sample, tachometer),
                                 offsetof(sample, desired_velocity));
        if (i == 1) {
            page_says("they hit %.0f times", c.result.summary.impacts);
        }
    }
    page_says("%.1f %% and %.1f %% of the plan's span off it", off[0][0], off[0][1]);
    page_says("and are %.0f %% and %.0f %% off\n", off[1][0], off[1][1]);

    // 5.6 and 5.7 are the run of 5.1 at twice the force
    SCOPED(forget)
    computed one = run_of("thesis/fig-5-1", ""), two = run_of("thesis/fig-5-7", "");
    SCOPED(forget) computed angle = run_of("thesis/fig-5-6", "");
    assert_true(
        one.scenario.parameters.initial.angle == two.scenario.parameters.initial.angle &&
        one.scenario.parameters.initial.angle == angle.scenario.parameters.initial.angle);
    SCOPED(forget) computed far = run_of("thesis/fig-5-7", "initial.angle=-0.1");
    page_says("agrees at 1 N: one contact, 90 %% of the steady force after %.3f s, "
              "settled after %.2f s; at 2 N one contact, settled after %.2f s, but "
              "90 %% only after %.3f s, and after %.3f s from 0.1 rad",
              rise_time(&one), one.result.summary.settling_time_s,
              two.result.summary.settling_time_s, rise_time(&two), rise_time(&far));
    assert_true(one.result.summary.separations == 0 &&
                two.result.summary.separations == 0);
}

TEST(numbers_of_the_control_laws)
{
    const double hybrid = number("compare/hybrid", "", "peak_force_N");
    page_says("agrees: %.2f N against %.2f N",
              number("compare/bang-bang", "", "peak_force_N"), hybrid);
    page_says("agrees: %.2f N instead of %.2f N, and %.2f s later at the wall",
              number("compare/speed-limit", "", "peak_force_N"), hybrid,
              number("compare/speed-limit", "", "first_contact_s") -
                  number("compare/hybrid", "", "first_contact_s"));
    page_says("agrees: %.2f N and %.2f N",
              number("compare/vibration-phase", "wall.angle=0.11", "peak_force_N"),
              number("compare/vibration-phase", "wall.angle=0.21", "peak_force_N"));
    page_says("steady force %.2f of the command as printed, %.2f corrected",
              number("compare/hybrid-printed", "", "steady_force_N"),
              number("compare/hybrid", "", "steady_force_N"));
    assert_int_equal((int)number("compare/force-integral-soft-wall", "wall.contact=rigid",
                                 "impacts"),
                     9);
    assert_int_equal((int)number("compare/force-integral-soft-wall", "", "separations"),
                     0);

    // told where the wall is by different means
    const double told =
        number("compare/hybrid", "belief.wall_error=0.02", "steady_force_N");
    const double film =
        number("compare/hybrid", "belief.wall_error=0.02 control.impact_angle=film",
               "steady_force_N");
    const double measured =
        number("compare/hybrid",
               "belief.wall_error=0.02 control.impact_angle=accelerometer",
               "steady_force_N");
    page_says("the force is %.2f N off when told, %.2f N by film, below 0.003 N by "
              "[accelerometer]",
              fabs(told - 1), fabs(film - 1));
    check_below(fabs(measured - 1), 0.003);

    // gains from which on the proportional law bounces, and rates at which the hybrid
    // fails
    static const int gains[] = {1, 3, 4, 6};
    for (int i = 0; i < 4; i++) {
        SCOPED(forget)
        computed c = run_with("compare/force-pd", "control.force_gain=%d", gains[i]);
        const summary *m = &c.result.summary;
        assert_true(i == 0   ? m->separations == 0 && m->settling_time_s > 0
                    : i == 1 ? m->separations == 1 && m->settling_time_s > 0
                             : m->separations > 1 && isnan(m->settling_time_s));
    }
    page_says("at 1 V/N one contact, at 3 V/N a bounce, from 4 V/N on it bounces and "
              "never settles");
    static const int rates[] = {30, 50, 55, 100, 160, 170, 200};
    for (int i = 0; i < 7; i++) {
        const char *rate = formatted("control.rate=%d", rates[i]);
        const double on_spring = number("compare/sampling-rate", rate, "settling_time_s");
        const double rigid =
            number("compare/sampling-rate", formatted("%s arm.hub_joint=rigid", rate),
                   "settling_time_s");
        assert_int_equal(isnan(on_spring), i == 0 || (i >= 2 && i <= 4));
        assert_int_equal(isnan(rigid), i == 0);
    }
    page_says("agrees on a hub spring, 55 to 160 Hz fail; on a rigid hub 30 Hz do");
}

// The files one behind the other.
static void read_pages(FILE *into, char *const *files)
{
    for (; *files != NULL; files++) {
        KEPT_TEXT(text) = file_text(*files);
        fputs(text, into);
    }
}

int main(int argc, char **argv)
{
    WRITTEN(text, read_pages(stream, argv + (argc > 0)));
    page = text;
    const int failed = run_cases(NULL, NULL);
    free(page);
    return failed != 0;
}
