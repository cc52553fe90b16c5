#include "server/show/map/map_report.h"
#include "core/map/length_unit.h"
#include "server/show/map/functional_report.h"
#include "server/show/map/groove_report.h"
#include <math.h>
#include <string.h>

static const double DEGREE = M_PI / 180;
/* Of heights that a Gaussian law fits at this level, none is looked for with two of them. */
static const double GAUSSIAN_LEVEL = 0.01;

/* --- parameters --- */

/* Adds a value, and its statistical error where that is known. */
static void add_with_error(struct named_values *out, const char *group, const char *const name[2],
                           double value, int power, bool has_error, double error) {
    named_values_add_length(out, group, name[0], value, power);
    if (has_error)
        named_values_add_length(out, group, name[1], error, power);
}
#define NAMED(name) ((const char *const[2]){name, name "_error"})

static void add_grid(struct named_values *out, const struct grid *grid) {
    static const char GROUP[] = "grid";
    named_values_add(out, GROUP, "nx", (double)grid->nx);
    named_values_add(out, GROUP, "ny", (double)grid->ny);
    named_values_add_length(out, GROUP, "dx", grid_dx(grid), 1);
    named_values_add_length(out, GROUP, "dy", grid_is_profile(grid) ? (double)NAN : grid_dy(grid),
                            1);
}

/* errors: NULL where none are known, here and below. */
static void add_heights(struct named_values *out, const struct roughness *roughness,
                        const struct scalar_errors *errors) {
    static const char GROUP[] = "heights";
    static const struct scalar_errors NONE = {0};
    const struct scalar_errors *by = errors != NULL ? errors : &NONE;
    const bool has = errors != NULL;
    named_values_add_length(out, GROUP, "mean", roughness->mean, 1);
    add_with_error(out, GROUP, NAMED("rms"), roughness->rms_height, 1, has, by->sq);
    add_with_error(out, GROUP, NAMED("skewness"), roughness->skewness, 0, has, by->ssk);
    add_with_error(out, GROUP, NAMED("kurtosis"), roughness->kurtosis, 0, has, by->sku);
    named_values_add_length(out, GROUP, "lowest", roughness->lowest, 1);
    named_values_add_length(out, GROUP, "highest", roughness->highest, 1);
}

/* Slopes and curvatures; m0 is NaN where the group has none. Errors are over the values. */
static void add_moments(struct named_values *out, const char *group, const struct moments *moments,
                        const struct scalar_errors *errors) {
    static const struct scalar_errors NONE = {0};
    const struct scalar_errors *by = errors != NULL ? errors : &NONE;
    const struct {
        const char *const name[2];
        double value, relative;
        int power;
    } rows[] = {
        {{"rms_slope", "rms_slope_error"}, moments->rms_slope, by->slope, 0},
        {{"rms_curvature", "rms_curvature_error"}, moments->rms_curvature, by->curvature, -1},
        {{"m0", "m0_error"}, moments->m0, by->m0, 2},
        {{"m2", "m2_error"}, moments->m2, by->m2, 0},
        {{"m4", "m4_error"}, moments->m4, by->m4, -2},
        {{"nayak_alpha", "nayak_alpha_error"}, moments->nayak_alpha, by->alpha, 0}};
    const bool has_m0 = strcmp(group, "finite_difference") != 0;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        if (has_m0 || strcmp(rows[r].name[0], "m0") != 0)
            add_with_error(out, group, rows[r].name, rows[r].value, rows[r].power, errors != NULL,
                           rows[r].relative * rows[r].value);
}

/* dimensions: 2 or 1. */
static void add_summits(struct named_values *out, const char *group, int dimensions,
                        const struct map_summits *summits) {
    const struct summit_errors *errors = &summits->errors;
    const bool has = summits->has_errors;
    named_values_add(out, group, "count", summits->count);
    add_with_error(out, group, NAMED("density"), summits->density, -dimensions, has,
                   errors->density);
    add_with_error(out, group, NAMED("height_mean"), summits->height_mean, 1, has,
                   errors->height_mean);
    add_with_error(out, group, NAMED("height_deviation"), summits->height_deviation, 1, has,
                   errors->height_deviation);
    add_with_error(out, group, NAMED("curvature_mean"), summits->curvature_mean, -1, has,
                   errors->curvature_mean);
}

