/* Protects: the page about a measured surface has every part, in units that read well; its table
 * says what the characterisation says; names are text, never markup; and maps that have nothing to
 * draw, or holes, or one row, are drawn all the same. */
#include "schema/json/json.h"
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/map_report.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/noise.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct page {
    struct height_map map;
    struct preparation asked;
    struct preparation_record record;
    struct map_characterisation measured;
    struct named_values found;
    char *text;
};

/* A sum of waves, in metres where unit is "m". */
static void make(struct page *page, size_t nx, size_t ny, double height, const char *unit) {
    struct error err = {0};
    *page = (struct page){0};
    assert_int_equal(height_map_shape(&page->map, ny, nx, *unit != '\0' ? 0.5e-6 : 1, &err), 0);
    page->map.z = array_create(nx * ny, sizeof *page->map.z);
    assert_non_null(page->map.z);
    snprintf(page->map.xy_unit, sizeof page->map.xy_unit, "%s", unit);
    snprintf(page->map.z_unit, sizeof page->map.z_unit, "%s", unit);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            page->map.z[j * nx + i] =
                height * (sin(0.7 * (double)i + 0.2 * (double)j) + cos(0.13 * (double)(i * j)));
    preparation_note(&page->record, "file", "%s", "a <b> & c.x3p");
    preparation_note(&page->record, "sha256", "%s", "0123abcd");
}

static void draw(struct page *page) {
    struct error err = {0};
    size_t size = 0;
    assert_int_equal(preparation_run(&page->record, &page->map, &page->asked, &err), 0);
    assert_int_equal(map_characterise(&page->measured, &page->map, &page->record,
                                      &(struct spectrum_fit_request){0}, MAP_WHOLE, &err),
                     0);
    assert_int_equal(
        map_report_fill(&page->found, &page->measured, &page->map, &page->record, &err), 0);
    const struct map_figure figure = {&page->measured, &page->found, &page->map, &page->record};
    FILE *file = open_memstream(&page->text, &size);
    assert_non_null(file);
    assert_int_equal(map_figure_draw(&figure, file, &err), 0);
    assert_int_equal(fclose(file), 0);
    assert_non_null(strstr(page->text, "</svg>\n"));
    assert_int_equal(count_of(page->text, "nan\""), 0); /* no number of an attribute */
    assert_int_equal(count_of(page->text, "inf"), 0);
    assert_int_equal(count_of(page->text, "<text"), count_of(page->text, "</text>"));
    assert_int_equal(count_of(page->text, "<b>"), 0);
    assert_true(count_of(page->text, "a &lt;b&gt; &amp; c.x3p<") == 1);
    static const char *const PARTS[] = {"Heights<", "Power spectral density<",
                                        "RMS slope by distance<", "RMS curvature by distance<",
                                        "SHA-256 0123abcd<"};
    for (size_t n = 0; n < sizeof PARTS / sizeof *PARTS; n++)
        assert_int_equal(count_of(page->text, PARTS[n]), 1);
}

static void clear(struct page *page) {
    named_values_clear(&page->found);
    map_characterisation_clear(&page->measured);
    height_map_clear(&page->map);
    free(page->text);
}

static void lengths_are_in_readable_units(void **state) {
    (void)state;
    struct page page;
    char row[64];
    make(&page, 48, 32, 30e-9, "m");
    draw(&page);
    snprintf(row, sizeof row, ">%.4g nm<", 1e9 * named_number(&page.found, "heights", "rms"));
    assert_true(count_of(page.text, row) >= 1);
    snprintf(row, sizeof row, ">%.4g 1/\xc2\xb5m<",
             1e-6 * named_number(&page.found, "finite_difference", "rms_curvature"));
    assert_int_equal(count_of(page.text, row), 1);
    assert_int_equal(count_of(page.text, ">5 \xc2\xb5m<"), 1); /* the bar beside 24 of them */
    assert_int_equal(count_of(page.text, "48 \xc3\x97 32 points, 0.5 \xc2\xb5m apart; open"), 1);
    assert_true(count_of(page.text, "class=\"map\"") > 6);
    assert_true(count_of(page.text, "detrend: plane") == 1);
    clear(&page);
}

/* Heights in steps make slopes that are not to be trusted: marked in the table, with the reason. */
static void what_is_not_trusted_is_marked(void **state) {
    (void)state;
    for (int stepped = 0; stepped < 2; stepped++) {
        struct page page;
        make(&page, 48, 48, 30e-9, "m");
        page.asked.artefacts = true;
        for (size_t p = 0; p < grid_points(&page.map.grid) && stepped == 1; p++)
            page.map.z[p] = 20e-9 * round(page.map.z[p] / 20e-9);
        draw(&page);
        assert_int_equal(count_of(page.text, "RMS slope *<"), stepped);
        assert_int_equal(count_of(page.text, "* not trusted: height steps<"), stepped);
        assert_int_equal(count_of(page.text, "RMS height Sq<"), 1);
        clear(&page);
    }
}

