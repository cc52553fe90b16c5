#include "server/show/map/together_report.h"
#include "core/map/length_unit.h"
#include "server/show/plot/plot_pen.h"
#include <math.h>
#include <stdlib.h>

/* --- numbers --- */

static const char *const FILES[] = {"1", "2",  "3",  "4",  "5",  "6",  "7",  "8",
                                    "9", "10", "11", "12", "13", "14", "15", "16"};
_Static_assert(sizeof FILES / sizeof *FILES == JOINT_PATCHES_MOST, "a name for each file");

static void add_interval(struct named_values *out, const char *const names[3],
                         const struct interval *interval, int power) {
    named_values_add_length(out, "together", names[0], interval->value, power);
    named_values_add_length(out, "together", names[1], interval->low, power);
    named_values_add_length(out, "together", names[2], interval->high, power);
}

/* With the ends of 95 % intervals. */
static void add_lay(struct named_values *out, const struct lay *lay) {
    static const double NORMAL = 1.96, DEGREES = 180 / M_PI;
    if (lay_is_plain(lay))
        return;
    named_values_add(out, "together", "lay_ratio", lay->ratio);
    named_values_add(out, "together", "lay_ratio_low",
                     lay->ratio * exp(-NORMAL * lay->ratio_error));
    named_values_add(out, "together", "lay_ratio_high",
                     lay->ratio * exp(NORMAL * lay->ratio_error));
    named_values_add(out, "together", "lay_angle", lay->angle * DEGREES);
    named_values_add(out, "together", "lay_angle_low",
                     (lay->angle - NORMAL * lay->angle_error) * DEGREES);
    named_values_add(out, "together", "lay_angle_high",
                     (lay->angle + NORMAL * lay->angle_error) * DEGREES);
}

static void add_law(struct named_values *out, const struct map_together *together) {
    static const char *const HURST[] = {"hurst", "hurst_low", "hurst_high"};
    static const char *const ROLLOFF[] = {"rolloff_wavelength", "rolloff_wavelength_low",
                                          "rolloff_wavelength_high"};
    static const char *const AMPLITUDE[] = {"amplitude", "amplitude_low", "amplitude_high"};
    static const char GROUP[] = "together";
    const struct joint_fit *fit = &together->fit;
    named_values_add(out, GROUP, "maps", (double)fit->patches);
    if (together->in_metres)
        named_values_add_text(out, GROUP, "unit", "m");
    named_values_add_length(out, GROUP, "trusted_from", fit->longest, 1);
    named_values_add_length(out, GROUP, "trusted_to", fit->shortest, 1);
    add_interval(out, HURST, &fit->hurst, 0);
    add_interval(out, ROLLOFF, &fit->rolloff_wavelength, 1);
    named_values_add_length(out, GROUP, "reference_wavelength", fit->reference_wavelength, 1);
    add_interval(out, AMPLITUDE, &fit->amplitude, together->profile ? 3 : 4);
    add_lay(out, &together->lay);
    named_values_add(out, GROUP, "between_maps", fit->between);
    named_values_add(out, GROUP, "between_maps_p_value", fit->p_value);
    named_values_add(out, GROUP, "deviance", fit->deviance);
    named_values_add(out, GROUP, "deviance_limit", fit->deviance_limit);
}

