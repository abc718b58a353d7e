// Marks at instants and levels, shaded intervals, and where their labels go.
#include <math.h>

#include "render/page/picture_file.h"
#include "render/page/sketch.h"
#include "render/plot/drawing.h"

#define LEVEL_ROOM    10.0 // above a level, for its label [pt]
#define NOTE_SPACE    4.0  // from a note to its point [pt]
#define DOT_RADIUS    1.3  // of the point of a note or a mark [pt]
#define INSIDE_SHARE  0.75 // upper share of the first panel, for labels of marks

#define POINT_SPACE   2.5 // from a mark's point to its label [pt]
#define LINE_SPACE    2.0 // from its line to its label
#define LABEL_SPACING 3.0 // least distance of labels of marks in a row
#define ARROW         "\u2009\u2192"

enum {
    INSIDE_MOST = 6, // labels of marks inside the first panel
    POINT_ROWS = 3   // rows that a label may be away from its point
};

// Whether the label of a mark stands at its point.
static bool at_point(const drawing *d, int index)
{
    return d->fig->marks[index].pointed && !d->mark_away[index];
}

// Whether the first panel shows the point of a mark.
static bool has_point(const drawing *d, const figure_mark *m)
{
    const plane *p = &d->panels[0].plane;
    return m->pointed && m->label != NULL && scale_holds(&p->x, m->x) &&
           scale_holds(&p->y, m->y);
}

// ---- where labels go

// The horizontal extents of the labels of marks above the panels [pt].
typedef struct mark_labels {
    double begins[MARKS_LABELLED], ends[MARKS_LABELLED];
    bool placed[MARKS_LABELLED];
    int count;
} mark_labels;

// The rightmost mark whose label has no place yet; -1 if all have one.
static int next_mark(const drawing *d, const mark_labels *l)
{
    int next = -1;
    for (int i = 0; i < l->count; i++) {
        if (!l->placed[i] && (next < 0 || d->fig->marks[i].x >= d->fig->marks[next].x)) {
            next = i;
        }
    }
    return next;
}

// Puts a label to the right of its mark's line, or to the left if the page ends before.
static void place_beside_line(const drawing *d, mark_labels *l, int index)
{
    const figure_mark *m = &d->fig->marks[index];
    const double x = plane_x(&d->panels[0].plane, m->x);
    double width = width_of(d, m->label, d->style.small);
    l->begins[index] = x + LINE_SPACE;
    if (l->begins[index] + width > d->page.width - PAGE_MARGIN) {
        if (m->onwards) {
            width += width_of(d, ARROW, d->style.small);
        }
        l->begins[index] = x - LINE_SPACE - width;
    }
    l->ends[index] = l->begins[index] + width;
}

// The lowest row for a label in which it stands above all labels that it would cover, or
// whose lines it would cross.
static int row_above(const drawing *d, const mark_labels *l, int index)
{
    const double begins = l->begins[index], ends = l->ends[index];
    int row = 0;
    for (int i = 0; i < l->count; i++) {
        if (i != index && l->placed[i] && d->mark_row[i] >= row &&
            ends + LABEL_SPACING > l->begins[i] - LINE_SPACE &&
            begins < l->ends[i] + LABEL_SPACING) {
            row = d->mark_row[i] + 1;
        }
    }
    return row;
}

// Places the labels of marks above the panels, like flags at the right of their lines. A
// label that would meet the next flag or its line goes a row higher, so that no line
// crosses a label. Returns the number of rows.
int place_marks(drawing *d)
{
    mark_labels l = {.count = MIN(d->fig->mark_count, MARKS_LABELLED)};
    int rows = 0;

    // from right to left, so that a label meets only those that are placed already
    for (int index = next_mark(d, &l); index >= 0; index = next_mark(d, &l)) {
        const figure_mark *m = &d->fig->marks[index];
        d->mark_row[index] = -1;
        l.placed[index] = true;
        l.begins[index] = l.ends[index] = -1;
        if (m->label == NULL || !scale_holds(&d->x.scale, m->x) || at_point(d, index)) {
            continue;
        }

        place_beside_line(d, &l, index);
        d->mark_text_x[index] = l.begins[index];
        const int row = row_above(d, &l, index);
        if (row < MARK_ROWS) {
            d->mark_row[index] = row;
            rows = MAX(rows, row + 1);
        }
    }
    return rows;
}

