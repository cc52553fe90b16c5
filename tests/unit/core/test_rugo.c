/* Protects: the public functions of rugo.h: that each kind of spectrum, height, rule and model is
 * the one that its name says, what is reported of wrong arguments, and that outputs stay untouched
 * then. */
#include "core/full/full.h"
#include "core/rugo.h"
#include "core/surface/surface.h"
#include "core/theory/contact.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const struct rugo_grid SQUARE = {64, 64, 1, 1};
enum { POINTS = 64 * 64 };

/* Heights of realisation 3 of seed 11. */
static void generate(const struct rugo_surface_options *options, double *z,
                     struct rugo_surface_report *report) {
    struct rugo_spectrum spectrum = rugo_spectrum_self_affine(0.8, 0.5, 0.125, 0.1);
    struct rugo_generator *generator = NULL;
    struct rugo_error err = {0};
    assert_int_equal(rugo_generator_create(&generator, &spectrum, &SQUARE, options, &err), 0);
    assert_int_equal(rugo_generator_run(generator, 11, 0, 3, z, report, &err), 0);
    rugo_generator_destroy(&generator);
    assert_null(generator);
    rugo_generator_destroy(&generator);
}

static double skewness_of(const double *z) {
    struct rugo_roughness roughness;
    assert_int_equal(rugo_roughness(&SQUARE, z, &roughness, NULL), 0);
    return roughness.skewness;
}

static double exponential_quantile(double probability, const void *context) {
    return -*(const double *)context * log1p(-probability);
}

static void a_surface_is_the_librarys(void **state) {
    (void)state;
    static double z[POINTS], inner[POINTS];
    struct rugo_surface_report report;
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = 0.125,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 0.1};
    struct grid grid = {64, 64, 1, 1};
    struct generator *generator = NULL;
    struct error err = {0};
    generate(NULL, z, &report);
    assert_int_equal(report.iterations, 0);
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, &err), 0);
    assert_int_equal(generator_run(generator, (struct random_key){11, 0, 3}, inner, NULL, &err), 0);
    generator_destroy(&generator);
    assert_memory_equal(z, inner, sizeof z);
}

/* Weibull with C = 1 has the skewness 2 at its minimum, -2 at its maximum; an exponential
 * distribution is the first. Measured: within 0.02 on these points. */
static void heights_are_those_named(void **state) {
    (void)state;
    static double z[POINTS];
    struct rugo_surface_options options = rugo_surface_defaults();
    struct rugo_surface_report report;
    double scale = 5;
    options.keep_heights = 1;
    options.heights = RUGO_WEIBULL_MIN;
    generate(&options, z, &report);
    assert_true(report.iterations > 0);
    check_close(skewness_of(z), 2, 0.3);
    options.heights = RUGO_WEIBULL_MAX;
    generate(&options, z, &report);
    check_close(skewness_of(z), -2, 0.3);
    options.heights = RUGO_LOGNORMAL; /* (e^(s^2) + 2) sqrt(e^(s^2) - 1) = 0.95 for s = 0.3 */
    options.shape = 0.3;
    generate(&options, z, &report);
    assert_true(report.iterations > 0);
    check_close(skewness_of(z), 0.95, 0.15);
    options.heights = RUGO_GAMMA; /* 2/sqrt(4) */
    options.shape = 4;
    generate(&options, z, NULL);
    check_close(skewness_of(z), 1, 0.15);
    options.heights = RUGO_BETA; /* 2 (b - a) sqrt(a + b + 1)/((a + b + 2) sqrt(a b)) */
    options.shape = 2;
    options.second_shape = 5;
    generate(&options, z, NULL);
    check_close(skewness_of(z), 0.596, 0.1);
    options.heights = RUGO_QUANTILE;
    options.quantile = exponential_quantile;
    options.quantile_context = &scale;
    generate(&options, z, NULL);
    check_close(skewness_of(z), 2, 0.3);
}

