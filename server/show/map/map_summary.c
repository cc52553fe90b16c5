#include "server/show/map/map_summary.h"
#include "server/show/map/main_values.h"
#include "server/show/map/map_verdicts.h"
#include "server/show/table/text_table.h"
#include <math.h>
#include <string.h>

enum { LINE_SIZE = 512, LABEL_WIDTH = 26 };

static const char *or_none(const char *text) {
    return text != NULL ? text : "";
}

static void print_file(FILE *file, const struct map_figure *figure) {
    const struct preparation_record *record = figure->record;
    const char *name = preparation_text(record, "file"), *bytes = preparation_text(record, "bytes");
    const char *format = preparation_text(record, "format");
    const char *layer = preparation_text(record, "layer");
    char text[LINE_SIZE];
    snprintf(text, sizeof text, "%s%s%s%s%s%s%s%s", name != NULL ? name : "a map",
             format != NULL ? ": " : "", or_none(format), bytes != NULL ? ", " : "", or_none(bytes),
             bytes != NULL ? " bytes" : "", layer != NULL ? ", layer " : "", or_none(layer));
    print_folded(file, text);
}

static void print_size(FILE *file, const struct map_figure *figure) {
    const struct grid *grid = &figure->map->grid;
    const struct figure_units units = figure_units_of(figure);
    const double dx = grid_dx(grid) / units.x, dy = grid_dy(grid) / units.x;
    const double holes = figure->record->holes;
    const bool open = figure->record->boundary == BOUNDARY_OPEN;
    const char *gap = *units.x_name != '\0' ? " " : "";
    char text[LINE_SIZE], spacing[64];
    if (grid_is_profile(grid) || fabs(dx - dy) <= 1e-9 * dx)
        snprintf(spacing, sizeof spacing, "%.4g", dx);
    else
        snprintf(spacing, sizeof spacing, "%.4g and %.4g", dx, dy);
    int used =
        grid_is_profile(grid)
            ? snprintf(text, sizeof text, "profile of %zu points, %s%s%s apart, %.4g%s%s long",
                       grid->nx, spacing, gap, units.x_name, grid->lx / units.x, gap, units.x_name)
            : snprintf(text, sizeof text, "%zu by %zu points, %s%s%s apart, %.4g by %.4g%s%s",
                       grid->nx, grid->ny, spacing, gap, units.x_name, grid->lx / units.x,
                       grid->ly / units.x, gap, units.x_name);
    if (used > 0 && (size_t)used < sizeof text)
        snprintf(text + used, sizeof text - (size_t)used, "; %s; ", open ? "open" : "periodic");
    used = (int)strlen(text);
    if (holes > 0)
        snprintf(text + used, sizeof text - (size_t)used, "%.3g %% not measured", 100 * holes);
    else
        snprintf(text + used, sizeof text - (size_t)used, "no holes");
    print_folded(file, text);
}

static void print_units(FILE *file, const struct map_figure *figure) {
    const char *note = height_map_unit_note(figure->map);
    if (note != NULL)
        print_folded(file, note);
}

static void print_steps(FILE *file, const struct map_figure *figure) {
    static const char BEGIN[] = "prepared: ";
    char text[sizeof BEGIN + PREPARATION_STEPS_TEXT];
    memcpy(text, BEGIN, sizeof BEGIN);
    preparation_steps_text(figure->record, text + strlen(BEGIN), PREPARATION_STEPS_TEXT);
    print_folded(file, text[strlen(BEGIN)] != '\0' ? text : "prepared: as it was read");
}

static void print_values(FILE *file, const struct map_figure *figure) {
    struct main_value rows[MAIN_VALUES_MOST];
    const size_t count = main_values_list(rows, figure, "+-");
    for (size_t n = 0; n < count; n++)
        if (!rows[n].said)
            fprintf(file, "%c %-*s %s%s%s\n", rows[n].untrusted ? '*' : ' ', LABEL_WIDTH,
                    rows[n].label, rows[n].text, *rows[n].unit != '\0' ? " " : "", rows[n].unit);
}

static void print_verdicts(FILE *file, const struct map_figure *figure) {
    char verdicts[VERDICTS_MOST][VERDICT_SIZE];
    const size_t count = map_verdicts_list(verdicts, figure);
    for (size_t n = 0; n < count; n++)
        print_folded(file, verdicts[n]);
}

static void print_rest(FILE *file, const struct named_values *found) {
    char text[3 * LINE_SIZE];
    size_t used = (size_t)snprintf(text, sizeof text, "more: --all, --format json, or --group of");
    const char *last = "";
    for (size_t n = 0; n < found->count + found->column_count && used < sizeof text; n++) {
        const char *group =
            n < found->count ? found->list[n].group : found->columns[n - found->count].group;
        if (strcmp(group, last) != 0)
            used += (size_t)snprintf(text + used, sizeof text - used, " %s", group);
        last = group;
    }
    print_folded(file, text);
}

void map_summary_print(FILE *file, const struct map_figure *figure) {
    print_file(file, figure);
    print_size(file, figure);
    print_units(file, figure);
    print_steps(file, figure);
    fputc('\n', file);
    print_values(file, figure);
    fputc('\n', file);
    print_verdicts(file, figure);
    fputc('\n', file);
    print_rest(file, figure->found);
}
