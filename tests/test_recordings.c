// Recordings as recorders and people write them: a recording of a known arm is written
// anew, by another clock, in another unit, precision and layout, with rows and cells that
// are missing. What a person can read is read by identify, playback and the lab's :data,
// and right; what nobody can read is refused with file and line.
//
//   test_recordings COUNT
#include "src/base/csv_table.h"
#include "src/study/identify/identify.h"
#include "tests/rig_fixture.h"

enum { BASES = 3, MOST_SAMPLES = 800, COLUMNS = 5, FITTED = 2 };

static int mutations = 60;
static const char *const paths[FITTED] = {"arm.k2", "motor.viscous_friction"};
static const double truth[FITTED] = {5.3, 0.007};
static const char recording_csv[] = "mutated.csv";

// What was recorded: time [s], command [V], encoder [rad], tachometer [rad/s], force [N].
typedef struct recorded {
    int rate, samples;
    double duration;
    double rows[MOST_SAMPLES][COLUMNS];
    double value[FITTED]; // fitted to exact rows
    summary played;       // the run under its commands, by a file of exact times
} recorded;

static recorded bases[BASES];

// A recording written anew.
typedef struct mutation {
    int base;
    double scatter, fast, begin, unit; // of stamps: share of a period, relative, [s], 1/s
    int decimals;
    double known_rate;        // of the scenario
    int lost, empty, doubled; // a row, a cell, a row twice in so many; 0: none
    int heading;              // how it names units
    char separator[8], decimal;
    const char *clock;             // heading of its times
    const char *line_end, *before; // of each line; what stands above the headings
    bool marked, quoted, unit_row, counted_rows, trailing, swapped, breaks_off, degrees;
    bool counter, headless,
        unsaid; // time as a number; no headings, ms of which none says
} mutation;

// --- the recordings --------------------------------------------------------------------

static scenario rig_scenario(const recorded *r, bool as_recorded)
{
    static action reversals[3];
    scenario s = {.name = (char *)"rig", .actions = reversals, .action_count = 3};
    for (int i = 0; i < 3; i++) {
        reversals[i] = SETS(0.1 + 0.2 * i, control.approach_voltage, i % 2 == 0 ? 1 : 3);
    }
    const char *known = "arm.k2=5.6 motor.viscous_friction=0.009";
    if (as_recorded) {
        known = "arm.k2=5.3 motor.viscous_friction=0.007";
    }
    s.parameters = rig_parameters_with(
        "control.law=open-loop control.rate=%d method.step=0.0005 initial.angle=-0.5 "
        "control.approach_voltage=2 run.duration=%g control.seed=%d %s",
        r->rate, r->duration, r->rate, known);
    return s;
}

// Runs the arm and takes the rows that a recorder would.
static void record(recorded *r)
{
    scenario s = rig_scenario(r, true);
    KEPT_RUN(run) = run_done(&s, true);
    r->samples = (int)(r->duration * r->rate);
    assert_true(r->samples <= MOST_SAMPLES && run.summary.peak_force_N > 0);
    for (int k = 0; k < r->samples; k++) {
        // a row within the period shows what the sample at its beginning read
        const double within = (k + 0.7) / r->rate;
        const sample *row = &run.trace.rows[trace_row_at(&run.trace, within)];
        const double values[COLUMNS] = {(double)k / r->rate, row->command, row->encoder,
                                        row->tachometer, row->force_reading};
        memcpy(r->rows[k], values, sizeof values);
    }
}

// --- writing them anew -----------------------------------------------------------------

static random_generator chance;

static int one_of(int count)
{
    return (int)(random_uniform(&chance) * count) % count;
}

static bool sometimes(double share)
{
    return random_uniform(&chance) < share;
}

static double between(double low, double high)
{
    return low + (high - low) * random_uniform(&chance);
}

