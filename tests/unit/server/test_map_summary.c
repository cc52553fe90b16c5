/* Protects: what `characterise` prints of a map is one screen, also where all that can be wrong
 * with a map is wrong with it; its sentences follow from the values; what an instrument left is
 * named and marks what holds it; and it has no mean of 1e-18. What the screen does not show need
 * not be measured for it.
 */
#include "core/surface/surface.h"
#include "server/show/map/map_report.h"
#include "server/show/map/map_summary.h"
#include "server/show/map/map_verdicts.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 256, POINTS = SIDE * SIDE, LINES_MOST = 45, LINE_WIDTH = 120 };

static double z[POINTS];
static struct map_characterisation measured;
static struct named_values found;

static char *summary_measured(const struct height_map *map, const struct preparation_record *record,
                              enum map_extent extent) {
    const struct map_figure figure = {&measured, &found, map, record};
    struct error err = {0};
    char *text = NULL;
    size_t size = 0;
    if (map_characterise(&measured, map, record, &(struct spectrum_fit_request){0}, extent, &err) !=
            0 ||
        map_report_fill(&found, &measured, map, record, &err) != 0)
        fail_msg("%s", err.text);
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    map_summary_print(file, &figure);
    assert_int_equal(fclose(file), 0);
    named_values_clear(&found);
    map_characterisation_clear(&measured);
    return text;
}

/* Characterises the heights, of which the first `rows` rows are the map, and checks that its main
 * values alone make the same screen; the caller frees the text. */
static char *summary_of_rows(size_t rows, const struct preparation_record *record) {
    const struct height_map map = {
        .grid = {SIDE, rows, 128e-6, rows > 1 ? 128e-6 / SIDE * (double)rows : 1},
        .z = z,
        .xy_unit = "m",
        .z_unit = "m"};
    char *text = summary_measured(&map, record, MAP_MAIN);
    char *whole = summary_measured(&map, record, MAP_WHOLE);
    assert_string_equal(text, whole);
    free(whole);
    return text;
}

static char *summary_of(const struct preparation_record *record) {
    return summary_of_rows(SIDE, record);
}

static void check_screen(const char *text) {
    size_t lines = 0;
    for (const char *at = text; *at != '\0'; at++, lines++) {
        const size_t width = strcspn(at, "\n");
        if (width > LINE_WIDTH)
            fail_msg("%zu bytes: %.*s", width, (int)width, at);
        at += width;
    }
    if (lines > LINES_MOST)
        fail_msg("%zu lines: %s", lines, text);
}

static void expect(const char *text, const char *const *words) {
    for (; *words != NULL; words++)
        if (strstr(text, *words) == NULL)
            fail_msg("no '%s' in %s", *words, text);
}

/* Heights of a known mean of rounding, correlated over a few points by sums of neighbours. */
static void fill_smooth(uint64_t seed, double along_x) {
    static double white[POINTS];
    noise_fill(&seed, POINTS, white);
    const int reach_x = (int)(3 * along_x), reach_y = 3;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            double sum = 0;
            for (int b = -reach_y; b <= reach_y; b++)
                for (int a = -reach_x; a <= reach_x; a++)
                    sum += white[(j + b + SIDE) % SIDE * SIDE + (i + a + SIDE) % SIDE] *
                           (reach_x + 1 - abs(a)) * (reach_y + 1 - abs(b));
            z[j * SIDE + i] = 1e-9 * sum;
        }
}

static void a_clean_map_is_one_screen(void **state) {
    (void)state;
    struct preparation_record record = {
        .boundary = BOUNDARY_PERIODIC, .boundary_by = "option", .window_power = 1};
    preparation_note(&record, "file", "patch.x3p");
    preparation_note(&record, "bytes", "114518");
    preparation_note(&record, "format", "x3p");
    fill_smooth(3, 1);
    char *text = summary_of(&record);
    check_screen(text);
    static const char HEAD[] =
        "patch.x3p: x3p, 114518 bytes\n256 by 256 points, 0.5 \xc2\xb5m apart, 128 by 128 "
        "\xc2\xb5m; periodic; no holes\nprepared: as it was read\n";
    expect(text, (const char *const[]){
                     HEAD, "RMS height Sq", " +- ", "Errors: +- one standard error",
                     "Directions: none differs (p-value ", "Parts: none differs (p-value ",
                     "Heights: Gaussian holds (p-value ",
                     "more: --all, --format json, or --group of preparation map grid",
                     "quantiles\n", NULL});
    assert_null(strstr(text, "e-1")); /* neither a mean nor a p-value that is 0 but for rounding */
    free(text);
}

