/* The table on the page: the main parameters with what is known of their errors. */
#include "jobs/maps/map_artefact_words.h"
#include "server/show/map/main_values.h"
#include <string.h>

/* BOTTOM: of the note below the rows, which are closer where there are many. */
enum { LEFT = 484, TOP = 112, ROW = 16, BOTTOM = 474 };

static void draw_row(const struct figure_page *page, const struct main_value *row, int y) {
    FILE *file = page->pen.file;
    fprintf(file, "<path d=\"M%d %dH%d\" class=\"grid\"/><text x=\"%d\" y=\"%d\">", LEFT, y + 5,
            PAGE_RIGHT, LEFT, y);
    svg_text(file, row->label);
    fputs(row->untrusted ? " *" : "", file);
    fprintf(file, "</text><text x=\"%d\" y=\"%d\" class=\"end\">", PAGE_RIGHT, y);
    svg_text(file, row->text);
    fputs(row->unit[0] != '\0' ? " " : "", file);
    svg_label(file, row->unit);
    fputs("</text>\n", file);
}

/* What the numbers behind values are, or why there are none. */
static void draw_note(const struct figure_page *page, int y) {
    const char *errors = named_text(page->figure->found, "uncertainty", "errors");
    char names[ARTEFACT_NAMES_SIZE];
    map_artefact_names(names, &page->figure->record->artefacts);
    bool none = errors != NULL && strncmp(errors, "none: ", 6) == 0;
    fprintf(page->pen.file, "<text x=\"%d\" y=\"%d\" class=\"small note\">", LEFT, y);
    fputs(none ? "no standard errors: " : "± standard error; [95 % interval]", page->pen.file);
    if (none)
        svg_text(page->pen.file, errors + 6);
    fputs("</text>\n", page->pen.file);
    if (*names == '\0')
        return;
    fprintf(page->pen.file,
            "<text x=\"%d\" y=\"%d\" class=\"small note\">* not trusted: %s</text>\n", LEFT, y + 13,
            names);
}

void figure_draw_table(struct figure_page *page) {
    struct main_value rows[MAIN_VALUES_MOST];
    const size_t count = main_values_list(rows, page->figure, "±");
    const double closer = (BOTTOM - TOP - 10) / (count > 0 ? (double)count : 1);
    const double row = closer < ROW ? closer : ROW;
    for (size_t n = 0; n < count; n++)
        draw_row(page, &rows[n], TOP + 8 + (int)(row * (double)n));
    draw_note(page, TOP + 10 + (int)(row * (double)count));
}
