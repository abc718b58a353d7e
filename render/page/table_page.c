#include "render/page/table_page.h"

#include <assert.h>
#include <math.h>

#define CELL_SPACE     3.0 // above and below a row's text, and left and right of a cell's
#define CELL_SIZE      7.0
#define ROUNDING_SPACE 0.5 // so that no rounding breaks a word that just fits
#define OUTER_RULE     0.9 // width of the lines above and below a table [pt]
#define INNER_RULE     0.5 // below its heading

table_page *table_create(const char *title, const table_column *columns, size_t count)
{
    assert(count > 0 && count <= TABLE_COLUMNS);
    table_page *t = g_new0(table_page, 1);
    t->title = g_strdup(title);
    t->columns = columns;
    t->column_count = (int)count;
    t->rows = g_ptr_array_new_with_free_func((GDestroyNotify)g_strfreev);
    return t;
}

void table_destroy(void *table)
{
    table_page *t = table;
    g_free(t->title);
    g_free(t->caption);
    g_free(t->parameters);
    g_ptr_array_free(t->rows, TRUE);
    g_free(t);
}

void table_add_row(table_page *t, const char *const *cells)
{
    char **row = g_new0(char *, (gsize)t->column_count + 1);
    for (int i = 0; i < t->column_count; i++) {
        row[i] = g_strdup(cells[i]);
    }
    g_ptr_array_add(t->rows, row);
}

void table_add_group(table_page *t, const char *heading)
{
    char **row = g_new0(char *, 2);
    row[0] = g_strdup(heading);
    g_ptr_array_add(t->rows, row);
}

// The cells of a row; row -1 is the heading, of the columns' labels.
enum { HEADING = -1 };

static int row_count(const table_page *t)
{
    return (int)t->rows->len;
}

static const char *cell_at(const table_page *t, int row, int column)
{
    char *const *cells = row != HEADING ? g_ptr_array_index(t->rows, row) : NULL;
    if (cells != NULL) {
        return cells[column];
    }
    return t->columns[column].label;
}

static bool table_row_is_group(const table_page *t, int row)
{
    return t->column_count > 1 && cell_at(t, row, 1) == NULL;
}

// ---- the page

// A table on a page of its width.
typedef struct table_layout {
    PangoContext *context;
    sketch_frame frame;
    double widths[TABLE_COLUMNS]; // [pt]
} table_layout;

static text_block cell_block(const sketch_frame *frame, const char *markup, bool bold)
{
    return (text_block){markup, sketch_letters(frame, CELL_SIZE),
                        .family = frame->look.font, .bold = bold};
}

// Width of the widest word of a cell, which should not be broken.
static double widest_word(PangoContext *context, const sketch_frame *frame,
                          const char *markup, bool bold)
{
    double widest = 0;
    g_autofree char *plain = text_plain(markup);
    g_auto(GStrv) words = g_strsplit_set(plain, " \n", -1);

    // measured as the cell would set it, bold or not
    for (int i = 0; words[i] != NULL; i++) {
        g_autofree char *word = text_escape(words[i]);
        text_block t = cell_block(frame, word, bold);
        widest = fmax(widest, text_measure(context, &t).width);
    }
    return widest;
}

// The width that a column needs for its widest word.
static double least_width(PangoContext *context, const table_page *t,
                          const sketch_frame *frame, int column)
{
    double widest = 0;
    for (int row = HEADING; row < row_count(t); row++) {
        if (!table_row_is_group(t, row)) {
            const char *text = cell_at(t, row, column);
            widest = fmax(widest, widest_word(context, frame, text, row == HEADING));
        }
    }
    return widest + 2 * CELL_SPACE + ROUNDING_SPACE;
}

