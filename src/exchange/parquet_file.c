#include "src/exchange/parquet_file.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/shipped.h"
#include "src/base/text_stream.h"

// Rows of a group: as many as fill GROUP_BYTES with numbers, within these bounds. Readers
// share their work by groups, and each column of each costs a hundred bytes more.
enum { GROUP_BYTES = 1 << 24, LEAST_ROWS = 1 << 12, MOST_ROWS = 1 << 16 };

// Numbers that the format gives to types, encodings and properties.
enum {
    TYPE_INT64 = 2,
    TYPE_DOUBLE = 5,
    TYPE_BYTE_ARRAY = 6,
    CONVERTED_UTF8 = 0,
    REPETITION_OPTIONAL = 1,
    ENCODING_PLAIN = 0,
    ENCODING_RLE = 3,
    PAGE_OF_DATA = 0,
    CODEC_NONE = 0,
    FORMAT_VERSION = 1
};

static const char magic[4] = {'P', 'A', 'R', '1'};

// --- bytes -----------------------------------------------------------------------------

// Bytes in memory, which grow as they are added.
typedef struct byte_string {
    unsigned char *at;
    size_t length, capacity;
    bool lost; // for want of memory
} byte_string;

static void add_bytes(byte_string *b, const void *bytes, size_t size)
{
    // room for twice as many whenever it is full
    if (b->length + size > b->capacity) {
        const size_t wanted = 2 * (b->length + size);
        unsigned char *grown = realloc(b->at, wanted);
        if (grown == NULL) {
            b->lost = true;
            return;
        }
        b->at = grown;
        b->capacity = wanted;
    }

    memcpy(b->at + b->length, bytes, size);
    b->length += size;
}

static void add_byte(byte_string *b, int byte)
{
    const unsigned char one = (unsigned char)byte;
    add_bytes(b, &one, 1);
}

// A whole number, seven bits a byte, the lowest first.
static void add_varint(byte_string *b, uint64_t value)
{
    enum { MORE = 0x80 };
    for (; value >= MORE; value >>= 7) {
        add_byte(b, (int)(value & (MORE - 1)) | MORE);
    }
    add_byte(b, (int)value);
}

// Four bytes, the lowest first, as everywhere in the format.
static void add_word(byte_string *b, size_t value)
{
    const uint32_t word = (uint32_t)value;
    add_bytes(b, &word, sizeof word);
}

// --- Thrift's compact protocol ---------------------------------------------------------

// A struct is its fields, each with a byte of its number (as far from the one before) and
// its type, then a zero byte. Whole numbers are zigzag varints: 0, -1, 1, -2 ...
typedef enum thrift_type {
    THRIFT_I32 = 5,
    THRIFT_I64 = 6,
    THRIFT_BINARY = 8,
    THRIFT_LIST = 9,
    THRIFT_STRUCT = 12
} thrift_type;

enum { THRIFT_DEPTH = 8 };

typedef struct thrift {
    byte_string *to;
    int last[THRIFT_DEPTH]; // number of the latest field of each struct that is open
    int depth;
} thrift;

static void thrift_field(thrift *t, int number, thrift_type type)
{
    const int step = number - t->last[t->depth];
    assert(step > 0 && step < 16);
    add_byte(t->to, step << 4 | (int)type);
    t->last[t->depth] = number;
}

static void thrift_zigzag(thrift *t, int64_t value)
{
    assert(value >= 0); // of the fields here none is negative
    add_varint(t->to, (uint64_t)value << 1);
}

static void thrift_whole(thrift *t, int number, thrift_type type, size_t value)
{
    thrift_field(t, number, type);
    thrift_zigzag(t, (int64_t)value);
}

static void thrift_characters(thrift *t, const char *text)
{
    const size_t length = strlen(text);
    add_varint(t->to, length);
    add_bytes(t->to, text, length);
}

static void thrift_text(thrift *t, int number, const char *text)
{
    thrift_field(t, number, THRIFT_BINARY);
    thrift_characters(t, text);
}

// The elements follow.
static void thrift_list(thrift *t, int number, thrift_type of, size_t count)
{
    enum { MOST_IN_BYTE = 15 };
    thrift_field(t, number, THRIFT_LIST);
    if (count < MOST_IN_BYTE) {
        add_byte(t->to, (int)count << 4 | (int)of);
    } else {
        add_byte(t->to, MOST_IN_BYTE << 4 | (int)of);
        add_varint(t->to, count);
    }
}