static mutation draw_mutation(void)
{
    static const double units[] = {1, 1, 1e3, 1e6, 1e9};
    static const double begins[] = {0, 0, 0, -0.2, 5.25, 1000, 1764420000.5};
    static const char *const separators[] = {",", ",", ";", "\t", "|", "  ", ", "};
    static const char *const befores[] = {
        "",
        "",
        "",
        "# bench 3, \"left\n# 2026\n",
        "Device: X2\nDate;2026\n\n",
        "% log\n",
        "Model,X2\nUnits,s\nInterval,0.01\nLength,400\nGain,2\n\n",
        "\"3 inch, left\n"};
    static const char *const clocks[] = {"time", "time", "T", "Zeit", "elapsed"};
    static const char *const line_ends[] = {"\n", "\n", "\r\n", "\r"};
    mutation m = {.base = one_of(BASES), .decimal = '.'};
    const recorded *r = &bases[m.base];

    // its clock
    m.scatter = sometimes(0.5) ? between(0, 0.005) : 0;
    m.fast = sometimes(0.5) ? between(-2e-4, 2e-4) : 0;
    m.begin = begins[one_of(7)];
    m.unit = units[one_of(5)];
    const int least = (int)ceil(log10(2.0 * r->rate / m.unit));
    m.decimals = (least > 0 ? least : 0) + one_of(4);
    m.counter = sometimes(0.05);
    m.known_rate = m.counter || m.fast != 0 || sometimes(0.5) ? r->rate : 333;

    // its rows
    m.lost = sometimes(0.3) ? 10 + one_of(50) : 0;
    m.empty = sometimes(0.3) ? 2 + one_of(5) : 0;
    m.doubled = sometimes(0.1) ? 2 + one_of(9) : 0;
    m.swapped = sometimes(0.1);
    m.breaks_off = sometimes(0.1);

    // its layout
    m.heading = one_of(6);
    snprintf(m.separator, sizeof m.separator, "%s", separators[one_of(7)]);
    m.line_end = line_ends[one_of(4)];
    m.before = befores[one_of(8)];
    m.clock = clocks[one_of(5)];
    m.marked = sometimes(0.2);
    m.quoted = m.separator[0] == ',' && sometimes(0.3);
    m.decimal = (m.separator[0] != ',' || m.quoted) && sometimes(0.4) ? ',' : '.';
    m.counted_rows = sometimes(0.1);
    m.trailing = m.separator[0] != ' ' && !m.counted_rows && sometimes(0.2);
    m.degrees = sometimes(0.2);

    // one in a hundred each that nobody can read
    m.headless = sometimes(0.01);
    m.unsaid = sometimes(0.01);
    if (m.unsaid) {
        m.unit = 1e3;
        m.counter = false;
        m.clock = "time";
    }
    return m;
}

// The heading of a column in one of the usual manners.
static void write_heading(FILE *file, const mutation *m, const char *name,
                          const char *unit)
{
    static const char *const manners[] = {"%s[%s]", "%s (%s)",    "%s_%s",
                                          "%s/%s",  "\"%s, %s\"", "%s"};
    const char *manner = manners[m->heading];
    if (m->heading == 1 && m->separator[0] == ' ') {
        manner = "%s(%s)";
    }
    char text[80];
    snprintf(text, sizeof text, manner, name, unit);
    const char *quote = m->quoted && text[0] != '"' ? "\"" : "";
    fprintf(file, "%s%s%s", quote, text, quote);
}

static void write_field(FILE *file, const mutation *m, const char *text)
{
    char field[64];
    snprintf(field, sizeof field, "%s", text);
    char *point = strchr(field, '.');
    if (point != NULL) {
        *point = m->decimal;
    }
    const char *quote = m->quoted ? "\"" : "";
    fprintf(file, "%s%s%s", quote, field, quote);
}

static const char *time_unit(const mutation *m)
{
    return m->unit == 1 ? "s" : m->unit == 1e3 ? "ms" : m->unit == 1e6 ? "us" : "ns";
}

static void write_headings(FILE *file, const mutation *m)
{
    const char *const names[COLUMNS] = {m->clock, "command", "encoder", "tachometer",
                                        "force_reading"};
    const char *units[COLUMNS] = {time_unit(m), "V", "rad", "rad/s", "N"};
    if (m->degrees) {
        units[2] = "deg";
        units[3] = "deg/s";
    }
    mutation here = *m;
    for (int c = 0; c < COLUMNS; c++) {
        const bool count = c == 0 && m->counter;
        here.heading = count || (c == 0 && m->unsaid) ? 5 : m->heading;
        fputs(c > 0 ? m->separator : "", file);
        write_heading(file, &here, count ? "sample" : names[c], units[c]);
    }
    fprintf(file, "%s%s", m->trailing ? m->separator : "", m->line_end);

    // units that the headings do not have stand below them
    for (int c = 0; c < COLUMNS && m->heading == 5 && !m->unsaid; c++) {
        fputs(c > 0 ? m->separator : "", file);
        write_field(file, m, c == 0 && m->counter ? "#" : units[c]);
    }
    if (m->heading == 5 && !m->unsaid) {
        fprintf(file, "%s%s", m->trailing ? m->separator : "", m->line_end);
    }
}