// Widths of the columns: their shares, but none narrower than its widest word where the
// others can spare the room.
static void choose_columns(PangoContext *context, const table_page *t,
                           const sketch_frame *frame, double widths[TABLE_COLUMNS])
{
    const double room = frame->design_width - 2 * SKETCH_MARGIN;
    double least[TABLE_COLUMNS], sum = 0, need = 0;
    for (int i = 0; i < t->column_count; i++) {
        least[i] = least_width(context, t, frame, i);
        sum += t->columns[i].share;
        need += least[i];
    }

    // what is left after the least widths goes by how much the shares ask for beyond them
    double asked = 0, spare = fmax(0, room - need);
    for (int i = 0; i < t->column_count; i++) {
        asked += fmax(0, room * t->columns[i].share / sum - least[i]);
    }
    for (int i = 0; i < t->column_count; i++) {
        double more = fmax(0, room * t->columns[i].share / sum - least[i]);
        if (need > room) {
            widths[i] = room * least[i] / need;
        } else if (asked > 0) {
            widths[i] = least[i] + spare * more / asked;
        } else {
            widths[i] = least[i] + spare / t->column_count;
        }
    }
}

static double text_height(const table_layout *l, const char *markup, double width,
                          bool bold)
{
    text_block t = cell_block(&l->frame, markup, bold);
    t.width = width - 2 * CELL_SPACE;
    return text_measure(l->context, &t).height;
}

// Space over the cells of a row, and under them.
static double space_over(int row)
{
    if (row == HEADING) {
        return CELL_SPACE;
    }
    return CELL_SPACE / 2;
}

// Height of a row with the space round its texts: that of its highest cell.
static double row_height(const table_layout *l, const table_page *t, int row)
{
    double most = 0;
    if (table_row_is_group(t, row)) {
        most = text_height(l, cell_at(t, row, 0),
                           l->frame.design_width - 2 * SKETCH_MARGIN, true);
        return most + 2 * CELL_SPACE;
    }
    for (int i = 0; i < t->column_count; i++) {
        const char *text = cell_at(t, row, i);
        most = fmax(most, text_height(l, text, l->widths[i], row == HEADING));
    }
    return most + 2 * space_over(row);
}

// Widths of the columns, and the height of all rows.
static void lay_out(table_layout *l, const table_page *t, PangoContext *context)
{
    // the frame is laid out at its own width: nothing is scaled
    *l = (table_layout){context, {t->title, t->caption, .look = t->look}};
    l->frame.design_width = SKETCH_WIDTH;
    if (t->look.width > 0) {
        l->frame.design_width = t->look.width * 72 / 25.4;
    }

    // columns, and as many rows as there are
    choose_columns(l->context, t, &l->frame, l->widths);
    l->frame.body_height = CELL_SPACE;
    for (int row = HEADING; row < row_count(t); row++) {
        l->frame.body_height += row_height(l, t, row);
    }
}

void table_size(const table_page *t, double *width, double *height)
{
    table_layout l;
    g_autoptr(PangoContext) context = text_context_create();
    lay_out(&l, t, context);
    sketch_size(&l.frame, width, height);
}

// The cells of a row side by side, from y downwards.
static void draw_row(sketch *s, const table_layout *l, const table_page *t, int row,
                     double y)
{
    double x = s->left;
    for (int i = 0; i < t->column_count; i++) {
        const text_block text = {cell_at(t, row, i), CELL_SIZE, .bold = row == HEADING,
                                 .align = t->columns[i].align,
                                 .width = l->widths[i] - 2 * CELL_SPACE};
        if (text.markup[0] != '\0') {
            sketch_wrapped(s, (point){x + CELL_SPACE, y}, &text);
        }
        x += l->widths[i];
    }
}

// The heading of a group, on a shaded row.
static void draw_group(sketch *s, const table_page *t, int row, double y, double height)
{
    const double width = s->right - s->left;
    set_colour(s->cr, s->colours->shade);
    cairo_rectangle(s->cr, s->left, y, width, height);
    cairo_fill(s->cr);
    sketch_wrapped(s, (point){s->left + CELL_SPACE, y + CELL_SPACE},
                   &(text_block){cell_at(t, row, 0), CELL_SIZE, .bold = true,
                                 .width = width - 2 * CELL_SPACE});
}

