/* Heights and curvatures together: refined summits of Gaussian surfaces against Nayak's joint
 * density, refined peaks of Gaussian profiles against that of Rice (1945) and Cartwright &
 * Longuet-Higgins (1956), and grid summits against theory of the same grid. Four standard errors
 * over the realisations; the seed is fixed, so a pass stays a pass. */
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include "core/theory/sampled_summits.h"
#include "tests/support/check.h"
#include <stdlib.h>

enum { ROWS = 6, COLUMNS = 6, SEED = 77 };

/* Bins that hold nearly all summits: z/sqrt(m0) and t1. */
static const double LOW_Z = -1, STEP_Z = 0.75, LOW_T = -5, STEP_T = 0.8;

struct joint_figures {
    double shares[ROWS][COLUMNS], errors[ROWS][COLUMNS]; /* of all summits */
    double density, density_error;                       /* summits a cell area or length */
    double curvature, curvature_error;                   /* mean over sqrt(m4) */
    struct moments moments;
};

struct joint_sample {
    double counts[ROWS][COLUMNS], total, curvature;
};

static void sample_fill(struct joint_sample *sample, const struct summit_list *list,
                        const struct moments *m, double t_per_curvature) {
    *sample = (struct joint_sample){.total = (double)list->count};
    for (size_t s = 0; s < list->count; s++) {
        double scaled = list->summits[s].curvature / sqrt(m->m4);
        double row = (list->summits[s].height / sqrt(m->m0) - LOW_Z) / STEP_Z;
        double column = (-t_per_curvature * scaled - LOW_T) / STEP_T;
        if (row >= 0 && row < ROWS && column >= 0 && column < COLUMNS)
            sample->counts[(int)row][(int)column]++;
        sample->curvature += scaled / sample->total;
    }
}

/* Shares are ratios of sums; their errors by linearisation. */
static void figures_fill(struct joint_figures *f, const struct joint_sample *samples,
                         size_t count) {
    double n = (double)count, all = 0, squares = 0, curvature = 0, curvatures = 0;
    for (size_t r = 0; r < count; r++) {
        all += samples[r].total;
        squares += samples[r].total * samples[r].total;
        curvature += samples[r].curvature / n;
        curvatures += samples[r].curvature * samples[r].curvature / n;
    }
    f->density = all / n;
    f->density_error = sqrt((squares / n - f->density * f->density) / (n - 1));
    f->curvature = curvature;
    f->curvature_error = sqrt((curvatures - curvature * curvature) / (n - 1));
    for (size_t i = 0; i < (size_t)ROWS * COLUMNS; i++) {
        size_t row = i / COLUMNS, column = i % COLUMNS;
        double sum = 0, spread = 0;
        for (size_t r = 0; r < count; r++)
            sum += samples[r].counts[row][column];
        for (size_t r = 0; r < count; r++) {
            double d = samples[r].counts[row][column] - sum / all * samples[r].total;
            spread += d * d;
        }
        f->shares[row][column] = sum / all;
        f->errors[row][column] = sqrt(spread * n / (n - 1)) / all;
    }
}

static void measure(const struct grid *grid, double ratio, enum summit_stencil stencil,
                    enum summit_curvature curvature, enum surface_amplitudes amplitudes,
                    size_t count, struct joint_figures *figures) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = amplitudes;
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = ratio,
                                .wavelength_rolloff = ratio,
                                .wavelength_short = 1};
    bool profile = grid_is_profile(grid);
    struct generator *generator = NULL;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0};
    double *z = malloc(grid_points(grid) * sizeof *z);
    struct joint_sample *samples = malloc(count * sizeof *samples);
    assert_true(z && samples);
    assert_int_equal(generator_create(&generator, &spectrum, grid, &options, NULL), 0);
    const struct modes *modes = generator_modes(generator);
    modes_moments(modes, &figures->moments);
    assert_int_equal(
        summit_finder_create(&finder, grid, stencil, curvature, modes->mode_x, modes->mode_y, NULL),
        0);
    for (size_t r = 0; r < count; r++) {
        assert_int_equal(generator_run(generator, (struct random_key){SEED, 0, r}, z, NULL, NULL),
                         0);
        assert_int_equal(summits_find(finder, z, &list, NULL), 0);
        sample_fill(&samples[r], &list, &figures->moments, profile ? 1 : sqrt(3));
    }
    figures_fill(figures, samples, count);
    generator_destroy(&generator);
    summit_finder_destroy(&finder);
    summit_list_clear(&list);
    free(samples);
    free(z);
}

