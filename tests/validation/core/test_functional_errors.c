/* Protects: what one patch determines of the functional parameters of the endless surface that it
 * is a part of. Over patches cut out of larger surfaces with random amplitudes, Gaussian ones,
 * stratified faces and exponential heights, which end at a bound, the 95 % intervals hold the true
 * values as often as they say (FORMULAS.md, F18.61, F18.52). RUGO_EFFORT=20 makes 320 patches of
 * each kind. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/uncertainty/functional_errors.h"
#include "core/surface/plateau_face.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 512, PATCH = 128, PATCHES = (SIDE / PATCH) * (SIDE / PATCH) };
enum { PATCHES_MOST = PATCHES * EFFORT_MOST, QUANTILES = 400000 };
static const struct grid WHOLE = {SIDE, SIDE, SIDE, SIDE}, PIECE = {PATCH, PATCH, PATCH, PATCH};

struct kind {
    const char *name;
    double hurst;
    double rms_ratio, material_ratio; /* of the plateau; 0: none */
    enum detrend detrend;
    struct heights heights;
};

enum { SK, SPK, SVK, SMR1, SMR2, SXP, VMP, VMC, VVC, VVV, SPQ, SVQ, SMQ, SCALARS };
static const char *const NAMES[SCALARS] = {"Sk",  "Spk", "Svk", "Smr1", "Smr2", "Sxp", "Vmp",
                                           "Vmc", "Vvc", "Vvv", "Spq",  "Svq",  "Smq"};

static void take(const struct functional *f, const struct plateau_law *law, double out[SCALARS]) {
    const double values[SCALARS] = {
        f->line.k, f->line.pk, f->line.vk, f->line.mr1,      f->line.mr2,     f->xp,     f->vmp,
        f->vmc,    f->vvc,     f->vvv,     law->plateau_rms, law->valley_rms, law->ratio};
    memcpy(out, values, sizeof values);
}

static struct found { double value[SCALARS], error[SCALARS]; } patches[PATCHES_MOST];
static size_t count;

static void patch_measure(double *z, const struct kind *kind, struct found *out) {
    const struct measured_map map = {&PIECE, z, BOUNDARY_OPEN};
    struct map_chance *chance = NULL;
    struct trend trend;
    struct material_curve curve;
    struct functional found;
    struct plateau_law plateau;
    struct functional_errors errors;
    assert_int_equal(detrend(&PIECE, z, kind->detrend, &trend, NULL), 0);
    assert_int_equal(map_chance_create(&chance, &map, NULL), 0);
    assert_true(chance->told);
    assert_int_equal(material_curve_create(&curve, &map, NULL), 0);
    functional_measure(&curve, &found);
    plateau_fit(&curve, &plateau);
    assert_int_equal(functional_errors_measure(&errors, &map, &curve, chance, NULL), 0);
    if (kind->heights.type != HEIGHTS_GAUSSIAN) {
        struct height_moments moments;
        assert_int_equal(heights_moments(&kind->heights, &moments, NULL), 0);
        assert_int_equal(
            functional_errors_by_law(&errors, chance, &kind->heights, &moments, false, NULL), 0);
    }
    take(&found, &plateau, out->value);
    take(&errors.found, &errors.plateau, out->error);
    material_curve_clear(&curve);
    map_chance_destroy(&chance);
}

static void patches_cut(const double *z, const struct kind *kind) {
    static double piece[PATCH * PATCH];
    for (size_t p = 0; p < PATCHES; p++, count++) {
        const double *corner = z + p / (SIDE / PATCH) * PATCH * SIDE + p % (SIDE / PATCH) * PATCH;
        for (size_t j = 0; j < PATCH; j++)
            memcpy(piece + j * PATCH, corner + j * SIDE, PATCH * sizeof *piece);
        patch_measure(piece, kind, &patches[count]);
    }
}

static struct spectrum spectrum_of(const struct kind *kind) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = kind->hurst,
                             .wavelength_long = SIDE,
                             .wavelength_rolloff = PATCH / 8.0,
                             .wavelength_short = 4,
                             .scale = SCALE_RMS_HEIGHT,
                             .scale_value = 1};
}

