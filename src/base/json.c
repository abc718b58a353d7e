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
    char *copy = NULL;
    if (string == NULL && errno != ENOMEM) {
        copy = strdup(text);
    }

    // a file's name may be no UTF-8, which JSON cannot hold
    for (char *c = copy; c != NULL && *c != '\0'; c++) {
        if (!((unsigned char)*c < 0x80)) {
            *c = '?';
        }
    }
    if (copy != NULL) {
        string = json_string(copy);
        free(copy);
    }
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

json_t *json_members(json_t *object, const char *members, ...)
{
    va_list list;
    va_start(list, members);
    while (*members != '\0') {
        char key[64];
        const int length = (int)strcspn(members, ":");
        assert(length < (int)sizeof key && members[length] == ':');
        snprintf(key, sizeof key, "%.*s", length, members);

        const char type = members[length + 1];
        json_t *value;
        if (type == 'n') {
            value = json_number(va_arg(list, double));
        } else if (type == 'i') {
            value = json_integer(va_arg(list, int));
        } else if (type == 'b') {
            value = json_boolean(va_arg(list, int));
        } else if (type == 't') {
            value = json_text(va_arg(list, const char *));
        } else {
            value = va_arg(list, json_t *);
        }
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

// An array of plain values stands on one line.
static void write_array(FILE *stream, const json_t *array, int depth)
{
    size_t length = json_array_size(array);
    bool nested = false;

    fputc('[', stream);

    // values stand side by side, what has parts of its own on lines of its own
    for (size_t i = 0; i < length; i++) {
        const json_t *element = json_array_get(array, i);
        nested = json_is_object(element) || json_is_array(element);

        if (i > 0) {
            fputs(nested ? "," : ", ", stream);
        }
        if (nested) {
            write_indent(stream, depth + 1);
        }
        write_indented(stream, element, depth + 1);
    }
    if (nested) {
        write_indent(stream, depth);
    }
    fputc(']', stream);
}

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