static void spectra_are_those_named(void **state) {
    (void)state;
    static const double K[] = {1, 190}, DENSITY[] = {1, 1};
    struct rugo_spectrum spectrum = rugo_spectrum_self_affine(0.8, 0.5, 0.125, 0.1);
    struct rugo_moments moments;
    struct rugo_error err = {0};
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &moments, &err), 0);
    check_relative(moments.rms_slope, 0.1, 1e-12);
    check_relative(moments.nayak_alpha, moments.m0 * moments.m4 / (moments.m2 * moments.m2), 1e-12);
    double narrow = moments.nayak_alpha;
    spectrum.rms_slope = 0;
    spectrum.rms_height = 3;
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &moments, &err), 0);
    check_relative(moments.rms_height, 3, 1e-12);
    check_relative(moments.nayak_alpha, narrow, 1e-12);
    spectrum.type = RUGO_EXPONENTIAL_ACF; /* not band-limited: fills the grid */
    spectrum.correlation_x = spectrum.correlation_y = 0.2;
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &moments, &err), 0);
    assert_true(moments.nayak_alpha > 2 * narrow);
    /* White over the disc |k| < 190: the mean of kx^2 is 190^2/4, but for the waves at its rim. */
    spectrum.type = RUGO_TABLE;
    spectrum.table_count = 2;
    spectrum.table_wave_number = K;
    spectrum.table_density = DENSITY;
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &moments, &err), 0);
    check_relative(moments.m2 / moments.m0, 190.0 * 190 / 4, 0.06);
    double ratio = 0;
    assert_int_equal(rugo_ratio_of_alpha(2, 0.8, 1, 10, &ratio, &err), 0);
    check_relative(rugo_alpha_of_ratio(2, 0.8, ratio, 1), 10, 1e-9);
}

static void a_map_tells_what_it_is_made_of(void **state) {
    (void)state;
    static double z[POINTS], fine[4 * POINTS], k[64], density[64];
    const struct rugo_grid finer = {128, 128, 1, 1};
    struct rugo_spectrum spectrum = rugo_spectrum_self_affine(0.8, 0.5, 0.125, 0.1);
    struct rugo_moments expected, moments;
    struct rugo_error err = {0};
    struct rugo_summits nine = {0}, five = {0}, refined = {0};
    generate(NULL, z, NULL);
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &expected, &err), 0);
    assert_int_equal(rugo_resample(&SQUARE, z, &finer, 8, 8, fine, &err), 0);
    check_relative(fine[2 * 128 * 5 + 2 * 7], z[64 * 5 + 7], 1e-9);
    assert_int_equal(rugo_moments(&finer, fine, &moments, &err), 0);
    check_relative(moments.m4, expected.m4, 1e-9);
    assert_in_range(rugo_psd_size(&SQUARE), 16, 64);
    assert_int_equal(rugo_psd(&SQUARE, z, k, density, &err), 0);
    assert_true(density[3] > 0 && density[20] < 1e-12 * density[3]);
    assert_int_equal(rugo_summits_find(&nine, &SQUARE, z, RUGO_NINE_POINT, &err), 0);
    assert_int_equal(rugo_summits_find(&five, &SQUARE, z, RUGO_FIVE_POINT, &err), 0);
    assert_int_equal(rugo_summits_find(&refined, &SQUARE, z, RUGO_REFINED, &err), 0);
    assert_true(five.count > nine.count && nine.count > 10 && refined.count > 10);
    assert_true(refined.summits[0].curvature > 0);
    /* about 20 summits: a count is good to its square root */
    check_close((double)refined.count, rugo_nayak_summit_density(expected.m2, expected.m4), 14);
    rugo_summits_clear(&nine);
    rugo_summits_clear(&five);
    rugo_summits_clear(&refined);
    assert_null(refined.summits);
    assert_int_equal(rugo_map_write("z.npy", &SQUARE, z, &err), 0);
    struct rugo_map map = {.z = NULL};
    assert_int_equal(rugo_map_read(&map, "z.npy", 1.0 / 64, &err), 0);
    assert_int_equal(map.grid.nx, 64);
    check_relative(map.grid.ly, 1, 1e-12);
    assert_memory_equal(map.z, z, sizeof z);
    rugo_map_clear(&map);
    assert_null(map.z);
}

