// CSV files: headings with units, quotes where RFC 4180 requires them, empty cells for
// unknown values.
#include "src/base/csv.h"

#include "tests/check.h"

typedef struct memory_file {
    char *text;
    size_t length;
    csv_writer csv;
} memory_file;

static void open_memory(memory_file *m)
{
    m->csv = csv_begin(open_memstream(&m->text, &m->length));
}

static void check_written(memory_file *m, const char *expected)
{
    fclose(m->csv.stream);
    assert_string_equal(m->text, expected);
    free(m->text);
}

TEST(headings_carry_units)
{
    memory_file m;
    open_memory(&m);
    csv_heading(&m.csv, "force", "N");
    csv_heading(&m.csv, "impacts", "");
    csv_heading(&m.csv, "value", NULL);
    csv_heading(&m.csv, "a,b", "m");
    csv_heading(&m.csv, "rate", "m, s");
    csv_end_row(&m.csv);
    check_written(&m, "force[N],impacts[],value,\"a,b[m]\",\"rate[m, s]\"\n");
}

TEST(texts_are_quoted_where_they_could_be_misread)
{
    memory_file m;
    open_memory(&m);
    csv_text(&m.csv, "plain text");
    csv_text(&m.csv, "one, two");
    csv_text(&m.csv, "say \"ah\"");
    csv_text(&m.csv, "two\nlines");
    csv_text(&m.csv, "");
    csv_end_row(&m.csv);
    csv_text(&m.csv, "next");
    csv_text(&m.csv, "\"\x1b[1m\xff\"");
    csv_end_row(&m.csv);
    check_written(&m, "plain text,\"one, two\",\"say "
                      "\"\"ah\"\"\",\"two\nlines\",\nnext,\"\"\"?[1m?\"\"\"\n");
}

TEST(missing_numbers_are_empty)
{
    memory_file m;
    open_memory(&m);
    csv_number(&m.csv, (double)NAN);
    csv_number(&m.csv, 0.1);
    csv_number(&m.csv, (double)INFINITY);
    csv_end_row(&m.csv);
    check_written(&m, ",0.1,inf\n");
}