// ---- inside the first panel

// Whether the line of another mark than `index` would cross a label.
static bool crosses_line(const drawing *d, const figure_rect *r, int index)
{
    for (int i = 0; i < d->fig->mark_count; i++) {
        double x = plane_x(&d->panels[0].plane, d->fig->marks[i].x);
        if (i != index && x > r->x - LINE_SPACE && x < r->x + r->width + LINE_SPACE) {
            return true;
        }
    }
    return false;
}

// Whether the label of mark `index` can stand at r: within the first panel, clear of
// curves and, unless over_lines allows it, of the lines of other marks.
static bool label_fits(const drawing *d, const placement *grid, const figure_rect *r,
                       int index, bool over_lines)
{
    const figure_rect *box = &d->panels[0].plane.box;
    return r->x >= box->x + 1 && r->x + r->width <= box->x + box->width &&
           r->y >= box->y && r->y + r->height <= box->y + box->height &&
           placement_ink(grid, *r) < INK_CURVE &&
           (over_lines || !crosses_line(d, r, index));
}

// Finds a place beside the line of a mark for its label inside the first panel, as high
// as possible and clear of the places that are taken. False if there is none.
static bool find_inside(const drawing *d, const placement *grid, int index,
                        const figure_rect *taken, int taken_count, figure_rect *found)
{
    const figure_mark *m = &d->fig->marks[index];
    const figure_rect *box = &d->panels[0].plane.box;
    const double x = plane_x(&d->panels[0].plane, m->x);
    const double width = width_of(d, m->label, d->style.small);

    // rows from the top down; in each the right side of the line, then the left
    const double lefts[] = {x + LINE_SPACE, x - LINE_SPACE - width};
    const int sides = m->onwards ? 1 : 2;
    for (double y = box->y + 1; y + MARK_ROW < box->y + INSIDE_SHARE * box->height;
         y += MARK_ROW) {
        for (int side = 0; side < sides; side++) {
            figure_rect r = {lefts[side], y, width, MARK_ROW};
            bool fits = label_fits(d, grid, &r, index, false);
            for (int i = 0; i < taken_count && fits; i++) {
                fits = !rects_meet(&r, &taken[i], LABEL_SPACING);
            }
            if (fits) {
                *found = r;
                return true;
            }
        }
    }
    return false;
}

// Finds a place for a label beside the point of its mark: as near as possible, above the
// point, at its height or below, on either side. At each distance places clear of other
// marks' lines come first. False if there is none.
static bool find_at_point(const drawing *d, const placement *grid, int index,
                          figure_rect *found)
{
    const figure_mark *m = &d->fig->marks[index];
    const plane *p = &d->panels[0].plane;
    double x = plane_x(p, m->x), y = plane_y(p, m->y);
    double width = width_of(d, m->label, d->style.small);

    // places 0 to 5: right and left above, at the point's height, and below
    const double lefts[] = {x + POINT_SPACE, x - POINT_SPACE - width};
    for (int row = 0; row < POINT_ROWS; row++) {
        const double distance = POINT_SPACE + row * MARK_ROW;
        const double tops[] = {y - distance - MARK_ROW, y - MARK_ROW / 2, y + distance};
        for (int over_lines = 0; over_lines < 2; over_lines++) {
            for (int place = 0; place < 6; place++) {
                figure_rect r = {lefts[place % 2], tops[place / 2], width, MARK_ROW};
                if (label_fits(d, grid, &r, index, over_lines == 1)) {
                    *found = r;
                    return true;
                }
            }
        }
    }
    return false;
}