/* Bins of less than a thousandth of the summits are left out, their errors being poorly known. */
static const double SHARE_LEAST = 1e-3;

struct joint_slice {
    double (*joint)(double, double, double);
    double alpha, z, low; /* t1 from low to low + STEP_T */
};

static double along_t(double t, const void *context) {
    const struct joint_slice *slice = context;
    return slice->joint(slice->z, t, slice->alpha);
}

static double along_z(double z, const void *context) {
    struct joint_slice slice = *(const struct joint_slice *)context;
    slice.z = z;
    return quadrature(along_t, &slice, slice.low, slice.low + STEP_T, 2);
}

/* The largest distance of a bin from theory, in standard errors. */
static double worst_bin(const struct joint_figures *f, double (*joint)(double, double, double)) {
    double worst = 0, covered = 0;
    for (size_t row = 0; row < ROWS; row++)
        for (size_t column = 0; column < COLUMNS; column++) {
            struct joint_slice slice = {joint, f->moments.nayak_alpha, 0,
                                        LOW_T + (double)column * STEP_T};
            double low = LOW_Z + (double)row * STEP_Z;
            double expected = quadrature(along_z, &slice, low, low + STEP_Z, 2);
            if (expected < SHARE_LEAST)
                continue;
            covered += expected;
            worst = fmax(worst, fabs(f->shares[row][column] - expected) / f->errors[row][column]);
        }
    assert_true(covered > 0.9);
    return worst;
}

static void summits_of_surfaces(void **state) {
    (void)state;
    const struct grid grid = {256, 256, 64, 64};
    struct joint_figures f;
    measure(&grid, 8, SUMMITS_REFINED, CURVATURE_SPECTRAL, AMPLITUDES_FIXED, 300, &f);
    double worst = worst_bin(&f, nayak_joint_pdf);
    print_message("seed %d: worst bin of the joint density at %.1f standard errors\n", SEED, worst);
    assert_true(worst < 4);
}

/* Long profiles, so that 500 waves of fixed amplitude are as good as Gaussian, to about 1e-3. */
static void peaks_of_profiles(void **state) {
    (void)state;
    const struct grid grid = {4096, 1, 512, 1};
    struct joint_figures f;
    measure(&grid, 8, SUMMITS_REFINED, CURVATURE_SPECTRAL, AMPLITUDES_FIXED, 1500, &f);
    const struct moments *m = &f.moments;
    double worst = worst_bin(&f, profile_peak_joint_pdf);
    double density = f.density / 512 / profile_peak_density(m->m2, m->m4);
    print_message("seed %d: worst bin %.1f, density %.4f +- %.4f, curvature %.4f +- %.4f\n", SEED,
                  worst, density, f.density_error / f.density, f.curvature, f.curvature_error);
    assert_true(worst < 4);
    check_close(density, 1, 4 * f.density_error / f.density + 1e-3);
    /* over all peaks -z'' is Rayleigh, whatever alpha */
    check_close(f.curvature, sqrt(M_PI / 2), 4 * f.curvature_error + 1e-3);
}

/* With exact derivatives, nine-point summits at 8 points a wave are a little flatter than maxima:
 * 1.495 (F8.3), three digits; by differences 1.464. */