/* What the screen says of grooves in a sentence has rows here. */
static void grooves_have_rows(void **state) {
    (void)state;
    struct page page;
    uint64_t seed = seed_or(6);
    make(&page, 96, 96, 0, "m");
    noise_fill(&seed, grid_points(&page.map.grid), page.map.z);
    for (size_t p = 0; p < grid_points(&page.map.grid); p++)
        page.map.z[p] = 30e-9 * (page.map.z[p] + 2 * cos(2 * M_PI * (double)(p % 96) / 12));
    draw(&page);
    assert_int_equal(page.measured.grooves.families, 1);
    assert_int_equal(count_of(page.text, ">grooves every<"), 1);
    assert_int_equal(count_of(page.text, ">grooves, degrees from x<"), 1);
    assert_int_equal(count_of(page.text, ">groove depth<"), 1);
    assert_int_equal(count_of(page.text, ">RMS height without grooves<"), 1);
    assert_int_equal(count_of(page.text, ">crossed grooves every<"), 0);
    assert_int_equal(count_of(page.text, "plateau"), 0);
    /* the reason why there are no errors is as wide as the table */
    assert_int_equal(count_of(page.text, ">no standard errors: along some direction heights stay<"),
                     1);
    clear(&page);
}

/* Of a plateau above valleys the rows of both, with errors. */
static void stratified_faces_have_rows(void **state) {
    (void)state;
    struct page page;
    uint64_t seed = seed_or(7);
    make(&page, 96, 96, 0, "m");
    const size_t points = grid_points(&page.map.grid);
    double *plateau = array_create(points, sizeof *plateau);
    assert_non_null(plateau);
    noise_fill(&seed, points, page.map.z);
    noise_fill(&seed, points, plateau);
    for (size_t p = 0; p < points; p++)
        page.map.z[p] = 1e-6 * fmin(page.map.z[p], 0.15 * plateau[p] - 0.3);
    draw(&page);
    free(plateau);
    assert_int_equal(count_of(page.text, ">RMS of the plateau Spq<"), 1);
    assert_int_equal(count_of(page.text, ">RMS of the valleys Svq<"), 1);
    assert_int_equal(count_of(page.text, ">ratio where they meet Smq<"), 1);
    assert_int_equal(count_of(page.text, ">grooves every<"), 0);
    clear(&page);
}

static void without_units_there_are_none(void **state) {
    (void)state;
    struct page page;
    make(&page, 32, 32, 2, "");
    draw(&page);
    assert_int_equal(count_of(page.text, ">z<"), 2); /* of the colours, and of the distribution */
    assert_int_equal(count_of(page.text, "lengths in units of the file"), 1);
    clear(&page);
}

/* Returns the text of the metadata, without the entities that svg_text writes; the caller frees. */
static char *metadata_of(const char *page) {
    static const struct {
        const char *entity;
        char letter;
    } ENTITIES[] = {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}};
    const char *at = strstr(page, "<metadata>");
    assert_non_null(at);
    at += strlen("<metadata>");
    size_t length = strcspn(at, "<"), used = 0;
    char *kept = array_create(length + 1, 1);
    assert_non_null(kept);
    for (size_t n = 0; n < length; n++) {
        kept[used] = at[n];
        for (size_t e = 0; e < 4 && kept[used] == '&'; e++)
            if (strncmp(at + n, ENTITIES[e].entity, strlen(ENTITIES[e].entity)) == 0) {
                kept[used] = ENTITIES[e].letter;
                n += strlen(ENTITIES[e].entity) - 1;
                break;
            }
        used++;
    }
    return kept;
}

/* Whoever has the page has the numbers. */
static void the_file_holds_the_characterisation(void **state) {
    (void)state;
    struct page page;
    char *json = NULL;
    size_t size = 0;
    make(&page, 32, 24, 2, "");
    draw(&page);
    FILE *file = open_memstream(&json, &size);
    assert_non_null(file);
    assert_true(named_values_print_json(file, &page.found));
    assert_int_equal(fclose(file), 0);
    char *kept = metadata_of(page.text);
    assert_string_equal(kept, json);
    cJSON *document = cJSON_Parse(kept);
    assert_non_null(cJSON_GetObjectItem(document, "heights"));
    cJSON_Delete(document);
    free(kept);
    free(json);
    clear(&page);
}