// Places the label of each mark with a point beside it. A label without room there joins
// those above the panels; false if there is one.
bool place_pointed_marks(drawing *d, placement *grid)
{
    bool placed = true;
    for (int i = 0; i < d->fig->mark_count && i < MARKS_LABELLED; i++) {
        figure_rect *r = &d->point_label[i];
        *r = (figure_rect){0};
        if (!at_point(d, i) || !scale_holds(&d->x.scale, d->fig->marks[i].x)) {
            continue;
        }

        // without a place it is put with the labels of marks that have no point
        if (!has_point(d, &d->fig->marks[i]) || !find_at_point(d, grid, i, r)) {
            d->mark_away[i] = true;
            placed = false;
            continue;
        }
        placement_block(grid, *r, INK_CURVE);
    }
    return placed;
}

// Places the labels of all marks inside the first panel. False, with none placed, if one
// finds no room.
bool place_marks_inside(drawing *d, placement *grid)
{
    figure_rect taken[INSIDE_MOST];
    int index[INSIDE_MOST], count = 0;

    // a place for every label that needs one
    for (int i = 0; i < d->fig->mark_count && i < MARKS_LABELLED; i++) {
        if (d->fig->marks[i].label == NULL ||
            !scale_holds(&d->x.scale, d->fig->marks[i].x) || at_point(d, i)) {
            continue;
        }
        if (count == INSIDE_MOST ||
            !find_inside(d, grid, i, taken, count, &taken[count])) {
            return false;
        }
        index[count++] = i;
    }

    // all have one: the legend and the inset keep off them
    for (int i = 0; i < MARKS_LABELLED; i++) {
        d->mark_row[i] = -1;
    }
    for (int k = 0; k < count; k++) {
        d->mark_row[index[k]] = 0;
        d->mark_text_x[index[k]] = taken[k].x;
        d->mark_text_y[index[k]] = taken[k].y;
        placement_block(grid, taken[k], INK_CURVE);
    }
    return true;
}

// ---- levels

// Whether a label would lie over that of an earlier level.
static bool meets_earlier_label(const panel_layout *l, int index, const figure_rect *r)
{
    for (int i = 0; i < index; i++) {
        const figure_rect *other = &l->level_place[i];
        if (other->width > 0 && rects_meet(r, other, 0)) {
            return true;
        }
    }
    return false;
}

// Chooses the place of a level's label: at the right or left end of its line, above or
// below it, whichever has the least ink under it; none where all lie over labels of
// earlier levels.
static figure_rect level_label(const drawing *d, const panel_layout *l, int index,
                               const placement *grid)
{
    const figure_rect *box = &l->plane.box;
    double y = plane_y(&l->plane, l->panel->levels[index].y);
    double width = width_of(d, l->panel->levels[index].label, d->style.small);

    // place k: end k/2 of the line, above it (k even) or below
    const double lefts[] = {box->x + box->width - 2 - width, box->x + 3};
    const double tops[] = {y - LEVEL_ROOM, y};
    figure_rect best = {0};
    for (int k = 0; k < 4; k++) {
        figure_rect r = {lefts[k / 2], tops[k % 2], width, LEVEL_ROOM};
        bool fits = r.y >= box->y && r.y + r.height <= box->y + box->height;
        if (fits && !meets_earlier_label(l, index, &r) &&
            (best.width == 0 || placement_ink(grid, r) < placement_ink(grid, best))) {
            best = r;
        }
    }
    return best;
}