/* Spikes, a lay, a form and a long history. */
static void faults_fit_on_it_too(void **state) {
    (void)state;
    struct preparation_record record = {
        .boundary = BOUNDARY_OPEN, .boundary_by = "option", .window_power = 1, .holes = 0.125};
    const char *const names[] = {"file", "unpacked", "converted", "format", "columns",
                                 "crop", "detrend",  "fill",      "filter", "resample"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        preparation_note(&record, names[n], "%060d", 7);
    fill_smooth(5, 3);
    for (int n = 0; n < POINTS; n++)
        z[n] *= n < POINTS / 2 ? 1 : 1.5;
    for (int n = 0; n < 40; n++)
        z[(997 * n * n + 31 * n) % POINTS] += 3e-6; /* no lattice */
    char *text = summary_of(&record);
    check_screen(text);
    expect(text, (const char *const[]){"; open; 12.5 % not measured\n", "Heights: kurtosis ",
                                       "Directions: they differ (p-value ", " times as long at ",
                                       "Parts: they differ (p-value ", NULL});
    free(text);
}

/* Noise of a fiftieth of the height makes curvatures several times as large: values without it
 * stand below those with it, and a sentence says so. */
static void noise_is_named(void **state) {
    (void)state;
    static double white[POINTS];
    const struct preparation_record record = {
        .boundary = BOUNDARY_OPEN, .boundary_by = "option", .window_power = 1};
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.8,
                                 .wavelength_long = SIDE,
                                 .wavelength_rolloff = 32,
                                 .wavelength_short = 8,
                                 .scale = SCALE_RMS_HEIGHT,
                                 .scale_value = 1e-7};
    const struct grid grid = {SIDE, SIDE, SIDE, SIDE};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    uint64_t seed = 8;
    double square = 0;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, &grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){6, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    for (int n = 0; n < POINTS; n++)
        square += z[n] * z[n] / POINTS;
    noise_fill(&seed, POINTS, white);
    for (int n = 0; n < POINTS; n++)
        z[n] += 0.02 * sqrt(square) * white[n];
    char *text = summary_of(&record);
    check_screen(text);
    expect(text, (const char *const[]){"RMS slope", "\n    without noise ", "RMS curvature",
                                       "\n    without noise ", "Noise: the RMS slope is ", NULL});
    free(text);
}

/* Steps, spikes and scan lines together: a sentence each with the option that takes it out, slopes
 * without each, marks on what holds them, and still one screen; of every second column likewise. */
static void what_instruments_left_is_named(void **state) {
    (void)state;
    struct height_map map = {
        .grid = {SIDE, SIDE, 128e-6, 128e-6}, .z = z, .xy_unit = "m", .z_unit = "m"};
    struct error err = {0};
    for (int columns = 0; columns < 2; columns++) {
        struct preparation asked = {.boundary = ASK_BOUNDARY_OPEN, .artefacts = true};
        struct preparation_record record = {0};
        uint64_t seed = 4;
        double offsets[SIDE];
        noise_fill(&seed, SIDE, offsets);
        fill_smooth(9, 1);
        for (int n = 0; n < POINTS && columns == 0; n++)
            z[n] = 1e-9 * round(1e9 * z[n] / 8 + 2 * offsets[n / SIDE]) * 8;
        for (int n = 0; n < 20 && columns == 0; n++)
            z[(2711 * n + 99) % POINTS] += 2000e-9;
        for (int n = 0; n < POINTS && columns == 1; n++)
            if (n % SIDE % 2 == 1 && n % SIDE + 1 < SIDE)
                z[n] = (z[n - 1] + z[n + 1]) / 2;
        assert_int_equal(preparation_run(&record, &map, &asked, &err), 0);
        char *text = summary_of(&record);
        check_screen(text);
        if (columns == 0)
            expect(text,
                   (const char *const[]){
                       "\n* RMS height Sq ", "\n* mean height Sa ", "\n* skewness ",
                       "\n* kurtosis ", "\n* RMS slope ", "\n    without artefacts, about ",
                       "\n* correlation length Sal ", "\n* Hurst exponent H ",
                       "\nSteps: heights are multiples of 8 nm, which ", "--denoise takes",
                       "\nSpikes: 20, up to ", "--despike --fill.", "\nLines: along x, offsets ",
                       "--lines median.", "\nRows marked * hold these", NULL});
        else
            expect(text,
                   (const char *const[]){"\n* RMS slope ", "Columns: 127 of 256 are on a line ",
                                         "--stride 2,1 leaves them out.", NULL});
        assert_null(strstr(text, "Heights: kurtosis"));
        free(text);
    }
}