/* Columns of the maps, a row each; of grooves where one has any, the first family. */
static bool add_maps(struct named_values *out, const struct map_together *together) {
    enum { NX, NY, SPACING, FROM, TO, HURST, LOW, HIGH, OFFSET, ERROR, PERIOD, DEPTH, COLUMNS };
    static const char *const NAMES[COLUMNS] = {
        "nx",        "ny",         "spacing", "trusted_from", "trusted_to",    "hurst",
        "hurst_low", "hurst_high", "offset",  "offset_error", "groove_period", "groove_depth"};
    double *columns[COLUMNS];
    int count = PERIOD;
    for (size_t m = 0; m < together->count; m++)
        if (together->maps[m].grooves.families > 0)
            count = COLUMNS;
    for (int c = 0; c < count; c++) {
        const bool length = (c >= SPACING && c <= TO) || c >= PERIOD;
        columns[c] =
            named_values_column_length(out, "maps", NAMES[c], together->count, length ? 1 : 0);
        if (columns[c] == NULL)
            return false;
    }
    for (size_t m = 0; m < together->count; m++) {
        const struct together_map *map = &together->maps[m];
        const struct joint_patch *patch = &together->patches[m];
        const struct map_groove *groove = &map->grooves.family[0];
        const bool grooved = map->grooves.families > 0;
        const double row[COLUMNS] = {
            [NX] = (double)map->grid.nx,
            [NY] = (double)map->grid.ny,
            [SPACING] = grid_dx(&map->grid),
            [FROM] = map->fit.trusted_from,
            [TO] = map->fit.trusted_to,
            [HURST] = map->fit.hurst.value,
            [LOW] = map->fit.hurst.low,
            [HIGH] = map->fit.hurst.high,
            [OFFSET] = patch->offset,
            [ERROR] = patch->error,
            [PERIOD] = grooved ? groove->period : (double)NAN,
            [DEPTH] = grooved ? groove->fit.depth : (double)NAN,
        };
        for (int c = 0; c < count; c++)
            columns[c][m] = row[c];
    }
    return true;
}

static bool is_trusted(const struct together_map *map, double wave_number) {
    const double length = 2 * M_PI / wave_number;
    return length <= map->fit.trusted_from * (1 + 1e-9) && length >= map->fit.trusted_to;
}

static bool add_rings(struct named_values *out, const struct map_together *together) {
    enum { MAP, WAVE_NUMBER, DENSITY, LOW, HIGH, TRUSTED, LAW, COLUMNS };
    static const char *const NAMES[COLUMNS] = {"map",           "wave_number",  "density",
                                               "density_low",   "density_high", "trusted",
                                               "density_fitted"};
    double *columns[COLUMNS];
    size_t rows = 0, row = 0;
    for (size_t m = 0; m < together->count; m++)
        rows += together_map_rings(&together->maps[m])->rings - 1;
    for (int c = 0; c < COLUMNS; c++) {
        const int power = together->profile ? 3 : 4;
        columns[c] = named_values_column_length(out, "psd", NAMES[c], rows,
                                                c == MAP || c == TRUSTED ? 0
                                                : c == WAVE_NUMBER       ? -1
                                                                         : power);
        if (columns[c] == NULL)
            return false;
    }
    for (size_t m = 0; m < together->count; m++) {
        const struct map_spectrum *s = together_map_rings(&together->maps[m]);
        for (size_t r = 1; r < s->rings; r++, row++) {
            columns[MAP][row] = (double)(m + 1);
            columns[WAVE_NUMBER][row] = s->wave_number[r];
            columns[DENSITY][row] = s->density[r];
            map_spectrum_band(s, r, &columns[LOW][row], &columns[HIGH][row]);
            columns[TRUSTED][row] = is_trusted(&together->maps[m], s->wave_number[r]) ? 1 : 0;
            columns[LAW][row] =
                joint_fit_density(&together->fit, together->profile, s->wave_number[r]);
        }
    }
    return true;
}

/* Densities of lines along x. */
static bool add_lines(struct named_values *out, const struct map_together *together) {
    enum { MAP, WAVE_NUMBER, DENSITY, LOW, HIGH, COLUMNS };
    static const char *const NAMES[COLUMNS] = {"map", "wave_number", "density", "density_low",
                                               "density_high"};
    double *columns[COLUMNS];
    size_t rows = 0, row = 0;
    for (size_t m = 0; m < together->count; m++)
        rows += line_psd_count(together->maps[m].spectrum, 0);
    for (int c = 0; c < COLUMNS; c++) {
        columns[c] = named_values_column_length(out, "psd_x", NAMES[c], rows,
                                                c == MAP           ? 0
                                                : c == WAVE_NUMBER ? -1
                                                                   : 3);
        if (columns[c] == NULL)
            return false;
    }
    for (size_t m = 0; m < together->count; m++) {
        const struct map_spectrum *s = together->maps[m].spectrum;
        const size_t count = line_psd_count(s, 0);
        line_psd_measure(s, 0, columns[WAVE_NUMBER] + row, columns[DENSITY] + row,
                         columns[LOW] + row, columns[HIGH] + row);
        for (size_t n = 0; n < count; n++)
            columns[MAP][row++] = (double)(m + 1);
    }
    return true;
}

