/* Protects: what is asked for of a map's preparation in words is read as it says or refused by
 * name; each step does that and no more, in the stated order, and reports it. */
#include "core/map/preparation/preparation_words.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 40, NY = 24 };

static double height_at(size_t i, size_t j) {
    return sin(0.7 * (double)i) + 0.3 * cos(0.4 * (double)(j * j)) + 0.01 * (double)(i * j);
}

static void make(struct height_map *map) {
    *map = (struct height_map){.grid = {NX, NY, NX, NY}};
    map->z = array_create((size_t)NX * NY, sizeof *map->z);
    assert_non_null(map->z);
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            map->z[j * NX + i] = height_at(i, j);
}

/* Prepares the map; the caller clears it. */
static int prepare(struct height_map *map, const struct preparation_words *words,
                   struct preparation_record *record, struct error *err) {
    struct preparation asked;
    *record = (struct preparation_record){0};
    int status = preparation_parse(&asked, words, err);
    return status == 0 ? preparation_run(record, map, &asked, err) : status;
}

static const char *step_text(const struct preparation_record *record, const char *name) {
    for (size_t step = 0; step < record->count; step++)
        if (strcmp(record->steps[step].name, name) == 0)
            return record->steps[step].text;
    return "";
}

static void words_are_read_or_refused(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        const char *says; /* NULL: read */
    } CASES[] = {
        {{.dx = "0.5um,0.25um", .z_unit = "25nm"}, NULL},
        {{.dx = "2", .unit = "um", .z_unit = "A"}, NULL},
        {{.crop = "0,0,10um,12"}, NULL},
        {{.dx = "0"}, "--dx 0"},
        {{.dx = "-1um"}, "--dx -1um"},
        {{.dx = "1,1um"}, "--dx 1,1um"},
        {{.dx = "1kg"}, "--dx 1kg"},
        {{.dx = "1,2,3"}, "--dx 1,2,3"},
        {{.dx = "nan"}, "--dx nan"},
        {{.unit = "V"}, "--unit V"},
        {{.unit = ""}, "--unit "},
        {{.z_unit = "0nm"}, "--z-unit 0nm"},
        {{.z_unit = "25"}, "--z-unit 25"},
        {{.missing = "none"}, NULL},
        {{.missing = "-9999,1e38"}, NULL},
        {{.missing = "nan"}, "--missing nan"},
        {{.missing = "1,2nm"}, "--missing 1,2nm"},
        {{.missing = "1,2,3,4,5"}, "--missing 1,2,3,4,5"},
        {{.crop = "0,0,10"}, "--crop 0,0,10"},
        {{.crop = "0,0,10,"}, "--crop 0,0,10,"},
        {{.crop = "-1,0,10,10"}, "--crop -1,0"},
        {{.crop = "0,0,0,10"}, "--crop 0,0,0"},
        {{.crop = "0.5,0,10,10"}, "--crop 0.5"},
        {{.crop = "0,0,1e999,10"}, "--crop 0,0,1e999"},
        {{.stride = "2"}, NULL},
        {{.stride = "2,1"}, NULL},
        {{.stride = "0"}, "--stride 0"},
        {{.stride = "2,"}, "--stride 2,"},
        {{.stride = "2,1,1"}, "--stride 2,1,1"},
        {{.stride = "x"}, "--stride x"},
        {{.filter = "S=2.5um,L=0.8mm,robust"}, NULL},
        {{.filter = "L=8"}, NULL},
        {{.filter = "robust"}, "--filter robust"},
        {{.filter = "S=1,S=2"}, "--filter S=1,S=2"},
        {{.filter = "S=0"}, "--filter S=0"},
        {{.filter = "S="}, "--filter S="},
        {{.filter = "S=1,"}, "--filter S=1,"},
        {{.filter = "X=1"}, "--filter X=1"},
        {{.filter = ""}, "--filter "},
        {{.despike = "8"}, NULL},
        {{.despike = "4.5"}, NULL},
        {{.despike = "0"}, "--despike 0"},
        {{.despike = "x"}, "--despike x"},
        {{.despike = ""}, "--despike "},
        {{.despike = "nan"}, "--despike nan"},
        {{.tip = "tip=10nm"}, NULL},
        {{.tip = "tip=10nm,holes"}, NULL},
        {{.tip = "2"}, NULL},
        {{.tip = "tip=0"}, "--deconvolve tip=0"},
        {{.tip = "tip=10nm,"}, "--deconvolve tip=10nm,"},
        {{.tip = "tip=10nm,holes,holes"}, "--deconvolve tip=10nm,holes,holes"},
        {{.tip = "holes"}, "--deconvolve holes"},
        {{.rotate = "-22.5"}, NULL},
        {{.rotate = "360"}, NULL},
        {{.rotate = "361"}, "--rotate 361"},
        {{.rotate = "30deg"}, "--rotate 30deg"},
        {{.rotate = "inf"}, "--rotate inf"},
        {{.resample = "512,256"}, NULL},
        {{.resample = "0.5um"}, NULL},
        {{.resample = "dx=0.5"}, NULL},
        {{.resample = "1"}, "--resample 1"},
        {{.resample = "0.5"}, "--resample 0.5"},
        {{.resample = "dx=0"}, "--resample dx=0"},
        {{.resample = "5,"}, "--resample 5,"},
        {{.resample = "5,0"}, "--resample 5,0"},
        {{.resample = "99999999999999999999"}, "--resample 999"},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct preparation asked;
        struct error err = {0};
        int status = preparation_parse(&asked, &CASES[c].words, &err);
        assert_int_equal(status, CASES[c].says == NULL ? 0 : ERROR_INPUT);
        if (CASES[c].says != NULL && strstr(err.text, CASES[c].says) == NULL)
            fail_msg("'%s' does not say '%s'", err.text, CASES[c].says);
    }
}