/* Pressing without a surface is refused with a word on how to give one. */
static void check_nothing_begun(struct rugo_contact *contact) {
    struct rugo_contact_state now = {.area = 7};
    struct rugo_error err = {0};
    assert_int_equal(rugo_contact_press(contact, 0.01, &now, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "rugo_contact_begin"));
    assert_true(now.area == 7);
    assert_true(isnan(rugo_contact_full_pressure(contact)));
}

/* One wave on a half-space is Westergaard's; a finite block is stiffer in its face's waves. */
static void models_are_those_named(void **state) {
    (void)state;
    const struct rugo_grid line = {128, 1, 1, 1};
    double z[128], area[3];
    struct rugo_error err = {0};
    for (int i = 0; i < 128; i++)
        z[i] = 0.01 * cos(2 * M_PI * i / 128);
    double full = M_PI * 0.01, height = z[5];
    for (int model = RUGO_HALFSPACE; model <= RUGO_FULL; model++) {
        struct rugo_block block = rugo_block_defaults((enum rugo_model)model, &line);
        struct rugo_contact *contact = NULL;
        struct rugo_contact_state now;
        assert_int_equal(rugo_contact_create(&contact, &line, &block, &err), 0);
        check_nothing_begun(contact);
        z[5] = NAN;
        assert_int_equal(rugo_contact_begin(contact, z, &err), RUGO_ERROR_INPUT);
        check_nothing_begun(contact);
        z[5] = height;
        assert_int_equal(rugo_contact_begin(contact, z, &err), 0);
        assert_int_equal(rugo_contact_press(contact, 0.3 * full, &now, &err), 0);
        area[model] = now.area;
        assert_int_equal(now.patches, 1);
        check_relative(now.pressure, 0.3 * full, 1e-12);
        assert_true(now.p[0] > 0 && now.p[64] == 0 && now.gap[64] > 0 && now.mean_gap > 0);
        assert_true(now.area_lower < now.area && now.area < now.area_upper);
        assert_true(now.stiffness > 0 && isfinite(now.stiffness) && now.iterations > 0);
        if (model == RUGO_HALFSPACE)
            check_relative(rugo_contact_full_pressure(contact), full, 1e-6);
        assert_true(isnan(rugo_contact_full_pressure(contact)) == (model == RUGO_FULL));
        assert_int_equal(rugo_contact_press(contact, -1, &now, &err), RUGO_ERROR_INPUT);
        assert_non_null(strstr(err.text, "must be 0 or more, not -1"));
        rugo_contact_destroy(&contact);
        rugo_contact_destroy(&contact);
    }
    check_relative(area[RUGO_HALFSPACE], rugo_westergaard_area(0.3), 2e-3);
    check_relative(area[RUGO_LAYERED], area[RUGO_HALFSPACE], 0.02);
    check_relative(area[RUGO_FULL], area[RUGO_HALFSPACE], 0.05);
    assert_true(area[RUGO_FULL] != area[RUGO_LAYERED]);
}

/* Areas of the full model are as those of studies, under load (F14.6): a count of nodes is
 * stretched as they are, and what they cover more is taken from the open face, which tiles the
 * cell. */
static void areas_of_full_are_those_under_load(void **state) {
    (void)state;
    const struct rugo_grid line = {64, 1, 1, 1};
    const struct grid cell = {64, 1, 1, 1};
    struct rugo_block block = rugo_block_defaults(RUGO_FULL, &line);
    struct block same = {.model = MODEL_LAYERED,
                         .height = block.height,
                         .layer_growth = block.layer_growth,
                         .weighting = GAP_STANDARD};
    struct rugo_contact *contact = NULL;
    struct rugo_contact_state now;
    struct rugo_error err = {0};
    struct full *full = NULL;
    struct contact_state pressed;
    struct full_report report;
    struct error why = {0};
    double z[64];
    block.poisson = 0;
    for (int i = 0; i < 64; i++)
        z[i] = 0.05 * cos(2 * M_PI * i / 64);
    assert_int_equal(rugo_contact_create(&contact, &line, &block, &err), 0);
    assert_int_equal(rugo_contact_begin(contact, z, &err), 0);
    assert_int_equal(rugo_contact_press(contact, 0.05, &now, &err), 0);
    assert_int_equal(full_create(&full, &cell, &same, &FULL_DEFAULTS, &why), 0);
    assert_int_equal(full_begin(full, z, &why), 0);
    assert_int_equal(full_press(full, 0.05, &pressed, &report, &why), 0);
    double nodes = (double)pressed.nodes / 64;
    assert_true(report.stretch < 0.99);
    check_relative(now.area_nodes, report.stretch * nodes, 1e-12);
    /* Edges lie between the nodes in contact and those beside them. */
    assert_true(now.area < now.area_nodes &&
                now.area > report.stretch * (nodes - 2.0 / 64) - 1.0 / 64);
    assert_int_equal(rugo_contact_press(contact, 0, &now, &err), 0);
    assert_true(now.area == 0 && now.area_nodes == 0 && now.area_lower == 0);
    full_destroy(&full);
    rugo_contact_destroy(&contact);
}