// A line across the table.
static void draw_rule(const sketch *s, double y, double width)
{
    sketch_line(s, (point){s->left, y}, (point){s->right, y}, width, SKETCH_INK);
}

// Row by row from above, on a page with title and caption.
status table_paint(cairo_t *cr, const table_page *t, figure_report *report, fault *f)
{
    sketch s;
    table_layout l;
    g_autoptr(PangoContext) context = text_context_create();
    lay_out(&l, t, context);
    TRY(sketch_begin(&s, cr, &l.frame, report, f));

    // the heading between two lines, the rows, and a line below them
    double y = s.top;
    draw_rule(&s, y, OUTER_RULE);
    for (int row = HEADING; row < row_count(t); row++) {
        const double height = row_height(&l, t, row);
        if (table_row_is_group(t, row)) {
            draw_group(&s, t, row, y, height);
        } else {
            draw_row(&s, &l, t, row, y + space_over(row));
        }
        y += height;
        if (row == HEADING) {
            draw_rule(&s, y, INNER_RULE);
        }
    }
    draw_rule(&s, y + CELL_SPACE, OUTER_RULE);

    return sketch_end(&s);
}

// ---- numbers and HTML

static void write_plain(csv_writer *csv, const char *markup)
{
    g_autofree char *plain = text_plain(markup);
    csv_text(csv, plain);
}

static bool has_groups(const table_page *t)
{
    for (int row = 0; row < row_count(t); row++) {
        if (table_row_is_group(t, row)) {
            return true;
        }
    }
    return false;
}

// A heading row, then the rows of cells.
void table_write_csv(const table_page *t, csv_writer *csv)
{
    const bool grouped = has_groups(t);
    const char *group = "";

    for (int row = HEADING; row < row_count(t); row++) {
        if (table_row_is_group(t, row)) {
            group = cell_at(t, row, 0);
            continue;
        }

        // the group that a row stands under is its first field
        if (grouped && row == HEADING) {
            write_plain(csv, "group");
        } else if (grouped) {
            write_plain(csv, group);
        }
        for (int i = 0; i < t->column_count; i++) {
            write_plain(csv, cell_at(t, row, i));
        }
        csv_end_row(csv);
    }
}

// The cells of a row as HTML.
static void add_html_cells(GString *html, const table_page *t, int row)
{
    // Pango's <span> and <sub> are HTML's; its colours and sizes are not used in cells
    const char *tag = row == HEADING ? "th" : "td";
    for (int i = 0; i < t->column_count; i++) {
        const char *class = "";
        if (t->columns[i].align != TEXT_LEFT) {
            class = " class=\"number\"";
        }
        text_append(html, "<%s%s>%s</%s>", tag, class, cell_at(t, row, i), tag);
    }
}

void table_add_html(const table_page *t, GString *html)
{
    // a heading that repeats where the table breaks
    g_string_append(html, "<table>\n<thead><tr>");
    add_html_cells(html, t, HEADING);
    g_string_append(html, "</tr></thead>\n<tbody>\n");
    for (int row = 0; row < row_count(t); row++) {
        // a group's heading spans all columns
        g_string_append(html, "<tr>");
        if (table_row_is_group(t, row)) {
            text_append(html, "<th class=\"group\" colspan=\"%d\">%s</th>",
                        t->column_count, cell_at(t, row, 0));
        } else {
            add_html_cells(html, t, row);
        }
        g_string_append(html, "</tr>\n");
    }

    g_string_append(html, "</tbody>\n</table>\n");
    if (t->caption != NULL) {
        text_append(html, "<p class=\"note\">%s</p>\n", t->caption);
    }
}