static void curvature_at_grid_summits(void **state) {
    (void)state;
    const struct grid grid = {512, 512, 64, 64};
    struct joint_figures exact, differences;
    measure(&grid, 8, SUMMITS_NINE_POINT, CURVATURE_SPECTRAL, AMPLITUDES_FIXED, 60, &exact);
    measure(&grid, 8, SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE, AMPLITUDES_FIXED, 60,
            &differences);
    print_message("seed %d: mean curvature %.4f exact, %.4f by differences, +- %.4f\n", SEED,
                  exact.curvature, differences.curvature, exact.curvature_error);
    check_close(exact.curvature, 1.495, 4 * exact.curvature_error + 5e-4);
    check_close(differences.curvature, 1.464, 4 * differences.curvature_error + 5e-4);
    /* the same summits: curvature alone differs */
    check_close(exact.density, differences.density, 0);
}

/* What a grid shows, against theory of the same grid (F8.4): density, mean curvature, and heights
 * and curvatures together. Random amplitudes make Gaussian surfaces. */
static void check_grid(size_t points, enum summit_stencil stencil,
                       enum summit_curvature curvature) {
    const struct grid grid = {64 * points, 64 * points, 64, 64};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = 8,
                                      .wavelength_rolloff = 8,
                                      .wavelength_short = 1};
    const struct bins height = {LOW_Z, LOW_Z + ROWS * STEP_Z, ROWS};
    const struct bins t1 = {LOW_T, LOW_T + COLUMNS * STEP_T, COLUMNS};
    double joint[ROWS * COLUMNS], worst = 0, covered = 0;
    const struct sampled_bins bins = {.height = &height, .t1 = &t1, .joint = joint};
    struct joint_figures f;
    struct modes *modes = NULL;
    struct sampled_summits expected;
    measure(&grid, 8, stencil, curvature, AMPLITUDES_RANDOM, 200, &f);
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
    const struct sampled_surface surface = {modes, &f.moments, stencil, curvature, NULL};
    assert_int_equal(sampled_summits(&surface, &expected, &bins, NULL), 0);
    modes_destroy(&modes);
    for (size_t b = 0; b < (size_t)ROWS * COLUMNS; b++) {
        double share = joint[b] * STEP_Z * STEP_T;
        if (share < SHARE_LEAST)
            continue;
        covered += share;
        worst = fmax(worst, fabs(f.shares[b / COLUMNS][b % COLUMNS] - share) /
                                f.errors[b / COLUMNS][b % COLUMNS]);
    }
    double nayak = nayak_summit_density(f.moments.m2, f.moments.m4);
    double density = f.density / 4096;
    print_message("seed %d, %zu points, stencil %d, curvature %d: worst bin %.1f, density %.4f +- "
                  "%.4f (theory %.4f), curvature %.4f +- %.4f (theory %.4f)\n",
                  SEED, points, (int)stencil, (int)curvature, worst, density / nayak,
                  f.density_error / 4096 / nayak, expected.density / nayak, f.curvature,
                  f.curvature_error, expected.curvature);
    assert_true(covered > 0.9 && worst < 4);
    check_close(density, expected.density,
                4 * hypot(f.density_error / 4096, expected.density * expected.density_error));
    check_close(f.curvature, expected.curvature, 4 * f.curvature_error + 2e-4);
}

static void summits_of_grids(void **state) {
    (void)state;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_FIVE_POINT; stencil++)
        for (int curvature = 0; curvature <= CURVATURE_SPECTRAL; curvature++)
            check_grid(curvature == CURVATURE_SPECTRAL ? 3 : 6, (enum summit_stencil)stencil,
                       (enum summit_curvature)curvature);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(summits_of_surfaces),
        cmocka_unit_test(peaks_of_profiles),
        cmocka_unit_test(summits_of_grids),
        cmocka_unit_test(curvature_at_grid_summits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
