#include "server/show/map/main_values.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "schema/result/view.h"
#include <math.h>
#include <string.h>

/* Values without noise, which are shown where there is some. */
static const char NOISELESS[] = "trusted";
/* What an instrument left, and slopes without it. */
static const char ARTEFACTS[] = "artefacts";
/* Grooves, and the two laws of a stratified face, which are shown where they clearly fit. */
static const char GROOVES[] = "grooves", CROSSED[] = "crossed_grooves", STRATA[] = "functional";

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
    {"  without noise", NOISELESS, "rms_slope", 0, 0, NULL},
    {"  without artefacts, about", ARTEFACTS, "slope_without", 0, 0, NULL},
    {"RMS curvature", "finite_difference", "rms_curvature", -1, 0, NULL},
    {"  without noise", NOISELESS, "rms_curvature", -1, 0, NULL},
    {"correlation length Sal", "areal", "Sal", 1, 0, NULL},
    {"texture aspect Str", "areal", "Str", 0, 0, NULL},
    {"developed area Sdr", "areal", "Sdr", 0, 0, NULL},
    {"Nayak's alpha", "finite_difference", "nayak_alpha", 0, 0, NULL},
    {"  without noise", NOISELESS, "nayak_alpha", 0, 0, NULL},
    {"summit density", "summits_nine_point", "density", -2, 0, NULL},
    {"  without noise", NOISELESS, "summit_density", -2, 0, NULL},
    {"peak density", "peaks", "density", -1, 0, NULL},
    {"  without noise", NOISELESS, "peak_density", -1, 0, NULL},
    {"Hurst exponent H", "spectrum_fit", "hurst", 0, 0, NULL},
    {"roll-off wavelength", "spectrum_fit", "rolloff_wavelength", 1, 0, NULL},
    {"shortest wavelength", "spectrum_fit", "short_wavelength", 1, 0, NULL},
    {"longest wavelength", "spectrum_fit", "long_wavelength", 1, 0, NULL},
    {"waves along over across", "spectrum_fit", "lay_ratio", 0, 0, NULL},
    {"lay, degrees from x", "spectrum_fit", "lay_angle", 0, 0, NULL},
    {"trusted wavelengths", "spectrum_fit", "trusted_to", 1, 0, "trusted_from"},
    {"grooves every", GROOVES, "period", 1, 0, NULL},
    {"grooves, degrees from x", GROOVES, "angle", 0, 0, NULL},
    {"groove depth", GROOVES, "depth", 0, 1, NULL},
    {"groove shape", GROOVES, "shape", 0, 0, NULL},
    {"crossed grooves every", CROSSED, "period", 1, 0, NULL},
    {"crossed, degrees from x", CROSSED, "angle", 0, 0, NULL},
    {"crossed groove depth", CROSSED, "depth", 0, 1, NULL},
    {"crossed groove shape", CROSSED, "shape", 0, 0, NULL},
    {"RMS height without grooves", GROOVES, "rms_height_without", 0, 1, NULL},
    {"RMS height without grooves", CROSSED, "rms_height_without", 0, 1, NULL},
    {"heights like", "height_fit", "distribution", 0, 0, NULL},
    {"their shape C", "height_fit", "shape", 0, 0, NULL},
    {"RMS of the plateau Spq", STRATA, "Spq", 0, 1, NULL},
    {"RMS of the valleys Svq", STRATA, "Svq", 0, 1, NULL},
    {"ratio where they meet Smq", STRATA, "Smq", 0, 0, NULL},
    {"RMS of the plateau Rpq", STRATA, "Rpq", 0, 1, NULL},
    {"RMS of the valleys Rvq", STRATA, "Rvq", 0, 1, NULL},
    {"ratio where they meet Rmq", STRATA, "Rmq", 0, 0, NULL},
    {"p-value of these heights", "height_fit", "p_value", 0, 0, NULL},
    {"p-value of isotropy", "isotropy", "p_value", 0, 0, NULL},
    {"p-value of stationarity", "stationarity", "p_value", 0, 0, NULL},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

/* What the rows are of. */
struct list {
    const struct named_values *found;
    struct figure_units units;
    const char *plus_minus;
};

static double value_of(const struct list *list, const struct table_row *row, const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "%.40s%s", row->name, ending);
    return named_number(list->found, row->group, name) /
           figure_unit(&list->units, row->x_power, row->z_power);
}

int decimals_of_error(double error) {
    int decimals = error > 0 && isfinite(error) ? 1 - (int)floor(log10(error)) : -1;
    return decimals > 9 ? -1 : decimals < 0 && error > 0 ? 0 : decimals;
}

/* Whether its decimals would be mostly zeros before it: they would not fit beside the label. */
static bool needs_exponent(double value) {
    return value != 0 && fabs(value) < 1e-3;
}

/* Writes a value with its standard error, to two digits of that. */
static void write_measured(char *out, const char *plus_minus, double value, double error) {
    int decimals = decimals_of_error(error);
    if (decimals < 0)
        snprintf(out, MAIN_VALUE_SIZE, "%.4g", value);
    else if (needs_exponent(value))
        snprintf(out, MAIN_VALUE_SIZE, "%.3g %s %.2g", value, plus_minus, error);
    else
        snprintf(out, MAIN_VALUE_SIZE, "%.*f %s %.*f", decimals, value, plus_minus, decimals,
                 error);
}

