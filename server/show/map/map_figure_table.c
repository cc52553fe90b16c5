/* The table on the page: the main parameters with what is known of their errors. */
#include "server/show/map/map_figure.h"
#include "server/show/map/map_figure_internal.h"
#include <math.h>
#include <string.h>

enum { LEFT = 484, TOP = 112, ROW = 16, ROWS_MOST = 24, TEXT_SIZE = 96 };

/* The rows in their order; those without a value are left out. Of rows with one label the first
 * that has a value is shown. */
static const struct table_row {
    const char *label, *group, *name;
    int x_power, z_power;
    const char *other; /* name of the other end of a range; NULL: a value */
} ROWS[] = {
    {"RMS height Sq", "areal", "Sq", 0, 1, NULL},
    {"RMS height", "heights", "rms", 0, 1, NULL},
    {"mean height Sa", "areal", "Sa", 0, 1, NULL},
    {"greatest height Sz", "areal", "Sz", 0, 1, NULL},
    {"skewness", "heights", "skewness", 0, 0, NULL},
    {"kurtosis", "heights", "kurtosis", 0, 0, NULL},
    {"RMS slope", "finite_difference", "rms_slope", 0, 0, NULL},
    {"RMS curvature", "finite_difference", "rms_curvature", -1, 0, NULL},
    {"correlation length Sal", "areal", "Sal", 1, 0, NULL},
    {"texture aspect Str", "areal", "Str", 0, 0, NULL},
    {"developed area Sdr", "areal", "Sdr", 0, 0, NULL},
    {"Nayak's alpha", "finite_difference", "nayak_alpha", 0, 0, NULL},
    {"summit density", "summits_nine_point", "density", -2, 0, NULL},
    {"peak density", "peaks", "density", -1, 0, NULL},
    {"Hurst exponent H", "spectrum_fit", "hurst", 0, 0, NULL},
    {"roll-off wavelength", "spectrum_fit", "rolloff_wavelength", 1, 0, NULL},
    {"shortest wavelength", "spectrum_fit", "short_wavelength", 1, 0, NULL},
    {"longest wavelength", "spectrum_fit", "long_wavelength", 1, 0, NULL},
    {"trusted wavelengths", "spectrum_fit", "trusted_to", 1, 0, "trusted_from"},
    {"heights like", "height_fit", "distribution", 0, 0, NULL},
    {"their shape C", "height_fit", "shape", 0, 0, NULL},
    {"p-value of these heights", "height_fit", "p_value", 0, 0, NULL},
    {"p-value of isotropy", "isotropy", "p_value", 0, 0, NULL},
    {"p-value of stationarity", "stationarity", "p_value", 0, 0, NULL},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static double value_of(const struct figure_page *page, const struct table_row *row,
                       const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "%.40s%s", row->name, ending);
    return named_number(page->figure->found, row->group, name) /
           figure_unit(&page->units, row->x_power, row->z_power);
}

/* Returns how many decimals show an error to two digits; -1: too many, or none is known. */
static int decimals_of(double error) {
    int decimals = error > 0 && isfinite(error) ? 1 - (int)floor(log10(error)) : -1;
    return decimals > 9 ? -1 : decimals < 0 && error > 0 ? 0 : decimals;
}

/* Whether its decimals would be mostly zeros before it: they would not fit beside the label. */
static bool needs_exponent(double value) {
    return value != 0 && fabs(value) < 1e-3;
}

/* Writes a value with its standard error, to two digits of that. */
static void write_measured(char *out, size_t size, double value, double error) {
    int decimals = decimals_of(error);
    if (decimals < 0)
        snprintf(out, size, "%.4g", value);
    else if (needs_exponent(value))
        snprintf(out, size, "%.3g ± %.2g", value, error);
    else
        snprintf(out, size, "%.*f ± %.*f", decimals, value, decimals, error);
}

/* Its half to two digits where it begins with 1 or 2, else to one, but at most four digits of the
 * value: more of all three numbers would not fit beside the label. */
