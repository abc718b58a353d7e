#include "render/figures/artwork.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/whole_file.h"

status make_folder(const char *folder, fault *f)
{
    FAULT_IF(mkdir(folder, 0777) != 0 && errno != EEXIST, f, STATUS_CANNOT_WRITE,
             "the folder '%s' cannot be made: %s", folder, strerror(errno));
    return STATUS_OK;
}

status artwork_paint(const artwork *a, cairo_t *cr, figure_report *report, fault *f)
{
    if (a->table != NULL) {
        return table_paint(cr, a->table, report, f);
    }
    if (a->plotted != NULL) {
        return figure_paint(cr, a->plotted, report, f);
    }
    return a->paint(cr, a->owner, report, f);
}

status artwork_write_csv(const artwork *a, const char *path, fault *f)
{
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    csv_writer csv = csv_begin(file.stream);
    if (a->table != NULL) {
        table_write_csv(a->table, &csv);
    } else if (a->plotted != NULL) {
        figure_write_csv(a->plotted, &csv);
    } else {
        a->write_csv(a->owner, &csv);
    }
    return whole_file_commit(&file, f);
}

static status paint_artwork(cairo_t *cr, const void *what, fault *f)
{
    const artwork *a = what;
    return artwork_paint(a, cr, a->seen, f);
}

// What it shows, and what the file is to say of it.
picture artwork_picture(const artwork *a, const figure_options *options)
{
    // without an alternative text the title stands in for it
    return (picture){.width = a->width,
                     .height = a->height,
                     .dpi = options->look.dpi,
                     .transparent = options->look.transparent,
                     .command = options->command,
                     .alternative = text_or(a->alternative, a->title),
                     .title = a->title,
                     .software = picture_software(),
                     .parameters = a->parameters,
                     .paint = paint_artwork,
                     .what = a};
}

// ---- tables

artwork artwork_of_table(table_page *t)
{
    artwork a = {
        t->title,   .caption = t->caption,   .parameters = t->parameters, .table = t,
        .owner = t, .release = table_destroy};
    table_size(t, &a.width, &a.height);
    return a;
}

// ---- plotted figures

// Appends a plain text that was given as markup.
static void append_plain(GString *out, const char *before, const char *markup)
{
    if (markup != NULL && markup[0] != '\0') {
        g_autofree char *plain = text_plain(markup);
        text_append(out, "%s%s", before, plain);
    }
}

static void append_axis(GString *out, const char *before, const figure_axis *a)
{
    append_plain(out, before, text_or(a->label, a->name));
    if (a->unit != NULL && a->unit[0] != '\0') {
        g_autofree char *unit = text_unit(a->unit);
        text_append(out, " in %s", unit);
    }
}

// What a figure shows, in words: its panels, their axes and what is drawn.
static char *describe_figure(const figure *fig)
{
    GString *out = g_string_new(text_or(fig->title, "Figure"));
    const char *panels = fig->panel_count == 1 ? "panel" : "panels";
    text_append(out, ". %d %s", fig->panel_count, panels);
    append_axis(out, " over ", &fig->x);

    // panel by panel: its axis, heading, colours and curves
    for (int i = 0; i < fig->panel_count; i++) {
        const figure_panel *p = &fig->panels[i];
        append_axis(out, i == 0 ? ": " : "; ", &p->y);
        append_plain(out, ", ", p->heading);
        if (p->map != NULL && p->colours != NULL) {
            append_axis(out, ", coloured by ", &p->colours->axis);
        }

        const char *before = ", curves: ";
        for (int k = 0; k < p->series_count; k++) {
            append_plain(out, before, p->series[k].label);
            if (p->series[k].label != NULL) {
                before = ", ";
            }
        }
    }

    // runs of all panels
    const char *before = "; runs: ";
    for (int k = 0; fig->key != NULL && k < fig->key->series_count; k++) {
        append_plain(out, before, fig->key->series[k].label);
        before = ", ";
    }

    g_string_append(out, ".");
    return g_string_free(out, FALSE);
}

artwork artwork_of_figure(const figure *fig)
{
    artwork a = {fig->title, .caption = fig->caption, .parameters = fig->parameters,
                 .alternative = describe_figure(fig), .plotted = fig};
    figure_size(fig, &a.width, &a.height);
    return a;
}

artwork artwork_of_owned(owned_figure *o)
{
    artwork a = artwork_of_figure(&o->figure);
    a.owner = o;
    a.release = owned_figure_destroy;
    return a;
}

// ==== publications

// ---- LaTeX

