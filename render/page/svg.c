// SVG text: ids that do not depend on what was drawn before, and pictures in fewer bytes.
#include "render/page/svg.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/text.h"
#include "src/base/numbers.h"

// Length of the id that begins at `text`: all up to the quote or bracket that ends it.
static size_t id_length(const char *text)
{
    return strcspn(text, "\"')");
}

// The new name of an id that has not been seen yet: its letters and its place.
static char *new_name(const char *id, GHashTable *names)
{
    size_t letters = strcspn(id, "0123456789");
    return text_printf("%.*s%u", (int)letters, id, g_hash_table_size(names));
}

// Collects all ids; the numbers follow the order in the file.
static GHashTable *collect_ids(const char *svg)
{
    GHashTable *names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    for (const char *c = strstr(svg, " id=\""); c != NULL; c = strstr(c, " id=\"")) {
        c += strlen(" id=\"");
        char *id = g_strndup(c, id_length(c));
        char *name = new_name(id, names);
        g_hash_table_insert(names, id, name);
    }
    return names;
}

// Length of what stands before an id at `text`; 0 if no id follows.
static size_t opening_length(const char *text)
{
    static const char *const openings[] = {" id=\"", "\"#", "url(#"};
    for (size_t i = 0; i < G_N_ELEMENTS(openings); i++) {
        size_t length = strlen(openings[i]);
        if (strncmp(text, openings[i], length) == 0) {
            return length;
        }
    }
    return 0;
}

// The SVG with every id, where it is set and where it is referred to, by its name in the table (may
// be NULL), or else with the prefix before it.
static char *rename_ids(const char *svg, GHashTable *names, const char *prefix)
{
    GString *out = g_string_sized_new(strlen(svg) + 1);
    while (*svg != '\0') {
        size_t length = opening_length(svg);
        if (length == 0) {
            g_string_append_c(out, *svg++);
            continue;
        }

        g_string_append_len(out, svg, (gssize)length);
        svg += length;
        g_autofree char *id = g_strndup(svg, id_length(svg));
        const char *name = names != NULL ? g_hash_table_lookup(names, id) : NULL;
        text_append(out, "%s%s", name ? "" : prefix, name ? name : id);
        svg += strlen(id);
    }
    return g_string_free(out, FALSE);
}

char *svg_prefix_ids(const char *svg, const char *prefix)
{
    assert(svg != NULL && prefix != NULL);
    return rename_ids(svg, NULL, prefix);
}

char *svg_renumber_ids(const char *svg)
{
    assert(svg != NULL);
    GHashTable *names = collect_ids(svg);
    char *renumbered = rename_ids(svg, names, "");
    g_hash_table_destroy(names);
    return renumbered;
}

// Ids of this SVG with known outlines, and the ids to use instead; their symbols are removed.
static GString *drop_known(const char *svg, GHashTable *known, GHashTable *renamed)
{
    static const char opening[] = "<symbol ", closing[] = "</symbol>";
    GString *out = g_string_sized_new(strlen(svg));
    while (*svg != '\0') {
        const char *start = strstr(svg, opening), *id = start ? strstr(start, " id=\"") : NULL;
        const char *inside = id != NULL ? strchr(id, '>') : NULL;
        const char *end = inside != NULL ? strstr(inside, closing) : NULL;
        if (end == NULL) {
            g_string_append(out, svg);
            break;
        }

        // by what is in it
        id += strlen(" id=\"");
        char *name = g_strndup(id, id_length(id));
        char *outline = g_strndup(inside + 1, (gsize)(end - inside - 1));
        const char *earlier = g_hash_table_lookup(known, outline);
        const char *after = end + strlen(closing);
        g_string_append_len(out, svg, (gssize)(earlier != NULL ? start - svg : after - svg));
        if (earlier != NULL) {
            g_hash_table_insert(renamed, name, g_strdup(earlier));
            g_free(outline);
        } else {
            g_hash_table_insert(known, outline, name);
        }
        svg = after;
    }
    return out;
}