int together_report_fill(struct named_values *out, const struct map_together *together,
                         struct error *err) {
    out->in_metres = together->in_metres;
    for (size_t m = 0; m < together->count; m++)
        named_values_add_text(out, "files", FILES[m], together->maps[m].file);
    add_law(out, together);
    return add_maps(out, together) && add_rings(out, together) && add_lines(out, together)
               ? 0
               : error_memory(err, 0, "the spectra of maps");
}

/* --- the picture --- */

enum { WIDTH = 1120, HEIGHT = 520, PANEL_TOP = 70, PANEL_BOTTOM = 440, LEFT = 90, RIGHT = 500 };
static const double DECADES_MOST = 1e14; /* below, there is rounding alone */

struct units {
    const char *name; /* "": none is known */
    double in_one;
};

static struct units units_of(const struct map_together *together) {
    struct units units = {"", 1};
    if (together->in_metres)
        units.name = length_unit_readable(together->fit.longest / 10, &units.in_one);
    return units;
}

/* One density of a map, in the units of the picture. */
struct drawn {
    size_t count;
    double *x, *y, *trusted, *room; /* trusted: y, NaN beyond the band; one block, owned by x */
};

static int drawn_create(struct drawn *out, size_t count, struct error *err) {
    double *block = array_create(count > 0 ? 5 * count : 1, sizeof *block);
    if (block == NULL)
        return error_memory(err, 5 * count * sizeof *block, "a picture");
    *out = (struct drawn){count, block, block + count, block + 2 * count, block + 3 * count};
    return 0;
}

/* lines: of lines along x, in place of rings. */
static int take(struct drawn *out, const struct map_together *together, size_t m, bool lines,
                const struct units *units, struct error *err) {
    const struct together_map *map = &together->maps[m];
    const struct map_spectrum *s = lines ? map->spectrum : together_map_rings(map);
    const size_t count = lines ? line_psd_count(s, 0) : s->rings - 1;
    const int power = lines || together->profile ? 3 : 4;
    int status = drawn_create(out, count, err);
    if (status != 0)
        return status;
    if (lines)
        line_psd_measure(s, 0, out->x, out->y, out->room, out->room + count);
    for (size_t n = 0; n < count; n++) {
        const double k = lines ? out->x[n] : s->wave_number[n + 1];
        const double y = (lines ? out->y[n] : s->density[n + 1]) / pow(units->in_one, power);
        out->x[n] = k * units->in_one;
        out->y[n] = y;
        out->trusted[n] = is_trusted(map, k) ? y : (double)NAN;
    }
    return 0;
}

static void draw_law(const struct plot_pen *pen, const struct map_together *together,
                     const struct units *units) {
    enum { POINTS = 200 };
    double x[POINTS], y[POINTS];
    const struct joint_fit *fit = &together->fit;
    const int power = together->profile ? 3 : 4;
    for (int n = 0; n < POINTS; n++) {
        const double part = (double)n / (POINTS - 1);
        const double length = fit->longest * pow(fit->shortest / fit->longest, part);
        x[n] = 2 * M_PI / length * units->in_one;
        y[n] = joint_fit_density(fit, together->profile, 2 * M_PI / length) /
               pow(units->in_one, power);
    }
    pen_line(pen, POINTS, x, y,
             "class=\"curve\" stroke=\"#000\" stroke-width=\"1.6\" stroke-dasharray=\"7 3\"");
}

static void draw_densities(const struct plot_pen *pen, size_t count, const struct drawn *drawn) {
    char style[120];
    for (size_t m = 0; m < count; m++) {
        const char *colour = PEN_COLOURS[m % PLOT_LINES];
        snprintf(style, sizeof style, "class=\"curve\" stroke=\"%s\" stroke-width=\".7\"", colour);
        pen_line(pen, drawn[m].count, drawn[m].x, drawn[m].y, style);
        snprintf(style, sizeof style, "class=\"curve\" stroke=\"%s\" stroke-width=\"2\"", colour);
        pen_line(pen, drawn[m].count, drawn[m].x, drawn[m].trusted, style);
    }
}