/* A wave of the side of the map has no errors, which the sentences say. */
static void what_is_unknown_is_said(void **state) {
    (void)state;
    const struct preparation_record record = {
        .boundary = BOUNDARY_PERIODIC, .boundary_by = "option", .window_power = 1};
    for (int n = 0; n < POINTS; n++)
        z[n] = 1e-7 * cos(2 * M_PI * (n % SIDE) / SIDE);
    char *text = summary_of(&record);
    check_screen(text);
    expect(text, (const char *const[]){"Errors: none are known: along some direction",
                                       "without errors there is no p-value", NULL});
    assert_null(strstr(text, "Directions"));
    free(text);
}

/* Of what the screen does not show nothing is measured, and no number stands for it. */
static void the_rest_is_left_out(void **state) {
    (void)state;
    const struct preparation_record record = {
        .boundary = BOUNDARY_OPEN, .boundary_by = "option", .window_power = 1};
    const struct height_map map = {
        .grid = {SIDE, SIDE, 128e-6, 128e-6}, .z = z, .xy_unit = "m", .z_unit = "m"};
    const struct spectrum_fit_request trusted = {0};
    fill_smooth(12, 1);
    assert_int_equal(map_characterise(&measured, &map, &record, &trusted, MAP_MAIN, NULL), 0);
    assert_true(isfinite(measured.areal.sdr) && isfinite(measured.errors.slope));
    assert_true(measured.spectra.has_fit && measured.spectra.rings.count > 1);
    assert_true(isnan(measured.areal.spd) && isnan(measured.functional.plateau.ratio));
    assert_true(isnan(measured.functional.found.line.k) && isnan(measured.parameters.moments.m2));
    assert_true(isnan(measured.parameters.summits[SUMMITS_REFINED].density));
    assert_true(isnan(measured.spectra.rings.density[1]));
    assert_true(measured.quantiles.count > 1 && isnan(measured.quantiles.y[1]));
    assert_true(measured.correlation.count > 1 && isnan(measured.correlation.y[1]));
    assert_int_equal(measured.scales.count, 0);
    map_characterisation_clear(&measured);
}

/* One of a profile, and one under a window of its own, too. */
static void profiles_and_windows_have_the_same_screen(void **state) {
    (void)state;
    struct preparation_record record = {
        .boundary = BOUNDARY_OPEN, .boundary_by = "option", .window_power = 1};
    fill_smooth(13, 1);
    char *text = summary_of_rows(1, &record);
    check_screen(text);
    expect(text, (const char *const[]){"profile of 256 points", "peak density", NULL});
    free(text);
    record.window_power = 0.4;
    text = summary_of(&record);
    expect(text, (const char *const[]){"the map is under a window", "summit density", NULL});
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rest_is_left_out),
        cmocka_unit_test(profiles_and_windows_have_the_same_screen),
        cmocka_unit_test(a_clean_map_is_one_screen),
        cmocka_unit_test(faults_fit_on_it_too),
        cmocka_unit_test(noise_is_named),
        cmocka_unit_test(what_instruments_left_is_named),
        cmocka_unit_test(what_is_unknown_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
