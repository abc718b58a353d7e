#include "src/study/expression.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/numbers.h"

enum { MOST_DEPTH = 100, KEY_TEXT = 128 };

// An expression being read, from left to right by recursive descent.
typedef struct reader {
    const char *text, *at;
    expression_key find;
    void *context;
    fault *fault;
    status code; // of the first fault; nothing is read after it
    int depth;
} reader;

// What is wrong, at a place of the text. Returns NaN.
__attribute__((format(printf, 3, 4))) static double refuse(reader *r, const char *at,
                                                           const char *format, ...)
{
    char why[400];
    va_list list;
    if (r->code == STATUS_OK) {
        const int column = (int)(at - r->text) + 1;
        va_start(list, format);
        decimal_vprint(why, sizeof why, format, list);
        va_end(list);
        r->code = fault_set_place(r->fault, STATUS_BAD_ARGUMENT, 1, column,
                                  "'%.200s', column %d: %s", r->text, column, why);
    }
    return (double)NAN;
}

// Whether the next character is one of `set`, without blanks before it; it is not taken.
static bool is_next(reader *r, const char *set)
{
    while (is_blank(*r->at)) {
        r->at++;
    }
    return *r->at != '\0' && strchr(set, *r->at) != NULL;
}

static void expect(reader *r, char c)
{
    if (is_next(r, (char[]){c, '\0'})) {
        r->at++;
    } else if (*r->at == '\0') {
        refuse(r, r->at, "expected '%c' at the end", c);
    } else {
        refuse(r, r->at, "expected '%c', not '%.20s'", c, r->at);
    }
}

static double read_sum(reader *r);

// A key, or max of two or more.
static double read_word(reader *r)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    const char *start = r->at, *near = NULL;
    const size_t length = strspn(start, letters);
    char name[KEY_TEXT];
    double value;
    snprintf(name, sizeof name, "%.*s", (int)length, start);
    r->at += length;

    if (strcmp(name, "max") == 0 && is_next(r, "(")) {
        r->at++;
        value = read_sum(r);
        do {
            expect(r, ',');
            const double other = read_sum(r);
            value = isnan(value) || isnan(other) ? (double)NAN : fmax(value, other);
        } while (r->code == STATUS_OK && is_next(r, ","));
        expect(r, ')');
        return value;
    }
    if (length == 0) {
        return refuse(r, start, "expected a key, a number, max or '(', not '%.20s'", start);
    }
    return r->find(r->context, name, &value, &near)
               ? value
               : refuse(r, start, "there is no quantity '%s'%s%s%s", name,
                        near != NULL ? ", did you mean '" : "", near != NULL ? near : "",
                        near != NULL ? "'?" : "");
}

// A number, a word or an expression in brackets, with its signs.
static double read_factor(reader *r)
{
    double value;
    if (r->code != STATUS_OK || ++r->depth > MOST_DEPTH) {
        return refuse(r, r->at, "more than %d brackets and signs within each other", MOST_DEPTH);
    }
    if (is_next(r, "+-")) {
        const bool minus = *r->at++ == '-';
        value = read_factor(r);
        value = minus ? -value : value;
    } else if (is_next(r, "(")) {
        r->at++;
        value = read_sum(r);
        expect(r, ')');
    } else if (!is_next(r, "0123456789.") || !decimal_read(r->at, &value, &r->at)) {
        value = read_word(r);
    }
    r->depth--;
    return value;
}

static double read_product(reader *r)
{
    double value = read_factor(r);
    while (r->code == STATUS_OK && is_next(r, "*/")) {
        const bool times = *r->at++ == '*';
        const double other = read_factor(r);
        value = times ? value * other : value / other;
    }
    return value;
}

static double read_sum(reader *r)
{
    double value = read_product(r);
    while (r->code == STATUS_OK && is_next(r, "+-")) {
        const bool plus = *r->at++ == '+';
        const double other = read_product(r);
        value = plus ? value + other : value - other;
    }
    return value;
}

status expression_evaluate(const char *text, expression_key find, void *context, double *value,
                           fault *f)
{
    assert(text != NULL && find != NULL && value != NULL);
    reader r = {.text = text, .at = text, .find = find, .context = context, .fault = f};
    *value = read_sum(&r);
    is_next(&r, "");
    if (r.code == STATUS_OK && *r.at != '\0') {
        refuse(&r, r.at, "expected an operator or the end, not '%.20s'", r.at);
    }
    return r.code;
}
