#include "server/show/plot/plot_legend.h"
#include <stdio.h>
#include <string.h>

enum { ROW = 20, STROKE = 34, SPACE = 6, GAP = 18 };

struct legend_row *legend_add(struct legend *legend, const char *label, const char *style) {
    size_t n = legend->count < LEGEND_ROWS_MOST ? legend->count++ : LEGEND_ROWS_MOST - 1;
    struct legend_row *row = &legend->rows[n];
    *row = (struct legend_row){.mark = -1};
    snprintf(row->label, sizeof row->label, "%s", label);
    snprintf(row->style, sizeof row->style, "%s", style);
    return row;
}

static double width_of(const struct legend_row *row, double scale) {
    double stroke = *row->style != '\0' ? STROKE + SPACE : 0;
    return scale * (stroke + PEN_LETTER * (double)plot_letters(row->label));
}

int legend_width(const struct legend *legend, double scale) {
    double widest = 0;
    for (size_t n = 0; n < legend->count; n++) {
        double width = width_of(&legend->rows[n], scale);
        widest = width > widest ? width : widest;
    }
    return (int)widest + 1;
}

/* Where the next row stands: beside the last one where there is room, or below it. Notes stand
 * alone. */
struct place {
    double x, y;
};
static struct place next_place(struct place *at, const struct legend_row *row, double scale,
                               int width) {
    double own = width_of(row, scale);
    bool note = *row->style == '\0';
    if (width == 0 || (at->x > 0 && (note || at->x + own > width))) {
        at->y += ROW * scale;
        at->x = 0;
    }
    struct place here = *at;
    at->x += note ? width + 1 : own + GAP * scale;
    if (width == 0)
        at->x = 0;
    return here;
}

static struct place first_place(int width, double scale) {
    return (struct place){.y = width == 0 ? -ROW * scale : 0};
}

int legend_height(const struct legend *legend, double scale, int width) {
    struct place at = first_place(width, scale), last = {0};
    for (size_t n = 0; n < legend->count; n++)
        last = next_place(&at, &legend->rows[n], scale, width);
    return legend->count > 0 ? (int)(last.y + ROW * scale) : 0;
}

static void draw_row(const struct legend_row *row, FILE *file, double scale, double x, double y) {
    bool note = *row->style == '\0';
    if (!note)
        fprintf(file, "<path d=\"M%.1f %.1fh%.1f\" %s/>", x, y - 4 * scale, STROKE * scale,
                row->style);
    if (row->mark >= 0)
        mark_draw(file, (size_t)row->mark, x + STROKE * scale / 2, y - 4 * scale, scale,
                  row->colour);
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\"%s>", note ? x : x + (STROKE + SPACE) * scale, y,
            note ? " class=\"note\"" : "");
    svg_label(file, row->label);
    fputs("</text>\n", file);
}

void legend_draw(const struct legend *legend, FILE *file, double scale, int left, int top,
                 int width) {
    struct place at = first_place(width, scale);
    for (size_t n = 0; n < legend->count; n++) {
        struct place here = next_place(&at, &legend->rows[n], scale, width);
        draw_row(&legend->rows[n], file, scale, left + here.x, top + here.y + 12 * scale);
    }
}

void mark_draw(FILE *file, size_t mark, double x, double y, double scale, const char *colour) {
    static const char *const SHAPES[] = {"m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
                                         "m-3.6 -3.6h7.2v7.2h-7.2Z", "m0 -4.8l4.4 7.8h-8.8Z",
                                         "m0 -5l5 5l-5 5l-5 -5Z"};
    enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };
    fprintf(file,
            "<path transform=\"translate(%.2f %.2f) scale(%.3g)\" d=\"M0 0%sZ\" class=\"mark\" "
            "stroke-width=\"1.2\" stroke=\"%s\" fill=\"%s\"/>\n",
            x, y, scale, SHAPES[mark % SHAPE_COUNT], colour,
            mark / SHAPE_COUNT % 2 == 0 ? colour : "#fff");
}