static void holes_profiles_and_flat_maps_are_drawn(void **state) {
    (void)state;
    struct page page;
    make(&page, 40, 40, 1, "");
    for (size_t n = 0; n < 200; n++)
        page.map.z[410 + n % 20 + 40 * (n / 20)] = NAN;
    draw(&page);
    assert_int_equal(count_of(page.text, "hatched: not measured"), 1);
    assert_int_equal(count_of(page.text, "12.5 % not measured"), 1);
    clear(&page);
    make(&page, 300, 1, 20e-6, "m");
    draw(&page);
    assert_int_equal(count_of(page.text, "profile of 300 points"), 1);
    assert_int_equal(count_of(page.text, "class=\"map\""), 0);
    clear(&page);
    make(&page, 16, 16, 0, "");
    for (size_t n = 0; n < 256; n++)
        page.map.z[n] = 3;
    draw(&page);
    assert_int_equal(count_of(page.text, "all heights are the same"), 4);
    assert_int_equal(count_of(page.text, "beyond each end"), 0);
    clear(&page);
    make(&page, 2, 2, 1, ""); /* heights, of which there is no spectrum and no curvature */
    page.map.z[3] += 1;
    draw(&page);
    assert_int_equal(count_of(page.text, "all heights are the same"), 0);
    assert_int_equal(count_of(page.text, "the map has too few points"), 2);
    clear(&page);
    make(&page, 512, 4, 1, ""); /* far from square: 20 units high in place of 330 4/512 */
    draw(&page);
    assert_int_equal(count_of(page.text, ">not to scale: y stretched 7.76 times<"), 1);
    clear(&page);
    make(&page, 40, 20, 1, "");
    draw(&page);
    assert_int_equal(count_of(page.text, "not to scale"), 0);
    clear(&page);
}

/* Heights far from 0 that differ by their last digit alone, which no multiple of the difference is
 * far enough from the next one to count by. */
static void heights_that_hardly_differ_are_drawn(void **state) {
    (void)state;
    struct page page;
    make(&page, 16, 16, 0, "");
    for (size_t n = 0; n < 256; n++)
        page.map.z[n] = n % 3 == 0 ? 0x1p60 : nextafter(0x1p60, INFINITY);
    page.asked.detrend = ASK_DETREND_NONE;
    draw(&page);
    clear(&page);
    for (size_t ny = 1; ny <= 16; ny += 15) {
        make(&page, 16, ny, 0, "");
        for (size_t n = 0; n < 16 * ny; n++)
            page.map.z[n] = 0x1p60;
        page.asked.detrend = ASK_DETREND_NONE;
        draw(&page);
        clear(&page);
    }
}

/* Draws again a map without a fit, with these numbers of one, and expects this in its row. */
static void expect_shortest(struct page *page, const double values[3], const char *expected) {
    static const char *const NAMES[3] = {"short_wavelength", "short_wavelength_low",
                                         "short_wavelength_high"};
    struct error err = {0};
    size_t size = 0, count = page->found.count;
    assert_true(isnan(named_number(&page->found, "spectrum_fit", NAMES[0])));
    for (size_t v = 0; v < 3; v++)
        named_values_add(&page->found, "spectrum_fit", NAMES[v], values[v]);
    free(page->text);
    FILE *file = open_memstream(&page->text, &size);
    assert_non_null(file);
    const struct map_figure figure = {&page->measured, &page->found, &page->map, &page->record};
    assert_int_equal(map_figure_draw(&figure, file, &err), 0);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(count_of(page->text, expected), 1);
    page->found.count = count;
}

static void intervals_leave_room_for_their_labels(void **state) {
    (void)state;
    struct page page;
    make(&page, 16, 8, 1, "");
    draw(&page);
    expect_shortest(&page, (double[]){8.0123456, 8.0123451, 8.0123461}, ">8.012 [8.012, 8.012]<");
    expect_shortest(&page, (double[]){7.9827e-6, 7.83e-6, 8.1e-6}, ">7.98e-06 [7.8e-06, 8.1e-06]<");
    expect_shortest(&page, (double[]){7.98, 7.2, 8.9}, ">8.0 [7.2, 8.9]<");
    clear(&page);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_in_readable_units),
        cmocka_unit_test(what_is_not_trusted_is_marked),
        cmocka_unit_test(grooves_have_rows),
        cmocka_unit_test(stratified_faces_have_rows),
        cmocka_unit_test(without_units_there_are_none),
        cmocka_unit_test(the_file_holds_the_characterisation),
        cmocka_unit_test(holes_profiles_and_flat_maps_are_drawn),
        cmocka_unit_test(heights_that_hardly_differ_are_drawn),
        cmocka_unit_test(intervals_leave_room_for_their_labels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