/* The true values, by quantiles of the law. */
static void truth_find(const struct kind *kind, double offset, double out[SCALARS]) {
    struct material_curve curve = {.n = QUANTILES, .z = malloc(QUANTILES * sizeof(double))};
    const bool stratified = kind->rms_ratio > 0;
    const struct stratified_heights law =
        stratified_heights_of(1, stratified ? kind->rms_ratio : 1, stratified ? offset : 40);
    struct functional found;
    assert_non_null(curve.z);
    struct height_moments moments;
    assert_int_equal(heights_moments(&kind->heights, &moments, NULL), 0);
    for (size_t q = 0; q < QUANTILES; q++) {
        if (kind->heights.type != HEIGHTS_GAUSSIAN) {
            curve.z[q] = heights_quantile(&kind->heights, &moments, ((double)q + 0.5) / QUANTILES);
            continue;
        }
        double low = -8 / law.deviation, high = 8 / law.deviation;
        for (int step = 0; step < 60; step++) {
            const double middle = (low + high) / 2;
            const bool below = stratified_cdf(&law, middle) < ((double)q + 0.5) / QUANTILES;
            low = below ? middle : low;
            high = below ? high : middle;
        }
        curve.z[q] = low * law.deviation;
    }
    functional_measure(&curve, &found);
    const struct plateau_law of_law = {
        .plateau_rms = kind->rms_ratio, .valley_rms = 1, .ratio = kind->material_ratio};
    take(&found, &of_law, out);
    free(curve.z);
}

static void kind_check(const struct kind *kind, uint64_t seed) {
    static double z[SIDE * SIDE] __attribute__((aligned(64)));
    struct generator *generator = NULL;
    struct surface_options options = SURFACE_DEFAULTS;
    double truth[SCALARS];
    options.amplitudes = AMPLITUDES_RANDOM;
    options.heights = kind->heights;
    struct spectrum spectrum = spectrum_of(kind);
    struct plateau_face plateau = {.spectrum = spectrum_of(kind), .options = options};
    if (kind->rms_ratio > 0) {
        plateau.rms_ratio = kind->rms_ratio;
        plateau.offset = stratified_offset(kind->rms_ratio, kind->material_ratio);
        spectrum.plateau = &plateau;
    }
    truth_find(kind, plateau.offset, truth);
    count = 0;
    assert_int_equal(generator_create(&generator, &spectrum, &WHOLE, &options, NULL), 0);
    for (uint64_t r = 0; r < effort(); r++) {
        const struct random_key key = {seed, 0, r};
        assert_int_equal(generator_run(generator, key, z, NULL, NULL), 0);
        patches_cut(z, kind);
    }
    generator_destroy(&generator);
    printf("%s, %zu patches:", kind->name, count);
    for (size_t q = 0; q < (kind->rms_ratio > 0 ? SCALARS : SPQ); q++) {
        double inside = 0, of = 0, error = 0, spread = 0, mean = 0;
        for (size_t p = 0; p < count; p++) {
            if (isnan(patches[p].error[q]))
                continue;
            const double off = patches[p].value[q] - truth[q];
            inside += fabs(off) <= low_modes_factor(19) * patches[p].error[q];
            error += pow(patches[p].error[q], 2);
            spread += off * off;
            mean += off;
            of++;
        }
        printf(" %s %.3f (of %.0f; error/spread %.2f, bias %.2f)", NAMES[q], inside / of, of,
               sqrt(error / spread), mean / of / sqrt(spread / of));
        assert_true(of >= 0.8 * (double)count);
        const double statistical = 4 * sqrt(0.95 * 0.05 / of);
        check_close(inside / of, 0.95, statistical + 0.03);
    }
    printf("\n");
}

static void coverage(void **state) {
    static const struct kind KINDS[] = {
        {"Gaussian, H = 0.8", 0.8, 0, 0, DETREND_MEAN, {0}},
        {"Gaussian, H = 0.2, less a plane", 0.2, 0, 0, DETREND_PLANE, {0}},
        {"stratified, H = 0.8", 0.8, 0.25, 0.8, DETREND_MEAN, {0}},
        {"stratified, H = 0.2", 0.2, 0.1, 0.6, DETREND_MEAN, {0}},
        {"exponential, H = 0.8, less a plane",
         0.8,
         0,
         0,
         DETREND_PLANE,
         {.type = HEIGHTS_WEIBULL_MIN, .shape = 1}}};
    const uint64_t seed = seed_or(3);
    (void)state;
    for (size_t k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        kind_check(&KINDS[k], seed);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(coverage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
