/* Units of lengths on the page, and text that many panels share. */
#include "core/map/length_unit.h"
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/figure/map_figure_internal.h"
#include <math.h>
#include <stdlib.h>

static void choose_unit(const char *unit, double length, const char **name, double *in_one) {
    *name = unit;
    *in_one = 1;
    if (length_unit_is_metre(unit) && isfinite(length) && length > 0)
        *name = length_unit_readable(length, in_one);
}

struct figure_units figure_units_of(const struct map_figure *figure) {
    static const double PART = 0.2; /* of the side: lengths on the page are parts of it */
    struct figure_units units;
    const struct height_map *map = figure->map;
    choose_unit(map->xy_unit, PART * map->grid.lx, &units.x_name, &units.x);
    choose_unit(map->z_unit, named_number(figure->found, "heights", "rms"), &units.z_name,
                &units.z);
    return units;
}

double figure_unit(const struct figure_units *units, int x_power, int z_power) {
    return pow(units->x, x_power) * pow(units->z, z_power);
}

/* A slope of two lengths is a number: both are in metres, then. */
void figure_unit_text(const struct figure_units *units, int x_power, int z_power,
                      char out[UNIT_TEXT_SIZE]) {
    const char *names[2] = {units->z_name, units->x_name};
    int powers[2] = {z_power, x_power};
    size_t used = 0;
    out[0] = '\0';
    for (int side = 1; side >= -1; side -= 2)
        for (int n = 0; n < 2; n++) {
            int power = side * powers[n];
            if (power <= 0 || names[n][0] == '\0')
                continue;
            const char *before = side < 0 ? (used > 0 ? "/" : "1/") : used > 0 ? " " : "";
            used += (size_t)snprintf(out + used, UNIT_TEXT_SIZE - used, "%s%s", before, names[n]);
            if (power > 1)
                used += (size_t)snprintf(out + used, UNIT_TEXT_SIZE - used, "^%d", power);
        }
}

void figure_axis_label(const struct figure_units *units, const char *name, int x_power, int z_power,
                       char out[PLOT_LABEL_SIZE]) {
    char unit[UNIT_TEXT_SIZE];
    figure_unit_text(units, x_power, z_power, unit);
    snprintf(out, PLOT_LABEL_SIZE, unit[0] != '\0' ? "%s (%s)" : "%s", name, unit);
}

void figure_heading(const struct figure_page *page, const char *text, int x, int y) {
    fprintf(page->pen.file, "<text x=\"%d\" y=\"%d\" class=\"title\">", x, y);
    svg_label(page->pen.file, text);
    fputs("</text>\n", page->pen.file);
}

void figure_legend(const struct figure_page *page, size_t count, const struct figure_mark *marks,
                   bool right, bool top) {
    enum { ROW = 15, STROKE = 22, GAP = 6, LETTER = 6, MARGIN = 8 };
    const struct frame *frame = &page->pen.frame;
    FILE *file = page->pen.file;
    size_t letters = 0;
    for (size_t n = 0; n < count; n++)
        letters = plot_letters(marks[n].label) > letters ? plot_letters(marks[n].label) : letters;
    int width = STROKE + GAP + (int)letters * LETTER + 2 * GAP, height = ROW * (int)count + GAP;
    int x = right ? frame->right - width - MARGIN : frame->left + MARGIN;
    int y = top ? frame->top + MARGIN : frame->bottom - height - MARGIN;
    fprintf(file,
            "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"#fff\" "
            "fill-opacity=\".8\"/>\n",
            x, y, width, height);
    for (size_t n = 0; n < count; n++) {
        int middle = y + GAP / 2 + ROW * (int)n + ROW / 2;
        if (marks[n].field)
            fprintf(file, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"10\" %s/>", x + GAP,
                    middle - 5, STROKE, marks[n].style);
        else
            fprintf(file, "<path d=\"M%d %dh%d\" %s/>", x + GAP, middle, STROKE, marks[n].style);
        fprintf(file, "<text x=\"%d\" y=\"%d\" class=\"small\">", x + STROKE + 2 * GAP, middle + 4);
        svg_label(file, marks[n].label);
        fputs("</text>\n", file);
    }
}
