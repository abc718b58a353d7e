// SVG text: ids that follow from the picture alone, and pictures in fewer bytes.
#include "render/page/picture_file.h"

#include <string.h>

#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/base/sha256.h"

// ==== ids

// Where an id is set, and where it or a reference to it stands.
static text_pattern set_id = {"( id=\")([^\"')]*)"};
static text_pattern any_id = {"( id=\"|\"#|url\\(#)([^\"')]*)"};

// What ids become, new ones with a prefix.
typedef struct id_names {
    GHashTable *names;
    const char *prefix;
} id_names;

// Gives an id a new name: the prefix and its place among all.
static gboolean collect_id(const GMatchInfo *match, GString *out, gpointer context)
{
    (void)out;
    const id_names *n = context;
    g_hash_table_insert(n->names, g_match_info_fetch(match, 2),
                        text_printf("%s%u", n->prefix, g_hash_table_size(n->names)));
    return FALSE;
}

// The id's name in the table, where it has one.
static gboolean rename_id(const GMatchInfo *match, GString *out, gpointer names)
{
    g_autofree char *before = g_match_info_fetch(match, 1),
                    *id = g_match_info_fetch(match, 2);
    const char *name = g_hash_table_lookup(names, id);
    text_append(out, "%s%s", before, text_or(name, id));
    return FALSE;
}

char *svg_renumber_ids(const char *svg, const char *prefix)
{
    g_autoptr(GHashTable) names =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    g_free(text_replaced(&set_id, svg, collect_id, &(id_names){names, prefix}));
    return text_replaced(&any_id, svg, rename_id, names);
}

// Forty bits of a digest: that two of a thousand pictures have the same ones happens once
// in two million times.
#define DIGEST_LETTERS 10

// The digest is that of the SVG with ids by their places, which is the same wherever and
// whenever it is drawn.
char *svg_own_ids(const char *svg)
{
    g_autofree char *placed = svg_renumber_ids(svg, "i");
    sha256 digest;
    char digits[SHA256_TEXT];
    sha256_init(&digest);
    sha256_add_text(&digest, placed);
    sha256_finish(&digest, digits);

    // a name of XML begins with a letter
    g_autofree char *prefix = text_printf("i%.*s-", DIGEST_LETTERS, digits);
    return svg_renumber_ids(placed, prefix);
}

// Outlines of earlier SVGs by what is in them, and what this SVG's ids become.
typedef struct letters {
    GHashTable *known, *renamed;
} letters;

// Drops a symbol with a known outline.
static gboolean drop_known(const GMatchInfo *match, GString *out, gpointer context)
{
    const letters *l = context;
    char *name = g_match_info_fetch(match, 1), *outline = g_match_info_fetch(match, 2);
    const char *earlier = g_hash_table_lookup(l->known, outline);
    if (earlier != NULL) {
        g_hash_table_insert(l->renamed, name, g_strdup(earlier));
        g_free(outline);
    } else {
        g_autofree char *whole = g_match_info_fetch(match, 0);
        g_string_append(out, whole);
        g_hash_table_insert(l->known, outline, name);
    }
    return FALSE;
}

// Omits letters that an earlier SVG has.
static char *share_symbols(const char *svg, GHashTable *known)
{
    g_autoptr(GHashTable) renamed =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    static text_pattern symbol = {"<symbol [^>]*? id=\"([^\"')]*)[^>]*>(.*?)</symbol>"};
    g_autofree char *kept =
        text_replaced(&symbol, svg, drop_known, &(letters){known, renamed});
    return text_replaced(&any_id, kept, rename_id, renamed);
}

// ==== fewer bytes

// What a tag says with too many digits or needlessly: a colour in per cent becomes
// "#0072b2", of a number zeros at its end go, and so does what goes without saying.
#define PER_CENT "([-+.\\d]+)%"
#define NUMBER   "(-?\\d+(?:\\.\\d+)?)"
static text_pattern verbose = {"rgb\\(" PER_CENT ", *" PER_CENT ", *" PER_CENT
                               "\\)|(?:stroke-opacity:1|fill-opacity:1|stroke-miterlimit:"
                               "10|fill-rule:nonzero);|xlink:(?=href)| "
                               "(?=[MLCZ])|(?<=[MLCZ]) |(?<= )" NUMBER
                               "|(?<=[\"(,:])" NUMBER};

