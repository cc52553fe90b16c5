#include "jobs/statistics/statistics_grid_theory.h"
#include "core/surface/translation/translation.h"
#include "core/theory/sampled_field.h"
#include "jobs/statistics/statistics_scalars.h"
#include <math.h>
#include <string.h>

const char STATISTICS_GRID_THEORY[] = "grid";

static bool is_gaussian(const struct statistics_case *one_case) {
    return surface_case_gaussian(&one_case->surface);
}

static bool keeps_heights(const struct surface_case *surface) {
    return surface_is_iterated(&surface->options) && surface->options.keep == KEEP_HEIGHTS;
}

bool statistics_grid_theory_applies(const struct statistics_case *one_case) {
    return one_case->surface.grooves == NULL &&
           (is_gaussian(one_case) || surface_case_translated(&one_case->surface)) &&
           one_case->stencil != SUMMITS_REFINED;
}

bool statistics_grid_theory_moments(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface, *counter = surface->counter;
    return surface->plateau == NULL && surface->grooves == NULL && !keeps_heights(surface) &&
           (counter == NULL || !keeps_heights(counter));
}

int statistics_grid_theory_summits(const struct statistics_case *one_case,
                                   const struct surface_basis *basis, bool pits,
                                   struct sampled_summits *out, const struct sampled_bins *bins,
                                   struct error *err) {
    const struct translation *law = basis->modes->translation;
    struct translated_surface translated = {.dimension = one_case->surface.dimension,
                                            .reached = basis->moments};
    struct sampled_surface surface = {basis->modes, &basis->moments, one_case->stencil,
                                      one_case->curvature, NULL};
    if (law != NULL) {
        translated.heights = (struct translated_heights){translation_function(law), pits};
        modes_gaussian_moments(basis->modes, &translated.gaussian);
        surface.moments = &translated.gaussian;
        surface.translated = &translated;
    }
    return sampled_summits(&surface, out, bins, err);
}

/* Adds the series to the curves of a quantity of a side. */
static void add_series(struct case_result *out, const char *quantity, bool pits, const double *y) {
    for (size_t a = 0; a < out->curve_count; a++) {
        struct curve *curve = &out->curves[a];
        if (strcmp(curve->quantity, quantity) == 0 && (*curve->series != '\0') == pits &&
            curve->theory_count < THEORIES_MOST)
            curve->theories[curve->theory_count++] = (struct theory){STATISTICS_GRID_THEORY, y};
    }
}