// Opens a struct: the whole, an element of a list, or after thrift_field a field.
static void thrift_open(thrift *t)
{
    t->depth++;
    assert(t->depth < THRIFT_DEPTH);
    t->last[t->depth] = 0;
}

static void thrift_close(thrift *t)
{
    add_byte(t->to, 0);
    t->depth--;
}

// --- columns ---------------------------------------------------------------------------

// A column of the group that is being filled: its values, plain and without what is
// missing, and runs of fields that are there (level 1) or missing (level 0).
typedef struct column_chunk {
    byte_string values, levels;
    size_t run;            // fields of the latest run, which is not in levels yet
    int level;             // of that run
    size_t missing;        // fields
    double least, largest; // of numbers that are there; largest is less where none is
} column_chunk;

struct parquet_file {
    FILE *stream;
    size_t written; // bytes of the file so far
    const parquet_column *columns;
    column_chunk *chunks;
    int count;
    size_t group_rows; // rows of a full group
    size_t rows;       // in the present group
    size_t all_rows;   // in the groups before
    size_t groups;
    byte_string footer; // where the columns of each group are
    byte_string scratch;
};

static void put(parquet_file *p, const void *bytes, size_t size)
{
    fwrite(bytes, 1, size, p->stream);
    p->written += size;
}

// Begins a group: nothing is there yet.
static void begin_chunk(column_chunk *c)
{
    c->levels.length = c->values.length = 0;
    c->missing = 0;
    c->least = HUGE_VAL;
    c->largest = -HUGE_VAL;
}

parquet_file *parquet_begin(FILE *stream, const parquet_column *columns, int count)
{
    assert(count > 0);
    parquet_file *p = calloc(1, sizeof *p);
    if (p == NULL) {
        return NULL;
    }
    p->stream = stream;
    p->columns = columns;
    p->count = count;
    p->chunks = calloc((size_t)count, sizeof *p->chunks);
    if (p->chunks == NULL) {
        free(p);
        return NULL;
    }

    p->group_rows = GROUP_BYTES / (sizeof(double) * (size_t)count);
    if (p->group_rows < LEAST_ROWS) {
        p->group_rows = LEAST_ROWS;
    } else if (p->group_rows > MOST_ROWS) {
        p->group_rows = MOST_ROWS;
    }

    for (int i = 0; i < count; i++) {
        begin_chunk(&p->chunks[i]);
    }
    put(p, magic, sizeof magic);
    return p;
}

// Ends the run of fields with one level: its length, doubled, and the level in a byte.
static void end_run(column_chunk *c)
{
    if (c->run > 0) {
        add_varint(&c->levels, (uint64_t)c->run << 1);
        add_byte(&c->levels, c->level);
    }
    c->run = 0;
}

// Counts a field that is there (1) or missing (0).
static void add_level(column_chunk *c, int level)
{
    if (level != c->level) {
        end_run(c);
        c->level = level;
    }
    c->run++;
    c->missing += level == 0;
}

// Eight bytes of a number as its column has it.
static void add_number(byte_string *b, parquet_type type, double value)
{
    if (type == PARQUET_WHOLE_NUMBER) {
        const int64_t whole = (int64_t)value;
        add_bytes(b, &whole, sizeof whole);
    } else {
        add_bytes(b, &value, sizeof value);
    }
}

void parquet_number(parquet_file *p, int column, double value)
{
    column_chunk *c = &p->chunks[column];
    assert(column < p->count && p->columns[column].type != PARQUET_TEXT);
    add_level(c, !isnan(value));
    if (isnan(value)) {
        return;
    }
    c->least = smaller(value, c->least);
    c->largest = larger(value, c->largest);

    add_number(&c->values, p->columns[column].type, value);
}

void parquet_text(parquet_file *p, int column, const char *text)
{
    column_chunk *c = &p->chunks[column];
    assert(column < p->count && p->columns[column].type == PARQUET_TEXT);
    add_level(c, text != NULL);
    if (text != NULL) {
        add_word(&c->values, strlen(text));
        add_bytes(&c->values, text, strlen(text));
    }
}

// --- groups ----------------------------------------------------------------------------

