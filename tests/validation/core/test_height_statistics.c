/* Protects: what one patch determines of the infinite surface that it is a part of. Over patches
 * cut out of larger surfaces with random amplitudes, the 95 % intervals hold the true values as
 * often as they say. The p-values of the fit of heights, of isotropy and of stationarity are
 * uniform where the hypothesis holds, and small where it does not. RUGO_EFFORT=20 makes 320 patches
 * of each kind; the figures in FORMULAS.md, F18.16 to F18.19, are of those. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/heights/height_fit.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/open_summits.h"
#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/scalar_errors.h"
#include "core/statistics/uncertainty/stationarity.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 512, PATCH = 128, PATCHES = (SIDE / PATCH) * (SIDE / PATCH) };
enum { SURFACES = 1, PATCHES_MOST = PATCHES * SURFACES * EFFORT_MOST };
static const struct grid WHOLE = {SIDE, SIDE, SIDE, SIDE}, PIECE = {PATCH, PATCH, PATCH, PATCH};

/* Surfaces of one kind; the roll-off is an eighth of a patch, the shortest wave 4 points. */
struct kind {
    double hurst;
    struct heights heights;
    enum detrend detrend;
    double anisotropy;     /* 0: none */
    double rougher, bowed; /* by what patches are made unlike all over */
};

enum { SA, SQ, SSK, SKU, SLOPE, CURVATURE, ALPHA, DENSITY, HEIGHT, SUMMIT_CURVATURE, SCALARS };
static const char *const NAMES[SCALARS] = {"Sa",
                                           "Sq",
                                           "Ssk",
                                           "Sku",
                                           "RMS slope",
                                           "RMS curvature",
                                           "alpha",
                                           "summit density",
                                           "mean summit height",
                                           "mean summit curvature"};

/* The values of each patch. */
static struct found {
    double value[SCALARS], error[SCALARS];
    struct height_fits fits;
    double isotropy[2]; /* p-values of a fine and a coarse lag */
    struct stationarity stationarity;
} patches[PATCHES_MOST];
static size_t count;

static void summits_measure(const struct measured_map *map, const struct map_chance *chance,
                            struct found *out) {
    struct summit_list list = {0};
    struct summit_errors errors;
    double searched, cells[LOW_CELLS_MOST];
    assert_int_equal(open_summits_find(map, SUMMITS_NINE_POINT, &list, &searched, NULL), 0);
    assert_int_equal(summit_cells_count(map, &chance->modes, 1, 1, cells, NULL), 0);
    out->value[DENSITY] = (double)list.count / searched;
    out->value[HEIGHT] = out->value[SUMMIT_CURVATURE] = 0;
    for (size_t a = 0; a < list.count; a++) {
        out->value[HEIGHT] += list.summits[a].height / (double)list.count;
        out->value[SUMMIT_CURVATURE] += list.summits[a].curvature / (double)list.count;
    }
    summit_errors_measure(&list, out->value[DENSITY], map->grid, cells, chance->heights,
                          &chance->modes, &errors);
    out->error[DENSITY] = errors.density;
    out->error[HEIGHT] = errors.height_mean;
    out->error[SUMMIT_CURVATURE] = errors.curvature_mean;
    summit_list_clear(&list);
}

static void scalars_measure(const struct measured_map *map, const struct map_chance *chance,
                            const struct cell_differences *differences, struct found *out) {
    struct roughness roughness;
    struct scalar_errors e;
    double size = 0, slope = 0, curvature = 0, bend = 0, n = 0;
    scalar_errors_heights(chance->heights, &chance->modes, &e);
    scalar_errors_differences(differences, chance->heights, &chance->modes, &e);
    roughness_measure(map->grid, map->z,
                      &roughness); /* of heights alone: the seam does not count */
    for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++) {
        size += chance->heights->size[cell] / chance->heights->count;
        slope += differences->slope[cell];
        bend += differences->bend[cell];
        curvature += differences->curvature[cell];
        n += differences->count[cell];
    }
    double m0 = roughness.rms_height * roughness.rms_height;
    const double values[] = {size,
                             roughness.rms_height,
                             roughness.skewness,
                             roughness.kurtosis,
                             sqrt(slope / n),
                             sqrt(curvature / n),
                             2 * m0 * bend * n / (slope * slope)};
    const double errors[] = {e.sa,
                             e.sq,
                             e.ssk,
                             e.sku,
                             e.slope * values[SLOPE],
                             e.curvature * values[CURVATURE],
                             e.alpha * values[ALPHA]};
    memcpy(out->value, values, sizeof values);
    memcpy(out->error, errors, sizeof errors);
    summits_measure(map, chance, out);
}

