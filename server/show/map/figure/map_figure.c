#include "server/show/map/figure/map_figure.h"
#include "core/map/preparation/preparation.h"
#include "server/show/map/figure/map_figure_internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PAGE_MILLIMETRES = 210;
enum { FOOT_TOP = 1064, FOOT_ROW = 14, FOOT_MOST = 8, LINE_LETTERS = 122, TITLE_LETTERS = 66 };

static void draw_head(const struct figure_page *page) {
    FILE *file = page->pen.file;
    pen_head_sized(&page->pen, &(struct pen_size){.width = PAGE_WIDTH,
                                                  .height = PAGE_HEIGHT,
                                                  .font = 12,
                                                  .millimetres = PAGE_MILLIMETRES});
    fputs("<style>.small{font-size:11px}.name{font-size:18px;font-weight:600}</style>\n"
          "<defs><pattern id=\"hole\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">"
          "<rect width=\"6\" height=\"6\" fill=\"#fff\"/>"
          "<path d=\"M0 6L6 0\" stroke=\"#999\"/></pattern></defs>\n",
          file);
}

/* A name that is too long keeps its begin and its end. */
static void short_name(const char *name, char *out, size_t size) {
    enum { END = 24 };
    name = name != NULL ? name : "a map";
    size_t length = strlen(name);
    if (length <= TITLE_LETTERS)
        snprintf(out, size, "%s", name);
    else
        snprintf(out, size, "%.*s...%s", TITLE_LETTERS - END, name, name + length - END);
}

static void draw_title(const struct figure_page *page) {
    const struct grid *grid = &page->figure->map->grid;
    const struct figure_units *units = &page->units;
    const char *gap = units->x_name[0] != '\0' ? " " : "";
    FILE *file = page->pen.file;
    char name[PLOT_LABEL_SIZE];
    double holes = named_number(page->figure->found, "map", "holes");
    short_name(preparation_text(page->figure->record, "file"), name, sizeof name);
    pen_subject(&page->pen, name, "a measured surface");
    fprintf(file, "<text x=\"%d\" y=\"56\" class=\"name\">", PAGE_LEFT);
    svg_text(file, name);
    fprintf(file, "</text>\n<text x=\"%d\" y=\"77\" class=\"note\">", PAGE_LEFT);
    if (grid_is_profile(grid))
        fprintf(file, "profile of %zu points, %.4g%s%s apart", grid->nx, grid_dx(grid) / units->x,
                gap, units->x_name);
    else if (fabs(grid_dx(grid) - grid_dy(grid)) <= 1e-9 * grid_dx(grid))
        fprintf(file, "%zu × %zu points, %.4g%s%s apart", grid->nx, grid->ny,
                grid_dx(grid) / units->x, gap, units->x_name);
    else
        fprintf(file, "%zu × %zu points, %.4g and %.4g%s%s apart", grid->nx, grid->ny,
                grid_dx(grid) / units->x, grid_dy(grid) / units->x, gap, units->x_name);
    fprintf(file, "; %s", page->figure->record->boundary == BOUNDARY_OPEN ? "open" : "periodic");
    if (holes > 0)
        fprintf(file, "; %.3g %% not measured", 100 * holes);
    if (units->x_name[0] == '\0')
        fputs("; lengths in units of the file", file);
    fputs("</text>\n", file);
}

/* --- where it comes from --- */

/* Draws a text in lines, and returns the next one. */
static int draw_lines(const struct figure_page *page, const char *text, int line) {
    char part[LINE_LETTERS + 1];
    while (*text != '\0' && line < FOOT_MOST) {
        size_t length = strlen(text);
        if (length > LINE_LETTERS) {
            length = LINE_LETTERS;
            while (length > 0 && text[length] != ' ')
                length--;
            length = length > 0 ? length : LINE_LETTERS;
        }
        snprintf(part, sizeof part, "%.*s", (int)length, text);
        fprintf(page->pen.file, "<text x=\"%d\" y=\"%d\" class=\"small note\">", PAGE_LEFT,
                FOOT_TOP + 18 + FOOT_ROW * line++);
        svg_text(page->pen.file, part);
        fputs("</text>\n", page->pen.file);
        text += length;
        text += strspn(text, " ");
    }
    return line;
}

static int draw_steps(const struct figure_page *page, int line) {
    static const char BEGIN[] = "Prepared: ";
    char text[sizeof BEGIN + PREPARATION_STEPS_TEXT];
    memcpy(text, BEGIN, sizeof BEGIN);
    preparation_steps_text(page->figure->record, text + strlen(BEGIN), PREPARATION_STEPS_TEXT);
    return draw_lines(page, text[strlen(BEGIN)] != '\0' ? text : "Prepared: as it was read", line);
}

static void draw_foot(const struct figure_page *page) {
    const struct preparation_record *record = page->figure->record;
    const char *format = preparation_text(record, "format"),
               *layer = preparation_text(record, "layer");
    const char *digest = preparation_text(record, "sha256"),
               *program = preparation_text(record, "program");
    const char *bytes = preparation_text(record, "bytes");
    char text[512];
    int line = 0;
    fprintf(page->pen.file, "<path d=\"M%d %dH%d\" stroke=\"#bbb\"/>\n", PAGE_LEFT, FOOT_TOP,
            PAGE_RIGHT);
    snprintf(text, sizeof text, "File: %.20s%s%.160s%s%.20s%s%.80s", format != NULL ? format : "",
             layer != NULL ? ", layer " : "", layer != NULL ? layer : "", bytes != NULL ? ", " : "",
             bytes != NULL ? bytes : "", digest != NULL ? " bytes, SHA-256 " : "",
             digest != NULL ? digest : "");
    line = draw_lines(page, text, line);
    line = draw_steps(page, line);
    if (program != NULL)
        (void)draw_lines(page, program, line);
}

int map_figure_draw(const struct map_figure *figure, FILE *file, struct error *err) {
    struct figure_page page = {.figure = figure, .pen = {.file = file}};
    page.units = figure_units_of(figure);
    page.map = (struct measured_map){&figure->map->grid, figure->map->z, figure->record->boundary};
    draw_head(&page);
    int status = named_values_draw_metadata(file, figure->found, err);
    draw_title(&page);
    figure_draw_table(&page);
    if (status == 0)
        status = figure_draw_map(&page, err);
    if (status == 0)
        status = figure_draw_heights(&page, err);
    if (status == 0)
        status = figure_draw_psd(&page, err);
    if (status == 0)
        status = figure_draw_scales(&page, err);
    draw_foot(&page);
    fputs("</svg>\n", file);
    return status;
}
