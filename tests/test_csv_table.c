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
        DONE(csv_table_numbers(&t, c->heading, c->unit, false, &values, &f));
        check_close(values[0], c->first, 1e-15);
        check_close(values[1], c->second, 1e-15);
        free(values);
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
        {"time[s],v[V]\n1,1\n0.5,2\n", 3, 1, "growing"},
    };
    for (EACH(c, cases)) {
        csv_table t;
        fault f;
        double *times = NULL, *values = NULL;
        status code = read_table(&t, c->text, 2, &f);
        if (code == STATUS_OK) {
            code = csv_table_times(&t, "time", &times, &f);
            code = code == STATUS_OK ? csv_table_numbers(&t, "v", "V", false, &values, &f)
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