/* As of studies, so that a map and its transpose have one block. */
static void blocks_are_as_high_as_the_longer_side_has_it(void **state) {
    (void)state;
    const struct rugo_grid lying = {64, 16, 4, 1}, standing = {16, 64, 1, 4}, line = {64, 1, 2, 5};
    assert_true(rugo_block_defaults(RUGO_LAYERED, &lying).height == 6);
    assert_true(rugo_block_defaults(RUGO_FULL, &standing).height == 6);
    assert_true(rugo_block_defaults(RUGO_FULL, &line).height == 3);
    assert_true(isinf(rugo_block_defaults(RUGO_HALFSPACE, &standing).height));
}

static void theories_are_those_named(void **state) {
    (void)state;
    assert_true(rugo_persson_area(0.1) == persson_area(0.1));
    assert_true(rugo_persson_pressure_pdf(0.2, 0.1) == persson_pressure_pdf(0.2, 0.1));
    assert_true(rugo_bgt_area(0.1, 5) == bgt_area(0.1, 5));
    assert_true(rugo_gw_mccool_area(0.1, 5) == gw_mccool_area(0.1, 5));
    assert_true(rugo_westergaard_pressure(0.01, 0.3) == westergaard_pressure(0.01, 0.3));
    assert_true(rugo_westergaard_gap(0.3) == westergaard_gap(0.3));
    check_close(rugo_nayak_summit_pdf(1, 5), 0.44058983, 1e-8); /* F6.9 of FORMULAS.md */
    check_close(rugo_nayak_joint_pdf(1, -2.5, 5), 0.21168776, 1e-8);
    check_close(rugo_nayak_mean_curvature(2, 5), 1.72353316, 1e-8);
    check_close(rugo_nayak_summit_cdf(20, 5), 1, 1e-12);
    assert_true(isnan(rugo_bgt_area(0.1, 1)));
    check_relative(rugo_nayak_summit_density(1, 1), 1 / (6 * M_PI * sqrt(3)), 1e-15);
    static const double OUTSIDE[][2] = {{-1, 1},  {0, 1},   {1, -1},
                                        {NAN, 1}, {1, NAN}, {1, INFINITY}};
    for (size_t m = 0; m < sizeof OUTSIDE / sizeof *OUTSIDE; m++)
        assert_true(isnan(rugo_nayak_summit_density(OUTSIDE[m][0], OUTSIDE[m][1])));
    assert_string_equal(rugo_version(), RUGO_VERSION);
}