// How the tag of a line begins.
#define LINE_TAG "<path style=\"fill:none;"

// A number without zeros at its end, and without a sign of zero.
static void append_short_number(GString *out, double value, int decimals)
{
    g_autofree char *text = text_printf("%.*f", decimals, value);
    size_t length = strlen(text);
    while (text[length - 1] == '0') {
        length--;
    }
    if (text[length - 1] == '.') {
        length--;
    }
    text[length] = '\0';
    if (strcmp(text, "-0") == 0) {
        g_string_append(out, "0");
    } else {
        g_string_append(out, text);
    }
}

// What stands in the place of something verbose in a tag; `of_lines` tells whether it
// is a path of lines.
static gboolean shorten(const GMatchInfo *match, GString *out, gpointer of_lines)
{
    const int group = g_match_info_get_match_count(match) - 1;
    if (group == 3) {
        // a byte each, which is all that a screen shows
        g_string_append_c(out, '#');
        for (int i = 1; i <= 3; i++) {
            g_autofree char *share = g_match_info_fetch(match, i);
            text_append(out, "%02x", (unsigned)(2.55 * decimal_parse(share, NULL) + 0.5));
        }
    } else if (group > 3) {
        // the places of a path are those after a space
        int decimals = 2;
        if (group == 4 && *(bool *)of_lines) {
            decimals = 1;
        }
        g_autofree char *number = g_match_info_fetch(match, group);
        append_short_number(out, decimal_parse(number, NULL), decimals);
    }
    return FALSE;
}

// A tag in fewer bytes. Outlines of letters are small and keep their hundredths, lines do
// not.
static char *short_tag(const char *tag)
{
    const char *data = strstr(tag, " d=\"");
    bool lines =
        g_str_has_prefix(tag, LINE_TAG) && data != NULL && strchr(data, 'C') == NULL;
    return text_replaced(&verbose, tag, shorten, &lines);
}

// Whether two tags are lines of one style, so that the data of the second can go on the
// first.
static bool have_one_style(const char *a, const char *b)
{
    const char *data = strstr(b, "d=\"M");
    return data != NULL && g_str_has_prefix(b, LINE_TAG) &&
           strncmp(a, b, (size_t)(data - b) + 3) == 0 && strstr(b, "transform=") == NULL;
}

// A tag and the text after it, which stays but for line feeds. *last is where the last
// path was written, if the next one may join it, else SIZE_MAX.
static gboolean compact(const GMatchInfo *match, GString *out, gpointer context)
{
    size_t *last = context;
    g_autofree char *tag = g_match_info_fetch(match, 1);
    g_autofree char *text = g_match_info_fetch(match, 2);
    g_autofree char *brief = short_tag(tag);

    // a path of the same style goes on in place of the last one's end
    if (*last != SIZE_MAX && have_one_style(out->str + *last, brief)) {
        g_string_truncate(out, out->len - strlen("\"/>"));
        g_string_append(out, strstr(brief, "d=\"") + 3);
    } else {
        *last = SIZE_MAX;
        if (g_str_has_prefix(brief, "<path") && g_str_has_suffix(brief, "\"/>")) {
            *last = out->len;
        }
        g_string_append(out, brief);
    }

    // blanks between tags are none of the picture
    for (const char *t = text; *t != '\0'; t++) {
        if (*t != '\n') {
            g_string_append_c(out, *t);
            if (*t != ' ') {
                *last = SIZE_MAX;
            }
        }
    }
    return FALSE;
}

// Renames ids, drops the metadata, shortens tags and refers to letters that are known.
char *svg_for_page(const char *svg, const char *prefix, GHashTable *known)
{
    const char *root = text_or(strstr(svg, "<svg"), svg);
    g_autofree char *own = svg_renumber_ids(root, prefix);

    // the page that holds the picture says what it is
    char *from = strstr(own, "<metadata>"), *to = strstr(own, "</metadata>");
    if (from != NULL && to != NULL) {
        to += strlen("</metadata>");
        memmove(from, to, strlen(to) + 1);
    }
    size_t last = SIZE_MAX;
    static text_pattern tags = {"(<[^>]*>)([^<]*)"};
    g_autofree char *small = text_replaced(&tags, own, compact, &last);
    return share_symbols(small, known);
}