static void write_interval(char *out, size_t size, double value, double low, double high) {
    int decimals = decimals_of(3.4 * (high - low) / 2);
    if (value != 0)
        decimals = (int)fmin(decimals, fmax(0, 3 - floor(log10(fabs(value)))));
    if (decimals < 0 || needs_exponent(value))
        snprintf(out, size, "%.3g [%.2g, %.2g]", value, low, high);
    else
        snprintf(out, size, "%.*f [%.*f, %.*f]", decimals, value, decimals, low, decimals, high);
}

/* Writes both ends of a range; false where there is nothing between them. */
static bool write_range(const struct figure_page *page, const struct table_row *row, double low,
                        char out[TEXT_SIZE]) {
    double high = named_number(page->figure->found, row->group, row->other) /
                  figure_unit(&page->units, row->x_power, row->z_power);
    snprintf(out, TEXT_SIZE, "%.3g to %.3g", low, high);
    return high > low;
}

/* Writes the value of a row; false where there is none. Of an interval that is open at one end it
 * writes the bound alone. */
static bool write_value(const struct figure_page *page, const struct table_row *row,
                        char out[TEXT_SIZE]) {
    const char *text = named_text(page->figure->found, row->group, row->name);
    double value = value_of(page, row, ""), error = value_of(page, row, "_error");
    double low = value_of(page, row, "_low"), high = value_of(page, row, "_high");
    if (text != NULL)
        plot_in_words(text, out, TEXT_SIZE);
    else if (row->other != NULL)
        return write_range(page, row, value, out);
    else if (isfinite(value) && isfinite(low) && isfinite(high))
        write_interval(out, TEXT_SIZE, value, low, high);
    else if (isfinite(value) && strcmp(row->name, "p_value") == 0)
        snprintf(out, TEXT_SIZE, "%.2g", value);
    else if (isfinite(value))
        write_measured(out, TEXT_SIZE, value, error);
    else if (isfinite(low) != isfinite(high))
        snprintf(out, TEXT_SIZE, isfinite(low) ? "> %.3g" : "< %.3g", isfinite(low) ? low : high);
    else
        return false;
    return true;
}

static void draw_row(const struct figure_page *page, const struct table_row *row, const char *value,
                     int y) {
    FILE *file = page->pen.file;
    char unit[UNIT_TEXT_SIZE];
    figure_unit_text(&page->units, row->x_power, row->z_power, unit);
    fprintf(file, "<path d=\"M%d %dH%d\" class=\"grid\"/><text x=\"%d\" y=\"%d\">", LEFT, y + 5,
            PAGE_RIGHT, LEFT, y);
    svg_text(file, row->label);
    fprintf(file, "</text><text x=\"%d\" y=\"%d\" class=\"end\">", PAGE_RIGHT, y);
    svg_text(file, value);
    fputs(unit[0] != '\0' ? " " : "", file);
    svg_label(file, unit);
    fputs("</text>\n", file);
}

/* What the numbers behind values are, or why there are none. */
static void draw_note(const struct figure_page *page, int y) {
    const char *errors = named_text(page->figure->found, "uncertainty", "errors");
    bool none = errors != NULL && strncmp(errors, "none: ", 6) == 0;
    fprintf(page->pen.file, "<text x=\"%d\" y=\"%d\" class=\"small note\">", LEFT, y);
    fputs(none ? "no standard errors: " : "± standard error; [95 % interval]", page->pen.file);
    if (none)
        svg_text(page->pen.file, errors + 6);
    fputs("</text>\n", page->pen.file);
}

void figure_draw_table(struct figure_page *page) {
    int rows = 0;
    char value[TEXT_SIZE];
    bool has_areal = isfinite(named_number(page->figure->found, "areal", "Sq"));
    for (size_t n = 0; n < ROW_COUNT && rows < ROWS_MOST; n++) {
        bool twin = has_areal && strcmp(ROWS[n].label, "RMS height") == 0;
        if (!twin && write_value(page, &ROWS[n], value))
            draw_row(page, &ROWS[n], value, TOP + 8 + ROW * rows++);
    }
    draw_note(page, TOP + 10 + ROW * rows);
}