static void patch_measure(double *z, const struct kind *kind, struct found *out) {
    static struct cell_differences fine, coarse;
    const struct measured_map map = {&PIECE, z, BOUNDARY_OPEN};
    struct map_chance *chance = NULL;
    struct trend trend;
    struct isotropy isotropy;
    for (size_t point = 0; point < (size_t)PATCH * PATCH; point++) {
        double x = 2 * (double)(point % PATCH) / PATCH - 1;
        z[point] = z[point] * (x > 0 ? 1 + kind->rougher : 1) + kind->bowed * x * x;
    }
    assert_int_equal(detrend(&PIECE, z, kind->detrend, &trend, NULL), 0);
    assert_int_equal(map_chance_create(&chance, &map, NULL), 0);
    assert_true(chance->told);
    cell_differences_measure(&map, &chance->modes, 1, &fine);
    cell_differences_measure(&map, &chance->modes, 2, &coarse);
    scalars_measure(&map, chance, &fine, out);
    height_fit_measure(chance->heights, &chance->modes, &out->fits);
    for (int n = 0; n < 2; n++) {
        double excess = low_modes_excess_slopes(&chance->modes, chance->correlation, &PIECE, 1 + n);
        isotropy_measure(n == 0 ? &fine : &coarse, 1 + n, &chance->modes, excess, &isotropy);
        out->isotropy[n] = isotropy.p_value;
    }
    stationarity_measure(&map, chance->heights, &fine, &chance->modes, chance->correlation,
                         &out->stationarity);
    map_chance_destroy(&chance);
}

static void kind_measure(const struct kind *kind, uint64_t seed) {
    static double z[SIDE * SIDE] __attribute__((aligned(64))), piece[PATCH * PATCH];
    struct generator *generator = NULL;
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = kind->hurst,
                                      .wavelength_long = SIDE,
                                      .wavelength_rolloff = PATCH / 8.0,
                                      .wavelength_short = 4,
                                      .anisotropy = kind->anisotropy,
                                      .scale = SCALE_RMS_HEIGHT,
                                      .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = kind->heights;
    options.amplitudes = AMPLITUDES_RANDOM;
    options.keep = KEEP_HEIGHTS;
    count = 0;
    assert_int_equal(generator_create(&generator, &spectrum, &WHOLE, &options, NULL), 0);
    for (uint64_t r = 0; r < SURFACES * effort(); r++) {
        const struct random_key key = {seed, 0, r};
        assert_int_equal(generator_run(generator, key, z, NULL, NULL), 0);
        for (size_t p = 0; p < PATCHES; p++, count++) {
            const double *corner =
                z + p / (SIDE / PATCH) * PATCH * SIDE + p % (SIDE / PATCH) * PATCH;
            for (size_t j = 0; j < PATCH; j++)
                memcpy(piece + j * PATCH, corner + j * SIDE, PATCH * sizeof *piece);
            patch_measure(piece, kind, &patches[count]);
        }
    }
    generator_destroy(&generator);
}

/* Four standard errors of a share of the patches, of a share that is p. */
static double chance_of(double p) {
    return 4 * sqrt(p * (1 - p) / (double)count);
}

/* p-values, of which `first` is that of the first patch: as many below 0.05, 0.1, 0.25, 0.5 and
 * 0.75 as there should be, within statistical errors and 3 in 100. */
static void check_uniform(const char *what, const double *first) {
    static const double SHARES[] = {0.05, 0.1, 0.25, 0.5, 0.75};
    printf("  p-values of %s:", what);
    for (size_t s = 0; s < 5; s++) {
        double below = 0;
        for (size_t p = 0; p < count; p++)
            below += *(const double *)((const char *)first + p * sizeof *patches) < SHARES[s];
        below /= (double)count;
        printf(" %.3f below %g", below, SHARES[s]);
        check_close(below, SHARES[s], chance_of(SHARES[s]) + 0.03);
    }
    printf("\n");
}

/* True values: where known[q] is NaN the mean over the patches. */
static void check_scalars(const double *known) {
    double factor = low_modes_factor(19);
    for (size_t q = 0; q < SCALARS; q++) {
        double mean = 0, inside = 0, told = 0, spread = 0;
        for (size_t p = 0; p < count; p++)
            mean += patches[p].value[q] / (double)count;
        double truth = isnan(known[q]) ? mean : known[q];
        for (size_t p = 0; p < count; p++) {
            inside += fabs(patches[p].value[q] - truth) <= factor * patches[p].error[q];
            told += patches[p].error[q] / (double)count;
            spread += pow(patches[p].value[q] - mean, 2) / (double)(count - 1);
        }
        printf("  %-22s %9.4g +- %8.3g, told %8.3g, inside %.3f\n", NAMES[q], mean, sqrt(spread),
               told, inside / (double)count);
        check_close(inside / (double)count, 0.94, 0.05 + chance_of(0.94));
    }
}

static void gaussian_patches(void **state) {
    (void)state;
    uint64_t seed = seed_or(11);
    static const double HURSTS[] = {0.2, 0.8};
    double none = (double)NAN;
    const double known[SCALARS] = {sqrt(2 / M_PI), 1, 0, 3, none, none, none, none, none, none};
    for (size_t h = 0; h < 2; h += case_step()) {
        const struct kind kind = {.hurst = HURSTS[h], .detrend = DETREND_PLANE};
        size_t right = 0;
        kind_measure(&kind, seed);
        printf("Gaussian, H = %g, %zu patches\n", HURSTS[h], count);
        check_scalars(known);
        check_uniform("heights", &patches[0].fits.list[HEIGHTS_GAUSSIAN].p_value);
        check_uniform("isotropy, fine", &patches[0].isotropy[0]);
        check_uniform("isotropy, coarse", &patches[0].isotropy[1]);
        check_uniform("2 x 2 areas", &patches[0].stationarity.p_value[0]);
        check_uniform("4 x 4 areas", &patches[0].stationarity.p_value[1]);
        for (size_t p = 0; p < count; p++)
            right += patches[p].fits.best == HEIGHTS_GAUSSIAN;
        printf("  called Gaussian: %.3f\n", (double)right / (double)count);
        assert_true((double)right / (double)count > 0.75 - chance_of(0.75));
    }
}

