// Tables that people recorded: what is read, and where what cannot be read stands.
#include "src/base/csv_table.h"

#include "tests/check.h"

static status read_table(csv_table *t, const char *text, size_t least, fault *f)
{
    put_file("table.csv", text);
    *f = (fault){.text = ""};
    return csv_table_read(t, "table.csv", least, f);
}

TEST(columns_are_found_by_name_and_converted)
{
    SCOPED(csv_table_finish) csv_table t;
    double *values;
    DONE(read_table(&t,
                    "\xEF\xBB\xBF\"t\" [ms],speed[rpm],\"a, \"\"b\"\"[V]\",plain\r\n"
                    "0, 60 ,1,2\r\n\n500,30,-1e3,3",
                    2, &f));
    assert_int_equal(t.rows, 2);
    assert_int_equal(t.lines[1], 4);
    const struct {
        const char *heading, *unit;
        double first, second;
    } cases[] = {{"t", "s", 0, 0.5},
                 {"speed", "rad/s", 6.283185307179586, 3.141592653589793},
                 {"speed[rad/s]", "rad/s", 60, 30},
                 {"a, \"b\"", "V", 1, -1000},
                 {"plain[mV]", "V", 2e-3, 3e-3},
                 {"plain", "N", 2, 3}};
    for (EACH(c, cases)) {
        DONE(csv_table_numbers(&t, c->heading, c->unit, GAPS_REFUSED, &values, &f));
        check_close(values[0], c->first, 1e-15);
        check_close(values[1], c->second, 1e-15);
        free(values);
    }
}

// One table as many programs write it: 0, 0.5 and 1 s, 1.5, -2 and 2500 V.
TEST(a_table_is_read_however_it_is_written)
{
    static const char *const texts[] = {
        "time[s],v[V]\n0,1.5\n0.5,-2\n1,2500\n",
        "time[s];v[V]\n0;1,5\n0,5;-2\n1;2,5e3\n",
        "time (s)\tv (mV)\r\n0\t1500\r\n0.5\t-2e3\r\n1\t2500000\r\n",
        "  time    v\n  0.0   1.5\n  0.5  -2.0  \n  1.0  2500\n",
        "time|v\n0|1.5\n0.5|-2\n1|2500\n",
        "\"time, ms\",\"v, V\"\n\"0\",\"1,5\"\n\"500\",\"-2\"\n\"1000\",\"2500\"\n",
        "Scope: X2, 3\" probe\nDate,2026\n\ntime,v\ns,V\n0,1.5\n.5,-2\n1,2500\n",
        "time;v;\n[ms];[V];\n0;1.5;\n500;-2;\n1000;2500;\n",
        "# a bench's \"log\n# time[s],v[V]\n0,1.5\n# pause\n0.5,-2\n1,2500\n",
        "% time v\n0 1.5\n0.5 -2\n1 2500\n",
        "\"time\",\"v\"\n\"1\",0,1.5\n\"2\",0.5,-2\n\"3\",1,2500\n",
        "time_ms,v_V,note\n0,1.5,begin\n500,-2,\n1000,2500,\"a, b\"\n",
        "t/s,V/kV,v/V\r0,7,1.5\r0.5,7,-2\r1,7,2500\r",
        "\xEF\xBB\xBFTIME[us],V[V]\n0,1.5\n5e5,-2\n1e6,2500\n,,\n",
        "sample v\n# mV\n0 1500\n1 -2000\n2 2.5e6\n",
        "time_s,v_V,speed_rad/s\n0,1.5,1\n0.5,-2,1\n1,2500,1\n",
        "sample,v\n0,1.5\n1,-2\n2,2500\n",
        "time[#],v\n0,1.5\n1,-2\n2,2500\n",
        "time,v\n0,1.5\n0.5,-2\n1,2500\n1.5",
        "Model,X2\nUnits,s\nInterval,0.5\nLength,3\n\ntime,v\n0,1.5\n0.5,-2\n1,2500\n",
        "\"3 inch scope\ntime;v\n0;1,5\n0,5;-2\n1;2500\n",
        "time,v,note\n0,1.5,\"open\n0.5,-2,x\n1,2500,\"again\n",
        "\"time\n[s]\",\"v\nof it\",v\n0,7,1.5\n0.5,7,-2\n1,7,2500\n",
        "index,Elapsed_(ms),v\n7,0,1.5\n8,500,-2\n9,1000,2500\n",
        "speed m/s;Zeit/s;v\n1;0;1,5\n2;0,5;-2\n1;1;2500\n",
        "time,v,v\n0,1.5,1.5\n0.5,-2,-2\n1,2500,2500\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        SCOPED(csv_table_finish) csv_table t = {0};
        SCOPED(free_kept) double *times = NULL, *volts = NULL;
        sample_clock clock;
        DONE(read_table(&t, texts[i], 2, &f));
        DONE(csv_table_times(&t, NULL, 2, &clock, &times, &f));
        DONE(csv_table_numbers(&t, "v", "V", GAPS_REFUSED, &volts, &f));
        assert_int_equal(t.rows, 3);
        for (int r = 0; r < 3; r++) {
            static const double expected[] = {1.5, -2, 2500};
            check_close(times[r], 0.5 * r, 1e-15);
            check_close(volts[r], expected[r], 1e-12);
        }
    }
}

