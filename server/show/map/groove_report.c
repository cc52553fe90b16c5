#include "server/show/map/groove_report.h"
#include <math.h>

static const double DEGREE = M_PI / 180;
static const char *const GROUPS[MAP_GROOVES_MOST] = {"grooves", "crossed_grooves"};
static const char *const TABLES[MAP_GROOVES_MOST] = {"grooves_harmonics",
                                                     "crossed_grooves_harmonics"};

/* Returns the radius of the tip that left arcs: f^2/(8 depth), with the feed f. */
static double tip_radius(const struct map_groove *groove) {
    return groove->fit.shape == GROOVE_ARCS && groove->fit.depth > 0
               ? groove->period * groove->period / (8 * groove->fit.depth)
               : (double)NAN;
}

static void add_family(struct named_values *out, const char *group, const struct map_groove *groove,
                       double rms_height) {
    named_values_add_length(out, group, "period", groove->period, 1);
    named_values_add_length(out, group, "period_error", groove->period_error, 1);
    named_values_add(out, group, "angle", groove->angle / DEGREE);
    named_values_add(out, group, "angle_error", groove->angle_error / DEGREE);
    named_values_add_length(out, group, "depth", groove->fit.depth, 1);
    named_values_add_length(out, group, "depth_error", groove->fit.depth_error, 1);
    named_values_add_text(out, group, "shape", GROOVE_SHAPE_NAMES[groove->fit.shape]);
    named_values_add(out, group, "shape_p_value", groove->fit.p_value);
    named_values_add_length(out, group, "tip_radius", tip_radius(groove), 1);
    named_values_add(out, group, "periods", groove->periods);
    named_values_add(out, group, "share", groove->mean_square / (rms_height * rms_height));
    named_values_add(out, group, "p_value", groove->p_value);
}

void groove_report_values(struct named_values *out, const struct map_characterisation *found) {
    const struct map_grooves *grooves = &found->grooves;
    for (size_t f = 0; f < grooves->families && f < MAP_GROOVES_MOST; f++)
        add_family(out, GROUPS[f], &grooves->family[f], found->parameters.roughness.rms_height);
    if (grooves->families > 0 && grooves->families <= MAP_GROOVES_MOST)
        named_values_add_length(out, GROUPS[grooves->families - 1], "rms_height_without",
                                found->rest_height, 1);
}

int groove_report_tables(struct named_values *out, const struct map_characterisation *found,
                         struct error *err) {
    const struct map_grooves *grooves = &found->grooves;
    for (size_t f = 0; f < grooves->families && f < MAP_GROOVES_MOST; f++) {
        const struct groove_lines *lines = &grooves->family[f].lines;
        double *amplitude =
            named_values_column_length(out, TABLES[f], "amplitude", lines->count, 1);
        double *error =
            named_values_column_length(out, TABLES[f], "amplitude_error", lines->count, 1);
        double *phase = named_values_column_length(out, TABLES[f], "phase", lines->count, 0);
        if (amplitude == NULL || error == NULL || phase == NULL)
            return error_memory(err, 3 * lines->count * sizeof *phase, "harmonics of grooves");
        for (size_t h = 0; h < lines->count; h++) {
            amplitude[h] = 2 * cabs(lines->coefficient[h]);
            error[h] = sqrt(2 * lines->variance[h]);
            phase[h] = carg(lines->coefficient[h]) / DEGREE;
        }
    }
    return 0;
}

/* Writes a value with its standard error, which has two digits. */
static void put(char *out, size_t size, double value, double error) {
    const double digits = error > 0 ? fmin(fmax(1 - floor(log10(error)), 0), 9) : 4;
    snprintf(out, size, "%.*f +- %.*f", (int)digits, value, (int)digits, error);
}

void groove_sentence(const struct map_groove *groove, const struct groove_units *units, char *out,
                     size_t size) {
    static const double LEAST = 1e-20;
    char period[60], angle[60], depth[60], shape[80], p_value[40];
    put(period, sizeof period, groove->period / units->x, groove->period_error / units->x);
    put(angle, sizeof angle, groove->angle / DEGREE, groove->angle_error / DEGREE);
    put(depth, sizeof depth, groove->fit.depth / units->z, groove->fit.depth_error / units->z);
    if (groove->fit.shape == GROOVE_ARCS)
        snprintf(shape, sizeof shape, "arcs of radius %.3g%s%s", tip_radius(groove) / units->x,
                 *units->x_name != '\0' ? " " : "", units->x_name);
    else if (groove->fit.shape == GROOVE_HARMONICS)
        snprintf(shape, sizeof shape, "a shape of %zu harmonics", groove->fit.standing);
    else
        snprintf(shape, sizeof shape, "a %s", GROOVE_SHAPE_NAMES[groove->fit.shape]);
    snprintf(p_value, sizeof p_value, groove->p_value < LEAST ? "below %.0e" : "%.2g",
             fmax(groove->p_value, LEAST));
    snprintf(out, size, "every %s%s%s%s%s%s, %s%s%s deep, %s (p-value %s)", period,
             *units->x_name != '\0' ? " " : "", units->x_name,
             isfinite(groove->angle) ? ", at " : "", isfinite(groove->angle) ? angle : "",
             isfinite(groove->angle) ? " degrees from x" : "", depth,
             *units->z_name != '\0' ? " " : "", units->z_name, shape, p_value);
}