// The place of a note's text: beside, above or below its point, where it has the least
// ink under it, the right side first; none of an optional note that would lie on a curve.
static figure_rect note_place(const drawing *d, const panel_layout *l,
                              const figure_note *n, const placement *grid)
{
    const figure_rect *box = &l->plane.box;
    const double x = plane_x(&l->plane, n->x), y = plane_y(&l->plane, n->y);
    const double width = width_of(d, n->text, d->style.tick);
    const double height = height_of(d, figure_text_of(d, n->text, d->style.tick));

    // the point lies at these shares of a text with its space; the panel keeps the text
    static const anchor at[] = {{0, 0.5}, {1, 0.5}, {0.5, 1}, {0.5, 0},
                                {0, 1},   {1, 1},   {0, 0},   {1, 0}};
    figure_rect best = {0};
    double least = INK_CURVE;
    if (!n->optional) {
        least = HUGE_VAL;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(at); i++) {
        figure_rect r = {x - at[i].x * (width + 2 * NOTE_SPACE) + NOTE_SPACE,
                         y - at[i].y * (height + 2 * NOTE_SPACE) + NOTE_SPACE, width,
                         height};
        r.x = fmax(box->x, fmin(box->x + box->width - width, r.x));
        r.y = fmax(box->y, fmin(box->y + box->height - height, r.y));
        if (placement_ink(grid, r) < least) {
            least = placement_ink(grid, r);
            best = r;
        }
    }
    return best;
}

// Adds the ink of levels, notes and marks to the grid of a panel, so that nothing else is
// placed over them, and places the labels of levels.
void ink_of_marks(const drawing *d, panel_layout *l, placement *grid)
{
    const figure_rect *box = &l->plane.box;

    // labels of levels first: the lines themselves are no obstacle to them
    for (int i = 0; i < l->panel->level_count && i < LEVELS_LABELLED; i++) {
        if (l->panel->levels[i].label != NULL) {
            l->level_place[i] = level_label(d, l, i, grid);
        }
    }

    // lines and labels of levels
    for (int i = 0; i < l->panel->level_count; i++) {
        double y = plane_y(&l->plane, l->panel->levels[i].y);
        placement_line(grid, box->x, y, box->x + box->width, y, INK_CURVE);
        if (i < LEVELS_LABELLED && l->level_place[i].width > 0) {
            placement_block(grid, l->level_place[i], INK_CURVE);
        }
    }

    // marks, and notes clear of them
    for (int i = 0; i < d->fig->mark_count; i++) {
        double x = plane_x(&l->plane, d->fig->marks[i].x);
        if (x >= box->x && x <= box->x + box->width) {
            placement_line(grid, x, box->y, x, box->y + box->height, INK_FAINT);
        }
    }
    for (int i = 0; i < l->panel->note_count && i < NOTES_PLACED; i++) {
        const figure_note *n = &l->panel->notes[i];
        l->note_place[i] = (figure_rect){0};
        if (scale_holds(&l->plane.x, n->x) && scale_holds(&l->plane.y, n->y)) {
            const double x = plane_x(&l->plane, n->x), y = plane_y(&l->plane, n->y);
            placement_line(grid, x, y, x, y, INK_CURVE);
            l->note_place[i] = note_place(d, l, n, grid);
            placement_block(grid, l->note_place[i], INK_CURVE);
        }
    }
}

// ---- strokes

// Shades the figure's intervals over the height of a panel, behind the data.
void draw_intervals(const drawing *d, const plane *p)
{
    const figure_rect *box = &p->box;

    cairo_save(d->cr);
    clip_to(d->cr, box);
    set_colour(d->cr, d->style.colours->shade);

    // each is cut at the ends of the axis
    for (int i = 0; i < d->fig->interval_count; i++) {
        const figure_interval *v = &d->fig->intervals[i];
        double low = scale_value(p->x.kind, p->x.low),
               high = scale_value(p->x.kind, p->x.high);
        double from = plane_x(p, fmax(v->from, low)), to = plane_x(p, fmin(v->to, high));
        if (to >= from) {
            cairo_rectangle(d->cr, from, box->y, fmax(to - from, GRID_WIDTH),
                            box->height);
        }
    }

    cairo_fill(d->cr);
    cairo_restore(d->cr);
}