// The header of a column's page of `size` bytes.
static void page_header(byte_string *to, size_t size, size_t rows)
{
    thrift t = {.to = to};
    thrift_whole(&t, 1, THRIFT_I32, PAGE_OF_DATA);
    thrift_whole(&t, 2, THRIFT_I32, size); // as it is, and compressed
    thrift_whole(&t, 3, THRIFT_I32, size);
    thrift_field(&t, 5, THRIFT_STRUCT);
    thrift_open(&t);
    thrift_whole(&t, 1, THRIFT_I32, rows);
    thrift_whole(&t, 2, THRIFT_I32, ENCODING_PLAIN);
    thrift_whole(&t, 3, THRIFT_I32, ENCODING_RLE); // of what is there and what is missing
    thrift_whole(&t, 4, THRIFT_I32, ENCODING_RLE); // of repetitions, which there are none
    thrift_close(&t);
    add_byte(to, 0);
}

static int type_of(const parquet_column *column)
{
    static const int types[] = {[PARQUET_NUMBER] = TYPE_DOUBLE,
                                [PARQUET_WHOLE_NUMBER] = TYPE_INT64,
                                [PARQUET_TEXT] = TYPE_BYTE_ARRAY};
    return types[column->type];
}

// A number as the bytes of its column's type.
static void thrift_number(thrift *t, int number, parquet_type type, double value)
{
    thrift_field(t, number, THRIFT_BINARY);
    add_varint(t->to, sizeof value);
    add_number(t->to, type, value);
}

// Says how many fields are missing and between what its numbers lie, so that a reader can
// pass over the group. A zero stands for both signs: the largest is +0, the least -0.
static void tell_range(thrift *t, const column_chunk *c, parquet_type type)
{
    thrift_field(t, 12, THRIFT_STRUCT);
    thrift_open(t);
    thrift_whole(t, 3, THRIFT_I64, c->missing);
    if (c->least <= c->largest) {
        thrift_number(t, 5, type, c->largest == 0 ? 0.0 : c->largest);
        thrift_number(t, 6, type, c->least == 0 ? -0.0 : c->least);
    }
    thrift_close(t);
}

// Says in the footer where a column of a group lies, at that byte, of that size, and what
// is in it.
static void tell_column(thrift *t, const parquet_column *column, const column_chunk *c,
                        size_t rows, size_t from, size_t size)
{
    thrift_open(t);
    thrift_whole(t, 2, THRIFT_I64, from);
    thrift_field(t, 3, THRIFT_STRUCT);
    thrift_open(t);
    thrift_whole(t, 1, THRIFT_I32, (size_t)type_of(column));
    thrift_list(t, 2, THRIFT_I32, 2); // encodings
    thrift_zigzag(t, ENCODING_PLAIN);
    thrift_zigzag(t, ENCODING_RLE);
    thrift_list(t, 3, THRIFT_BINARY, 1); // its path in the table
    thrift_characters(t, column->name);
    thrift_whole(t, 4, THRIFT_I32, CODEC_NONE);
    thrift_whole(t, 5, THRIFT_I64, rows);
    thrift_whole(t, 6, THRIFT_I64, size); // as it is, and compressed
    thrift_whole(t, 7, THRIFT_I64, size);
    thrift_whole(t, 9, THRIFT_I64, from);
    tell_range(t, c, column->type);
    thrift_close(t);
    thrift_close(t);
}

// Writes a column of the present group: its page's header, levels and values.
static void write_column(parquet_file *p, thrift *t, int column)
{
    column_chunk *c = &p->chunks[column];
    const size_t from = p->written;
    end_run(c);

    byte_string *head = &p->scratch;
    head->length = 0;
    page_header(head, sizeof(uint32_t) + c->levels.length + c->values.length, p->rows);
    add_word(head, c->levels.length);
    put(p, head->at, head->length);
    put(p, c->levels.at, c->levels.length);
    if (c->values.length > 0) {
        put(p, c->values.at, c->values.length);
    }
    tell_column(t, &p->columns[column], c, p->rows, from, p->written - from);
    begin_chunk(c);
}