// Writes sample k as row `number`, its stamp so much off.
static void write_row(FILE *file, const mutation *m, int k, double off, int number)
{
    const recorded *r = &bases[m->base];
    const double time = m->begin + r->rows[k][0] * (1 + m->fast) + off;
    if (m->counted_rows) {
        fprintf(file, "%d%s", number, m->separator);
    }
    char text[64];
    snprintf(text, sizeof text, "%.*f", m->decimals, m->unit * time);
    if (m->counter) {
        snprintf(text, sizeof text, "%d", k);
    }
    write_field(file, m, text);
    for (int c = 1; c < COLUMNS; c++) {
        const double degree = m->degrees && (c == 2 || c == 3) ? 180 / M_PI : 1;
        snprintf(text, sizeof text, "%.9g", degree * r->rows[k][c]);
        const bool empty = m->empty > 0 && c > 1 && (k + c) % m->empty != 0;
        if (empty) {
            snprintf(text, sizeof text, "%s", m->separator[0] == ' ' ? "nan" : "");
        }
        fputs(m->separator, file);
        write_field(file, m, text);
    }
    fprintf(file, "%s%s", m->trailing ? m->separator : "", m->line_end);
}

static void write_mutated(const mutation *m)
{
    const recorded *r = &bases[m->base];
    FILE *file = fopen(recording_csv, "w");
    assert_non_null(file);
    fputs(m->marked ? "\xEF\xBB\xBF" : "", file);
    for (const char *c = m->before; *c != '\0'; c++) {
        if (*c == '\n') {
            fputs(m->line_end, file);
        } else {
            fputc(*c, file);
        }
    }
    if (!m->headless) {
        write_headings(file, m);
    }
    int number = 1;
    for (int k = 0; k < r->samples; k++) {
        int from = k;
        if (m->swapped && k % 97 == 50 && k + 1 < r->samples) {
            from = k + 1; // before the row that belongs here
        } else if (m->swapped && k % 97 == 51) {
            from = k - 1;
        }
        // what tells of another command is not lost
        const bool tells = from == 0 || r->rows[from][1] != r->rows[from - 1][1];
        if (m->lost > 0 && from % m->lost == 7 && !tells) {
            continue;
        }
        const double off = m->scatter * (2 * random_uniform(&chance) - 1) / r->rate;
        write_row(file, m, from, off, number++);
        if (m->doubled > 0 && from % m->doubled == 1) {
            write_row(file, m, from, off, number++);
        }
    }
    if (m->breaks_off && !m->counted_rows) {
        fputs("1.7", file);
    }
    assert_int_equal(fclose(file), 0);
}

// --- reading them ----------------------------------------------------------------------

// A sentence that names file and line.
static bool names_line(const char *text)
{
    const char *name = strstr(text, recording_csv);
    return name != NULL && name[strlen(recording_csv)] == ':' &&
           name[strlen(recording_csv) + 1] >= '1' &&
           name[strlen(recording_csv) + 1] <= '9';
}

// Fits the recording; whether it is read. off[] becomes how far the values are from
// those of exact rows, in their standard errors.
static bool fits(const mutation *m, double off[FITTED], double value[FITTED], fault *why)
{
    scenario base = rig_scenario(&bases[m->base], false);
    base.parameters.control.rate = m->known_rate;
    SCOPED(identify_finish)
    identification id = {.base = &base, .jobs = 1, .starts = 1};
    for (int i = 0; i < FITTED; i++) {
        DONE(identify_add_path(&id, paths[i], &f));
    }
    if (identify_add_trace(&id, recording_csv, NULL, 0, why) != STATUS_OK) {
        return false;
    }
    DONE(identify_fit(&id, &f));
    for (int i = 0; i < FITTED; i++) {
        assert_true(id.fit[i].determined);
        off[i] = (id.fit[i].value - bases[m->base].value[i]) / id.fit[i].standard_error;
        value[i] = id.fit[i].value;
    }
    return true;
}

// Plays its commands back.
static summary play(const mutation *m)
{
    const recorded *r = &bases[m->base];
    return rig_summary_with(
        "control.law=playback control.playback_file=%s control.rate=%d "
        "method.step=0.0005 initial.angle=-0.5 run.duration=%g arm.k2=5.3 "
        "motor.viscous_friction=0.007 control.playback_shift=%.17g",
        recording_csv, r->rate, r->duration, m->begin < 0 && !m->counter ? -m->begin : 0);
}