// What is written otherwise in LaTeX, and how; longer beginnings come first.
static const struct {
    const char *markup, *latex;
} replacements[] = {
    {"<i>", "\\textit{"},
    {"</i>", "}"},
    {"<b>", "\\textbf{"},
    {"</b>", "}"},
    {"<sub>", "\\textsubscript{"},
    {"</sub>", "}"},
    {"<sup>", "\\textsuperscript{"},
    {"</sup>", "}"},
    {"&amp;", "\\&"},
    {"&lt;", "$<$"},
    {"&gt;", "$>$"},
    {"&quot;", "\""},
    {"&apos;", "'"},
    {"&#39;", "'"},
    {"θ\u0307", "$\\dot\\theta$"},
    {"θ\u0308", "$\\ddot\\theta$"},
    {"F\u0302", "$\\hat F$"},
    {"X\u0302", "$\\hat X$"},
    {"Ŷ", "$\\hat Y$"},
    {"Δ", "$\\Delta$"},
    {"α", "$\\alpha$"},
    {"β", "$\\beta$"},
    {"γ", "$\\gamma$"},
    {"δ", "$\\delta$"},
    {"ε", "$\\varepsilon$"},
    {"θ", "$\\theta$"},
    {"μ", "$\\mu$"},
    {"µ", "$\\mu$"},
    {"ρ", "$\\rho$"},
    {"τ", "$\\tau$"},
    {"ω", "$\\omega$"},
    {"Ω", "$\\Omega$"},
    {"Ω", "$\\Omega$"},
    {"−", "$-$"},
    {"·", "$\\cdot$"},
    {"×", "$\\times$"},
    {"≥", "$\\geq$"},
    {"≤", "$\\leq$"},
    {"∞", "$\\infty$"},
    {"∫", "$\\int$"},
    {"\u2009", "\\,"},
    {"\u202f", "\\,"},
    {"\u00a0", "~"},
    {"½", "$\\frac12$"},
    {"¼", "$\\frac14$"},
    {"²", "\\textsuperscript{2}"},
    {"³", "\\textsuperscript{3}"},
    {"⁻", "\\textsuperscript{$-$}"},
    {"¹", "\\textsuperscript{1}"},
    {"’", "'"},
    {"\\", "\\textbackslash{}"},
    {"#", "\\#"},
    {"$", "\\$"},
    {"%", "\\%"},
    {"_", "\\_"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"~", "\\textasciitilde{}"},
    {"^", "\\textasciicircum{}"},
    {"\u2060", ""},
};

// Pango markup as LaTeX: italics, indices, Greek letters and signs. Free the result with
// g_free.
static char *latex_of_markup(const char *markup)
{
    GString *out = g_string_new(NULL);
    while (*markup != '\0') {
        size_t found = 0;
        while (found < G_N_ELEMENTS(replacements) &&
               !g_str_has_prefix(markup, replacements[found].markup)) {
            found++;
        }

        // what LaTeX writes otherwise; what only sizes letters has no meaning in a
        // caption; or else the character itself
        if (found < G_N_ELEMENTS(replacements)) {
            g_string_append(out, replacements[found].latex);
            markup += strlen(replacements[found].markup);
        } else if (g_str_has_prefix(markup, "<span") ||
                   g_str_has_prefix(markup, "</span")) {
            markup += strcspn(markup, ">");
            if (*markup == '>') {
                markup++;
            }
        } else {
            g_string_append_c(out, *markup++);
        }
    }
    return g_string_free(out, FALSE);
}

// Plain text with LaTeX's own signs escaped and all others as they are: what a reader is
// told aloud.
static char *latex_escape(const char *plain)
{
    GString *out = g_string_new(NULL);
    for (; *plain != '\0'; plain++) {
        if (strchr("#$%&_{}", *plain) != NULL) {
            g_string_append_c(out, '\\');
        }

        // what cannot be escaped is left out
        if (strchr("\\~^", *plain) != NULL) {
            g_string_append_c(out, ' ');
        } else {
            g_string_append_c(out, *plain);
        }
    }
    return g_string_free(out, FALSE);
}

