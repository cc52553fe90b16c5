/* Protects: the picture of a surface marks each of its summits at its position, shows the extremes
 * of a trace however many points it has, and says where it marks but the highest. */
#include "server/show/map/map_png.h"
#include "server/show/plot/plot_frame.h"
#include "server/show/plot/plot_map.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the picture; the caller frees. */
static char *draw_picture(const struct map_picture *picture) {
    char *text = NULL;
    size_t size = 0;
    struct error err = {0};
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(plot_map(picture, file, &err), 0);
    assert_int_equal(fclose(file), 0);
    assert_null(strstr(text, "nan"));
    assert_non_null(strstr(text, "</svg>"));
    return text;
}

static char *draw_map(const struct grid *grid, const double *z, enum boundary boundary) {
    const struct map_picture picture = {.name = "a & b",
                                        .subject = "case 1",
                                        .x_label = "along",
                                        .y_label = "across",
                                        .z_label = "height",
                                        .grid = grid,
                                        .z = z,
                                        .boundary = boundary};
    return draw_picture(&picture);
}

static char *draw(const struct grid *grid, const double *z) {
    return draw_map(grid, z, BOUNDARY_PERIODIC);
}

/* Returns a cosine of `waves` waves along x, one along y where the grid has rows; the caller frees.
 */
static double *waves_of(const struct grid *grid, double waves) {
    double *z = array_create(grid_points(grid), sizeof *z);
    assert_non_null(z);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] =
                cos(2 * M_PI * waves * (double)i / (double)grid->nx) +
                (grid_is_profile(grid) ? 0 : cos(2 * M_PI * (double)j / (double)grid->ny));
    return z;
}

static void a_trace_has_its_peaks(void **state) {
    (void)state;
    const struct grid grid = {.nx = 64, .ny = 1, .lx = 8, .ly = 1};
    double *z = waves_of(&grid, 4), x, y, range[2] = {-1.12, 1.12};
    struct frame frame;
    char *text = draw(&grid, z);
    frame_set(&frame, (const double[]){0, 8}, range, false);
    assert_int_equal(count_of(text, "class=\"summit\""), 4);
    assert_int_equal(count_of(text, ">circles: 4 peaks<"), 1);
    assert_int_equal(count_of(text, ">along<"), 1);
    assert_int_equal(count_of(text, ">height<"), 1);
    assert_int_equal(count_of(text, "a &amp; b: case 1<"), 2);
    bool seen[4] = {false};
    for (const char *at = text; (at = strstr(at, "class=\"summit\"")) != NULL; at++) {
        assert_int_equal(sscanf(at, "class=\"summit\" cx=\"%lf\" cy=\"%lf\"", &x, &y), 2);
        assert_true(fabs(y - frame_y(&frame, 1)) < 0.06);
        for (int peak = 0; peak < 4; peak++)
            seen[peak] = seen[peak] || fabs(x - frame_x(&frame, 2 * peak)) < 0.06;
    }
    assert_true(seen[0] && seen[1] && seen[2] && seen[3]);
    free(text);
    free(z);
}

/* The row that is asked for is marked across the surface and drawn below it, over the same x; one
 * beyond the last is the first. */
static void a_row_is_drawn_below(void **state) {
    (void)state;
    const struct grid grid = {.nx = 32, .ny = 16, .lx = 8, .ly = 8};
    double *z = waves_of(&grid, 2);
    for (int asked = 0; asked < 2; asked++) {
        struct map_picture picture = {.name = "cut",
                                      .subject = "case 1",
                                      .x_label = "along",
                                      .y_label = "across",
                                      .z_label = "height",
                                      .grid = &grid,
                                      .z = z,
                                      .trace = asked ? 8 : 3.9};
        char *text = NULL;
        size_t size = 0;
        struct error err = {0};
        FILE *file = open_memstream(&text, &size);
        double y, across;
        assert_non_null(file);
        assert_int_equal(plot_map(&picture, file, &err), 0);
        assert_int_equal(fclose(file), 0);
        const char *cut = strstr(text, "class=\"cut\"");
        assert_non_null(cut);
        assert_int_equal(sscanf(cut, "class=\"cut\" d=\"M80 %lf", &y), 1);
        across = FRAME_BOTTOM - (FRAME_BOTTOM - FRAME_TOP) * ((asked ? 0 : 4) + 0.25) / 8;
        assert_true(fabs(y - across) < 0.01);
        assert_int_equal(count_of(text, "class=\"curve\""), 1);
        assert_int_equal(count_of(text, "class=\"summit\""), 2);
        assert_int_equal(count_of(text, ">along<"), 1);
        assert_int_equal(count_of(text, ">height<"), 2); /* of colours and of the trace */
        free(text);
    }
    free(z);
}