// What is left out or moved is told; what lasts is held or missing.
TEST(rows_without_a_time_are_left_out_and_gaps_filled)
{
    char text[4096] = "time[s],v[V],n[N]\n", told[200];
    for (int i = 0; i < 60; i++) {
        const char *volts = i % 3 == 1 ? "1" : (i % 2 ? "#N/A" : "-nan");
        char time[16];
        snprintf(time, sizeof time, "%d", i);
        if (i == 20) {
            time[0] = '\0';
        } else if (i == 31) {
            snprintf(time, sizeof time, "29.5");
        }
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s,%s,%s\n", time,
                 volts, i % 2 ? "2" : "");
    }
    snprintf(text + strlen(text), sizeof text - strlen(text), "60,1");
    SCOPED(csv_table_finish) csv_table t = {0};
    SCOPED(free_kept) double *times = NULL, *volts = NULL, *newtons = NULL;
    sample_clock clock;
    DONE(read_table(&t, text, 2, &f));
    DONE(csv_table_times(&t, "time", 0, &clock, &times, &f));
    DONE(csv_table_numbers(&t, "v", "V", GAPS_HELD, &volts, &f));
    DONE(csv_table_numbers(&t, "n", "N", GAPS_MISSING, &newtons, &f));
    assert_int_equal(t.rows, 59);
    check_close(times[20], 21, 1e-12);
    check_close(times[29], 29.5, 1e-12);
    check_close(times[30], 30, 1e-12);
    assert_int_equal(t.lines[29], 33);
    check_close(volts[0], 1, 0);
    check_close(volts[58], 1, 0);
    assert_true(isnan(newtons[0]) && newtons[1] == 2 && newtons[58] == 2);
    assert_string_equal(
        csv_table_left_out(&t, told, sizeof told),
        "line 62, which breaks off, is left out; 1 without a time (the "
        "first in line 22); 1 before the row above by time, put in order");
}

// A second recording below the first, however short, is not mixed into it.
TEST(a_recording_that_begins_anew_is_refused)
{
    char text[4096] = "log\ntime[s],v[V]\n";
    for (int i = 0; i < 310; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "%d,1\n", i % 300);
    }
    SCOPED(csv_table_finish) csv_table t = {0};
    double *times = NULL;
    sample_clock clock;
    fault f;
    assert_int_equal(read_table(&t, text, 2, &f), STATUS_OK);
    assert_int_equal(csv_table_times(&t, "time", 0, &clock, &times, &f),
                     STATUS_BAD_ARGUMENT);
    assert_null(times);
    assert_int_equal(f.line, 303);
    assert_non_null(strstr(f.text, "0 s lies before that of a row above, 299 s"));
}

// Times that come to the nearest of their last digit are those of the samples, times that
// scatter more are their own.
TEST(rounded_stamps_are_the_samples_and_others_their_own)
{
    char text[2][4096] = {"time[ms],v\n", "time[ms],v\n"};
    for (int i = 0; i < 100; i++) {
        const double own = 3 * i + (i % 7) * 0.05;
        snprintf(text[0] + strlen(text[0]), sizeof text[0] - strlen(text[0]), "%.0f,1\n",
                 i * 3.3);
        snprintf(text[1] + strlen(text[1]), sizeof text[1] - strlen(text[1]), "%.4f,1\n",
                 own);
    }
    for (int k = 0; k < 2; k++) {
        SCOPED(csv_table_finish) csv_table t = {0};
        SCOPED(free_kept) double *times = NULL;
        sample_clock clock;
        DONE(read_table(&t, text[k], 2, &f));
        DONE(csv_table_times(&t, "time", 0, &clock, &times, &f));
        for (int i = 0; i < 100; i++) {
            const double own = 1e-3 * (3 * i + (i % 7) * 0.05);
            const double wanted = k == 0 ? i * 3.3e-3 : own;
            check_close(times[i], wanted, k == 0 ? 6e-5 : 1e-12);
        }
    }
}