static void add_parameters(struct named_values *out, const struct map_parameters *parameters,
                           const struct scalar_errors *errors,
                           const struct scalar_errors *moment_errors) {
    static const char *const SUMMITS[] = {"summits_nine_point", "summits_five_point",
                                          "summits_refined"};
    static const char *const PEAKS[] = {"peaks", NULL, "peaks_refined"};
    const struct roughness *roughness = &parameters->roughness;
    const struct moments differences = {.m2 = roughness->m2,
                                        .m4 = roughness->m4,
                                        .nayak_alpha = roughness->nayak_alpha,
                                        .rms_slope = roughness->rms_slope,
                                        .rms_curvature = roughness->rms_curvature};
    const bool profile = grid_is_profile(&parameters->grid);
    const bool open = parameters->boundary == BOUNDARY_OPEN;
    add_grid(out, &parameters->grid);
    add_heights(out, roughness, errors);
    add_moments(out, "finite_difference", &differences, errors);
    add_moments(out, open ? "interpolated" : "spectral", &parameters->moments, moment_errors);
    for (int s = 0; s < MAP_STENCILS; s++)
        if (parameters->summits[s].sought)
            add_summits(out, profile ? PEAKS[s] : SUMMITS[s], profile ? 1 : 2,
                        &parameters->summits[s]);
}

void map_report_parameters(struct named_values *out, const struct map_parameters *parameters) {
    add_parameters(out, parameters, NULL, NULL);
}