char *svg_share_symbols(const char *svg, GHashTable *known)
{
    assert(svg != NULL && known != NULL);
    GHashTable *renamed = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    GString *kept = drop_known(svg, known, renamed);

    // references to what went
    char *shared = rename_ids(kept->str, renamed, "");
    g_string_free(kept, TRUE);
    g_hash_table_destroy(renamed);
    return shared;
}

// ==== fewer bytes

// ---- inside a tag

// A length to a hundredth, without zeros at its end: "123.457031" gives "123.46".
static void add_length(GString *out, double value)
{
    char text[32];
    decimal_print(text, sizeof text, "%.2f", value);
    size_t length = strlen(text);
    while (text[length - 1] == '0') {
        text[--length] = '\0';
    }
    if (text[length - 1] == '.') {
        text[--length] = '\0';
    }
    g_string_append(out, strcmp(text, "-0") == 0 ? "0" : text);
}

// "rgb(0%, 44.7%, 69.8%)" as "#0072b2"; returns what follows it, or NULL if it is none.
static const char *add_colour(GString *out, const char *at)
{
    if (strncmp(at, "rgb(", 4) != 0) {
        return NULL;
    }

    // three percentages with commas between
    double share[3];
    const char *rest = at + 4;
    for (int i = 0; i < 3; i++) {
        if (!decimal_read(rest, &share[i], &rest) || *rest != '%') {
            return NULL;
        }
        rest += 1 + strspn(rest + 1, ", ");
    }
    if (*rest != ')') {
        return NULL;
    }

    // a byte each, which is all that a screen shows
    text_append(out, "#%02x%02x%02x", (unsigned)(2.55 * share[0] + 0.5),
                (unsigned)(2.55 * share[1] + 0.5), (unsigned)(2.55 * share[2] + 0.5));
    return rest + 1;
}

// Length of a property at `at` that says what goes without saying, 0 if there is none.
static size_t default_length(const char *at)
{
    static const char *const defaults[] = {"stroke-opacity:1;", "fill-opacity:1;",
                                           "stroke-miterlimit:10;", "fill-rule:nonzero;"};
    for (size_t i = 0; i < G_N_ELEMENTS(defaults); i++) {
        if (strncmp(at, defaults[i], strlen(defaults[i])) == 0) {
            return strlen(defaults[i]);
        }
    }
    return 0;
}

// A number of tenths with its separator: " 12.3", "-.4".
static void add_tenths(GString *out, long tenths)
{
    char last = out->str[out->len - 1];
    bool letter = g_ascii_isalpha(last);
    long size = labs(tenths);
    char whole[24] = "", fraction[4] = "";
    if (size >= 10 || size == 0) {
        g_snprintf(whole, sizeof whole, "%ld", size / 10);
    }
    if (size % 10 != 0) {
        g_snprintf(fraction, sizeof fraction, ".%d", (int)(size % 10));
    }
    g_string_append(out, tenths < 0 ? "-" : letter ? "" : " ");
    g_string_append(out, whole);
    g_string_append(out, fraction);
}

// The data of a path of lines alone, up to its quote: to a tenth of a point, lines relative to
// where the last one ended. Returns the quote.
static const char *add_lines(GString *out, const char *at)
{
    long x = 0, y = 0;
    char command = ' ', written = ' ';

    // up to whatever is no part of such a path
    while (*at != '"' && *at != '\0') {
        double to[2];
        const char *rest;
        if (*at == ' ') {
            at++;
        } else if (strchr("MLZ", *at) != NULL) {
            command = *at++;
            if (command == 'Z') {
                g_string_append_c(out, 'z');
                written = 'z';
            }
        } else if (decimal_read(at, &to[0], &rest) && decimal_read(rest, &to[1], &rest)) {
            // rounded where it is, so that no error adds up
            long next_x = lround(10 * to[0]), next_y = lround(10 * to[1]);
            char wanted = command == 'M' ? 'M' : 'l';

            // a letter only where it changes; numbers after a move would be taken for lines
            if (written != wanted || wanted == 'M') {
                g_string_append_c(out, wanted);
            }
            add_tenths(out, wanted == 'M' ? next_x : next_x - x);
            add_tenths(out, wanted == 'M' ? next_y : next_y - y);
            x = next_x;
            y = next_y;
            written = wanted;
            at = rest;
        } else {
            return at;
        }
    }
    return at;
}

