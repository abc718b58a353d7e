#include "render/page/svg_ids.h"

#include <assert.h>
#include <glib.h>
#include <string.h>

// Length of the id that begins at `text`: all up to the quote or bracket that ends it.
static size_t id_length(const char *text)
{
    return strcspn(text, "\"')");
}

// The new name of an id that has not been seen yet: its letters and its place.
static char *new_name(const char *id, GHashTable *names)
{
    size_t letters = strcspn(id, "0123456789");
    return g_strdup_printf("%.*s%u", (int)letters, id, g_hash_table_size(names));
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

char *svg_prefix_ids(const char *svg, const char *prefix)
{
    assert(svg != NULL && prefix != NULL);
    GString *out = g_string_sized_new(strlen(svg) + 1);

    // the prefix stands between the opening and the identifier
    while (*svg != '\0') {
        size_t length = opening_length(svg);
        if (length == 0) {
            g_string_append_c(out, *svg++);
            continue;
        }
        g_string_append_len(out, svg, (gssize)length);
        g_string_append(out, prefix);
        svg += length;
    }
    return g_string_free(out, FALSE);
}

char *svg_renumber_ids(const char *svg)
{
    assert(svg != NULL);
    GHashTable *names = collect_ids(svg);
    GString *out = g_string_sized_new(strlen(svg) + 1);

    // all but identifiers is copied
    while (*svg != '\0') {
        size_t length = opening_length(svg);
        if (length == 0) {
            g_string_append_c(out, *svg++);
            continue;
        }

        // an identifier that is known gets its number
        g_string_append_len(out, svg, (gssize)length);
        svg += length;
        char *id = g_strndup(svg, id_length(svg));
        const char *name = g_hash_table_lookup(names, id);
        g_string_append(out, name ? name : id);
        svg += strlen(id);
        g_free(id);
    }

    g_hash_table_destroy(names);
    return g_string_free(out, FALSE);
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
    GString *kept = drop_known(svg, known, renamed), *out = g_string_sized_new(kept->len);

    // references to what went
    for (const char *at = kept->str; *at != '\0';) {
        if (strncmp(at, "\"#", 2) == 0) {
            char *name = g_strndup(at + 2, id_length(at + 2));
            const char *other = g_hash_table_lookup(renamed, name);
            g_string_append_printf(out, "\"#%s", other != NULL ? other : name);
            at += 2 + strlen(name);
            g_free(name);
        } else {
            g_string_append_c(out, *at++);
        }
    }
    g_string_free(kept, TRUE);
    g_hash_table_destroy(renamed);
    return g_string_free(out, FALSE);
}