static void a_surface_has_its_summits(void **state) {
    (void)state;
    const struct grid grid = {.nx = 32, .ny = 16, .lx = 8, .ly = 8};
    double *z = waves_of(&grid, 2);
    char *text = draw(&grid, z);
    assert_int_equal(count_of(text, "class=\"summit\""), 2);
    assert_int_equal(count_of(text, ">circles: 2 summits<"), 1);
    assert_true(count_of(text, "class=\"heat\"") >= 4);
    assert_int_equal(count_of(text, ">across<"), 1);
    assert_int_equal(count_of(text, ">height<"), 1);
    free(text);
    free(z);
}

/* One high point among many is seen, though points are joined. */
static void extremes_of_long_traces_are_seen(void **state) {
    (void)state;
    const struct grid grid = {.nx = 100000, .ny = 1, .lx = 100000, .ly = 1};
    double *z = waves_of(&grid, 5000);
    z[54321] = 3;
    char *text = draw(&grid, z), place[32];
    struct frame frame;
    frame_set(&frame, (const double[]){0, grid.lx}, (const double[]){-1.24, 3.24}, false);
    snprintf(place, sizeof place, "L%.2f %.2f", frame_x(&frame, 54321), frame_y(&frame, 3));
    assert_int_equal(count_of(text, place), 1);
    assert_int_equal(count_of(text, "class=\"summit\""), 1000);
    assert_int_equal(count_of(text, "circles: the 1000 highest of 500"), 1);
    assert_true(strlen(text) < 250000);
    free(text);
    free(z);
}

/* Summits that lie on the side of an open map, or beside a hole, may be none; a hole stays blank,
 * in a trace a gap, which ends where the map does. */
static void open_maps_end_and_have_holes(void **state) {
    (void)state;
    const struct grid surface = {.nx = 32, .ny = 16, .lx = 8, .ly = 8};
    const struct grid profile = {.nx = 64, .ny = 1, .lx = 8, .ly = 1};
    double *z = waves_of(&surface, 4), *trace = waves_of(&profile, 4);
    for (size_t j = 0; j < 16; j++) /* the ridge of each wave is highest in the middle */
        for (size_t i = 0; i < 32; i++)
            z[j * 32 + i] -= 2 * cos(2 * M_PI * (double)j / 16);
    char *whole = draw_map(&surface, z, BOUNDARY_OPEN), *periodic = draw(&surface, z);
    z[8 * 32 + 17] = trace[33] = NAN;
    char *hole = draw_map(&surface, z, BOUNDARY_OPEN);
    char *gap = draw_map(&profile, trace, BOUNDARY_OPEN);
    assert_int_equal(count_of(periodic, "class=\"summit\""), 4);
    assert_int_equal(count_of(whole, "class=\"summit\""), 3); /* without the one at i = 0 */
    assert_int_equal(count_of(hole, "class=\"summit\""), 2);
    assert_int_equal(count_of(gap, "class=\"summit\""), 2); /* of peaks at 0, 16, 32 and 48 */
    const char *path = strstr(gap, "class=\"curve\""), *end = strstr(path, "/>");
    size_t moves = 0, points = 0;
    for (const char *at = strstr(path, "d=\""); at < end; at++) {
        moves += *at == 'M';
        points += *at == 'M' || *at == 'L';
    }
    assert_int_equal(moves, 2);
    assert_int_equal(points, 63);
    free(z);
    free(trace);
    free(whole);
    free(periodic);
    free(hole);
    free(gap);
}

/* Heights that are all the same, far from 0, or as good as the same, are drawn all the same. */
static void next_to_flat_maps_are_drawn(void **state) {
    (void)state;
    static const double HEIGHTS[][2] = {{1e17, 1e17}, {0, 5e-324}, {-1e-310, 3e-310}, {1e38, 1e38}};
    for (size_t h = 0; h < sizeof HEIGHTS / sizeof *HEIGHTS; h++)
        for (size_t ny = 1; ny <= 20; ny += 19) {
            const struct grid grid = {.nx = 20, .ny = ny, .lx = 20, .ly = (double)ny};
            double z[400];
            for (size_t n = 0; n < 20 * ny; n++)
                z[n] = HEIGHTS[h][n % 2];
            char *text = draw(&grid, z);
            assert_int_equal(count_of(text, "inf"), 0);
            assert_int_equal(count_of(text, "nan"), 0);
            free(text);
        }
}