static void axis_labels(const struct units *units, bool lines, int power,
                        char x_label[PLOT_LABEL_SIZE], char y_label[PLOT_LABEL_SIZE]) {
    const char *name = lines ? "C(q_x)" : "C(q)";
    const bool known = units->name[0] != '\0';
    snprintf(x_label, PLOT_LABEL_SIZE, known ? "q = 2π/λ (1/%s)" : "q = 2π/λ", units->name);
    snprintf(y_label, PLOT_LABEL_SIZE, known ? "%s (%s^%d)" : "%s", name, units->name, power);
}

static int draw_panel(struct plot_pen *pen, const struct map_together *together, bool lines,
                      const struct units *units, struct error *err) {
    struct drawn drawn[JOINT_PATCHES_MOST] = {{0}};
    struct frame *frame = &pen->frame;
    char x_label[PLOT_LABEL_SIZE], y_label[PLOT_LABEL_SIZE];
    int status = 0;
    frame_start(frame, true, true);
    for (size_t m = 0; m < together->count && status == 0; m++) {
        status = take(&drawn[m], together, m, lines, units, err);
        if (status == 0)
            frame_include(frame, drawn[m].count, drawn[m].x, drawn[m].y);
    }
    if (status == 0 && frame_finish(frame)) {
        frame->y.low = fmax(frame->y.low, frame->y.high / DECADES_MOST);
        frame->left = lines ? LEFT + WIDTH / 2 : LEFT;
        frame->right = lines ? RIGHT + WIDTH / 2 : RIGHT;
        frame->top = PANEL_TOP;
        frame->bottom = PANEL_BOTTOM;
        frame->scale = 1;
        frame->powers = true;
        axis_labels(units, lines, lines || together->profile ? 3 : 4, x_label, y_label);
        frame_draw(pen->file, frame, x_label, y_label);
        draw_densities(pen, together->count, drawn);
        if (!lines || together->profile)
            draw_law(pen, together, units);
    }
    for (size_t m = 0; m < together->count; m++)
        free(drawn[m].x);
    return status;
}

/* The names of the files in their colours, below the panels. */
static void draw_names(const struct plot_pen *pen, const struct map_together *together) {
    enum { ROW = 16, COLUMNS = 4, COLUMN = 270, TOP = 500 };
    const size_t rows = (together->count + COLUMNS - 1) / COLUMNS;
    for (size_t m = 0; m < together->count; m++) {
        const int x = LEFT - 40 + COLUMN * (int)(m % COLUMNS);
        const int y = TOP + ROW * (int)(m / COLUMNS);
        fprintf(pen->file,
                "<path d=\"M%d %dh24\" stroke=\"%s\" stroke-width=\"2\"/><text x=\"%d\" y=\"%d\">",
                x, y - 4, PEN_COLOURS[m % PLOT_LINES], x + 30, y);
        svg_text(pen->file, together->maps[m].file);
        fputs(together->maps[m].grooves.families > 0 ? " (degrooved)</text>\n" : "</text>\n",
              pen->file);
    }
    fprintf(pen->file,
            "<text x=\"%d\" y=\"%d\" class=\"note\">thick: trusted; dashed: the law of all, "
            "H = %.3g</text>\n",
            LEFT - 40, TOP + ROW * (int)rows, together->fit.hurst.value);
}

int together_draw(const struct map_together *together, const struct named_values *found, FILE *file,
                  struct error *err) {
    struct plot_pen pen = {.file = file};
    const struct units units = units_of(together);
    const int more = 16 * (int)((together->count + 3) / 4) + 16;
    pen_head_sized(&pen, &(struct pen_size){.width = WIDTH, .height = HEIGHT + more, .font = 13});
    int status = named_values_draw_metadata(file, found, err);
    pen_title(&pen, "Power spectral density", "maps of one surface together");
    if (status == 0)
        status = draw_panel(&pen, together, false, &units, err);
    if (status == 0)
        status = draw_panel(&pen, together, true, &units, err);
    draw_names(&pen, together);
    fputs("</svg>\n", file);
    return status;
}
