#include "server/show/plot/plot_layout.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* On screens; those of print are scaled. */
enum {
    BELOW = 70,
    GAP_X = 30,
    GAP_Y = 30,
    LEGEND_GAP = 16,
    MARGIN = 16,
    SECOND_X = 36, /* above and beside panels: axes in physical units */
    SECOND_Y = 62,
    NARROW = 600,
    PANEL_LEAST = 90
};
static const double UNITS_PER_MM = 96 / 25.4; /* CSS pixels */
static const double PRINT_SCALE = 10.0 / 13;  /* letters of 7.5 points */

static size_t columns_of(size_t panels, size_t wanted) {
    if (wanted > 0)
        return wanted;
    return panels <= 3 ? panels : panels == 4 ? 2 : panels <= 9 ? 3 : 4;
}

/* The picture of one panel has the frame of all other pictures. */
static void size_for_screen(struct plot_layout *out) {
    static const int WIDTHS[] = {620, 330, 270, 230};
    enum { MOST = sizeof WIDTHS / sizeof *WIDTHS };
    out->panel_width = WIDTHS[out->columns <= MOST ? out->columns - 1 : MOST - 1];
    out->panel_height =
        out->panels == 1 ? FRAME_BOTTOM - FRAME_TOP : (int)(0.78 * out->panel_width);
}

static int grid_width(const struct plot_layout *out) {
    return (int)out->columns * out->panel_width +
           (int)((double)(out->columns - 1) * GAP_X * out->scale);
}

static int grid_height(const struct plot_layout *out) {
    int rows = (int)((out->panels + out->columns - 1) / out->columns);
    return rows * out->panel_height + (int)((rows - 1) * GAP_Y * out->scale);
}

/* In fewer columns where panels would be too small to read. */
static void size_for_print(struct plot_layout *out, int legend) {
    double room = out->size.width - out->left - MARGIN * out->scale;
    room -= out->second_y ? SECOND_Y * out->scale : 0;
    if (out->size.width >= NARROW)
        room -= legend + LEGEND_GAP * out->scale;
    do {
        double gaps = (double)(out->columns - 1) * GAP_X * out->scale;
        out->panel_width = (int)((room - gaps) / (double)out->columns);
    } while (out->panel_width < PANEL_LEAST && out->columns-- > 1);
    if (out->columns == 0)
        out->columns = 1;
    if (out->panel_width < PANEL_LEAST)
        out->panel_width = PANEL_LEAST;
    out->panel_height = (int)(0.78 * out->panel_width);
}

void plot_lay_out(struct plot_layout *out, size_t panels, size_t columns,
                  const struct legend *legend, double millimetres) {
    bool print = millimetres > 0;
    double scale = print ? PRINT_SCALE : 1;
    int legend_room = legend_width(legend, scale);
    bool second_x = out->second_x && panels == 1, second_y = out->second_y && panels == 1;
    *out = (struct plot_layout){.second_x = second_x,
                                .second_y = second_y,
                                .panels = panels,
                                .columns = columns_of(panels, columns),
                                .scale = scale,
                                .left = (int)(FRAME_LEFT * scale),
                                .top = print && panels == 1 ? MARGIN : FRAME_TOP};
    out->top += !print && panels > 1 ? GAP_Y - 10 : 0; /* panels have titles */
    out->top += second_x ? (int)(SECOND_X * scale) : 0;
    out->size = (struct pen_size){.font = 13 * scale, .millimetres = millimetres};
    out->size.width = (int)lrint(millimetres * UNITS_PER_MM);
    if (print)
        size_for_print(out, legend_room);
    else
        size_for_screen(out);
    bool below = print && out->size.width < NARROW;
    int right = out->left + grid_width(out), bottom = out->top + grid_height(out);
    right += second_y ? (int)(SECOND_Y * scale) : 0;
    out->legend_left = below ? out->left : right + (int)(LEGEND_GAP * scale);
    out->legend_top = below ? bottom + (int)(BELOW * scale) : out->top - 4;
    out->legend_width = below ? out->size.width - out->left - MARGIN : 0;
    int needed = out->legend_left + legend_room + MARGIN;
    if (!print)
        out->size.width = needed > PEN_WIDTH || panels > 1 ? needed : PEN_WIDTH;
    int legend_bottom =
        out->legend_top + legend_height(legend, scale, out->legend_width) + (int)(8 * scale);
    out->size.height = bottom + (int)(BELOW * scale);
    if (legend_bottom > out->size.height)
        out->size.height = legend_bottom;
}

void plot_place(const struct plot_layout *layout, size_t panel, struct frame *frame) {
    size_t column = panel % layout->columns, row = panel / layout->columns;
    frame->scale = layout->scale;
    frame->left =
        layout->left + (int)((double)column * (layout->panel_width + GAP_X * layout->scale));
    frame->top = layout->top + (int)((double)row * (layout->panel_height + GAP_Y * layout->scale));
    frame->right = frame->left + layout->panel_width;
    frame->bottom = frame->top + layout->panel_height;
    frame->without_x = panel + layout->columns < layout->panels;
    frame->without_y = column > 0;
}

int plot_width_read(const char *text, double *millimetres, struct error *err) {
    char *end;
    *millimetres = 0;
    if (text == NULL)
        return 0;
    if (strcmp(text, "one") == 0 || strcmp(text, "two") == 0) {
        *millimetres = *text == 'o' ? WIDTH_ONE : WIDTH_TWO;
        return 0;
    }
    *millimetres = strtod(text, &end);
    if (end != text && (*end == '\0' || strcmp(end, "mm") == 0) && *millimetres >= WIDTH_LEAST &&
        *millimetres <= WIDTH_MOST)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "width: \"%.20s\" is neither one, two nor millimetres in [%d, %d]", text,
                     WIDTH_LEAST, WIDTH_MOST);
}
