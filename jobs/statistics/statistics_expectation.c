#include "jobs/statistics/statistics_expectation.h"
#include "core/theory/nayak.h"
#include "core/theory/sampled_field.h"
#include "core/theory/sampled_summits.h"
#include "jobs/statistics/statistics_grid_theory.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_theory.h"
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
    double *pdf, *cdf, *curvature, *t1_pdf, *joint; /* joint: NULL without */
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
    if (status == 0)
        status = add_curve(
            e, named("summit_mean_curvature", surface ? "kappa_m/sqrt(m4)" : "-z''/sqrt(m4)"),
            series, n, e->heights, curves->curvature, err);
    if (status == 0)
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

static double continuous_alpha(const struct surface_case *surface) {
    const struct spectrum *spectrum = &surface->spectrum;
    if (spectrum->type != SPECTRUM_SELF_AFFINE || spectrum->anisotropy > 1)
        return NAN;
    return spectrum_alpha_continuous(surface->dimension, spectrum->hurst, surface->wavelength_ratio,
                                     spectrum->wavelength_long / spectrum->wavelength_rolloff);
}

static int add_moments(struct expectation *e, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    const struct moments *m = &e->basis.moments;
    struct sampled_moments grid;
    struct height_moments heights;
    int status = heights_moments(&surface->options.heights, &heights, err);
    if (status != 0)
        return status;
    sampled_moments(e->modes, &grid);
    bool few_waves = surface->options.heights.type == HEIGHTS_GAUSSIAN &&
                     surface->options.amplitudes == AMPLITUDES_FIXED;
    const struct expected_scalar list[] = {
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

static int add_summit_scalars(struct expectation *e, const struct summit_expectation *value,
                              const struct sampled_summits *grid, struct error *err) {
    const struct surface_case *surface = &e->one_case.surface;
    double ratio = surface->wavelength_ratio, long_waves = ratio;
    if (surface->dimension == 2)
        long_waves *= ratio;
    const struct expected_scalar list[] = {
        {"summit_density", value->density, grid->density},
        {"summit_density_per_area", value->density * long_waves, grid->density * long_waves},
        {"summit_height_mean", value->height_mean, grid->height_mean},
        {"summit_height_variance", value->height_variance, grid->height_variance},
        {"summit_height_skewness", value->height_skewness, grid->height_skewness},
        {"summit_height_kurtosis", value->height_kurtosis, grid->height_kurtosis},
        {"summit_curvature_mean", value->curvature, grid->curvature},
    };
    return add_scalars(e, sizeof list / sizeof *list, list, err);
}

/* --- summits: both theories --- */

static int add_without_grid(struct expectation *e, bool joint, struct summit_expectation *out,
                            struct error *err) {
    const struct moments *m = &e->basis.moments;
    struct summit_curves curves;
    int status = summit_curves_create(e, joint, &curves, err);
    if (status != 0)
        return status;
    *out = summit_expectation(e->one_case.surface.dimension, m->m2, m->m4, m->nayak_alpha);
    statistics_theory_summits(&e->one_case, m->nayak_alpha, curves.pdf, curves.cdf,
                              curves.curvature);
    statistics_theory_equivalent(&e->one_case, curves.t1_pdf);
    if (joint)
        statistics_theory_joint(&e->one_case, m->nayak_alpha, curves.joint);
    return add_summit_curves(e, statistics_theory_name(&e->one_case), &curves, err);
}

static int add_of_grid(struct expectation *e, bool joint, struct sampled_summits *out,
                       struct error *err) {
    const struct statistics_case *one_case = &e->one_case;
    const struct sampled_surface surface = {e->modes, &e->basis.moments, one_case->stencil,
                                            one_case->curvature};
    struct summit_curves curves;
    int status = summit_curves_create(e, joint, &curves, err);
    if (status != 0)
        return status;
    const struct sampled_bins bins = {&one_case->height, &one_case->equivalent, curves.pdf,
                                      curves.cdf,        curves.curvature,      curves.t1_pdf,
                                      curves.joint};
    status = sampled_summits(&surface, out, &bins, err);
    return status != 0 ? status : add_summit_curves(e, STATISTICS_GRID_THEORY, &curves, err);
}

/* Adds summits, of which theory exists for Gaussian heights alone. */
static int add_summits(struct expectation *e, bool joint, struct error *err) {
    struct summit_expectation without = {NAN, NAN, NAN, NAN, NAN, NAN};
    struct sampled_summits grid = {NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    int status = 0;
    if (e->one_case.surface.options.heights.type != HEIGHTS_GAUSSIAN)
        return 0;
    if (statistics_theory_applies(&e->one_case, &e->basis.moments))
        status = add_without_grid(e, joint, &without, err);
    if (status == 0 && e->one_case.stencil != SUMMITS_REFINED)
        status = add_of_grid(e, joint, &grid, err);
    return status != 0 ? status : add_summit_scalars(e, &without, &grid, err);
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

int statistics_expectation(const cJSON *parameters, bool joint, struct case_result *out,
                           struct error *err) {
    struct expectation e = {.result = out};
    int status = result_set_parameters(out, parameters, err);
    if (status == 0)
        status = case_create(&e, parameters, err);
    if (status == 0)
        status = add_moments(&e, err);
    if (status == 0)
        status = add_heights(&e, err);
    if (status == 0)
        status = add_summits(&e, joint, err);
    if (status == 0)
        status = spectra_prescribed(&e.one_case, e.modes, out, err);
    if (status == 0)
        status = add_alpha(&e, err);
    modes_destroy(&e.modes);
    statistics_case_clear(&e.one_case);
    if (status != 0)
        result_clear(out);
    return status;
}