// Sets the dashed line of marks and levels.
static void set_mark_line(const drawing *d)
{
    static const double pattern[] = {2.4, 1.8};
    set_plain_line(d->cr, d->style.colours->mark, MARK_WIDTH);
    cairo_set_dash(d->cr, pattern, 2, 0);
}

// Clips to the page without legends and labels of points: by the even-odd rule their
// rectangles are holes in the page's.
void clip_out_labels(const drawing *d)
{
    cairo_new_path(d->cr);
    cairo_rectangle(d->cr, d->page.x, d->page.y, d->page.width, d->page.height);
    for (int i = 0; i < d->fig->panel_count; i++) {
        const panel_layout *l = &d->panels[i];
        if (l->legend_inside && l->legend.width > 0) {
            cairo_rectangle(d->cr, l->legend.x, l->legend.y, l->legend.width,
                            l->legend.height);
        }
    }
    for (int i = 0; i < d->fig->mark_count && i < MARKS_LABELLED; i++) {
        const figure_rect *r = &d->point_label[i];
        cairo_rectangle(d->cr, r->x, r->y, r->width, r->height);
    }
    cairo_set_fill_rule(d->cr, CAIRO_FILL_RULE_EVEN_ODD);
    cairo_clip(d->cr);
}

// Whether a vertical line at x meets a legend or the label of a point.
static bool meets_label(const drawing *d, double x)
{
    for (int i = 0; i < d->fig->panel_count; i++) {
        const panel_layout *l = &d->panels[i];
        if (l->legend_inside && x > l->legend.x - 1 &&
            x < l->legend.x + l->legend.width + 1) {
            return true;
        }
    }
    for (int i = 0; i < d->fig->mark_count && i < MARKS_LABELLED; i++) {
        const figure_rect *r = &d->point_label[i];
        if (x > r->x && x < r->x + r->width) {
            return true;
        }
    }
    return false;
}

// Draws the line of a mark from `top` down to `bottom`, interrupted by legends and
// labels.
static void draw_hairline(const drawing *d, double x, double top, double bottom)
{
    cairo_save(d->cr);
    if (meets_label(d, x)) {
        clip_out_labels(d);
    }
    set_mark_line(d);
    picture_line(d->cr, x, top, x, bottom);
    cairo_restore(d->cr);
}

// Draws the dot of a note or a mark at a point given in the axes' units.
static void draw_dot(const drawing *d, const plane *p, double x, double y)
{
    set_colour(d->cr, d->style.colours->text);
    cairo_new_path(d->cr);
    cairo_arc(d->cr, plane_x(p, x), plane_y(p, y), DOT_RADIUS, 0, 2 * G_PI);
    cairo_fill(d->cr);
}

// Draws the dots of marks that have a point, and the labels that stand beside them.
void draw_points(drawing *d)
{
    const plane *p = &d->panels[0].plane;
    for (int i = 0; i < d->fig->mark_count && i < MARKS_LABELLED; i++) {
        const figure_mark *m = &d->fig->marks[i];
        const figure_rect *r = &d->point_label[i];
        if (!has_point(d, m)) {
            continue;
        }
        draw_dot(d, p, m->x, m->y);
        if (at_point(d, i)) {
            draw_markup(d, m->label, d->style.small, r->x, r->y, (anchor){0, 0});
        }
    }
}

// Draws the figure's measure, a line with two arrow heads and a label above it.
void draw_measure(drawing *d)
{
    const figure_measure *m = d->fig->measure;
    const plane *p = &d->panels[0].plane;
    if (m == NULL) {
        return;
    }

    // with the pen of diagrams
    sketch s = {.cr = d->cr,
                .context = d->context,
                .colours = d->style.colours,
                .theme = d->fig->theme,
                .report = d->report,
                .scale = 1};
    const point from = {plane_x(p, m->from), plane_y(p, m->y)};
    const point to = {plane_x(p, m->to), from.y};
    sketch_measure(&s, from, to);
    sketch_small(&s, (point){(from.x + to.x) / 2, from.y - 2}, (anchor){0.5, 1}, "%s",
                 m->label);
}