// Lays it under a run as :data does: the largest speed stands where it was recorded, to
// the stamps' errors.
static bool lies_right(const mutation *m, fault *f)
{
    const recorded *r = &bases[m->base];
    SCOPED(csv_table_finish) csv_table table = {0};
    SCOPED(trace_finish) trace t = {0};
    trace_init(&t, 1);
    if (csv_table_read(&table, recording_csv, 1, f) != STATUS_OK ||
        measured_rows(&t, &table, m->known_rate, NULL, -1, 0, f) != STATUS_OK) {
        return false;
    }
    size_t largest = 0;
    for (size_t i = 0; i < t.row_count; i++) {
        if (t.rows[i].tachometer > t.rows[largest].tachometer ||
            isnan(t.rows[largest].tachometer)) {
            largest = i;
        }
    }
    const double since = t.rows[largest].time - t.rows[0].time;
    const int k = (int)(since * r->rate + 0.5);
    const double digit = 1 / m->unit / pow(10, m->decimals);
    check_close(t.rows[largest].tachometer, r->rows[k][3], 1e-8);
    check_close(since, r->rows[k][0],
                2 * m->scatter / r->rate + digit + fabs(m->fast) + 1e-6);
    return true;
}

// The run under exact commands, to compare with.
static void play_exactly(int base)
{
    const mutation exact = {.base = base,
                            .known_rate = bases[base].rate,
                            .unit = 1,
                            .decimals = 9,
                            .decimal = '.',
                            .separator = ",",
                            .clock = "time",
                            .line_end = "\n",
                            .before = ""};
    write_mutated(&exact);
    bases[base].played = play(&exact);

    // the values of exact rows are near the truth by themselves
    double off[FITTED];
    recorded *r = &bases[base];
    memcpy(r->value, truth, sizeof truth);
    fault f;
    assert_true(fits(&exact, off, r->value, &f));
    for (int i = 0; i < FITTED; i++) {
        print_message("%d Hz: %s %.3g errors off\n", r->rate, paths[i], off[i]);
        check_below(fabs(off[i]), 4);
    }
}

TEST(what_a_person_can_read_is_read_and_right)
{
    static const int rates[BASES] = {500, 200, 1000};
    int refused = 0;
    double farthest = 0;
    for (int i = 0; i < BASES; i++) {
        bases[i] = (recorded){.rate = rates[i], .duration = 0.75};
        record(&bases[i]);
        play_exactly(i);
    }
    for (int n = 0; n < mutations; n++) {
        random_seed(&chance, (uint64_t)n);
        const mutation m = draw_mutation();
        const recorded *r = &bases[m.base];
        write_mutated(&m);

        // what nobody can read is refused
        double off[FITTED];
        fault f = {.text = ""};
        const bool unreadable = m.headless || m.unsaid;
        double value[FITTED];
        const bool read = fits(&m, off, value, &f);
        fail_if(read == unreadable, "mutation %d: %s", n, f.text);
        if (unreadable) {
            fail_if(!names_line(f.text), "mutation %d: %s", n, f.text);
            fail_if(m.headless && lies_right(&m, &f), "mutation %d is read", n);
            fail_if(!names_line(f.text), "mutation %d: %s", n, f.text);
            refused++;
            continue;
        }
        for (int i = 0; i < FITTED; i++) {
            fail_if(fabs(off[i]) > 3, "mutation %d: %s is %.3g errors off", n, paths[i],
                    off[i]);
            farthest = fmax(farthest, fabs(off[i]));
        }

        // the same run under its commands, to the last bit
        const summary is = play(&m);
        fail_if(is.message[0] != '\0' && strstr(is.message, recording_csv) == NULL,
                "mutation %d: %s", n, is.message);
        fail_if(is.peak_force_N != r->played.peak_force_N,
                "mutation %d: peak %.9g N for %.9g N", n, is.peak_force_N,
                r->played.peak_force_N);
        fail_if(!lies_right(&m, &f), "mutation %d: %s", n, f.text);
    }
    print_message("%d of %d refused, values up to %.3g errors off\n", refused, mutations,
                  farthest);
    assert_true(refused <= mutations / 20);
}

int main(int argc, char **argv)
{
    fault f;
    mutations = argc > 1 ? atoi(argv[1]) : mutations;
    if (identify_available(&f) != STATUS_OK) {
        return 77;
    }
    return run_cases(enter_folder, leave_folder);
}
