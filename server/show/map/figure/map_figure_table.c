/* The table on the page: the main parameters with what is known of their errors. */
#include "jobs/maps/map_artefact_words.h"
#include "server/show/map/main_values.h"
#include <string.h>

/* BOTTOM: of the note below the rows, which are closer where there are many. */
enum { LEFT = 484, TOP = 112, ROW = 16, BOTTOM = 474, NOTE_ROW = 13, NOTE_LETTERS = 56 };
/* Letters are smaller where rows are closer than this. */
static const double ROW_OF_LETTERS = 13;

/* apart: of rows. */
static void draw_row(const struct figure_page *page, const struct main_value *row, double apart,
                     int y) {
    FILE *file = page->pen.file;
    char size[40] = "";
    if (apart < ROW_OF_LETTERS)
        snprintf(size, sizeof size, " style=\"font-size:%.1fpx\"", apart - 1);
    fprintf(file, "<path d=\"M%d %dH%d\" class=\"grid\"/><text x=\"%d\" y=\"%d\"%s>", LEFT,
            y + (int)(apart / 3), PAGE_RIGHT, LEFT, y, size);
    svg_text(file, row->label);
    fputs(row->untrusted ? " *" : "", file);
    fprintf(file, "</text><text x=\"%d\" y=\"%d\" class=\"end\"%s>", PAGE_RIGHT, y, size);
    svg_text(file, row->text);
    fputs(row->unit[0] != '\0' ? " " : "", file);
    svg_label(file, row->unit);
    fputs("</text>\n", file);
}

/* Draws a note in lines as wide as the table, and returns where the next one is. */
static int draw_lines(FILE *file, const char *text, int y) {
    char part[NOTE_LETTERS + 1];
    while (*text != '\0') {
        size_t length = strlen(text);
        if (length > NOTE_LETTERS) {
            length = NOTE_LETTERS;
            while (length > 0 && text[length] != ' ')
                length--;
            length = length > 0 ? length : NOTE_LETTERS;
        }
        snprintf(part, sizeof part, "%.*s", (int)length, text);
        fprintf(file, "<text x=\"%d\" y=\"%d\" class=\"small note\">", LEFT, y);
        svg_text(file, part);
        fputs("</text>\n", file);
        text += length;
        text += strspn(text, " ");
        y += NOTE_ROW;
    }
    return y;
}

/* What the numbers behind values are, or why there are none. */
static void draw_note(const struct figure_page *page, int y) {
    const char *errors = named_text(page->figure->found, "uncertainty", "errors");
    char names[ARTEFACT_NAMES_SIZE], text[256];
    map_artefact_names(names, &page->figure->record->artefacts);
    bool none = errors != NULL && strncmp(errors, "none: ", 6) == 0;
    snprintf(text, sizeof text, "%s%s",
             none ? "no standard errors: " : "± standard error; [95 % interval]",
             none ? errors + 6 : "");
    y = draw_lines(page->pen.file, text, y);
    if (*names == '\0')
        return;
    snprintf(text, sizeof text, "* not trusted: %s", names);
    (void)draw_lines(page->pen.file, text, y);
}

void figure_draw_table(struct figure_page *page) {
    struct main_value rows[MAIN_VALUES_MOST];
    const size_t count = main_values_list(rows, page->figure, "±");
    const double closer = (BOTTOM - TOP - 10) / (count > 0 ? (double)count : 1);
    const double row = closer < ROW ? closer : ROW;
    for (size_t n = 0; n < count; n++)
        draw_row(page, &rows[n], row, TOP + 8 + (int)(row * (double)n));
    draw_note(page, TOP + 10 + (int)(row * (double)count));
}