static void units_make_metres(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        double dx, dy, z;
        const char *xy_unit, *z_unit;
    } CASES[] = {
        {{0}, 1, 1, 1, "", ""},
        {{.dx = "0.5"}, 0.5, 0.5, 1, "", ""},
        {{.dx = "0.5um"}, 5e-7, 5e-7, 1, "m", ""},
        {{.dx = "0.5,2", .unit = "mm", .z_unit = "nm"}, 5e-4, 2e-3, 1e-9, "m", "m"},
        {{.unit = "um", .z_unit = "25nm"}, 1e-6, 1e-6, 2.5e-8, "m", "m"},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_map map;
        struct preparation_record record;
        struct preparation_words words = CASES[c].words;
        make(&map);
        words.detrend = ASK_DETREND_NONE;
        assert_int_equal(prepare(&map, &words, &record, NULL), 0);
        check_relative(grid_dx(&map.grid), CASES[c].dx, 1e-15);
        check_relative(grid_dy(&map.grid), CASES[c].dy, 1e-15);
        check_relative(map.z[77], CASES[c].z * height_at(77 % NX, 77 / NX), 1e-15);
        assert_string_equal(map.xy_unit, CASES[c].xy_unit);
        assert_string_equal(map.z_unit, CASES[c].z_unit);
        bool same = strcmp(map.xy_unit, map.z_unit) == 0;
        assert_int_equal(height_map_check_units(&map, NULL), same ? 0 : ERROR_INPUT);
        height_map_clear(&map);
    }
}

/* A file that has units takes no others. */
static void units_of_the_file_stand(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        const char *says;
    } CASES[] = {{{.unit = "um"}, "--unit"},
                 {{.z_unit = "um"}, "--z-unit"},
                 {{.dx = "0.5"}, "--dx 0.5 needs a unit"},
                 {{.dx = "0.5um", .unit = "um"}, "--unit has nothing to say"}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_map map;
        struct preparation_record record;
        struct error err = {0};
        make(&map);
        strcpy(map.xy_unit, "m");
        strcpy(map.z_unit, "m");
        assert_int_equal(prepare(&map, &CASES[c].words, &record, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, CASES[c].says));
        height_map_clear(&map);
    }
}

