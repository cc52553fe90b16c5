#include "jobs/statistics/statistics_expectation.h"
#include "core/theory/sampled_field.h"
#include "jobs/statistics/statistics_grid_theory.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_theory.h"
#include "jobs/units.h"
#include "schema/json/field.h"
#include "schema/result/result_json.h"
#include <math.h>
#include <stdlib.h>

/* What expectations of a case are made from. */
struct expectation {
    struct statistics_case one_case; /* owned */
    struct modes *modes;             /* owned */
    struct surface_basis basis;
    struct case_result *result;   /* borrowed: its arena owns all arrays */
    double *nothing;              /* standard errors: NaN, of the longest curve */
    double *heights, *edges, *t1; /* centres of bins of heights, their upper edges, centres of t1 */
};

static int no_room(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for theories");
}

static int add_curve(struct expectation *e, struct curve curve, const char *series, size_t n,
                     const double *x, const double *y, struct error *err) {
    curve.series = series;
    curve_set_points(&curve, n, x, y, e->nothing);
    return result_add_curve(e->result, &curve, err);
}

/* --- curves of heights and summits --- */

static struct curve named(const char *quantity, const char *y_label) {
    return curve_named(quantity, "z/sqrt(m0)", y_label);
}

static int add_heights(struct expectation *e, struct error *err) {
    const struct statistics_case *one_case = &e->one_case;
    size_t n = one_case->height.count;
    double *pdf = result_numbers(e->result, 2 * n), *cdf = pdf + n;
    if (pdf == NULL)
        return no_room(err);
    int status = statistics_theory_heights(one_case, pdf, cdf, err);
    if (status == 0)
        status = add_curve(e, named("height_pdf", "probability density"),
                           one_case->surface.heights_name, n, e->heights, pdf, err);
    if (status == 0)
        status = add_curve(e, named("height_cdf", "cumulative probability"),
                           one_case->surface.heights_name, n, e->edges, cdf, err);
    return status;
}

/* Theories of summits over bins; the arena owns the arrays. */
struct summit_curves {
    double *pdf, *cdf, *curvature, *t1_pdf, *joint; /* of curvatures: NULL without */
};

static int summit_curves_create(struct expectation *e, bool joint, struct summit_curves *out,
                                struct error *err) {
    size_t n = e->one_case.height.count, columns = e->one_case.equivalent.count;
    double *room = result_numbers(e->result, 3 * n + columns + (joint ? n * columns : 0));
    if (room == NULL)
        return no_room(err);
    *out = (struct summit_curves){room, room + n, room + 2 * n, room + 3 * n,
                                  joint ? room + 3 * n + columns : NULL};
    return 0;
}

static const char *t1_label(const struct expectation *e) {
    return e->one_case.surface.dimension == 2 ? "-sqrt(3/m4) kappa_m" : "z''/sqrt(m4)";
}

static int add_joint(struct expectation *e, const char *series, const double *joint,
                     struct error *err) {
    size_t n = e->one_case.height.count, columns = e->one_case.equivalent.count;
    struct curve curve = named("summit_joint_pdf", "probability density");
    uint32_t *cells = result_room(e->result, n * columns, sizeof *cells);
    if (cells == NULL)
        return no_room(err);
    for (size_t cell = 0; cell < n * columns; cell++)
        cells[cell] = (uint32_t)cell;
    curve.columns = columns;
    curve.x2 = e->t1;
    curve.x2_label = t1_label(e);
    curve.cells = cells;
    curve.cell_count = n * columns;
    curve.empty_standard_error = NAN;
    return add_curve(e, curve, series, n, e->heights, joint, err);
}

static int add_summit_curves(struct expectation *e, const char *series,
                             const struct summit_curves *curves, struct error *err) {
    bool surface = e->one_case.surface.dimension == 2;
    size_t n = e->one_case.height.count;
    int status = add_curve(e, named("summit_height_pdf", "probability density"), series, n,
                           e->heights, curves->pdf, err);
    if (status == 0)
        status = add_curve(e, named("summit_height_cdf", "cumulative probability"), series, n,
                           e->edges, curves->cdf, err);
    if (status == 0 && curves->curvature != NULL)
        status = add_curve(
            e, named("summit_mean_curvature", surface ? "kappa_m/sqrt(m4)" : "-z''/sqrt(m4)"),
            series, n, e->heights, curves->curvature, err);
    if (status == 0 && curves->t1_pdf != NULL)
        status =
            add_curve(e, curve_named("summit_curvature_pdf", t1_label(e), "probability density"),
                      series, e->one_case.equivalent.count, e->t1, curves->t1_pdf, err);
    if (status == 0 && curves->joint != NULL)
        status = add_joint(e, series, curves->joint, err);
    return status;
}

