/* Protects: whichever allocation fails, a map is read, prepared, characterised and pressed, or
 * memory is short by the error; nothing leaks, and the next attempt finds the same. */
#include "tests/support/check.h"

#include "jobs/maps/map_characterisation.h"
#include "jobs/maps/map_counter.h"
#include "jobs/maps/map_preparation.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 20, POINTS = SIDE * SIDE };
static double HEIGHTS[POINTS];

struct work {
    enum boundary boundary;
    enum press_boundary pressed;
    const char *model;
    bool slides;
    double expected; /* NaN: not known yet */
};

/* What is found once is found again, whatever failed between. */
static void expect_same(struct work *work, double value) {
    if (isnan(work->expected))
        work->expected = value;
    assert_true(value == work->expected);
}

static int read_map(void *context, struct error *err) {
    static const char TEXT[] = "1,2,0\n2,nan,1\n0,1,1\n2,2,3\n";
    struct work *work = context;
    struct height_map map = {.z = NULL};
    struct preparation_record record = {.count = 0};
    const struct preparation asked = {.fill = true, .boundary = ASK_BOUNDARY_OPEN};
    const struct map_source source = {.name = "map.csv", .data = TEXT, .size = strlen(TEXT)};
    int status = map_source_read(&map, &record, &source, err);
    if (status == 0)
        status = map_prepare(&map, &record, "map.csv", &asked, err);
    if (status == 0) {
        assert_string_equal(preparation_text(&record, "file"), "map.csv");
        expect_same(work, map.z[4]);
    }
    height_map_clear(&map);
    return status;
}

static int characterise(void *context, struct error *err) {
    static struct map_characterisation found;
    struct work *work = context;
    const struct height_map map = {.grid = {SIDE, SIDE, 10, 10}, .z = HEIGHTS};
    const struct preparation_record record = {.boundary = work->boundary, .window_power = 1};
    const struct spectrum_fit_request trusted = {0};
    found = (struct map_characterisation){.histogram = {0}};
    int status = map_characterise(&found, &map, &record, &trusted, MAP_WHOLE, err);
    if (status == 0)
        expect_same(work, found.areal.sdr + found.spectra.rings.density[3]);
    map_characterisation_clear(&found);
    if (status == 0)
        status = map_characterise(&found, &map, &record, &trusted, MAP_MAIN, err);
    map_characterisation_clear(&found);
    return status;
}

static int press_series(struct map_press *press, struct height_map *map,
                        struct press_series *series, struct work *work, struct error *err) {
    const double pressure = 0.02;
    struct case_result result = {0};
    int status = map_press_begin(press, map, work->pressed, err);
    for (size_t m = 0; m < 2 && status == 0; m++)
        status = map_press_loads(press, map->z, 1, &pressure, &series[m], err);
    map_press_release(press);
    if (status == 0)
        status = map_press_error(press, map, 2, series, 1, &pressure, err);
    if (status == 0)
        status = map_press_result(&result, press, 2, series, 1, err);
    if (status == 0)
        expect_same(work, result_curve(&result, "contact_area")->y[0] +
                              series[0].rows->error[ERROR_DISCRETISATION][MEASURE_EDGES].bound);
    result_clear(&result);
    return status;
}

/* The second model has a low block, so that exact layers are pressed beside it. */
static int press_map(void *context, struct error *err) {
    struct work *work = context;
    const struct choice *choice = choice_find(CONTACT_MODEL_CHOICES, work->model);
    double path[] = {0, 0.5};
    struct press_row rows[2], slides[2];
    struct press_series series[] = {
        {.block = {.model = CONTACT_MODELS[choice->value], .poisson = 0.3}, .rows = &rows[0]},
        {.block = {.model = CONTACT_MODELS[0], .lengths = work->pressed == PRESS_OPEN ? 0 : 0.2},
         .rows = &rows[1]}};
    struct map_press press = {.copies = 0};
    struct height_map map = {.grid = {SIDE, 1, 10, 1}, .z = array_create(SIDE, sizeof *map.z)};
    int status = map.z == NULL ? error_memory(err, SIDE * sizeof *map.z, "a map") : 0;
    if (work->slides) {
        series[0].slides = slides;
        series[0].block.friction = 0.2;
        series[0].block.slide = path;
        series[0].block.slide_count = 2;
        series[0].block.slide_steps = 1;
    }
    for (size_t i = 0; i < SIDE && status == 0; i++)
        map.z[i] = 0.05 * cos(2 * M_PI * (double)i / SIDE);
    if (status == 0)
        status = press_series(&press, &map, series, work, err);
    map_press_clear(&press);
    height_map_clear(&map);
    return status;
}

static void check(const char *name, int (*run)(void *context, struct error *err),
                  struct work work) {
    work.expected = NAN;
    /* Sorting does without its memory (qsort_r). */
    each_allocation(&(struct failing_call){
        .name = name, .run = run, .context = &work, .may_succeed = run == characterise});
}

static void maps_are_read(void **state) {
    (void)state;
    check("read", read_map, (struct work){.boundary = BOUNDARY_OPEN});
}

static void maps_are_characterised(void **state) {
    (void)state;
    check("open", characterise, (struct work){.boundary = BOUNDARY_OPEN});
    check("periodic", characterise, (struct work){.boundary = BOUNDARY_PERIODIC});
}

/* A map faces itself. */
static int add_counter(void *context, struct error *err) {
    struct work *work = context;
    struct height_map one = {.grid = {SIDE, SIDE, 10, 10}}, other = one;
    struct map_counter counter;
    double heights[2][POINTS];
    memcpy(heights[0], HEIGHTS, sizeof HEIGHTS);
    memcpy(heights[1], HEIGHTS, sizeof HEIGHTS);
    one.z = heights[0];
    other.z = heights[1];
    int status = map_counter_add(&one, &other, true, &counter, err);
    if (status == 0)
        expect_same(work, one.z[5] + counter.facing.value);
    return status;
}

static void maps_are_pressed(void **state) {
    (void)state;
    check("counter", add_counter, (struct work){.pressed = PRESS_PERIODIC});
    check("open", press_map, (struct work){.pressed = PRESS_OPEN, .model = "halfspace"});
    check("mirrored", press_map, (struct work){.pressed = PRESS_MIRRORED, .model = "layered"});
    check("full", press_map, (struct work){.pressed = PRESS_PERIODIC, .model = "full"});
    /* A path takes seconds of itself: only where all allocations fail. */
    if (getenv("RUGO_FAULTS") != NULL)
        check("slides", press_map,
              (struct work){.pressed = PRESS_PERIODIC, .model = "full", .slides = true});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_read),
        cmocka_unit_test(maps_are_characterised),
        cmocka_unit_test(maps_are_pressed),
    };
    uint64_t seed = 21;
    noise_fill(&seed, POINTS, HEIGHTS);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