static void a_crop_is_a_part_bit_for_bit(void **state) {
    (void)state;
    static const char *const WORDS[] = {"3,5,20,10", "1.5,2.5,10,5"};
    for (size_t w = 0; w < 2; w++) {
        struct height_map map;
        struct preparation_record record;
        char crop[60];
        double parts[4];
        make(&map);
        assert_int_equal(
            sscanf(WORDS[w], "%lf,%lf,%lf,%lf", parts, parts + 1, parts + 2, parts + 3), 4);
        const char *unit = w == 0 ? "" : "um";
        snprintf(crop, sizeof crop, "%g%s,%g%s,%g%s,%g%s", parts[0], unit, parts[1], unit, parts[2],
                 unit, parts[3], unit);
        const struct preparation_words words = {
            .dx = "0.5um", .crop = crop, .detrend = ASK_DETREND_NONE};
        assert_int_equal(prepare(&map, &words, &record, NULL), 0);
        assert_int_equal(map.grid.nx, 20);
        assert_int_equal(map.grid.ny, 10);
        check_relative(grid_dx(&map.grid), 5e-7, 1e-15);
        for (size_t point = 0; point < 200; point++)
            assert_true(map.z[point] == height_at(3 + point % 20, 5 + point / 20));
        assert_string_equal(step_text(&record, "crop"),
                            "columns 3 to 22, rows 5 to 14 of 40 by 24 points");
        height_map_clear(&map);
    }
}

static void a_crop_beyond_the_map_is_refused(void **state) {
    (void)state;
    static const char *const CROPS[] = {"30,0,11,4", "0,20,4,5",   "40,0,2,2",
                                        "0,0,1,4",   "1e30,0,4,4", "0,0,4um,4"};
    for (size_t c = 0; c < sizeof CROPS / sizeof *CROPS; c++) {
        struct height_map map;
        struct preparation_record record;
        struct error err = {0};
        make(&map);
        assert_int_equal(
            prepare(&map, &(struct preparation_words){.crop = CROPS[c]}, &record, &err),
            ERROR_INPUT);
        assert_non_null(strstr(err.text, "--crop"));
        height_map_clear(&map);
    }
}

/* A filled map counts as what it was with its holes, and reports their share. */
static void holes_are_filled_where_asked(void **state) {
    (void)state;
    for (int asked = 0; asked < 2; asked++) {
        struct height_map map;
        struct preparation_record record;
        make(&map);
        for (size_t j = 0; j < 12; j++)
            map.z[(6 + j) * NX + 20] = (double)NAN;
        assert_int_equal(
            prepare(&map, &(struct preparation_words){.fill = asked == 1}, &record, NULL), 0);
        assert_int_equal(height_map_holes(&map), asked == 1 ? 0 : 12);
        assert_int_equal(record.boundary, BOUNDARY_OPEN);
        assert_string_equal(record.boundary_by, "holes");
        assert_string_equal(step_text(&record, "fill"),
                            asked == 1 ? "12 holes, 1.25 % of the points, by the smoothest membrane"
                                       : "");
        height_map_clear(&map);
    }
    struct height_map map;
    struct preparation_record record;
    struct preparation_words words = {.boundary = ASK_BOUNDARY_PERIODIC};
    struct error err = {0};
    make(&map);
    map.z[0] = (double)NAN;
    assert_int_equal(prepare(&map, &words, &record, &err), ERROR_INPUT);
    words.fill = true;
    assert_int_equal(prepare(&map, &words, &record, NULL), 0);
    assert_int_equal(record.boundary, BOUNDARY_PERIODIC);
    height_map_clear(&map);
}

/* No instrument measures what repeats, however smooth the seam. */
static void converted_maps_are_open(void **state) {
    (void)state;
    for (int converted = 0; converted < 2; converted++) {
        struct height_map map;
        struct preparation_record record = {0};
        const struct preparation none = {0};
        make(&map);
        for (size_t row = 0; row < NY; row++)
            for (size_t column = 0; column < NX; column++)
                map.z[row * NX + column] =
                    sin(2 * M_PI * (double)column / NX) + cos(2 * M_PI * (double)row / NY);
        if (converted)
            preparation_note(&record, "converted", "by a program");
        assert_int_equal(preparation_run(&record, &map, &none, NULL), 0);
        assert_int_equal(record.boundary, converted ? BOUNDARY_OPEN : BOUNDARY_PERIODIC);
        assert_string_equal(record.boundary_by, converted ? "instrument" : "seam");
        height_map_clear(&map);
    }
}