/* Weibull's distribution of shape 1 is the gamma distribution of shape 1. */
static bool is_family(size_t found, const struct heights *truth) {
    return found == truth->type ||
           (truth->type == HEIGHTS_WEIBULL_MIN && truth->shape == 1 && found == HEIGHTS_GAMMA);
}

/* A plane that is taken out blurs the bound of heights of shape 1, which intervals allow for, and
 * p-values in part. */
static void shapes_found_again(void **state) {
    (void)state;
    uint64_t seed = seed_or(12);
    static const struct kind KINDS[] = {{.hurst = 0.8,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = 1}},
                                        {.hurst = 0.8,
                                         .detrend = DETREND_MEAN,
                                         .heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = 1}},
                                        {.hurst = 0.8,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = 1.5}},
                                        {.hurst = 0.5,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 2}},
                                        {.hurst = 0.8,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = 3}},
                                        {.hurst = 0.8,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 4}},
                                        {.hurst = 0.8,
                                         .detrend = DETREND_PLANE,
                                         .heights = {.type = HEIGHTS_LOGNORMAL, .shape = 0.4}}};
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k += case_step()) {
        const struct heights *truth = &KINDS[k].heights;
        double inside = 0, right = 0, mean = 0, spread = 0, missed = 0;
        kind_measure(&KINDS[k], seed + k);
        for (size_t p = 0; p < count; p++) {
            const struct height_fit *fit = &patches[p].fits.list[truth->type];
            inside += fit->shape_low <= truth->shape && truth->shape <= fit->shape_high;
            right += is_family(patches[p].fits.best, truth);
            missed += fit->p_value < 0.05;
            mean += fit->shape / (double)count;
        }
        for (size_t p = 0; p < count; p++)
            spread += pow(patches[p].fits.list[truth->type].shape - mean, 2) / (double)(count - 1);
        printf("%s, shape %g, %zu patches: %.4f +- %.3f, inside %.3f, family found %.3f, p < 0.05 "
               "in %.3f\n",
               heights_distribution(truth->type)->family, truth->shape, count, mean, sqrt(spread),
               inside / (double)count, right / (double)count, missed / (double)count);
        check_close(inside / (double)count, 0.945, 0.045 + chance_of(0.945));
        check_close(mean, truth->shape, 0.02 * truth->shape + 4 * sqrt(spread / (double)count));
        if (truth->shape < 2.5)
            assert_true(right / (double)count > 0.8 - chance_of(0.8));
        if (truth->shape > 1 || KINDS[k].detrend == DETREND_MEAN ||
            truth->type == HEIGHTS_LOGNORMAL)
            check_uniform("heights", &patches[0].fits.list[truth->type].p_value);
    }
}

/* Shares of p-values below 0.05. */
static double seen(const double *first) {
    double below = 0;
    for (size_t p = 0; p < count; p++)
        below += *(const double *)((const char *)first + p * sizeof *patches) < 0.05;
    return below / (double)count;
}

static void differences_are_seen(void **state) {
    (void)state;
    uint64_t seed = seed_or(13);
    const struct kind grooved = {.hurst = 0.8, .detrend = DETREND_PLANE, .anisotropy = 1.3};
    kind_measure(&grooved, seed);
    printf("waves 1.3 times as long along x: seen in %.3f\n", seen(&patches[0].isotropy[0]));
    assert_true(seen(&patches[0].isotropy[0]) > 0.9 - chance_of(0.9));
    const struct kind rougher = {.hurst = 0.8, .detrend = DETREND_PLANE, .rougher = 0.3};
    kind_measure(&rougher, seed);
    printf("a half rougher by 0.3: seen in %.3f and %.3f\n",
           seen(&patches[0].stationarity.p_value[0]), seen(&patches[0].stationarity.p_value[1]));
    assert_true(seen(&patches[0].stationarity.p_value[0]) > 0.9 - chance_of(0.9));
    const struct kind bowed = {.hurst = 0.8, .detrend = DETREND_PLANE, .bowed = 1};
    kind_measure(&bowed, seed);
    printf("a bow of the RMS height: seen in %.3f\n",
           seen(&patches[0].stationarity.spread[1][STATIONARY_MEAN].p_value));
    assert_true(seen(&patches[0].stationarity.spread[1][STATIONARY_MEAN].p_value) >
                0.5 - chance_of(0.5));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(gaussian_patches),
                                       cmocka_unit_test(shapes_found_again),
                                       cmocka_unit_test(differences_are_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
