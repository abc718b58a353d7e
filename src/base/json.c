#include "src/base/json.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/numbers.h"

void json_put(json_t *object, const char *key, json_t *value)
{
    loss_unless(json_object_set_new(object, key, value) == 0);
}

void json_add(json_t *array, json_t *value)
{
    loss_unless(json_array_append_new(array, value) == 0);
}

json_t *json_number(double value)
{
    if (isfinite(value)) {
        return json_real(value);
    }
    return json_null();
}

json_t *json_text(const char *text)
{
    errno = 0;
    json_t *string = json_string(text);
    if (string != NULL || errno == ENOMEM) {
        return string;
    }

    // a file's name may be no UTF-8, which JSON cannot hold
    char *copy = strdup(text);
    if (copy == NULL) {
        return NULL;
    }
    for (char *c = copy; *c != '\0'; c++) {
        if ((unsigned char)*c >= 0x80) {
            *c = '?';
        }
    }
    string = json_string(copy);
    free(copy);
    return string;
}

json_t *json_numbers(const double *values, int count)
{
    assert(count >= 0 && (values != NULL || count == 0));
    json_t *array = json_array();
    for (int i = 0; i < count; i++) {
        json_add(array, json_number(values[i]));
    }
    return array;
}

// The next of the values, of the type that a letter names.
static json_t *next_member_value(char type, va_list *list)
{
    if (type == 'n') {
        return json_number(va_arg(*list, double));
    }
    if (type == 'i') {
        return json_integer(va_arg(*list, int));
    }
    if (type == 'b') {
        return json_boolean(va_arg(*list, int));
    }
    if (type == 't') {
        return json_text(va_arg(*list, const char *));
    }
    return va_arg(*list, json_t *);
}

json_t *json_members(json_t *object, const char *members, ...)
{
    va_list list;
    va_start(list, members);
    while (*members != '\0') {
        // key:t, where t is the type of its value
        char key[64];
        const int length = (int)strcspn(members, ":");
        assert(length < (int)sizeof key && members[length] == ':');
        snprintf(key, sizeof key, "%.*s", length, members);

        // its value is the next argument
        json_t *value = next_member_value(members[length + 1], &list);
        json_put(object, key, value);

        members += length + 2;
        members += strspn(members, " ");
    }
    va_end(list);
    return object;
}

// A value without parts of its own, as jansson writes it.
static void write_leaf(FILE *stream, const json_t *value)
{
    loss_unless(value != NULL && json_dumpf(value, stream, JSON_ENCODE_ANY) == 0);
}

static void write_indented(FILE *stream, const json_t *value, int depth);

static void write_indent(FILE *stream, int depth)
{
    fprintf(stream, "\n%*s", 2 * depth, "");
}

// An object, a member on each line.
static void write_object(FILE *stream, const json_t *object, int depth)
{
    const char *key, *separator = "";
    json_t *member;
    fputc('{', stream);

    // a line a member
    json_object_foreach((json_t *)object, key, member)
    {
        fputs(separator, stream);
        write_indent(stream, depth + 1);
        json_t *name = json_text(key);
        write_leaf(stream, name);
        json_decref(name);
        fputs(": ", stream);
        write_indented(stream, member, depth + 1);
        separator = ",";
    }

    if (separator[0] != '\0') {
        write_indent(stream, depth);
    }
    fputc('}', stream);
}

// An array: plain values stand on one line, values with parts of their own on lines of
// their own.
static void write_array(FILE *stream, const json_t *array, int depth)
{
    size_t length = json_array_size(array);
    bool nested = false;

    fputc('[', stream);

    for (size_t i = 0; i < length; i++) {
        const json_t *element = json_array_get(array, i);
        nested = json_is_object(element) || json_is_array(element);

        if (i > 0) {
            fputc(',', stream);
        }
        if (nested) {
            write_indent(stream, depth + 1);
        } else if (i > 0) {
            fputc(' ', stream);
        }
        write_indented(stream, element, depth + 1);
    }
    if (nested) {
        write_indent(stream, depth);
    }
    fputc(']', stream);
}

// A value, its parts indented by its depth within others.
static void write_indented(FILE *stream, const json_t *value, int depth)
{
    char text[NUMBER_TEXT];
    if (json_is_object(value)) {
        write_object(stream, value, depth);
    } else if (json_is_array(value)) {
        write_array(stream, value, depth);
    } else if (json_is_number(value)) {
        number_format(text, json_number_value(value)); // whole ones like all others
        fputs(text, stream);
    } else {
        write_leaf(stream, value);
    }
}

void json_write(FILE *stream, const json_t *value)
{
    json_write_member(stream, value, 0);
    fputc('\n', stream);
}

void json_write_member(FILE *stream, const json_t *value, int depth)
{
    assert(depth >= 0);
    loss_unless(value != NULL);
    if (value != NULL) {
        write_indented(stream, value, depth);
    }
}