/* The S-filter is first; the L-filter takes out what it leaves of long waves. */
static void filters_are_told(void **state) {
    (void)state;
    struct height_map map;
    struct preparation_record record;
    struct error err = {0};
    struct preparation_words words = {.dx = "0.5um", .z_unit = "nm", .filter = "L=10um,S=2um"};
    make(&map);
    assert_int_equal(prepare(&map, &words, &record, NULL), 0);
    assert_string_equal(step_text(&record, "s_filter"),
                        "Gaussian, cut-off 2 \xc2\xb5m, of which the mean has 50.19 %");
    assert_string_equal(record.steps[record.count - 1].name, "l_filter");
    height_map_clear(&map);
    static const struct {
        const char *dx, *filter, *says;
    } CASES[] = {{"0.5um", "S=2", "--filter S 2 needs a unit"},
                 {"0.5", "S=2um", "--filter S has a unit"},
                 {"0.5", "S=6,L=3", "leave no waves"},
                 {"0.5", "S=0.5", "--filter S: points 0.5 apart"},
                 {"0.5", "L=100", "--filter L: a cut-off of 100;"},
                 {"0.5um", "S=0.5um", "--filter S: points 500 nm apart leave "},
                 {"0.5um", "S=0.5um", " as long as the cut-off, 500 nm, in place of 0.5"},
                 {"0.5um", "L=1mm", "--filter L: a cut-off of 1 mm; allowed: above 0, up to "}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        make(&map);
        words = (struct preparation_words){.dx = CASES[c].dx, .filter = CASES[c].filter};
        assert_int_equal(prepare(&map, &words, &record, &err), ERROR_INPUT);
        if (strstr(err.text, CASES[c].says) == NULL)
            fail_msg("'%s' does not say '%s'", err.text, CASES[c].says);
        height_map_clear(&map);
    }
}

/* Each step that needs all heights says so. */
static void holes_are_refused_with_a_word(void **state) {
    (void)state;
    static const struct preparation_words WORDS[] = {{.resample = "50"}, {.window = 1}};
    for (size_t w = 0; w < 2; w++) {
        struct height_map map;
        struct preparation_record record;
        struct preparation_words words = WORDS[w];
        struct error err = {0};
        make(&map);
        map.z[100] = (double)NAN;
        assert_int_equal(prepare(&map, &words, &record, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "--fill"));
        map.z[100] = (double)NAN;
        words.fill = true;
        assert_int_equal(prepare(&map, &words, &record, NULL), 0);
        height_map_clear(&map);
    }
}

/* A window makes the map periodic, falls to next to nothing at the sides and reports its power. */
static void a_window_is_told(void **state) {
    (void)state;
    for (int window = MAP_WINDOW_HANN; window <= MAP_WINDOW_TUKEY; window++) {
        struct height_map map;
        struct preparation_record record;
        make(&map);
        assert_int_equal(
            prepare(&map, &(struct preparation_words){.window = window}, &record, NULL), 0);
        assert_int_equal(record.boundary, BOUNDARY_PERIODIC);
        assert_string_equal(record.boundary_by, "window");
        /* 3/8 a side of Hann's; 1 - 5/8 of the two tenths that fall of Tukey's */
        const double side = window == MAP_WINDOW_HANN ? 0.375 : 0.875;
        check_relative(record.window_power, side * side, window == MAP_WINDOW_HANN ? 1e-12 : 0.01);
        double most = 0;
        for (size_t point = 0; point < (size_t)NX * NY; point++)
            most = fmax(most, fabs(map.z[point]));
        for (size_t i = 0; i < NX; i++)
            assert_true(fabs(map.z[i]) < 0.2 * most);
        height_map_clear(&map);
    }
}