TEST(what_cannot_be_read_is_named_with_line_and_column)
{
    const struct {
        const char *text;
        int line, column; // 0: nowhere
        const char *said;
    } cases[] = {
        {"", 1, 1, "0 rows"},
        {"time[s],v[V]\n", 1, 1, "0 rows"},
        {"time[s],v[V]\n0,1\n", 2, 1, "1 row below"},
        {"time[s],v[V]\n0,1\n1\n", 3, 1, "fewer than 2"},
        {"time[s],v[V]\n0,1\n1,2,3\n", 3, 2, "more than 2"},
        {"time[s],w[V]\n0,1\n1,2\n", 1, 1, "no column 'v'"},
        {"time[s],v[furlong]\n0,1\n1,2\n", 1, 2, "[furlong]"},
        {"time[N],v[V]\n0,1\n1,2\n", 1, 1, "[N]"},
        {"time[s],v[V]\n0,1\n1,nan\n", 3, 2, "'nan'"},
        {"time[s],v[V]\n0,1\n1,inf\n", 3, 2, "'inf'"},
        {"time[s],v[V]\n0,\n1,2\n", 2, 2, "''"},
        {"time[s],v[V]\n0,1\n1,2x\n", 3, 2, "'2x'"},
        {"time[s],v[V]\n0,1\n1,1e999\n", 3, 2, "'1e999'"},
        {"time[s];v[V]\n0;1,5\n1;2.000\n", 3, 2, "such as 1,5"},
        {"time,v,w,v\n0,1,2,1\n1,2,3,4\n", 3, 4, "columns 2 and 4"},
        {"Model,X2\ntime[s],w[V]\n0,1\n1,2\n", 2, 1, "'time[s]', 'w[V]'"},
        {"log\n\ntime[s],v[furlong]\n0,1\n1,2\n", 3, 2, "[furlong]"},
        {"time[s],v[V]\n1,1\n0.5,2\n", 3, 1, "growing"},
    };
    for (EACH(c, cases)) {
        csv_table t;
        fault f;
        double *times = NULL, *values = NULL;
        status code = read_table(&t, c->text, 2, &f);
        if (code == STATUS_OK) {
            sample_clock clock;
            code = csv_table_times(&t, "time", 0, &clock, &times, &f);
            code = code == STATUS_OK
                       ? csv_table_numbers(&t, "v", "V", GAPS_REFUSED, &values, &f)
                       : code;
            csv_table_finish(&t);
        }
        assert_int_equal(code, STATUS_BAD_ARGUMENT);
        free(times);
        assert_null(values);
        assert_non_null(strstr(f.text, c->said));
        assert_int_equal(f.line, c->line);
        assert_int_equal(f.column, c->column);
    }

    // what is no table at all
    csv_table t;
    fault f;
    assert_int_equal(csv_table_read(&t, "/nowhere/at/all.csv", 2, &f),
                     STATUS_CANNOT_READ);
    assert_int_equal(csv_table_read(&t, "/", 2, &f), STATUS_CANNOT_READ);
}

TEST(between_rows_a_value_holds_or_lies_on_a_line)
{
    const double times[] = {0, 1, 1, 3}, values[] = {5, 6, 8, 10};
    const struct {
        double time, held, linear;
    } cases[] = {{-1, 5, 5}, {0, 5, 5},   {0.5, 5, 5.5}, {1, 8, 8},
                 {2, 8, 9},  {3, 10, 10}, {9, 10, 10}};
    for (EACH(c, cases)) {
        check_close(csv_table_at(times, values, 4, c->time, false), c->held, 0);
        check_close(csv_table_at(times, values, 4, c->time, true), c->linear, 0);
    }
}

ALL_BETWEEN(enter_folder, leave_folder)