static void wrong_arguments_are_told(void **state) {
    (void)state;
    const struct rugo_grid empty = {0, 1, 1, 1};
    struct rugo_spectrum spectrum = rugo_spectrum_self_affine(0.8, 0.5, 0.001, 0.1);
    struct rugo_surface_options options = rugo_surface_defaults();
    struct rugo_block block = rugo_block_defaults(RUGO_LAYERED, &SQUARE);
    struct rugo_generator *generator = NULL;
    struct rugo_contact *contact = NULL;
    struct rugo_summits summits = {0};
    struct rugo_map map = {.z = NULL};
    struct rugo_moments moments = {.m0 = 7};
    struct rugo_error err = {0};
    static double z[POINTS];
    assert_int_equal(rugo_generator_create(&generator, &spectrum, &SQUARE, NULL, &err),
                     RUGO_ERROR_INPUT);
    assert_int_equal(err.code, RUGO_ERROR_INPUT);
    assert_true(strlen(err.text) > 20);
    spectrum.wavelength_short = 0.125;
    spectrum.rms_height = 1;
    assert_int_equal(rugo_spectrum_moments(&spectrum, &SQUARE, &moments, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "one must be above 0"));
    assert_true(moments.m0 == 7);
    spectrum.rms_height = 0;
    options.heights = RUGO_QUANTILE;
    assert_int_equal(rugo_generator_create(&generator, &spectrum, &SQUARE, &options, &err),
                     RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no function"));
    block.poisson = 0.7;
    assert_int_equal(rugo_contact_create(&contact, &SQUARE, &block, &err), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_summits_find(&summits, &empty, z, RUGO_NINE_POINT, &err),
                     RUGO_ERROR_INPUT);
    assert_int_equal(rugo_psd_size(&empty), 0);
    assert_int_equal(rugo_map_read(&map, "absent.npy", 0, &err), RUGO_ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "absent.npy: No such file"));
    assert_int_equal(rugo_map_read(&map, "map.txt", 0, NULL), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_map_write("no/such/folder/z.csv", &SQUARE, z, &err), RUGO_ERROR_SYSTEM);
    assert_null(generator);
    assert_null(contact);
    assert_null(map.z);
}

static void a_ratio_is_not_sought_for_wrong_arguments(void **state) {
    (void)state;
    static const struct {
        int dimension, code;
        double hurst, rolloff, alpha;
        const char *text;
    } WRONG[] = {
        {3, RUGO_ERROR_INPUT, 0.8, 1, 10, "the dimension must be 1 or 2, not 3"},
        {2, RUGO_ERROR_INPUT, NAN, 1, 10, "hurst must be in [0, 1], not nan"},
        {2, RUGO_ERROR_INPUT, 1.5, 1, 10, "hurst must be in [0, 1], not 1.5"},
        {2, RUGO_ERROR_INPUT, 0.8, 0.5, 10, "rolloff must be finite and 1 or more, not 0.5"},
        {2, RUGO_ERROR_INPUT, 0.8, 1, NAN, "alpha must be finite, not nan"},
        {2, RUGO_ERROR_NUMERIC, 0.8, 1, 1.2, "allowed: 1.5 to "},
    };
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        double ratio = 7;
        struct rugo_error err = {0};
        assert_int_equal(rugo_ratio_of_alpha(WRONG[w].dimension, WRONG[w].hurst, WRONG[w].rolloff,
                                             WRONG[w].alpha, &ratio, &err),
                         WRONG[w].code);
        assert_int_equal(err.code, WRONG[w].code);
        assert_non_null(strstr(err.text, WRONG[w].text));
        assert_true(ratio == 7);
    }
}

/* Programs are compiled with these numbers: an entry of rugo_lists.h never gets another. */
static void values_of_choices_stay(void **state) {
    (void)state;
    assert_int_equal(RUGO_SELF_AFFINE, 0);
    assert_int_equal(RUGO_EXPONENTIAL_ACF, 1);
    assert_int_equal(RUGO_TABLE, 2);
    assert_int_equal(RUGO_GAUSSIAN, 0);
    assert_int_equal(RUGO_WEIBULL_MIN, 1);
    assert_int_equal(RUGO_WEIBULL_MAX, 2);
    assert_int_equal(RUGO_QUANTILE, 3);
    assert_int_equal(RUGO_LOGNORMAL, 4);
    assert_int_equal(RUGO_GAMMA, 5);
    assert_int_equal(RUGO_BETA, 6);
    assert_int_equal(RUGO_NINE_POINT, 0);
    assert_int_equal(RUGO_FIVE_POINT, 1);
    assert_int_equal(RUGO_REFINED, 2);
    assert_int_equal(RUGO_MEAN, 0);
    assert_int_equal(RUGO_PLANE, 1);
    assert_int_equal(RUGO_QUADRATIC, 2);
    assert_int_equal(RUGO_HALFSPACE, 0);
    assert_int_equal(RUGO_LAYERED, 1);
    assert_int_equal(RUGO_FULL, 2);
}