/* Every so manieth point stays as it is; a profile has columns alone. */
static void strides_keep_points(void **state) {
    (void)state;
    static const struct {
        const char *stride;
        size_t x, y, nx, ny;
    } CASES[] = {
        {"2", 2, 2, 20, 12}, {"3,1", 3, 1, 14, 24}, {"1,5", 1, 5, 40, 5}, {"1", 1, 1, 40, 24}};
    struct height_map map;
    struct preparation_record record;
    struct error err;
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct preparation_words words = {.stride = CASES[c].stride,
                                                .detrend = ASK_DETREND_NONE};
        make(&map);
        assert_int_equal(prepare(&map, &words, &record, NULL), 0);
        assert_true(map.grid.nx == CASES[c].nx && map.grid.ny == CASES[c].ny);
        check_relative(grid_dx(&map.grid), (double)CASES[c].x, 1e-14);
        check_relative(grid_dy(&map.grid), (double)CASES[c].y, 1e-14);
        for (size_t j = 0; j < CASES[c].ny; j++)
            for (size_t i = 0; i < CASES[c].nx; i++)
                assert_true(map.z[j * CASES[c].nx + i] ==
                            height_at(i * CASES[c].x, j * CASES[c].y));
        height_map_clear(&map);
    }
    make(&map);
    assert_int_equal(prepare(&map, &(struct preparation_words){.stride = "2,24"}, &record, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "--stride 2,24 leaves 20 by 1 of 40 by 24 points"));
    height_map_clear(&map);
    make(&map);
    map.grid = (struct grid){NX, 1, NX, 1};
    assert_int_equal(prepare(&map, &(struct preparation_words){.stride = "4"}, &record, NULL), 0);
    assert_true(map.grid.nx == NX / 4 && map.grid.ny == 1);
    height_map_clear(&map);
}

/* What an instrument left is sought where it is asked for: steps in the heights as they were read,
 * lines in those that were levelled. */
static void artefacts_are_sought_where_they_are_asked_for(void **state) {
    (void)state;
    for (int asked = 0; asked < 2; asked++)
        for (int levelled = 0; levelled < 2; levelled++) {
            struct preparation how = {.lines = levelled == 1 ? SCAN_LINES_MEAN : SCAN_LINES_NONE,
                                      .artefacts = asked == 1};
            struct preparation_record record = {0};
            struct height_map map;
            make(&map);
            map.grid = (struct grid){NY, NX, NY, NX}; /* so many lines as the test needs */
            for (size_t p = 0; p < (size_t)NX * NY; p++) {
                const size_t i = p % NY, j = p / NY;
                map.z[p] = round(20 * sin(0.9 * (double)i) * cos(0.3 * (double)j)) +
                           4 * (double)((j * UINT32_C(2654435761) >> 7) % 5); /* no period */
            }
            assert_int_equal(preparation_run(&record, &map, &how, NULL), 0);
            assert_int_equal(record.artefacts.sought, asked == 1);
            check_close(record.artefacts.steps.step, asked, 1e-9);
            assert_int_equal(record.artefacts.lines.found, asked == 1 && levelled == 0);
            height_map_clear(&map);
        }
}

/* Points of an open map lie in the middle of the old ones; those of a periodic one share out the
 * cell. Asked for as they are they stay bit for bit. */
static void other_points_are_told(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        size_t nx, ny;
        double dx, dy;
    } CASES[] = {
        {{.resample = "79"}, 79, 47, 0.5, 0.5},
        {{.resample = "79,24"}, 79, 24, 0.5, 1},
        {{.resample = "dx=0.4"}, 98, 58, 0.4, 0.4},
        {{.resample = "dx=0.4", .boundary = ASK_BOUNDARY_PERIODIC}, 100, 60, 0.4, 0.4},
        {{.resample = "80", .boundary = ASK_BOUNDARY_PERIODIC}, 80, 48, 0.5, 0.5},
        {{.resample = "40,24"}, 40, 24, 1, 1},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_map map;
        struct preparation_record record;
        struct preparation_words words = CASES[c].words;
        words.detrend = ASK_DETREND_NONE;
        make(&map);
        assert_int_equal(prepare(&map, &words, &record, NULL), 0);
        assert_int_equal(map.grid.nx, CASES[c].nx);
        assert_int_equal(map.grid.ny, CASES[c].ny);
        check_relative(grid_dx(&map.grid), CASES[c].dx, 1e-14);
        check_relative(grid_dy(&map.grid), CASES[c].dy, 1e-14);
        for (size_t point = 0; c == 5 && point < (size_t)NX * NY; point++)
            assert_true(map.z[point] == height_at(point % NX, point / NX));
        height_map_clear(&map);
    }
}