/* --- scalars --- */

static int add_scalar(struct expectation *e, const char *name, double value, double grid,
                      struct error *err) {
    struct scalar scalar = scalar_named(name, value, NAN, NAN);
    scalar.grid = grid;
    return isnan(value) && isnan(grid) ? 0 : result_add_scalar(e->result, &scalar, err);
}

struct expected_scalar {
    const char *name;
    double value, grid;
};

static int add_scalars(struct expectation *e, size_t n, const struct expected_scalar *list,
                       struct error *err) {
    int status = 0;
    for (size_t a = 0; a < n && status == 0; a++)
        status = add_scalar(e, list[a].name, list[a].value, list[a].grid, err);
    return status;
}

/* Alphas of a translated surface beside its own: of its Gaussian field, and of the spectrum that is
 * asked for. */
static int add_alphas(struct expectation *e, struct error *err) {
    struct spectrum spectrum = e->one_case.surface.spectrum;
    struct moments asked, gaussian;
    if (!surface_case_translated(&e->one_case.surface))
        return 0;
    spectrum.translation = NULL;
    int status = spectrum_moments(&spectrum, &e->one_case.surface.grid, &asked, err);
    if (status != 0)
        return status;
    modes_gaussian_moments(e->modes, &gaussian);
    const struct expected_scalar list[] = {{"nayak_alpha_gaussian", gaussian.nayak_alpha, NAN},
                                           {"nayak_alpha_asked", asked.nayak_alpha, NAN}};
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

static double continuous_alpha(const struct surface_case *surface) {
    const struct spectrum *spectrum = &surface->spectrum;
    if (spectrum->type != SPECTRUM_SELF_AFFINE || spectrum->anisotropy > 1)
        return NAN;
    return spectrum_alpha_continuous(surface->dimension, spectrum->hurst, surface->wavelength_ratio,
                                     spectrum->wavelength_long / spectrum->wavelength_rolloff);
}

/* What is known of a stratified face (F18.60): heights and slopes, and where its plateau lies. */
static int add_stratified(struct expectation *e, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    const struct moments *m = &e->basis.moments;
    const struct stratified_heights law = surface_case_stratified(surface);
    const struct height_moments heights = stratified_moments(&law);
    const struct expected_scalar list[] = {
        {"m0", m->m0, NAN},
        {"m2", m->m2, NAN},
        {"rms_height", m->rms_height, NAN},
        {"rms_slope", m->rms_slope, NAN},
        {"skewness", heights.skewness, NAN},
        {"kurtosis", heights.kurtosis, NAN},
        {"plateau_share", 1 - law.valley_share, NAN},
    };
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

/* What is known of the sum of a random part and grooves: its heights and slopes, as beside results;
 * none of it on the grid. */
static int add_grooved(struct expectation *e, struct error *err) {
    static const enum statistics_scalar KNOWN[] = {SCALAR_M0, SCALAR_RMS_HEIGHT, SCALAR_RMS_SLOPE,
                                                   SCALAR_SKEWNESS, SCALAR_KURTOSIS};
    const struct surface_case *surface = &e->one_case.surface;
    double theory[SCALAR_COUNT];
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        theory[a] = NAN;
    statistics_scalars_with_grooves(&e->one_case, &e->basis.moments, theory);
    int status = add_scalar(
        e, "hurst", surface->hurst_solved ? surface->spectrum.hurst : (double)NAN, NAN, err);
    if (status == 0)
        status = add_scalar(e, "wavelength_ratio", surface->wavelength_ratio, NAN, err);
    for (size_t a = 0; a < sizeof KNOWN / sizeof *KNOWN && status == 0; a++)
        status = add_scalar(e, statistics_scalar_name(KNOWN[a]), theory[KNOWN[a]], NAN, err);
    return status;
}

static int add_moments(struct expectation *e, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    const struct moments *m = &e->basis.moments;
    struct sampled_moments grid = {NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    struct height_moments heights;
    int status = heights_moments(&surface->options.heights, &heights, err);
    if (status != 0)
        return status;
    if (statistics_grid_theory_moments(&e->one_case))
        sampled_moments(e->modes, &grid);
    bool few_waves = surface->options.heights.type == HEIGHTS_GAUSSIAN &&
                     surface->options.amplitudes == AMPLITUDES_FIXED;
    const struct expected_scalar list[] = {
        {"hurst", surface->hurst_solved ? surface->spectrum.hurst : (double)NAN, NAN},
        {"wavelength_ratio", surface->wavelength_ratio, NAN},
        {"nayak_alpha", m->nayak_alpha, grid.nayak_alpha},
        {"nayak_alpha_continuous", continuous_alpha(surface), NAN},
        {"m0", m->m0, NAN},
        {"m2", m->m2, grid.m2},
        {"m4", m->m4, grid.m4},
        {"isotropy", surface->dimension == 2 ? 3 * m->m22 / m->m4 : (double)NAN, grid.isotropy},
        {"spectrum_clipped",
         surface->spectrum.type == SPECTRUM_EXPONENTIAL_ACF ? e->modes->clipped : (double)NAN, NAN},
        {"rms_height", m->rms_height, NAN},
        {"rms_slope", m->rms_slope, grid.rms_slope},
        {"rms_curvature", m->rms_curvature, grid.rms_curvature},
        {"skewness", heights.skewness, NAN},
        {"kurtosis", heights.kurtosis, few_waves ? grid.kurtosis : (double)NAN},
    };
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

/* --- quantities by the names of the reference (FORMULAS.md, section 19) --- */

/* Returns the density C0 of a self-affine spectrum on its plateau, or at its roll-off where it has
 * none, by the power of one of its waves. */
static double plateau(const struct spectrum *spectrum, const struct modes *modes) {
    const struct grid *grid = &modes->grid;
    bool profile = grid_is_profile(grid);
    double unit_x = 2 * M_PI / grid->lx, unit_y = profile ? 1 : 2 * M_PI / grid->ly;
    double rolloff = 2 * M_PI / spectrum->wavelength_rolloff;
    double exponent = profile ? 1 + 2 * spectrum->hurst : 2 * (spectrum->hurst + 1);
    for (size_t mx = 1; mx <= modes->mode_x; mx++)
        if (modes_power(modes, mx, 0) > 0 && 2 * mx < grid->nx)
            return modes_power(modes, mx, 0) / (unit_x * unit_y) *
                   pow(fmax(1, unit_x * (double)mx / rolloff), exponent);
    return NAN;
}

/* Returns the scale G of profiles or g of surfaces of (2.49), of which there is none at H = 1. */
static double fractal_scale(const struct spectrum *spectrum, int dimension, double density) {
    double hurst = spectrum->hurst, rolloff = 2 * M_PI / spectrum->wavelength_rolloff;
    double factor = dimension == 1 ? 2 * M_PI : 4 * M_PI * M_PI; /* of Phi over C */
    double exponent = dimension == 1 ? 1 + 2 * hurst : 2 * (hurst + 1);
    if (hurst == 1)
        return NAN;
    return pow(factor * density * pow(rolloff, exponent), 1 / (2 * (1 - hurst)));
}

static int add_fractal(struct expectation *e, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    const struct spectrum *spectrum = &surface->spectrum;
    if (spectrum->type != SPECTRUM_SELF_AFFINE || spectrum->anisotropy > 1 ||
        surface_case_translated(surface))
        return 0;
    double density = plateau(spectrum, e->modes);
    const struct expected_scalar list[] = {
        {"fractal_dimension", surface->dimension + 1 - spectrum->hurst, NAN},
        {"psd_plateau", density, NAN},
        {"fractal_scale", fractal_scale(spectrum, surface->dimension, density), NAN}};
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

/* Returns the lag at which the autocorrelation first falls to a level; NaN where it does not. */
static double lag_at(const struct curve *acf, double level) {
    for (size_t a = 1; acf != NULL && a < acf->n; a++) {
        double before = acf->y[a - 1], here = acf->y[a];
        if (before > level && here <= level)
            return acf->x[a - 1] + (acf->x[a] - acf->x[a - 1]) * (before - level) / (before - here);
    }
    return NAN;
}

/* Adds correlation lengths: at 0.2, as ISO 25178-2 has it, and at 1/e. */
static int add_lengths(struct expectation *e, struct error *err) {
    const struct curve *acf = result_curve(e->result, "acf");
    const struct expected_scalar list[] = {{"correlation_length", lag_at(acf, 0.2), NAN},
                                           {"correlation_length_e", lag_at(acf, exp(-1)), NAN}};
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

static int add_summit_scalars(struct expectation *e, bool pits,
                              const struct summit_expectation *value,
                              const struct sampled_summits *grid, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    double ratio = surface->wavelength_ratio, long_waves = ratio;
    size_t side = pits ? SIDE_SCALARS : 0;
    if (surface->dimension == 2)
        long_waves *= ratio;
    const struct {
        size_t scalar;
        double value, grid;
    } list[] = {
        {SCALAR_SUMMIT_DENSITY, value->density, grid->density},
        {SCALAR_SUMMIT_DENSITY_PER_AREA, value->density * long_waves, grid->density * long_waves},
        {SCALAR_SUMMIT_HEIGHT_MEAN, value->height_mean, grid->height_mean},
        {SCALAR_SUMMIT_HEIGHT_VARIANCE, value->height_variance, grid->height_variance},
        {SCALAR_SUMMIT_HEIGHT_SKEWNESS, value->height_skewness, grid->height_skewness},
        {SCALAR_SUMMIT_HEIGHT_KURTOSIS, value->height_kurtosis, grid->height_kurtosis},
        {SCALAR_SUMMIT_CURVATURE_MEAN, value->curvature, grid->curvature},
    };
    int status = 0;
    for (size_t a = 0; a < sizeof list / sizeof *list && status == 0; a++)
        status = add_scalar(e, statistics_scalar_name(list[a].scalar + side), list[a].value,
                            list[a].grid, err);
    return status;
}

/* --- summits: both theories, of each side --- */

static int add_without_grid(struct expectation *e, const struct summit_theory *theory, bool joint,
                            bool pits, struct summit_expectation *out, struct error *err) {
    const struct statistics_case *one_case = &e->one_case;
    struct summit_curves curves;
    int status = summit_curves_create(e, joint, &curves, err);
    if (status != 0)
        return status;
    *out = summit_theory_expectation(theory, pits);
    summit_theory_heights(theory, one_case, pits, curves.pdf, curves.cdf, curves.curvature);
    summit_theory_equivalent(theory, one_case, pits, curves.t1_pdf);
    if (joint)
        summit_theory_joint(theory, one_case, pits, curves.joint);
    return add_summit_curves(e, pits ? "pits" : theory->name, &curves, err);
}

static int add_of_grid(struct expectation *e, bool joint, bool pits, struct sampled_summits *out,
                       struct error *err) {
    const struct statistics_case *one_case = &e->one_case;
    bool translated = surface_case_translated(&one_case->surface);
    struct summit_curves curves;
    int status = summit_curves_create(e, joint && !translated, &curves, err);
    if (status != 0)
        return status;
    const struct sampled_bins bins = {&one_case->height, &one_case->equivalent, curves.pdf,
                                      curves.cdf,        curves.curvature,      curves.t1_pdf,
                                      curves.joint};
    status = statistics_grid_theory_summits(one_case, &e->basis, pits, out, &bins, err);
    if (isnan(out->curvature))
        curves.curvature = NULL;
    if (translated)
        curves.t1_pdf = NULL;
    return status != 0
               ? status
               : add_summit_curves(e, pits ? "grid_pits" : STATISTICS_GRID_THEORY, &curves, err);
}

static int add_side(struct expectation *e, const struct summit_theory *theory, bool joint,
                    bool pits, struct error *err) {
    struct summit_expectation without = {NAN, NAN, NAN, NAN, NAN, NAN};
    struct sampled_summits grid = {NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    int status = 0;
    if (theory != NULL)
        status = add_without_grid(e, theory, joint, pits, &without, err);
    if (status == 0 && statistics_grid_theory_applies(&e->one_case))
        status = add_of_grid(e, joint, pits, &grid, err);
    return status != 0 ? status : add_summit_scalars(e, pits, &without, &grid, err);
}

static int add_summits(struct expectation *e, bool joint, struct error *err) {
    struct summit_theories theories;
    int status = summit_theories_create(&theories, &e->one_case, &e->basis, err);
    if (status != 0)
        return status;
    const struct summit_theory *theory = summit_theories_own(&theories, &e->one_case);
    for (size_t side = 0; side < statistics_case_sides(&e->one_case) && status == 0; side++)
        status = add_side(e, theory, joint, side == SIDE_PITS, err);
    summit_theories_clear(&theories);
    return status;
}

/* --- alpha of self-affine spectra, by the continuous formula --- */

enum { RATIOS = 41, HURSTS = 21 };
static const double RATIO_REACH = 128; /* times the ratio of roll-off */

static int add_alpha(struct expectation *e, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    const struct spectrum *spectrum = &surface->spectrum;
    if (spectrum->type != SPECTRUM_SELF_AFFINE || spectrum->anisotropy > 1)
        return 0;
    double rolloff = spectrum->wavelength_long / spectrum->wavelength_rolloff;
    double *x = result_numbers(e->result, 2 * (RATIOS + HURSTS)), *y = x + RATIOS;
    if (x == NULL)
        return no_room(err);
    double *hurst = x + 2 * RATIOS, *by_hurst = hurst + HURSTS;
    for (size_t a = 0; a < RATIOS; a++) {
        x[a] = rolloff * pow(RATIO_REACH, (double)a / (RATIOS - 1));
        y[a] = spectrum_alpha_continuous(surface->dimension, spectrum->hurst, x[a], rolloff);
    }
    for (size_t a = 0; a < HURSTS; a++) {
        hurst[a] = (double)a / (HURSTS - 1);
        by_hurst[a] = spectrum_alpha_continuous(surface->dimension, hurst[a],
                                                surface->wavelength_ratio, rolloff);
    }
    int status = add_curve(e,
                           curve_named("nayak_alpha_by_ratio", "lambda_l/lambda_s",
                                       "Nayak parameter, continuous spectrum"),
                           NULL, RATIOS, x, y, err);
    if (status == 0)
        status = add_curve(e,
                           curve_named("nayak_alpha_by_hurst", "Hurst exponent",
                                       "Nayak parameter, continuous spectrum"),
                           NULL, HURSTS, hurst, by_hurst, err);
    return status;
}

/* --- a case --- */

static int axes_create(struct expectation *e, struct error *err) {
    const struct bins *height = &e->one_case.height, *t1 = &e->one_case.equivalent;
    size_t n = height->count, columns = t1->count, cells = n * columns;
    size_t longest = cells > RATIOS ? cells : RATIOS;
    double *room = result_numbers(e->result, 2 * n + columns + longest);
    if (room == NULL)
        return no_room(err);
    e->heights = room;
    e->edges = room + n;
    e->t1 = room + 2 * n;
    e->nothing = e->t1 + columns;
    for (size_t b = 0; b < n; b++) {
        e->heights[b] = bins_centre(height, b);
        e->edges[b] = height->low + (double)(b + 1) * bins_width(height);
    }
    for (size_t b = 0; b < columns; b++)
        e->t1[b] = bins_centre(t1, b);
    for (size_t a = 0; a < longest; a++)
        e->nothing[a] = NAN;
    return 0;
}

/* Reads a case from parameters of any kind: those of the surface and of statistics. */
static int case_create(struct expectation *e, const cJSON *parameters, struct error *err) {
    static const char *const PARTS[] = {"surface", "statistics"};
    cJSON *document = cJSON_CreateObject();
    bool complete = document != NULL;
    for (size_t p = 0; p < 2 && complete; p++) {
        const cJSON *part = cJSON_GetObjectItemCaseSensitive(parameters, PARTS[p]);
        complete = part == NULL || field_put(document, PARTS[p], cJSON_Duplicate(part, true));
    }
    int status = complete ? statistics_case_read(&e->one_case, document, NULL, err) : no_room(err);
    cJSON_Delete(document);
    if (status == 0)
        status =
            modes_create(&e->modes, &e->one_case.surface.spectrum, &e->one_case.surface.grid, err);
    if (status != 0)
        return status;
    e->basis.modes = e->modes;
    modes_moments(e->modes, &e->basis.moments);
    return axes_create(e, err);
}

/* Adds what is known of faces of one surface. */
static int add_all(struct expectation *e, bool joint, struct error *err) {
    const bool grooved = e->one_case.surface.grooves != NULL;
    int status = grooved ? add_grooved(e, err) : add_moments(e, err);
    if (status == 0 && !grooved)
        status = add_alphas(e, err);
    if (status == 0 && !grooved)
        status = add_fractal(e, err);
    if (status == 0)
        status = add_heights(e, err);
    if (status == 0)
        status = add_summits(e, joint, err);
    if (status == 0)
        status = spectra_prescribed(&e->one_case, e->modes, e->result, err);
    if (status == 0 && !grooved)
        status = add_lengths(e, err);
    return status == 0 && !grooved ? add_alpha(e, err) : status;
}

int statistics_expectation(const cJSON *parameters, bool joint, struct case_result *out,
                           struct error *err) {
    struct expectation e = {.result = out};
    int status = result_set_parameters(out, parameters, err);
    if (status == 0)
        status = case_create(&e, parameters, err);
    const bool stratified = status == 0 && e.one_case.surface.plateau != NULL;
    if (stratified)
        status = add_stratified(&e, err);
    if (stratified && status == 0)
        status = add_heights(&e, err);
    if (status == 0 && !stratified)
        status = add_all(&e, joint, err);
    if (status == 0)
        units_set(out);
    modes_destroy(&e.modes);
    statistics_case_clear(&e.one_case);
    if (status != 0)
        result_clear(out);
    return status;
}