// Whether the data of a path, up to its quote, are straight lines alone.
static bool has_lines_alone(const char *data)
{
    return data[strcspn(data, "\"CcSsQqTtAaHhVv")] == '"';
}

// A tag from its '<' to its '>' in fewer bytes. Returns what follows the tag.
static const char *add_tag(GString *out, const char *at)
{
    // outlines of letters are small: they keep their hundredths
    bool path = g_str_has_prefix(at, "<path style=\"fill:none;");
    char before = '<';
    while (*at != '\0' && *at != '>') {
        const char *rest = add_colour(out, at);
        size_t skipped = rest == NULL ? default_length(at) : 0;
        bool number = g_ascii_isdigit(*at) || (*at == '-' && g_ascii_isdigit(at[1]));
        bool starts =
            before == ' ' || before == '"' || before == '(' || before == ',' || before == ':';
        double value;

        if (rest != NULL) {
            at = rest;
        } else if (skipped > 0) {
            at += skipped;
        } else if (path && g_str_has_prefix(at, " d=\"") && has_lines_alone(at + 4)) {
            g_string_append(out, " d=\"");
            at = add_lines(out, at + 4);
        } else if (number && starts && decimal_read(at, &value, &rest)) {
            add_length(out, value);
            at = rest;
            while (at[-1] == ' ') {
                at--;
            }
        } else {
            g_string_append_c(out, *at++);
        }
        before = at[-1];
    }
    g_string_append_c(out, '>');
    return *at == '>' ? at + 1 : at;
}

// ---- from tag to tag

// Where the data of a path begin in what was written of it last, if that is a line of the style of
// the tag written at `tag`; SIZE_MAX if the two are not to be one.
static size_t joint_of(const GString *out, size_t last, size_t tag)
{
    const char *a = out->str + last, *b = out->str + tag;
    const char *data = strstr(b, "d=\"");
    size_t style = data != NULL ? (size_t)(data - b) : 0;
    bool lines = strncmp(b, "<path style=\"fill:none;", 23) == 0 && style > 0 && data[3] == 'M';
    bool alike = lines && strncmp(a, b, style + 3) == 0 && strstr(b, "transform=") == NULL &&
                 strncmp(a, "<path", 5) == 0;
    return alike ? tag + style + 3 : (size_t)-1;
}

char *svg_compact(const char *svg)
{
    assert(svg != NULL);
    GString *out = g_string_sized_new(strlen(svg) / 2);
    size_t last = (size_t)-1; // where the last path was written

    while (*svg != '\0') {
        // the page that holds the picture says what it is
        if (g_str_has_prefix(svg, "<metadata>")) {
            const char *end = strstr(svg, "</metadata>");
            svg = end != NULL ? end + strlen("</metadata>") : svg + strlen(svg);
            continue;
        }
        if (*svg != '<') {
            // blanks between tags are none of the picture
            if (*svg != '\n') {
                g_string_append_c(out, *svg);
                last = *svg == ' ' ? last : (size_t)-1;
            }
            svg++;
            continue;
        }

        size_t tag = out->len;
        svg = add_tag(out, svg);
        size_t joint = last != (size_t)-1 ? joint_of(out, last, tag) : (size_t)-1;
        if (joint != (size_t)-1) {
            // the data go to the end of the path before, in place of its quote and slash
            g_autofree char *data = g_strdup(out->str + joint);
            g_string_truncate(out, tag);
            g_string_truncate(out, out->len - strlen("\"/>"));
            g_string_append(out, data);
            continue;
        }
        last = strncmp(out->str + tag, "<path", 5) == 0 && g_str_has_suffix(out->str, "\"/>")
                   ? tag
                   : (size_t)-1;
    }
    return g_string_free(out, FALSE);
}