/* Spikes on lines with offsets, under a tip, on a map that is turned: each step finds what the one
 * before leaves, and says so. */
static void what_instruments_leave_is_removed_in_order(void **state) {
    (void)state;
    const struct preparation_words words = {.lines = SCAN_LINES_MEDIAN,
                                            .despike = MAP_DESPIKE,
                                            .tip = "tip=0.01,holes",
                                            .transpose = true,
                                            .rotate = "90",
                                            .detrend = ASK_DETREND_NONE};
    static const char *const NAMES[] = {"lines", "despike", "deconvolve", "transpose", "rotate"};
    static const char *const SAYS[] = {
        "median of each of 24 lines along x, RMS ", "2 points, 0.208 %, became holes: beyond 8 ",
        "tip of radius 0.01, RMS change ", "x and y exchanged, 24 by 40 points",
        "90 degrees counter-clockwise, exactly"};
    struct height_map map;
    struct preparation_record record;
    make(&map);
    for (size_t point = 0; point < (size_t)NX * NY; point++) {
        const size_t i = point % NX, j = point / NX, third = j % 3;
        map.z[point] = 0.2 * sin(0.5 * (double)i) * cos(0.4 * (double)j) + 20 * (double)third;
    }
    map.z[5 * NX + 20] += 30;
    map.z[12 * NX + 8] -= 30;
    assert_int_equal(prepare(&map, &words, &record, NULL), 0);
    assert_int_equal(record.count, 5);
    for (size_t step = 0; step < 5; step++) {
        assert_string_equal(record.steps[step].name, NAMES[step]);
        if (strncmp(record.steps[step].text, SAYS[step], strlen(SAYS[step])) != 0)
            fail_msg("%s: '%s'", NAMES[step], record.steps[step].text);
    }
    /* exchanged and turned by 90 degrees: y as it was, x counted backwards */
    assert_true(map.grid.nx == NX && map.grid.ny == NY);
    assert_true(isnan(map.z[5 * NX + NX - 1 - 20]) && isnan(map.z[12 * NX + NX - 1 - 8]));
    assert_int_equal(height_map_holes(&map), 2); /* so sharp a tip reached all points */
    assert_string_equal(record.boundary_by, "holes");
    height_map_clear(&map);
}

static void turns_are_stated_or_refused(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        const char *says;
    } REFUSED[] = {
        {{.rotate = "30", .boundary = ASK_BOUNDARY_PERIODIC}, "allowed with --boundary periodic"},
        {{.tip = "tip=1um"}, "--deconvolve has a unit"},
        {{.tip = "tip=1", .unit = "um"}, "so that slopes have no meaning"},
        {{.tip = "tip=1", .z_unit = "um"}, "heights are in m and x and y have no unit"},
    };
    struct height_map map;
    struct preparation_record record;
    struct error err = {0};
    for (size_t c = 0; c < sizeof REFUSED / sizeof *REFUSED; c++) {
        make(&map);
        assert_int_equal(prepare(&map, &REFUSED[c].words, &record, &err), ERROR_INPUT);
        if (strstr(err.text, REFUSED[c].says) == NULL)
            fail_msg("'%s' does not say '%s'", err.text, REFUSED[c].says);
        height_map_clear(&map);
    }
    make(&map);
    assert_int_equal(prepare(&map, &(struct preparation_words){.rotate = "-30"}, &record, NULL), 0);
    assert_non_null(
        strstr(step_text(&record, "rotate"), "-30 degrees counter-clockwise, 40 by 24 points to "));
    assert_int_equal(record.boundary, BOUNDARY_OPEN);
    assert_non_null(strstr(step_text(&record, "detrend"), "plane"));
    height_map_clear(&map);
    make(&map);
    assert_int_equal(
        prepare(&map,
                &(struct preparation_words){.rotate = "-450", .boundary = ASK_BOUNDARY_PERIODIC},
                &record, &err),
        ERROR_INPUT);
    assert_int_equal(
        prepare(&map,
                &(struct preparation_words){.rotate = "-90", .boundary = ASK_BOUNDARY_PERIODIC},
                &record, NULL),
        0);
    assert_true(map.z[(NX - 1) * NY] == height_at(0, 0)); /* the first point is in the last row */
    height_map_clear(&map);
    make(&map);
    map.grid = (struct grid){NX, 1, NX, NX};
    assert_int_equal(
        prepare(&map, &(struct preparation_words){.lines = 1, .lines_along = 1}, &record, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "--lines-along y"));
    assert_int_equal(prepare(&map, &(struct preparation_words){.transpose = true}, &record, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "--transpose: a profile"));
    height_map_clear(&map);
}