// Draws the label of a mark above the panels, `shift` to the right of its place; x is its
// line's in the first column. A label left of its line has an arrow towards what begins
// there. Returns the upper end of the line.
static double draw_flag(drawing *d, int index, double x, double shift)
{
    const figure_mark *m = &d->fig->marks[index];
    const double row = d->marks_bottom - MARK_ROW * (d->mark_row[index] + 1);
    const bool before = m->onwards && d->mark_text_x[index] < x;
    const char *arrow = before ? ARROW : "";
    g_autofree char *label = g_strconcat(m->label, arrow, NULL);
    draw_markup(d, label, d->style.small, d->mark_text_x[index] + shift, row,
                (anchor){0, 0});
    return row + 1;
}

// Draws the marks of a column of panels, which lies `shift` to the right of the first:
// the labels, and the lines from them down to the last panel.
static void draw_column_marks(drawing *d, const plane *first, const plane *last,
                              double shift)
{
    for (int i = 0; i < d->fig->mark_count; i++) {
        const figure_mark *m = &d->fig->marks[i];
        if (!scale_holds(&d->x.scale, m->x)) {
            continue;
        }

        // its label inside the first panel or above it, where its line begins
        double x = plane_x(first, m->x), top = first->box.y + 1;
        if (i < MARKS_LABELLED && d->mark_row[i] >= 0 && d->marks_inside) {
            draw_markup(d, m->label, d->style.small, d->mark_text_x[i] + shift,
                        d->mark_text_y[i], (anchor){0, 0});
            top = first->box.y;
        } else if (i < MARKS_LABELLED && d->mark_row[i] >= 0) {
            top = draw_flag(d, i, x, shift);
        }
        draw_hairline(d, x, top, last->box.y + last->box.height);
    }
}

// Draws the marks of all columns of panels.
void draw_marks(drawing *d)
{
    for (int column = 0; column < d->columns; column++) {
        int first_panel = column, last_panel = column;
        while (last_panel + d->columns < d->fig->panel_count) {
            last_panel += d->columns;
        }
        draw_column_marks(d, &d->panels[first_panel].plane, &d->panels[last_panel].plane,
                          d->column[column].left - d->column[0].left);
    }
}

// Draws the levels of a panel: dashed lines across it, with their labels.
void draw_panel_levels(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    for (int i = 0; i < l->panel->level_count; i++) {
        const figure_level *level = &l->panel->levels[i];
        double y = plane_y(&l->plane, level->y);
        if (!(y >= box->y && y <= box->y + box->height)) {
            continue;
        }

        set_mark_line(d);
        picture_line(d->cr, box->x, y, box->x + box->width, y);

        // its label, where the layout found room
        if (level->label != NULL && i < LEVELS_LABELLED && l->level_place[i].width > 0) {
            const figure_rect *r = &l->level_place[i];
            const bool above = r->y < y - 1;
            if (above) {
                draw_markup(d, level->label, d->style.small, r->x, y, (anchor){0, 1});
            } else {
                draw_markup(d, level->label, d->style.small, r->x, y + 0.5, (anchor){0});
            }
        }
    }
}

// Draws the notes of a panel: dots with their texts.
void draw_notes(drawing *d, const panel_layout *l)
{
    for (int i = 0; i < l->panel->note_count && i < NOTES_PLACED; i++) {
        const figure_note *n = &l->panel->notes[i];
        const figure_rect *place = &l->note_place[i];
        if (place->width > 0) {
            draw_dot(d, &l->plane, n->x, n->y);
            draw_markup(d, n->text, d->style.tick, place->x, place->y, (anchor){0, 0});
        }
    }
}