static void add_areal(struct named_values *out, const struct map_characterisation *found,
                      const struct scalar_errors *errors) {
    static const struct scalar_errors NONE = {0};
    const struct areal *areal = &found->areal;
    const struct scalar_errors *by = errors != NULL ? errors : &NONE;
    const bool has = errors != NULL, hills = found->hills_have_errors;
    const struct {
        const char *const name[2];
        double value;
        int power;
        bool has_error;
        double error;
    } rows[] = {{{"Sa", "Sa_error"}, areal->sa, 1, has, by->sa},
                {{"Sq", "Sq_error"}, areal->sq, 1, has, by->sq},
                {{"Ssk", "Ssk_error"}, areal->ssk, 0, has, by->ssk},
                {{"Sku", "Sku_error"}, areal->sku, 0, has, by->sku},
                {{"Sp", NULL}, areal->sp, 1, false, 0},
                {{"Sv", NULL}, areal->sv, 1, false, 0},
                {{"Sz", NULL}, areal->sz, 1, false, 0},
                {{"Sdq", "Sdq_error"}, areal->sdq, 0, has, by->slope * areal->sdq},
                {{"Sdr", "Sdr_error"}, areal->sdr, 0, has, by->area * areal->sdr},
                {{"Sal", NULL}, areal->sal, 1, false, 0},
                {{"Str", NULL}, areal->str, 0, false, 0},
                {{"Spd", "Spd_error"}, areal->spd, -2, hills, found->hill_errors.density},
                {{"Spc", "Spc_error"}, areal->spc, -1, hills, found->hill_errors.curvature_mean}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        add_with_error(out, "areal", rows[r].name, rows[r].value, rows[r].power, rows[r].has_error,
                       rows[r].error);
}

/* --- what was done --- */

static void add_decision(struct named_values *out, const struct preparation_record *decision,
                         const struct height_map *map) {
    static const char GROUP[] = "map";
    const struct trend *trend = &decision->trend;
    const bool profile = grid_is_profile(&map->grid), open = decision->boundary == BOUNDARY_OPEN;
    for (size_t step = 0; step < decision->count; step++)
        named_values_add_text(out, "preparation", decision->steps[step].name,
                              decision->steps[step].text);
    if (*map->xy_unit != '\0')
        named_values_add_text(out, GROUP, "unit", map->xy_unit);
    named_values_add_text(out, GROUP, "boundary", open ? "open" : "periodic");
    named_values_add_text(out, GROUP, "boundary_by", decision->boundary_by);
    named_values_add(out, GROUP, "seam_x", decision->seam.x);
    named_values_add(out, GROUP, "seam_y", profile ? (double)NAN : decision->seam.y);
    named_values_add(out, GROUP, "holes", decision->holes);
    named_values_add_text(out, GROUP, "psd_window", open ? "hann" : "none");
    if (decision->window_power < 1)
        named_values_add(out, GROUP, "window_power", decision->window_power);
    named_values_add_text(out, GROUP, "detrend", DETREND_NAMES[decision->detrend]);
    if (decision->detrend != DETREND_NONE)
        named_values_add_length(out, GROUP, "trend_height", trend->height, 1);
    if (decision->detrend >= DETREND_PLANE) {
        named_values_add(out, GROUP, "trend_slope_x", trend->slope_x);
        named_values_add(out, GROUP, "trend_slope_y", trend->slope_y);
    }
    if (decision->detrend == DETREND_QUADRATIC) {
        named_values_add_length(out, GROUP, "trend_bend_xx", trend->bend_xx, -1);
        named_values_add_length(out, GROUP, "trend_bend_xy", trend->bend_xy, -1);
        named_values_add_length(out, GROUP, "trend_bend_yy", trend->bend_yy, -1);
    }
}

/* --- statistical errors --- */

static void add_certainty(struct named_values *out, const struct map_certainty *certainty) {
    static const char GROUP[] = "uncertainty";
    named_values_add_text(out, GROUP, "errors", certainty->reason);
    named_values_add(out, GROUP, "lengths_inside", certainty->lengths);
    named_values_add(out, GROUP, "lengths_needed", LENGTHS_INSIDE_LEAST);
    named_values_add(out, GROUP, "freedom", certainty->freedom);
    named_values_add(out, GROUP, "factor_95", certainty->factor);
}

/* Names of a family's values, by enum heights_type; the shape is NULL without one. */
#define FAMILY(type, name, value)                                                                  \
    {name, name "_shape", name "_shape_low", name "_shape_high", name "_p_value", name "_distance"},
static const struct family_names {
    const char *name, *shape, *low, *high, *p_value, *distance;
} FAMILIES[HEIGHTS_QUANTILE] = {RUGO_DISTRIBUTIONS(FAMILY)};

static void add_height_fit(struct named_values *out, const struct height_fits *fits) {
    static const char GROUP[] = "height_fit";
    const struct height_fit *best = &fits->list[fits->best];
    if (isnan(best->distance))
        return;
    named_values_add_text(out, GROUP, "distribution", FAMILIES[fits->best].name);
    named_values_add(out, GROUP, "shape", best->shape);
    named_values_add(out, GROUP, "shape_low", best->shape_low);
    named_values_add(out, GROUP, "shape_high", best->shape_high);
    named_values_add(out, GROUP, "p_value", best->p_value);
    named_values_add(out, GROUP, "distance", best->distance);
    named_values_add(out, GROUP, "independent", fits->independent);
    for (size_t n = 0; n < HEIGHTS_QUANTILE; n++) {
        const struct height_fit *fit = &fits->list[n];
        if (!isnan(fit->shape)) {
            named_values_add(out, GROUP, FAMILIES[n].shape, fit->shape);
            named_values_add(out, GROUP, FAMILIES[n].low, fit->shape_low);
            named_values_add(out, GROUP, FAMILIES[n].high, fit->shape_high);
        }
        named_values_add(out, GROUP, FAMILIES[n].p_value, fit->p_value);
        named_values_add(out, GROUP, FAMILIES[n].distance, fit->distance);
    }
}

static void add_isotropy(struct named_values *out, const struct map_directions *directions) {
    static const char GROUP[] = "isotropy";
    const struct isotropy *fine = &directions->fine, *coarse = &directions->coarse;
    named_values_add(out, GROUP, "p_value", directions->p_value);
    named_values_add(out, GROUP, "Std", directions->texture / DEGREE);
    named_values_add(out, GROUP, "slope_ratio", fine->ratio);
    named_values_add(out, GROUP, "slope_ratio_error", fine->ratio_error);
    named_values_add(out, GROUP, "slope_direction", fine->direction / DEGREE);
    named_values_add(out, GROUP, "slope_direction_error", fine->direction_error / DEGREE);
    named_values_add(out, GROUP, "slope_p_value", fine->p_value);
    named_values_add_length(out, GROUP, "coarse_length", coarse->length, 1);
    named_values_add(out, GROUP, "coarse_ratio", coarse->ratio);
    named_values_add(out, GROUP, "coarse_ratio_error", coarse->ratio_error);
    named_values_add(out, GROUP, "coarse_direction", coarse->direction / DEGREE);
    named_values_add(out, GROUP, "coarse_direction_error", coarse->direction_error / DEGREE);
    named_values_add(out, GROUP, "coarse_p_value", coarse->p_value);
}

static void add_spreads(struct named_values *out, const char *group, double areas,
                        const struct spread *spread, double p_value) {
    static const char *const NAMES[STATIONARY_PARAMETERS][3] = {
        {"mean_spread", "mean_expected", "mean_p_value"},
        {"rms_spread", "rms_expected", "rms_p_value"},
        {"skewness_spread", "skewness_expected", "skewness_p_value"},
        {"slope_spread", "slope_expected", "slope_p_value"}};
    named_values_add(out, group, "areas", areas);
    named_values_add(out, group, "p_value", p_value);
    for (int q = 0; q < STATIONARY_PARAMETERS; q++) {
        named_values_add(out, group, NAMES[q][0], spread[q].found);
        named_values_add(out, group, NAMES[q][1], spread[q].expected);
        named_values_add(out, group, NAMES[q][2], spread[q].p_value);
    }
}

static void add_stationarity(struct named_values *out, const struct map_characterisation *found) {
    static const char *const GROUPS[STATIONARY_DIVISIONS] = {"stationarity_coarse",
                                                             "stationarity_fine"};
    static const double AREAS[STATIONARY_DIVISIONS] = {4, 16};
    const struct stationarity *s = &found->stationarity;
    named_values_add(out, "stationarity", "p_value", found->stationarity_p_value);
    for (size_t d = 0; d < STATIONARY_DIVISIONS && found->certainty.has_errors; d++)
        add_spreads(out, GROUPS[d], AREAS[d], s->spread[d], s->p_value[d]);
}

static void add_form(struct named_values *out, const struct map_form *form) {
    named_values_add_length(out, "form", "rms_height", form->height, 1);
    named_values_add_length(out, "form", "expected", form->expected, 1);
    named_values_add(out, "form", "share", form->share);
    named_values_add(out, "form", "p_value", form->p_value);
}

/* What the map has without noise, and without what an instrument does not transmit: of the law from
 * the longest to the shortest wavelength that is trusted. */
static void add_trusted(struct named_values *out, const struct spectrum_fit *fit,
                        const struct map_parameters *parameters) {
    static const char GROUP[] = "trusted";
    const struct {
        const char *name, *low, *high;
        const struct interval *interval;
        int power;
    } rows[] = {
        {"rms_height", "rms_height_low", "rms_height_high", &fit->rms_height, 1},
        {"rms_slope", "rms_slope_low", "rms_slope_high", &fit->rms_slope, 0},
        {"rms_curvature", "rms_curvature_low", "rms_curvature_high", &fit->rms_curvature, -1},
        {"nayak_alpha", "nayak_alpha_low", "nayak_alpha_high", &fit->nayak_alpha, 0},
        {fit->profile ? "peak_density" : "summit_density",
         fit->profile ? "peak_density_low" : "summit_density_low",
         fit->profile ? "peak_density_high" : "summit_density_high", &fit->summit_density,
         fit->profile ? -1 : -2},
    };
    named_values_add_length(out, GROUP, "from", fit->longest, 1);
    named_values_add_length(out, GROUP, "to", fit->shortest, 1);
    named_values_add(
        out, GROUP, "noise_share",
        spectrum_fit_noise_share(fit, &parameters->grid, parameters->roughness.rms_curvature));
    for (size_t n = 0; n < sizeof rows / sizeof *rows; n++) {
        if (isnan(rows[n].interval->value))
            continue;
        named_values_add_length(out, GROUP, rows[n].name, rows[n].interval->value, rows[n].power);
        named_values_add_length(out, GROUP, rows[n].low, rows[n].interval->low, rows[n].power);
        named_values_add_length(out, GROUP, rows[n].high, rows[n].interval->high, rows[n].power);
    }
}

static void add_fit(struct named_values *out, const char *group, const struct spectrum_fit *fit) {
    const int power = fit->profile ? 3 : 4;
    const struct {
        const char *name, *low, *high;
        const struct interval *interval;
        int power;
    } rows[] = {
        {"hurst", "hurst_low", "hurst_high", &fit->hurst, 0},
        {"rolloff_wavelength", "rolloff_wavelength_low", "rolloff_wavelength_high",
         &fit->rolloff_wavelength, 1},
        {"short_wavelength", "short_wavelength_low", "short_wavelength_high",
         &fit->short_wavelength, 1},
        {"long_wavelength", "long_wavelength_low", "long_wavelength_high", &fit->long_wavelength,
         1},
        {"amplitude", "amplitude_low", "amplitude_high", &fit->amplitude, power},
        {"rms_height", "rms_height_low", "rms_height_high", &fit->rms_height, 1},
        {"rms_slope", "rms_slope_low", "rms_slope_high", &fit->rms_slope, 0},
    };
    named_values_add_length(out, group, "trusted_from", fit->trusted_from, 1);
    named_values_add_text(out, group, "trusted_from_by", SPECTRUM_END_NAMES[fit->from_end]);
    named_values_add_length(out, group, "trusted_to", fit->trusted_to, 1);
    named_values_add_text(out, group, "trusted_to_by", SPECTRUM_END_NAMES[fit->to_end]);
    named_values_add_length(out, group, "noise", fit->noise, power);
    for (size_t n = 0; n < sizeof rows / sizeof *rows && fit->fitted; n++) {
        named_values_add_length(out, group, rows[n].name, rows[n].interval->value, rows[n].power);
        named_values_add_length(out, group, rows[n].low, rows[n].interval->low, rows[n].power);
        named_values_add_length(out, group, rows[n].high, rows[n].interval->high, rows[n].power);
    }
    if (!fit->fitted)
        return;
    named_values_add_length(out, group, "amplitude_at", fit->reference_wavelength, 1);
    named_values_add(out, group, "deviance", fit->deviance);
    named_values_add(out, group, "deviance_limit", fit->deviance_limit);
    named_values_add(out, group, "freedom", fit->freedom);
    if (fit->lay_ratio.value == 1)
        return;
    named_values_add(out, group, "lay_ratio", fit->lay_ratio.value);
    named_values_add(out, group, "lay_ratio_low", fit->lay_ratio.low);
    named_values_add(out, group, "lay_ratio_high", fit->lay_ratio.high);
    named_values_add(out, group, "lay_angle", fit->lay_angle.value / DEGREE);
    named_values_add(out, group, "lay_angle_low", fit->lay_angle.low / DEGREE);
    named_values_add(out, group, "lay_angle_high", fit->lay_angle.high / DEGREE);
}

/* --- columns --- */

/* Numbers that lie `stride` bytes apart, and what they are divided by. */
struct numbers {
    const char *name;
    const double *first; /* NULL: there is no such column */
    int power;
    double unit;
};

static int add_columns(struct named_values *out, const char *group, size_t count, size_t stride,
                       size_t columns, const struct numbers *numbers, struct error *err) {
    for (size_t c = 0; c < columns; c++) {
        const char *at = (const char *)numbers[c].first;
        if (at == NULL)
            continue;
        double *values =
            named_values_column_length(out, group, numbers[c].name, count, numbers[c].power);
        if (values == NULL)
            return error_memory(err, count * sizeof *values, "a table of a map");
        for (size_t n = 0; n < count; n++)
            values[n] = *(const double *)(at + n * stride) / numbers[c].unit;
    }
    return 0;
}
#define COLUMNS(list) sizeof(list) / sizeof *(list), (list)

static int add_angular(struct named_values *out, const struct angular_spectrum *angular,
                       struct error *err) {
    const struct numbers list[] = {{"angle", angular->angle, 0, DEGREE},
                                   {"height", angular->power[ANGULAR_HEIGHTS], 0, 1},
                                   {"height_error", angular->error[ANGULAR_HEIGHTS], 0, 1},
                                   {"slope", angular->power[ANGULAR_SLOPES], 0, 1},
                                   {"slope_error", angular->error[ANGULAR_SLOPES], 0, 1}};
    return add_columns(out, "angular_spectrum", ANGULAR_SECTORS, sizeof(double), COLUMNS(list),
                       err);
}

static int add_scales(struct named_values *out, const struct map_scales *scales, bool profile,
                      struct error *err) {
    const struct map_scale *first = &scales->scale[0];
    const struct isotropy *isotropy = &first->isotropy;
    const struct numbers list[] = {{"length", &first->found.length, 1, 1},
                                   {"rms_height", &first->found.height, 1, 1},
                                   {"rms_height_error", &first->height_error, 1, 1},
                                   {"rms_slope", &first->found.slope, 0, 1},
                                   {"rms_slope_error", &first->slope_error, 0, 1},
                                   {"rms_curvature", &first->found.curvature, -1, 1},
                                   {"rms_curvature_error", &first->curvature_error, -1, 1}};
    const struct numbers directions[] = {{"length", &first->found.length, 1, 1},
                                         {"ratio", &isotropy->ratio, 0, 1},
                                         {"ratio_error", &isotropy->ratio_error, 0, 1},
                                         {"direction", &isotropy->direction, 0, DEGREE},
                                         {"direction_error", &isotropy->direction_error, 0, DEGREE},
                                         {"p_value", &isotropy->p_value, 0, 1}};
    int status = add_columns(out, "scales", scales->count, sizeof *first, COLUMNS(list), err);
    return status == 0 && !profile ? add_columns(out, "isotropy_by_scale", scales->count,
                                                 sizeof *first, COLUMNS(directions), err)
                                   : status;
}

static int add_density(struct named_values *out, const char *group, int power,
                       const struct map_density *density, struct error *err) {
    const struct numbers list[] = {{"wave_number", density->wave_number, -1, 1},
                                   {"density", density->density, power, 1},
                                   {"density_low", density->low, power, 1},
                                   {"density_high", density->high, power, 1},
                                   {"density_fitted", density->law, power, 1}};
    return density->count > 0
               ? add_columns(out, group, density->count, sizeof(double), COLUMNS(list), err)
               : 0;
}

static int add_spectra(struct named_values *out, const struct map_spectra *spectra, bool profile,
                       struct error *err) {
    int status = add_density(out, "psd", profile ? 3 : 4, &spectra->rings, err);
    if (status == 0)
        status = add_density(out, "psd_x", 3, &spectra->line[0], err);
    return status == 0 ? add_density(out, "psd_y", 3, &spectra->line[1], err) : status;
}

static int add_tables(struct named_values *out, const struct map_characterisation *found,
                      struct error *err) {
    const bool profile = grid_is_profile(&found->parameters.grid);
    const struct map_curve *acf = &found->correlation, *heights = &found->quantiles;
    const struct numbers lags[] = {{"lag", acf->x, 1, 1}, {"correlation", acf->y, 0, 1}};
    const struct numbers quantiles[] = {{"probability", heights->x, 0, 1},
                                        {"quantile", heights->y, 1, 1}};
    int status = profile ? 0 : add_angular(out, &found->directions.angular, err);
    if (status == 0)
        status = groove_report_tables(out, found, err);
    if (status == 0)
        status = add_scales(out, &found->scales, profile, err);
    if (status == 0)
        status = add_spectra(out, &found->spectra, profile, err);
    if (status == 0)
        status = add_columns(out, "acf", acf->count, sizeof(double), COLUMNS(lags), err);
    if (status == 0)
        status = functional_report_table(out, &found->functional, err);
    return status == 0 ? add_columns(out, "quantiles", heights->count, sizeof(double),
                                     COLUMNS(quantiles), err)
                       : status;
}

/* What the instrument left, and RMS slopes without it. */
static void add_artefacts(struct named_values *out, const struct map_artefacts *artefacts,
                          const struct map_characterisation *found, bool profile) {
    static const char GROUP[] = "artefacts";
    const struct roughness *roughness = &found->parameters.roughness;
    const bool has_noise = found->spectra.has_fit && found->spectra.fit.fitted &&
                           spectrum_fit_noise_share(&found->spectra.fit, &found->parameters.grid,
                                                    roughness->rms_curvature) > NOISE_SHARE_MOST;
    const struct repeated_lines *columns = artefacts->columns;
    const struct map_spikes *spikes = &artefacts->spikes;
    const struct line_offsets *lines = &artefacts->lines;
    const bool spiky = map_spikes_found(artefacts);
    const double none = (double)NAN;
    named_values_add_length(out, GROUP, "step",
                            artefacts->steps.step > 0 ? artefacts->steps.step : none, 1);
    named_values_add(out, GROUP, "step_curvature_share", artefacts->steps.curvature);
    named_values_add(out, GROUP, "spikes", spiky ? (double)spikes->count : 0);
    named_values_add(out, GROUP, "spike_deviations", spiky ? spikes->largest : none);
    named_values_add(out, GROUP, "spike_curvature_share", spiky ? spikes->curvature : 0);
    if (!profile) {
        named_values_add_text(out, GROUP, "lines_along",
                              artefacts->lines_along == SCAN_ALONG_X ? "x" : "y");
        named_values_add(out, GROUP, "line_p_value", lines->p_value);
        named_values_add_length(out, GROUP, "line_offset", lines->found ? lines->rms : none, 1);
        named_values_add(out, GROUP, "line_curvature_share", lines->curvature);
    }
    named_values_add(out, GROUP, profile ? "points_repeated" : "columns_repeated",
                     (double)columns[0].copies);
    named_values_add(out, GROUP, profile ? "points_between" : "columns_between",
                     (double)columns[0].between);
    if (!profile) {
        named_values_add(out, GROUP, "rows_repeated", (double)columns[1].copies);
        named_values_add(out, GROUP, "rows_between", (double)columns[1].between);
    }
    named_values_add(out, GROUP, "slope_without",
                     map_artefacts_count(artefacts) && map_artefacts_slope(artefacts) < 1
                         ? map_artefacts_slope(artefacts) * roughness->rms_slope
                         : none);
    named_values_add(out, GROUP, "slopes_trusted", map_artefacts_count(artefacts) ? 0 : 1);
    named_values_add(out, GROUP, "spectrum_trusted",
                     map_artefacts_bend(artefacts, has_noise) ? 0 : 1);
}

int map_report_fill(struct named_values *out, const struct map_characterisation *found,
                    const struct height_map *map, const struct preparation_record *record,
                    struct error *err) {
    const bool profile = grid_is_profile(&map->grid);
    const bool has = found->certainty.has_errors;
    const struct scalar_errors *errors = has ? &found->errors : NULL;
    out->in_metres = length_unit_is_metre(map->xy_unit) && length_unit_is_metre(map->z_unit);
    add_decision(out, record, map);
    add_parameters(out, &found->parameters, errors, has ? &found->moment_errors : NULL);
    if (!profile)
        add_areal(out, found, errors);
    functional_report_values(out, &found->functional, profile);
    if (isfinite(found->functional.plateau.ratio) &&
        !(found->height_fits.list[HEIGHTS_GAUSSIAN].p_value >= GAUSSIAN_LEVEL))
        functional_report_plateau(out, &found->functional, profile);
    add_certainty(out, &found->certainty);
    add_height_fit(out, &found->height_fits);
    if (!profile)
        add_isotropy(out, &found->directions);
    add_stationarity(out, found);
    if (isfinite(found->form.p_value))
        add_form(out, &found->form);
    groove_report_values(out, found);
    if (found->spectra.has_fit)
        add_fit(out, "spectrum_fit", &found->spectra.fit);
    if (found->spectra.has_scores) {
        named_values_add_length(out, "spectrum_fit_scores", "sharp_end", found->spectra.scores_end,
                                1);
        add_fit(out, "spectrum_fit_scores", &found->spectra.scores);
    }
    if (found->spectra.has_fit && found->spectra.fit.fitted)
        add_trusted(out, &found->spectra.fit, &found->parameters);
    if (record->artefacts.sought)
        add_artefacts(out, &record->artefacts, found, profile);
    return add_tables(out, found, err);
}