/* What squares and their products leave the numbers for is refused before anything is computed; the
 * largest float, which files have in holes, is not where it is said to be a height. */
static void what_cannot_be_computed_with_is_refused(void **state) {
    (void)state;
    static const struct {
        struct preparation_words words;
        double scale, first; /* of the heights, and of the first of them in their place */
        const char *says;    /* NULL: prepared */
    } CASES[] = {
        {{.missing = "none"}, 1, 3.4028234663852886e38, NULL},
        {{0}, 1, 3.4028234663852886e38, "1 of 960 heights are 3.40282347e+38, far"},
        {{.missing = "none"}, 1, 1e41, "to 1e+41; allowed: at most 1e+40"},
        {{.missing = "none"}, 1, -1e300, "heights from -1e+300"},
        {{0}, 1e-39, 0, NULL},
        {{0}, 1e-300, 0, "heights that differ by"},
        {{0}, 0, 0, NULL},
        {{.z_unit = "1e300m"}, 1, 0, "allowed: at most 1e+40"},
        {{.dx = "1e29"}, 1, 0, NULL},
        {{.dx = "1e300"}, 1, 0, "points 1e+300 by 1e+300 apart; allowed: 1e-30 to 1e+30"},
        {{.dx = "1,1e-300"}, 1, 0, "points 1 by 1e-300 apart"},
        {{.dx = "5e-324"}, 1, 0, "apart; allowed"},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_map map;
        struct preparation_record record;
        struct error err = {0};
        make(&map);
        for (size_t point = 0; point < (size_t)NX * NY; point++)
            map.z[point] *= CASES[c].scale;
        map.z[1] = NAN;
        map.z[0] = CASES[c].first;
        assert_int_equal(prepare(&map, &CASES[c].words, &record, &err),
                         CASES[c].says == NULL ? 0 : ERROR_INPUT);
        if (CASES[c].says != NULL && strstr(err.text, CASES[c].says) == NULL)
            fail_msg("'%s' does not say '%s'", err.text, CASES[c].says);
        height_map_clear(&map);
    }
}

/* More points than can be are not cut to as many as can be: of a profile these were 16 GiB. */
static void too_many_new_points_are_refused(void **state) {
    (void)state;
    struct height_map map;
    struct preparation_record record;
    struct error err = {0};
    make(&map);
    map.grid = (struct grid){NX, 1, NX, NX};
    assert_int_equal(
        prepare(&map, &(struct preparation_words){.resample = "dx=1e-20"}, &record, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "--resample: 3.9e+21 by 1 points; at most 2^31"));
    height_map_clear(&map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_read_or_refused),
        cmocka_unit_test(units_make_metres),
        cmocka_unit_test(units_of_the_file_stand),
        cmocka_unit_test(a_crop_is_a_part_bit_for_bit),
        cmocka_unit_test(a_crop_beyond_the_map_is_refused),
        cmocka_unit_test(holes_are_filled_where_asked),
        cmocka_unit_test(converted_maps_are_open),
        cmocka_unit_test(filters_are_told),
        cmocka_unit_test(holes_are_refused_with_a_word),
        cmocka_unit_test(a_window_is_told),
        cmocka_unit_test(other_points_are_told),
        cmocka_unit_test(what_instruments_leave_is_removed_in_order),
        cmocka_unit_test(strides_keep_points),
        cmocka_unit_test(artefacts_are_sought_where_they_are_asked_for),
        cmocka_unit_test(turns_are_stated_or_refused),
        cmocka_unit_test(what_cannot_be_computed_with_is_refused),
        cmocka_unit_test(too_many_new_points_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