/* A flat surface has neither summits nor a range. */
static void flat_surfaces_are_drawn(void **state) {
    (void)state;
    const struct grid grid = {.nx = 16, .ny = 300, .lx = 1, .ly = 20};
    double *z = array_create(grid_points(&grid), sizeof *z);
    assert_non_null(z);
    memset(z, 0, grid_points(&grid) * sizeof *z);
    char *text = draw(&grid, z);
    assert_int_equal(count_of(text, "class=\"heat\""), 1);
    assert_int_equal(count_of(text, ">circles: 0 summits<"), 1);
    free(text);
    free(z);
}

/* What is open has no colour, and the scale begins at the contact; a lone pressure is drawn, too.
 */
static void pressures_are_blank_where_there_is_no_contact(void **state) {
    (void)state;
    const struct grid grid = {.nx = 4, .ny = 2, .lx = 4, .ly = 2},
                      profile = {.nx = 4, .ny = 1, .lx = 4, .ly = 1};
    double p[8] = {0, 3, 4, 0, 0, 5, 0, 0}, none[8] = {0}, line[4] = {0, 1, 0, 2};
    map_blank_open(&grid, p);
    for (size_t i = 0; i < 8; i++)
        assert_int_equal(isnan(p[i]), i != 1 && i != 2 && i != 5);
    char *text = draw_map(&grid, p, BOUNDARY_OPEN);
    assert_int_equal(count_of(text, ">3<"), 1); /* at the scale, and at neither axis */
    assert_int_equal(count_of(text, ">0<"), 2);
    free(text);
    map_blank_open(&grid, none);
    map_blank_open(&profile, line);
    assert_true(none[0] == 0 && line[0] == 0);
}

/* Values in metres and pascals are drawn with prefixes, which the labels have. */
static void units_are_readable(void **state) {
    (void)state;
    const struct grid grid = {.nx = 32, .ny = 32, .lx = 12e-6, .ly = 12e-6};
    double *z = waves_of(&grid, 2);
    for (size_t n = 0; n < grid_points(&grid); n++)
        z[n] *= 3e9;
    const struct map_picture picture = {.name = "map",
                                        .subject = "",
                                        .x_label = "x",
                                        .y_label = "y",
                                        .z_label = "pressure",
                                        .xy_unit = "m",
                                        .z_unit = "Pa",
                                        .note = "blank: no contact",
                                        .grid = &grid,
                                        .z = z,
                                        .unmarked = true};
    char *text = NULL;
    size_t size = 0;
    struct error err = {0};
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(plot_map(&picture, file, &err), 0);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(count_of(text, ">map<"), 2); /* a title without a subject */
    assert_int_equal(count_of(text, ">x (\xc2\xb5m)<"), 1);
    assert_int_equal(count_of(text, ">y (\xc2\xb5m)<"), 1);
    assert_int_equal(count_of(text, ">pressure (GPa)<"), 1);
    assert_int_equal(count_of(text, ">10</text>"), 2); /* of 12 micrometres */
    assert_int_equal(count_of(text, ">blank: no contact<"), 1);
    assert_null(strstr(text, "e-0"));
    assert_null(strstr(text, "e+0"));
    free(text);
    free(z);
}

/* A plane of wave vectors or lags has 0 in its middle, and units of their own; those of a profile
 * are of its length alone. */
static void planes_have_their_middle(void **state) {
    (void)state;
    const struct {
        struct grid grid;
        const char *xy_unit, *z_unit, *x_label, *z_label;
    } planes[] = {{{33, 33, 33e6, 33e6}, "rad/m", "m^2", ">x (rad/\xc2\xb5m)<", ">z (nm<"},
                  {{33, 1, 33e-6, 1}, "m", "V^2", ">x (\xc2\xb5m)<", ">z (V<"}};
    for (size_t p = 0; p < sizeof planes / sizeof *planes; p++) {
        const struct grid *grid = &planes[p].grid;
        double *z = waves_of(grid, 2);
        for (size_t n = 0; n < grid_points(grid); n++)
            z[n] *= 0.3e-18;
        const struct map_picture picture = {.name = "plane",
                                            .subject = "",
                                            .x_label = "x",
                                            .y_label = "y",
                                            .z_label = "z",
                                            .xy_unit = planes[p].xy_unit,
                                            .z_unit = planes[p].z_unit,
                                            .grid = grid,
                                            .x0 = -16 * grid_dx(grid),
                                            .y0 = -16 * grid_dy(grid),
                                            .z = z,
                                            .boundary = BOUNDARY_OPEN,
                                            .unmarked = true};
        char *text = draw_picture(&picture);
        const int axes = grid_is_profile(grid) ? 1 : 2;
        assert_int_equal(count_of(text, planes[p].x_label), 1);
        assert_int_equal(count_of(text, planes[p].z_label), 1);
        assert_int_equal(count_of(text, ">\xe2\x88\x92" /* minus */
                                        "10</text>"),
                         axes);
        assert_int_equal(count_of(text, ">10</text>"), axes);
        assert_int_equal(count_of(text, ">20</text>"), 0);
        free(text);
        free(z);
    }
}