// The environment of a picture with its caption, as LaTeX text.
static char *latex_environment(const artwork *a, const char *tex, const char *file)
{
    g_autofree char *tex_folder = g_path_get_dirname(tex),
                    *folder = g_path_get_dirname(file);
    g_autofree char *name = g_path_get_basename(file);

    // the label is the file's name without its ending, the picture's path goes from the
    // LaTeX file
    int stem = (int)(picture_ending(name) - name);
    if (stem == 0) {
        stem = (int)strlen(name);
    }
    const char *picture_path = file;
    if (strcmp(tex_folder, folder) == 0) {
        picture_path = name;
    }

    // title and caption
    g_autofree char *title = text_escape(text_or(a->title, ""));
    g_autofree char *heading = latex_of_markup(title);
    g_autofree char *caption = latex_of_markup(text_or(a->caption, ""));
    g_autofree char *alt = latex_escape(text_or(a->alternative, a->title));
    const char *between = caption[0] != '\0' ? ". " : "";
    return text_printf("\\begin{figure}\n"
                       "  \\centering\n"
                       "  \\includegraphics[width=%.4gmm,alt={%s}]{%s}\n"
                       "  \\caption{%s%s%s}\n"
                       "  \\label{fig:%.*s}\n"
                       "\\end{figure}\n",
                       a->width * 25.4 / 72, alt, picture_path, heading, between, caption,
                       stem, name);
}

// ---- what stands beside a picture

static status write_text_file(const char *path, const char *text, fault *f)
{
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    fputs(text, file.stream);
    return whole_file_commit(&file, f);
}

// Whether a CSV is there that is none of a figure's.
static bool holds_other_numbers(const char *csv)
{
    static const char heading[] = "panel,"; // of figure_write_csv
    char start[sizeof heading] = "";
    FILE *there = fopen(csv, "re");
    if (there == NULL) {
        return false;
    }
    const size_t length = fread(start, 1, sizeof start - 1, there);
    fclose(there);
    return length > 0 && strcmp(start, heading) != 0;
}

status artwork_publish_csv(const artwork *a, const char *path, fault *f)
{
    g_autofree char *csv = picture_beside(path, ".csv");
    FAULT_IF(a->plotted != NULL && holds_other_numbers(csv), f, STATUS_CANNOT_WRITE,
             "'%s' holds other numbers and is kept, so that those of the picture are not "
             "written",
             csv);
    return artwork_write_csv(a, csv, f);
}

// Writes title and caption as plain text beside a picture.
static status write_caption(const artwork *a, const char *path, fault *f)
{
    g_autofree char *file = picture_beside(path, ".txt");
    g_autofree char *caption = text_plain(text_or(a->caption, ""));
    const char *between = caption[0] != '\0' ? "\n\n" : "";
    g_autofree char *text =
        text_printf("%s%s%s\n", text_or(a->title, ""), between, caption);
    return write_text_file(file, text, f);
}

// A PDF where the picture itself is an SVG.
status artwork_publish_latex(const artwork *a, const figure_options *o, const char *path,
                             char **environment, fault *f)
{
    g_autofree char *read = picture_for_latex(path);
    if (strcmp(read, path) != 0) {
        const picture p = artwork_picture(a, o);
        TRY(picture_write(&p, read, f));
    }
    *environment = latex_environment(a, o->latex, read);
    return STATUS_OK;
}

// The picture, and beside it whatever the options ask for.
status artwork_publish(const artwork *a, const figure_options *o, const char *path,
                       bool with_csv, fault *f)
{
    picture p = artwork_picture(a, o);
    TRY(picture_write(&p, path, f));

    // title and caption of a picture that has none of its own
    if (o->look.bare) {
        TRY(write_caption(a, path, f));
    }

    // for LaTeX, and as numbers
    if (o->latex != NULL) {
        g_autofree char *text = NULL;
        TRY(artwork_publish_latex(a, o, path, &text, f));
        TRY(write_text_file(o->latex, text, f));
    }
    if (with_csv) {
        return artwork_publish_csv(a, path, f);
    }
    return STATUS_OK;
}

void figure_take_range(figure *fig, const figure_options *o)
{
    if (o->from < o->to) {
        fig->x.low = o->from;
        fig->x.high = o->to;
    }
    fig->zoom_from = o->zoom.from;
    fig->zoom_to = o->zoom.to;
}

// A figure that shows no recorded signals.
status figure_publish(const figure *fig, const figure_options *o, const char *path,
                      bool with_csv, fault *f)
{
    const char *option = o->overlay != NULL ? "--overlay" : "--signals";
    FAULT_IF(o->overlay != NULL || o->signals != NULL, f, STATUS_BAD_ARGUMENT,
             "%s: the picture shows no recorded signals that %s could choose or lie over",
             path, option);

    // a copy with the look and the range asked for
    figure shown = *fig;
    figure_take_look(&shown, &o->look);
    figure_take_range(&shown, o);

    g_auto(artwork) a = artwork_of_figure(&shown);
    return artwork_publish(&a, o, path, with_csv, f);
}
