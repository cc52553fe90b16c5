/* What the parts of the page about a surface share. */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_FIGURE_INTERNAL_H
#define RUGO_SERVER_SHOW_MAP_MAP_FIGURE_INTERNAL_H

#include "core/statistics/measured_map.h"
#include "server/show/plot/plot_pen.h"

struct map_figure; /* that of map_figure.h */

/* In SVG user units, four a millimetre. */
enum { PAGE_WIDTH = 840, PAGE_HEIGHT = 1188, PAGE_LEFT = 52, PAGE_RIGHT = 788 };

/* The units that lengths are shown in. */
struct figure_units {
    const char *x_name, *z_name; /* "": none is known */
    double x, z;                 /* units of the map in one; 1 without a name */
};
struct figure_page {
    const struct map_figure *figure;
    struct figure_units units;
    struct measured_map map;
    struct plot_pen pen;
};

enum { UNIT_TEXT_SIZE = 40 };
struct figure_units figure_units_of(const struct map_figure *figure);
/* Writes a unit for svg_label: of powers -1 and 2, "nm^2/\xc2\xb5m"; "" where none is known. */
void figure_unit_text(const struct figure_units *units, int x_power, int z_power,
                      char out[UNIT_TEXT_SIZE]);
/* Returns what a value of such powers is divided by to be in those units. */
double figure_unit(const struct figure_units *units, int x_power, int z_power);
/* Writes "NAME (UNIT)" for svg_label. */
void figure_axis_label(const struct figure_units *units, const char *name, int x_power, int z_power,
                       char out[PLOT_LABEL_SIZE]);

/* The legend of a panel: rows in one of its corners. */
struct figure_mark {
    const char *label; /* for svg_label */
    const char *style; /* of a stroke, or a filled field where it has a fill */
    bool field;
};
void figure_legend(const struct figure_page *page, size_t count, const struct figure_mark *marks,
                   bool right, bool top);
void figure_heading(const struct figure_page *page, const char *text, int x, int y);

/* Strokes and fields differ by their darkness and dashes, not by colour alone. */
#define MEASURED "class=\"curve\" stroke=\"#0b4f7d\" stroke-width=\"1.5\""
#define BAND "fill=\"#9cc3e0\" fill-opacity=\".7\""
#define FITTED "class=\"curve\" stroke=\"#d0450a\" stroke-width=\"1.6\" stroke-dasharray=\"7 3\""
#define NORMAL "class=\"curve\" stroke=\"#555\" stroke-width=\"1.1\" stroke-dasharray=\"2 2\""
#define TRUSTED "fill=\"#f5f1e3\""

/* Numbers of a panel in the units of the page; the memory of all is one block. */
struct figure_points {
    size_t count;
    double *x, *y, *low, *high, *law;
};
int figure_points_create(struct figure_points *out, size_t count, struct error *err);
/* Moves the frame of the page to a panel. */
void figure_place(struct figure_page *page, bool right, bool low);
/* Draws an empty panel with the reason as its text. */
void figure_draw_none(struct figure_page *page, bool right, bool low, const char *heading,
                      const char *text);
enum { FIGURE_HEADING = 12 }; /* above a panel */

/* Draw the parts, each in its panel. */
int figure_draw_map(struct figure_page *page, struct error *err);
int figure_draw_heights(struct figure_page *page, struct error *err);
int figure_draw_psd(struct figure_page *page, struct error *err);
int figure_draw_scales(struct figure_page *page, struct error *err);
void figure_draw_table(struct figure_page *page);

#endif