/* Finds the sides of the first frame. */
static void frame_of(const char *text, double *width, double *height) {
    double x, y;
    const char *at = strstr(text, "class=\"frame\"");
    assert_non_null(at);
    while (strncmp(at, "<rect", 5) != 0)
        at--;
    assert_int_equal(
        sscanf(at, "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y, width, height),
        4);
}

/* A length of y is as long as one of x, to the pixel that frames end at; of sides beyond 1 to 8 it
 * is not, which the legend says, as it does where a cell is a mean. */
static void lengths_are_to_scale(void **state) {
    (void)state;
    const struct {
        struct grid grid;
        double width, height;
        const char *stretched;
        const char *joined;
    } maps[] = {{{800, 100, 80, 10}, 620, 77.5, NULL, ">means of 2 × 2 points<"},
                {{100, 800, 10, 80}, 57.5, 460, NULL, ">means of 2 × 2 points<"},
                {{160, 40, 8, 4}, 620, 310, NULL, NULL},
                {{160, 5, 80, 2}, 620, 77.5, ">not to scale: y stretched 5 times<", NULL},
                {{5, 160, 2, 80}, 57.5, 460, ">not to scale: x stretched 5 times<", NULL}};
    for (size_t m = 0; m < sizeof maps / sizeof *maps; m++) {
        double *z = waves_of(&maps[m].grid, 2), width, height;
        char *text = draw(&maps[m].grid, z);
        frame_of(text, &width, &height);
        assert_true(fabs(width - maps[m].width) <= 0.5);
        assert_true(fabs(height - maps[m].height) <= 0.5);
        assert_int_equal(count_of(text, "not to scale"), maps[m].stretched != NULL);
        assert_int_equal(count_of(text, ">means of "), maps[m].joined != NULL);
        if (maps[m].stretched != NULL)
            assert_non_null(strstr(text, maps[m].stretched));
        if (maps[m].joined != NULL)
            assert_non_null(strstr(text, maps[m].joined));
        free(text);
        free(z);
    }
}

/* Points that are one or the other have two colours and their names, also where they are joined. */
static void classes_have_names(void **state) {
    (void)state;
    for (size_t side = 64; side <= 1280; side *= 20) {
        const struct grid grid = {.nx = side, .ny = side, .lx = 1, .ly = 1};
        double *z = waves_of(&grid, 2);
        for (size_t n = 0; n < grid_points(&grid); n++)
            z[n] = z[n] > 1;
        const struct map_picture picture = {.name = "contact",
                                            .subject = "",
                                            .x_label = "x",
                                            .y_label = "y",
                                            .z_label = "contact (1) or none (0)",
                                            .classes = {"no contact", "in contact"},
                                            .grid = &grid,
                                            .z = z,
                                            .unmarked = true};
        char *text = draw_picture(&picture);
        assert_int_equal(count_of(text, "class=\"heat\""), 2);
        assert_int_equal(count_of(text, ">in contact<"), 1);
        assert_int_equal(count_of(text, ">no contact<"), 1);
        assert_int_equal(count_of(text, " to "), 0);
        assert_int_equal(count_of(text, ">majorities of 4 × 4 points<"), side > 64);
        free(text);
        free(z);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trace_has_its_peaks),
        cmocka_unit_test(units_are_readable),
        cmocka_unit_test(planes_have_their_middle),
        cmocka_unit_test(lengths_are_to_scale),
        cmocka_unit_test(classes_have_names),
        cmocka_unit_test(a_row_is_drawn_below),
        cmocka_unit_test(a_surface_has_its_summits),
        cmocka_unit_test(extremes_of_long_traces_are_seen),
        cmocka_unit_test(open_maps_end_and_have_holes),
        cmocka_unit_test(flat_surfaces_are_drawn),
        cmocka_unit_test(next_to_flat_maps_are_drawn),
        cmocka_unit_test(pressures_are_blank_where_there_is_no_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