/* The message of a number that no list has names the number. */
static void unknown_choices_are_named(void **state) {
    (void)state;
    struct rugo_spectrum spectrum = rugo_spectrum_self_affine(0.8, 0.5, 0.125, 0.1);
    struct rugo_surface_options options = rugo_surface_defaults();
    struct rugo_block block = rugo_block_defaults(RUGO_HALFSPACE, &SQUARE);
    struct rugo_generator *generator = NULL;
    struct rugo_contact *contact = NULL;
    struct rugo_summits summits = {0};
    struct rugo_error err = {0};
    static double z[POINTS];
    options.heights = (enum rugo_heights_type)7;
    assert_int_equal(rugo_generator_create(&generator, &spectrum, &SQUARE, &options, &err),
                     RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no distribution of heights of type 7"));
    spectrum.type = (enum rugo_spectrum_type)3;
    assert_int_equal(rugo_generator_create(&generator, &spectrum, &SQUARE, NULL, &err),
                     RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no spectrum of type 3"));
    block.model = (enum rugo_model)3;
    assert_int_equal(rugo_contact_create(&contact, &SQUARE, &block, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no contact model 3"));
    assert_int_equal(rugo_detrend(&SQUARE, z, (enum rugo_trend)3, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no trend 3"));
    assert_int_equal(rugo_summits_find(&summits, &SQUARE, z, (enum rugo_summit_rule)3, &err),
                     RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "no rule 3"));
}

/* Programs in other languages have no other source of the enumerations. */
static void choices_have_their_names(void **state) {
    (void)state;
    int value = -1;
    assert_string_equal(rugo_choice("spectra", 0, &value), "self_affine");
    assert_int_equal(value, RUGO_SELF_AFFINE);
    assert_string_equal(rugo_choice("distributions", 3, &value), "lognormal");
    assert_int_equal(value, RUGO_LOGNORMAL);
    assert_string_equal(rugo_choice("summit_rules", 2, &value), "refined");
    assert_int_equal(value, RUGO_REFINED);
    assert_string_equal(rugo_choice("trends", 1, NULL), "plane");
    assert_string_equal(rugo_choice("models", 2, &value), "full");
    assert_int_equal(value, RUGO_FULL);
    assert_null(rugo_choice("models", 3, &value));
    assert_null(rugo_choice("models", SIZE_MAX, &value));
    assert_null(rugo_choice("colours", 0, &value));
    assert_int_equal(value, RUGO_FULL);
}

/* rugo.h promises it: a failure comes before the first height is written. */
static void a_map_that_cannot_be_sampled_is_left_alone(void **state) {
    (void)state;
    static const double Z[64];
    static const struct rugo_grid GRID = {64, 1, 1, 1}, COARSE = {8, 1, 1, 1};
    double out[8] = {7, 7, 7, 7, 7, 7, 7, 7};
    struct rugo_error err = {0};
    assert_int_equal(rugo_resample(&GRID, Z, &COARSE, 5, 0, out, &err), RUGO_ERROR_INPUT);
    for (size_t i = 0; i < 8; i++)
        assert_true(out[i] == 7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_is_the_librarys),
        cmocka_unit_test(heights_are_those_named),
        cmocka_unit_test(spectra_are_those_named),
        cmocka_unit_test(a_map_tells_what_it_is_made_of),
        cmocka_unit_test(models_are_those_named),
        cmocka_unit_test(areas_of_full_are_those_under_load),
        cmocka_unit_test(blocks_are_as_high_as_the_longer_side_has_it),
        cmocka_unit_test(theories_are_those_named),
        cmocka_unit_test(wrong_arguments_are_told),
        cmocka_unit_test(a_ratio_is_not_sought_for_wrong_arguments),
        cmocka_unit_test(a_map_that_cannot_be_sampled_is_left_alone),
        cmocka_unit_test(values_of_choices_stay),
        cmocka_unit_test(unknown_choices_are_named),
        cmocka_unit_test(choices_have_their_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