// Writes the present group, if it has rows, and begins the next.
static void write_group(parquet_file *p)
{
    thrift t = {.to = &p->footer};
    const size_t from = p->written;
    if (p->rows == 0) {
        return;
    }

    thrift_list(&t, 1, THRIFT_STRUCT, (size_t)p->count);
    for (int i = 0; i < p->count; i++) {
        write_column(p, &t, i);
    }
    thrift_whole(&t, 2, THRIFT_I64, p->written - from);
    thrift_whole(&t, 3, THRIFT_I64, p->rows);
    add_byte(&p->footer, 0);

    p->all_rows += p->rows;
    p->groups++;
    p->rows = 0;
}

void parquet_end_row(parquet_file *p)
{
    p->rows++;
    if (p->rows == p->group_rows) {
        write_group(p);
    }
}

// --- the end ---------------------------------------------------------------------------

// The root of the table, and its columns.
static void tell_schema(thrift *t, const parquet_file *p)
{
    thrift_list(t, 2, THRIFT_STRUCT, (size_t)p->count + 1);
    thrift_open(t);
    thrift_text(t, 4, "table");
    thrift_whole(t, 5, THRIFT_I32, (size_t)p->count);
    thrift_close(t);

    for (int i = 0; i < p->count; i++) {
        thrift_open(t);
        thrift_whole(t, 1, THRIFT_I32, (size_t)type_of(&p->columns[i]));
        thrift_whole(t, 3, THRIFT_I32, REPETITION_OPTIONAL);
        thrift_text(t, 4, p->columns[i].name);
        if (p->columns[i].type == PARQUET_TEXT) {
            thrift_whole(t, 6, THRIFT_I32, CONVERTED_UTF8);
        }
        thrift_close(t);
    }
}

static void tell_note(thrift *t, const char *key, const char *value)
{
    thrift_open(t);
    thrift_text(t, 1, key);
    thrift_text(t, 2, value);
    thrift_close(t);
}

// The notes: those given, then the unit of each column.
static void tell_notes(thrift *t, const parquet_file *p, const parquet_note *notes,
                       int note_count)
{
    thrift_list(t, 5, THRIFT_STRUCT, (size_t)note_count + (size_t)p->count);
    for (int i = 0; i < note_count; i++) {
        tell_note(t, notes[i].key, notes[i].value);
    }
    for (int i = 0; i < p->count; i++) {
        char key[128];
        snprintf(key, sizeof key, "unit.%s", p->columns[i].name);
        tell_note(t, key, p->columns[i].unit);
    }
}

// That the ranges of all columns are in the order of their types.
static void tell_orders(thrift *t, const parquet_file *p)
{
    thrift_list(t, 7, THRIFT_STRUCT, (size_t)p->count);
    for (int i = 0; i < p->count; i++) {
        thrift_open(t);
        thrift_field(t, 1, THRIFT_STRUCT);
        add_byte(t->to, 0);
        thrift_close(t);
    }
}

// Writes what the file says of itself, its size, and the magic word again.
static void write_footer(parquet_file *p, const parquet_note *notes, int note_count)
{
    thrift t = {.to = &p->scratch};
    char creator[64];
    snprintf(creator, sizeof creator, "impactlab version %s", lab_version());
    p->scratch.length = 0;

    thrift_whole(&t, 1, THRIFT_I32, FORMAT_VERSION);
    tell_schema(&t, p);
    thrift_whole(&t, 3, THRIFT_I64, p->all_rows);
    thrift_list(&t, 4, THRIFT_STRUCT, p->groups);
    add_bytes(&p->scratch, p->footer.at, p->footer.length);
    tell_notes(&t, p, notes, note_count);
    thrift_text(&t, 6, creator);
    tell_orders(&t, p);
    add_byte(&p->scratch, 0);

    add_word(&p->scratch, p->scratch.length);
    add_bytes(&p->scratch, magic, sizeof magic);
    put(p, p->scratch.at, p->scratch.length);
}

// Frees bytes, and notes what they lost.
static void finish_bytes(byte_string *b)
{
    loss_unless(!b->lost);
    free(b->at);
}

void parquet_end(parquet_file *p, const parquet_note *notes, int note_count)
{
    if (p == NULL) {
        return;
    }
    write_group(p);
    write_footer(p, notes, note_count);

    for (int i = 0; i < p->count; i++) {
        finish_bytes(&p->chunks[i].values);
        finish_bytes(&p->chunks[i].levels);
    }
    finish_bytes(&p->footer);
    finish_bytes(&p->scratch);
    free(p->chunks);
    free(p);
}