/* Its half to two digits where it begins with 1 or 2, else to one, but at most four digits of the
 * value: more of all three numbers would not fit beside the label. */
static void write_interval(char *out, size_t size, double value, double low, double high) {
    int decimals = decimals_of_error(3.4 * (high - low) / 2);
    if (value != 0)
        decimals = (int)fmin(decimals, fmax(0, 3 - floor(log10(fabs(value)))));
    if (decimals < 0 || needs_exponent(value))
        snprintf(out, size, "%.3g [%.2g, %.2g]", value, low, high);
    else
        snprintf(out, size, "%.*f [%.*f, %.*f]", decimals, value, decimals, low, decimals, high);
}

/* Writes both ends of a range; false where there is nothing between them. */
static bool write_range(const struct list *list, const struct table_row *row, double low,
                        char out[MAIN_VALUE_SIZE]) {
    double high = named_number(list->found, row->group, row->other) /
                  figure_unit(&list->units, row->x_power, row->z_power);
    snprintf(out, MAIN_VALUE_SIZE, high < 1000 ? "%.3g to %.3g" : "%.4g to %.4g", low, high);
    return high > low;
}

/* Writes the value of a row; false where there is none. Of an interval that is open at one end it
 * writes the bound alone. */
static bool write_value(const struct list *list, const struct table_row *row,
                        char out[MAIN_VALUE_SIZE]) {
    const char *text = named_text(list->found, row->group, row->name);
    double value = value_of(list, row, ""), error = value_of(list, row, "_error");
    double low = value_of(list, row, "_low"), high = value_of(list, row, "_high");
    if (text != NULL)
        plot_in_words(text, out, MAIN_VALUE_SIZE);
    else if (row->other != NULL)
        return write_range(list, row, value, out);
    else if (isfinite(value) && isfinite(low) && isfinite(high))
        write_interval(out, MAIN_VALUE_SIZE, value, low, high);
    else if (isfinite(value) && strcmp(row->name, "p_value") == 0)
        snprintf(out, MAIN_VALUE_SIZE, "%.2g", value);
    else if (isfinite(value))
        write_measured(out, list->plus_minus, value, error);
    else if (isfinite(low) != isfinite(high))
        snprintf(out, MAIN_VALUE_SIZE, isfinite(low) ? "> %.3g" : "< %.3g",
                 isfinite(low) ? low : high);
    else
        return false;
    return true;
}

bool main_values_have_noise(const struct named_values *found) {
    return named_number(found, NOISELESS, "noise_share") > NOISE_SHARE_MOST &&
           named_number(found, NOISELESS, "rms_slope") <
               named_number(found, "finite_difference", "rms_slope");
}

/* What is measured by short waves holds what the instrument left, and what rests on heights and
 * their mean square its spikes; so does what follows from the spectrum, unless it is noise there.
 */
static bool is_untrusted(const struct table_row *row, const struct map_artefacts *artefacts,
                         bool has_noise) {
    static const char *const SHORT_WAVES[] = {"rms_slope", "rms_curvature", "nayak_alpha",
                                              "Sdr",       "density",       NULL};
    static const char *const OF_HEIGHTS[] = {"Sq",           "rms",      "Sa",  "Sz",
                                             "skewness",     "kurtosis", "Sal", "Str",
                                             "distribution", "shape",    NULL};
    static const char *const OF_SPECTRUM[] = {"hurst", "rolloff_wavelength", "short_wavelength",
                                              NULL};
    const bool noiseless = strcmp(row->group, NOISELESS) == 0;
    const bool measured = !noiseless && view_lists(SHORT_WAVES, row->name);
    const bool follows = noiseless || view_lists(OF_SPECTRUM, row->name);
    return (measured && map_artefacts_count(artefacts)) ||
           (view_lists(OF_HEIGHTS, row->name) && map_spikes_count(artefacts)) ||
           (follows && map_artefacts_bend(artefacts, has_noise));
}

static bool is_said(const struct table_row *row) {
    return strcmp(row->name, "p_value") == 0 || row->group == GROOVES || row->group == CROSSED ||
           row->group == STRATA;
}

size_t main_values_list(struct main_value out[MAIN_VALUES_MOST], const struct map_figure *figure,
                        const char *plus_minus) {
    const struct list list = {figure->found, figure_units_of(figure), plus_minus};
    const bool has_areal = isfinite(named_number(list.found, "areal", "Sq"));
    const bool has_noise = main_values_have_noise(list.found);
    const bool has_strata = plateau_is_clear(&figure->measured->functional.plateau);
    size_t count = 0;
    for (size_t n = 0; n < ROW_COUNT && count < MAIN_VALUES_MOST; n++) {
        const bool twin = has_areal && strcmp(ROWS[n].label, "RMS height") == 0;
        if (twin || (ROWS[n].group == NOISELESS && !has_noise) ||
            (ROWS[n].group == STRATA && !has_strata) ||
            !write_value(&list, &ROWS[n], out[count].text))
            continue;
        out[count].label = ROWS[n].label;
        out[count].said = is_said(&ROWS[n]);
        out[count].untrusted = is_untrusted(&ROWS[n], &figure->record->artefacts, has_noise);
        figure_unit_text(&list.units, ROWS[n].x_power, ROWS[n].z_power, out[count].unit);
        count++;
    }
    return count;
}
