#include "src/base/expression.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/words.h"

enum { MOST_DEPTH = 100, KEY_TEXT = 128 };

// An expression being read, from left to right by recursive descent.
typedef struct expression_reader {
    expression *to;
    const char *text, *at;
    expression_find *find;
    void *context;
    fault *fault;
    status code; // of the first fault; nothing is read after it
    int depth;
} expression_reader;

// What is wrong, at a place of the text.
__attribute__((format(printf, 3, 4))) static void
expression_refuse(expression_reader *r, const char *at, const char *format, ...)
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
}

// Appends a step to the expression, which is evaluated on a stack.
static void add_step(expression_reader *r, expression_step step)
{
    if (r->to->count == EXPRESSION_STEPS) {
        expression_refuse(r, r->at, "more than %d names, numbers and operations",
                          EXPRESSION_STEPS);
        return;
    }
    r->to->step[r->to->count++] = step;
}

// Whether the next character is one of `set`, without blanks before it; it is not taken.
static bool is_next(expression_reader *r, const char *set)
{
    while (is_blank(*r->at)) {
        r->at++;
    }
    return *r->at != '\0' && strchr(set, *r->at) != NULL;
}

// Takes the next character, which must be this one.
static void expect(expression_reader *r, char c)
{
    if (is_next(r, (char[]){c, '\0'})) {
        r->at++;
    } else if (*r->at == '\0') {
        expression_refuse(r, r->at, "expected '%c' at the end", c);
    } else {
        expression_refuse(r, r->at, "expected '%c', not '%.20s'", c, r->at);
    }
}

static void read_sum(expression_reader *r);

// The rest of max(a, b, ...), from its bracket on.
static void read_maximum(expression_reader *r)
{
    expect(r, '(');
    read_sum(r);
    do {
        expect(r, ',');
        read_sum(r);
        add_step(r, (expression_step){.what = EXPRESSION_MAX});
    } while (r->code == STATUS_OK && is_next(r, ","));
    expect(r, ')');
}

// Says that what comes next is nothing that an expression begins with.
static void refuse_factor(expression_reader *r)
{
    static const char expected[] = "expected a name, a number, max or '('";
    if (*r->at == '\0') {
        expression_refuse(r, r->at, "%s at the end", expected);
    } else {
        expression_refuse(r, r->at, "%s, not '%.20s'", expected, r->at);
    }
}

// A name, or max of two or more.
static void read_word(expression_reader *r)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    const char *start = r->at, *near = NULL;
    const size_t length = strspn(start, letters);
    if (length == 0) {
        refuse_factor(r);
        return;
    }

    char name[KEY_TEXT];
    snprintf(name, sizeof name, "%.*s", (int)length, start);
    r->at += length;
    if (strcmp(name, "max") == 0 && is_next(r, "(")) {
        read_maximum(r);
        return;
    }
    const int found = r->find(r->context, name, &near);
    if (found < 0) {
        char hint[HINT_TEXT];
        expression_refuse(r, start, "there is no quantity '%s'%s", name,
                          did_you_mean(hint, near, ""));
        return;
    }
    add_step(r, (expression_step){.what = EXPRESSION_NAME, .name = found});
}

// A number, a word or an expression in brackets, with its signs.
static void read_factor(expression_reader *r)
{
    double number;
    if (r->code != STATUS_OK || ++r->depth > MOST_DEPTH) {
        expression_refuse(r, r->at, "more than %d brackets and signs within each other",
                          MOST_DEPTH);
        return;
    }

    if (is_next(r, "+-")) {
        const bool minus = *r->at++ == '-';
        read_factor(r);
        if (minus) {
            add_step(r, (expression_step){.what = EXPRESSION_MINUS});
        }
    } else if (is_next(r, "(")) {
        r->at++;
        read_sum(r);
        expect(r, ')');
    } else if (is_next(r, "0123456789.") && decimal_read(r->at, &number, &r->at)) {
        add_step(r, (expression_step){.what = EXPRESSION_NUMBER, .number = number});
    } else {
        read_word(r);
    }
    r->depth--;
}

// Factors with * and / between them.
static void read_product(expression_reader *r)
{
    read_factor(r);
    while (r->code == STATUS_OK && is_next(r, "*/")) {
        const bool times = *r->at++ == '*';
        read_factor(r);
        if (times) {
            add_step(r, (expression_step){.what = EXPRESSION_MULTIPLY});
        } else {
            add_step(r, (expression_step){.what = EXPRESSION_DIVIDE});
        }
    }
}

// Products with + and - between them.
static void read_sum(expression_reader *r)
{
    read_product(r);
    while (r->code == STATUS_OK && is_next(r, "+-")) {
        const bool plus = *r->at++ == '+';
        read_product(r);
        if (plus) {
            add_step(r, (expression_step){.what = EXPRESSION_ADD});
        } else {
            add_step(r, (expression_step){.what = EXPRESSION_SUBTRACT});
        }
    }
}

// The whole text must be one expression.
status expression_read(expression *e, const char *text, expression_find *find,
                       void *context, fault *f)
{
    expression_reader r = {
        .to = e, .text = text, .at = text, .find = find, .context = context, .fault = f};
    e->count = 0;
    read_sum(&r);
    is_next(&r, "");
    if (r.code == STATUS_OK && *r.at != '\0') {
        expression_refuse(&r, r.at, "expected an operator or the end, not '%.20s'", r.at);
    }
    return r.code;
}

// An operation on two values.
static double combine(int what, double a, double b)
{
    if (what == EXPRESSION_ADD) {
        return a + b;
    }
    if (what == EXPRESSION_SUBTRACT) {
        return a - b;
    }
    if (what == EXPRESSION_MULTIPLY) {
        return a * b;
    }
    if (what == EXPRESSION_DIVIDE) {
        return a / b;
    }

    // the larger one, if both are there
    if (isnan(a) || isnan(b)) {
        return (double)NAN;
    }
    return fmax(a, b);
}

double expression_evaluate(const expression *e, expression_value *value,
                           const void *context)
{
    assert(e->count > 0);
    double stack[EXPRESSION_STEPS];
    int top = -1;

    // values go onto the stack, operations take theirs off it
    for (int i = 0; i < e->count; i++) {
        const expression_step *s = &e->step[i];
        if (s->what == EXPRESSION_NUMBER) {
            stack[++top] = s->number;
        } else if (s->what == EXPRESSION_NAME) {
            stack[++top] = value(context, s->name);
        } else if (s->what == EXPRESSION_MINUS) {
            stack[top] = -stack[top];
        } else {
            top--;
            stack[top] = combine((int)s->what, stack[top], stack[top + 1]);
        }
    }
    return stack[0];
}