static int add_curves(const struct statistics_case *one_case, const struct surface_basis *basis,
                      bool pits, struct sampled_summits *summits, struct case_result *out,
                      struct error *err) {
    size_t n = one_case->height.count;
    double *room = result_numbers(out, 3 * n + one_case->equivalent.count);
    if (room == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for theory of the grid");
    const struct sampled_bins bins = {&one_case->height, &one_case->equivalent, room, room + n,
                                      room + 2 * n,      room + 3 * n,          NULL};
    int status = statistics_grid_theory_summits(one_case, basis, pits, summits, &bins, err);
    if (status != 0)
        return status;
    add_series(out, "summit_height_pdf", pits, bins.pdf);
    add_series(out, "summit_height_cdf", pits, bins.cdf);
    if (!isnan(summits->curvature))
        add_series(out, "summit_mean_curvature", pits, bins.curvature);
    if (basis->modes->translation != NULL)
        return 0;
    add_series(out, "summit_curvature_pdf", pits, bins.t1_pdf);
    add_series(out, "summit_joint_pdf", pits, NULL);
    return 0;
}

static void set_scalar(struct case_result *out, size_t scalar, double value) {
    const char *name = statistics_scalar_name(scalar);
    for (size_t s = 0; s < out->scalar_count; s++)
        if (strcmp(out->scalars[s].name, name) == 0)
            out->scalars[s].grid = value;
}

static void set_summits(const struct statistics_case *one_case, bool pits,
                        const struct sampled_summits *summits, struct case_result *out) {
    const struct surface_case *surface = &one_case->surface;
    bool profile = surface->dimension == 1;
    double ratio = surface->wavelength_ratio;
    double cell = surface->grid.lx * (profile ? 1 : surface->grid.ly);
    size_t side = pits ? SIDE_SCALARS : 0;
    set_scalar(out, side + SCALAR_SUMMITS, summits->density * cell);
    set_scalar(out, side + SCALAR_SUMMIT_DENSITY, summits->density);
    set_scalar(out, side + SCALAR_SUMMIT_DENSITY_PER_AREA,
               summits->density * (profile ? ratio : ratio * ratio));
    set_scalar(out, side + SCALAR_SUMMIT_HEIGHT_MEAN, summits->height_mean);
    set_scalar(out, side + SCALAR_SUMMIT_HEIGHT_VARIANCE, summits->height_variance);
    set_scalar(out, side + SCALAR_SUMMIT_HEIGHT_SKEWNESS, summits->height_skewness);
    set_scalar(out, side + SCALAR_SUMMIT_HEIGHT_KURTOSIS, summits->height_kurtosis);
    set_scalar(out, side + SCALAR_SUMMIT_CURVATURE_MEAN, summits->curvature);
}

static int add_scalar(struct case_result *out, const char *name, double value, double theory,
                      double grid, struct error *err) {
    struct scalar scalar = scalar_named(name, value, 0, theory);
    scalar.grid = grid;
    return result_add_scalar(out, &scalar, err);
}

/* Returns whether a spectrum is isotropic; that of an exponential autocorrelation ends at the
 * corners of the grid, which is square. */
static bool is_isotropic(const struct spectrum *spectrum) {
    return spectrum->type != SPECTRUM_EXPONENTIAL_ACF && !(spectrum->anisotropy > 1);
}

/* Adds scalars that depend on the spectrum alone: how isotropic its moments are (1: isotropic), of
 * surfaces without grooves, and the share of an exponential autocorrelation that no surface can
 * have. */
static int add_spectrum(const struct statistics_case *one_case, const struct surface_basis *basis,
                        struct case_result *out, struct error *err) {
    struct sampled_moments grid;
    const struct moments *m = &basis->moments;
    const struct surface_case *surface = &one_case->surface;
    const struct surface_case *counter = surface->counter;
    const bool isotropic =
        is_isotropic(&surface->spectrum) && (counter == NULL || is_isotropic(&counter->spectrum));
    int status = 0;
    sampled_moments(basis->modes, &grid);
    if (surface->dimension == 2 && surface->grooves == NULL)
        status =
            add_scalar(out, "isotropy", 3 * m->m22 / m->m4, isotropic ? 1 : (double)NAN,
                       statistics_grid_theory_moments(one_case) ? grid.isotropy : (double)NAN, err);
    if (status == 0 && surface->spectrum.type == SPECTRUM_EXPONENTIAL_ACF)
        status = add_scalar(out, "spectrum_clipped", basis->modes->clipped, NAN, NAN, err);
    return status;
}

static void set_moments(const struct statistics_case *one_case, const struct modes *modes,
                        struct case_result *out) {
    struct sampled_moments moments;
    sampled_moments(modes, &moments);
    set_scalar(out, SCALAR_RMS_SLOPE, moments.rms_slope);
    set_scalar(out, SCALAR_RMS_CURVATURE, moments.rms_curvature);
    set_scalar(out, SCALAR_M2_DIFFERENCE, moments.m2);
    set_scalar(out, SCALAR_M4_DIFFERENCE, moments.m4);
    set_scalar(out, SCALAR_NAYAK_ALPHA_DIFFERENCE, moments.nayak_alpha);
    if (is_gaussian(one_case) && one_case->surface.options.amplitudes == AMPLITUDES_FIXED)
        set_scalar(out, SCALAR_KURTOSIS, moments.kurtosis);
}

int statistics_grid_theory(const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct case_result *out,
                           struct error *err) {
    struct sampled_summits summits;
    if (one_case->surface.plateau != NULL)
        return 0; /* kinks change with the grid whatever differences see */
    if (statistics_grid_theory_moments(one_case))
        set_moments(one_case, basis->modes, out);
    int status = add_spectrum(one_case, basis, out, err);
    if (!statistics_grid_theory_applies(one_case))
        return status;
    for (size_t side = 0; side < statistics_case_sides(one_case) && status == 0; side++) {
        bool pits = side == SIDE_PITS;
        status = add_curves(one_case, basis, pits, &summits, out, err);
        if (status == 0)
            set_summits(one_case, pits, &summits, out);
    }
    return status;
}

int statistics_grid_theory_joint(const struct statistics_case *one_case,
                                 const struct surface_basis *basis, double *pdf,
                                 struct error *err) {
    const struct sampled_bins bins = {
        .height = &one_case->height, .t1 = &one_case->equivalent, .joint = pdf};
    struct sampled_summits summits;
    return statistics_grid_theory_summits(one_case, basis, false, &summits, &bins, err);
}
