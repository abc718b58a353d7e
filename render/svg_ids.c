#include "render/svg_ids.h"

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

char *svg_renumber_ids(const char *svg)
{
    static const char *const openings[] = {" id=\"", "\"#", "url(#"};
    GHashTable *names = collect_ids(svg);
    GString *out = g_string_sized_new(strlen(svg) + 1);
    while (*svg != '\0') {
        size_t length = 0;
        for (size_t i = 0; i < G_N_ELEMENTS(openings) && length == 0; i++) {
            size_t n = strlen(openings[i]);
            length = strncmp(svg, openings[i], n) == 0 ? n : 0;
        }
        if (length == 0) {
            g_string_append_c(out, *svg++);
            continue;
        }
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
