/* Protects the compliance of the linear contact models: what is refused and how, the stack of
 * layers, the layout and symmetries of the arrays, and numbers at the ends of their ranges. */
#include "core/contact/compliance.h"
#include "tests/support/check.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

static const struct block HALFSPACE = {.model = MODEL_HALFSPACE, .height = INFINITY};
static const struct block LAYERED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 0.7, .layer_growth = 1.1};

static struct compliance *make(const struct grid *grid, const struct block *block) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    if (compliance_create(&compliance, grid, block, &err))
        fail_msg("%s", err.text);
    return compliance;
}

static void check_refused(struct grid grid, struct block block, const char *text) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    assert_int_equal(compliance_create(&compliance, &grid, &block, &err), ERROR_INPUT);
    assert_null(compliance);
    if (!strstr(err.text, text))
        fail_msg("\"%s\" does not contain \"%s\"", err.text, text);
}

static struct block with_poisson(double poisson) {
    struct block block = LAYERED;
    block.poisson = poisson;
    return block;
}

static struct block with_height(enum block_model model, double height) {
    struct block block = LAYERED;
    block.model = model;
    block.height = height;
    return block;
}

static struct block with_growth(double growth) {
    struct block block = LAYERED;
    block.layer_growth = growth;
    return block;
}

static void refuses_what_is_out_of_range(void **state) {
    (void)state;
    const struct grid grid = {8, 8, 1, 1};
    check_refused((struct grid){1, 1, 1, 1}, LAYERED, "1 by 1 points");
    check_refused((struct grid){8, 8, 1, NAN}, LAYERED, "ly = nan");
    static const double POISSON[] = {-0.1, 0.5, NAN, INFINITY};
    for (size_t c = 0; c < 4; c++)
        check_refused(grid, with_poisson(POISSON[c]), "Poisson's ratio");
    check_refused(grid, with_poisson(0.5), "= 0.5; allowed: 0 or more, below 0.5");
    static const double HEIGHTS[] = {0, -1, NAN};
    for (size_t c = 0; c < 3; c++) {
        check_refused(grid, with_height(MODEL_LAYERED, HEIGHTS[c]), "block height");
        check_refused(grid, with_height(MODEL_HALFSPACE, HEIGHTS[c]), "above 0, or infinite");
    }
    check_refused(grid, with_height(MODEL_LAYERED, INFINITY), "finite for a layered block");
    static const double GROWTH[] = {0.999, 2.001, NAN, INFINITY};
    for (size_t c = 0; c < 4; c++)
        check_refused(grid, with_growth(GROWTH[c]), "layer growth");
    struct block block = LAYERED;
    block.model = (enum block_model)7;
    check_refused(grid, block, "contact model 7 is unknown");
    block = LAYERED;
    block.weighting = (enum gap_weighting)7;
    check_refused(grid, block, "gap weighting 7 is unknown");
}

static void refuses_blocks_of_too_many_layers(void **state) {
    (void)state;
    const struct grid grid = {8, 1, 8, 1};
    struct block block = LAYERED;
    block.layer_growth = 1;
    block.height = LAYERS_MOST;
    struct compliance *compliance = make(&grid, &block);
    assert_int_equal(compliance->layers, LAYERS_MOST);
    compliance_destroy(&compliance);
    block.height = LAYERS_MOST + 1;
    check_refused(grid, block, "of height 4097 needs more than 4096 layers that grow by 1;");
    /* Layers out of the range of doubles, and a block lost beside its cell. */
    check_refused((struct grid){8, 1, 1e-300, 1}, with_height(MODEL_LAYERED, 1e300), "layers");
    check_refused((struct grid){8, 1, 1e300, 1}, with_height(MODEL_LAYERED, 1e-300),
                  "out of range");
}

/* Each thickness is rounded, and their sum: 4 roundings of the total are allowed. */
static void layers_fill_the_block(void **state) {
    (void)state;
    static const double HEIGHTS[] = {1e-3, 0.124, 0.125, 0.126, 0.7, 1.5, 40};
    static const double GROWTH[] = {1, 1.05, 1.1, 1.5, 2};
    const struct grid grid = {8, 10, 1, 2};
    double thickness[LAYERS_MOST];
    for (size_t c = 0; c < 35; c++) {
        struct block block = with_height(MODEL_LAYERED, HEIGHTS[c / 5]);
        block.layer_growth = GROWTH[c % 5];
        size_t layers = block_layers(&grid, &block, thickness);
        assert_true(layers >= 1);
        double sum = 0;
        for (size_t k = 0; k < layers; k++) {
            sum += thickness[k];
            if (k > 0)
                check_relative(thickness[k] / thickness[k - 1], GROWTH[c % 5], 4 * DBL_EPSILON);
        }
        check_relative(sum, block.height, (double)(3 + layers) * DBL_EPSILON);
        /* the first is as the finer of dx and dy or less, and one layer fewer would not do */
        assert_true(thickness[0] <= 0.125 * (1 + 1e-11));
        double fewer = (sum - thickness[layers - 1]) * 0.125 / thickness[0];
        assert_true(fewer < block.height);
    }
    /* a height of whole layers takes no more of them */
    struct block block = with_height(MODEL_LAYERED, 0.3);
    block.layer_growth = 1;
    assert_int_equal(block_layers(&(struct grid){10, 1, 1, 1}, &block, thickness), 3);
}

static void halfspace_is_two_over_k(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{8, 6, 2, 3}, {7, 5, 1, 1}, {2, 2, 1, 1}, {9, 1, 4, NAN}};
    for (size_t g = 0; g < 4; g++) {
        const struct grid *grid = &GRIDS[g];
        struct compliance *compliance = make(grid, &HALFSPACE);
        assert_int_equal(compliance->waves, (grid->nx / 2 + 1) * grid->ny);
        assert_int_equal(compliance->layers, 0);
        assert_null(compliance->weight);
        check_close(compliance->length[0], 0, 0);
        for (size_t k = 1; k < compliance->waves; k++) {
            size_t column = k / grid->ny, row = k % grid->ny;
            double mx = (double)column, my = (double)row;
            if (row > grid->ny / 2)
                my -= (double)grid->ny;
            double q = hypot(mx / grid->lx, grid->ny > 1 ? my / grid->ly : 0);
            check_relative(compliance->length[k], 1 / (M_PI * q), 4 * DBL_EPSILON);
        }
        compliance_destroy(&compliance);
    }
}

/* Thin layers yield as free columns, S = H (1 + O((k H)^4)); deep ones as half-spaces; between
 * them the formula as it stands. */
static void layers_of_any_depth_are_exact(void **state) {
    (void)state;
    const struct grid grid = {2, 1, 2, 1};
    double k = M_PI;
    static const double DEPTHS[] = {1e-300, 1e-160, 1e-8, 1e-5, 0.1, 1, 10, 100, 1e8, 1e300};
    for (size_t c = 0; c < sizeof DEPTHS / sizeof *DEPTHS; c++) {
        double height = DEPTHS[c] / k, x = 2 * DEPTHS[c];
        double expected = x < 1e-3  ? height
                          : x > 100 ? 2 / k
                                    : 2 / k * (cosh(x) - 1) / (sinh(x) + x);
        struct block block = with_height(MODEL_HALFSPACE, height);
        struct compliance *compliance = make(&grid, &block);
        check_relative(compliance->length[1], expected, 1e-14);
        compliance_destroy(&compliance);
    }
}

/* S is even in kx and ky, and blind to the order of x and y; a plain sum over waves that are stored
 * by their own numbers shows it. Rounding alone may differ when x and y are exchanged. */
static void layered_has_the_symmetries_of_the_cell(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{8, 8, 1, 1}, {7, 7, 2, 2}, {8, 6, 1, 1}, {5, 9, 3, 2},
                                        {2, 2, 1, 1}, {2, 3, 1, 1}, {3, 2, 1, 1}};
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        const struct grid *grid = &GRIDS[g];
        struct grid turned = {grid->ny, grid->nx, grid->ly, grid->lx};
        struct compliance *a = make(grid, &LAYERED), *b = make(&turned, &LAYERED);
        assert_true(a->layers > 0 && a->layers == b->layers);
        check_close(a->length[0], 0, 0);
        for (size_t mx = 0; mx <= grid->nx / 2; mx++)
            for (size_t row = 0; row < grid->ny; row++) {
                size_t my = row <= grid->ny / 2 ? row : grid->ny - row;
                double length = a->length[mx * grid->ny + row];
                assert_true(length > 0 || mx + my == 0);
                check_close(length, a->length[mx * grid->ny + my], 0);
                check_relative(length, b->length[my * grid->nx + mx], 1e-13);
            }
        compliance_destroy(&a);
        compliance_destroy(&b);
    }
}

/* A wave along x is plane strain, whatever stands in y: the hexahedra give what the quadrilaterals
 * give. It needs cells of which dx is the finer, so that the layers are the same. */
static void waves_along_x_are_plane_strain(void **state) {
    (void)state;
    const struct grid surface = {12, 5, 3, 2}, profile = {12, 1, 3, 1};
    struct compliance *a = make(&surface, &LAYERED), *b = make(&profile, &LAYERED);
    for (size_t mx = 1; mx <= 6; mx++)
        check_relative(a->length[mx * 5], b->length[mx], 1e-13);
    compliance_destroy(&a);
    compliance_destroy(&b);
}

/* A number of waves that fills no whole group, and one that does, are computed alike. */
static void groups_of_waves_do_not_show(void **state) {
    (void)state;
    struct compliance *all = make(&(struct grid){768, 1, 1, 1}, &LAYERED);
    struct block coarse = LAYERED;
    for (size_t n = 2; n <= 768; n += n < 70 ? 1 : 113) {
        /* the same dx: every mode of the small cell is one of the large cell */
        if (768 % n)
            continue;
        struct compliance *few = make(&(struct grid){n, 1, (double)n / 768, 1}, &coarse);
        for (size_t mx = 1; mx <= n / 2; mx++)
            check_relative(few->length[mx], all->length[mx * (768 / n)], 1e-13);
        compliance_destroy(&few);
    }
    compliance_destroy(&all);
}

static void standard_weights_average_neighbours(void **state) {
    (void)state;
    const struct grid grid = {8, 5, 1, 2};
    struct block block = LAYERED;
    struct compliance *compliance = make(&grid, &block);
    assert_non_null(compliance->weight);
    for (size_t mx = 0; mx <= 4; mx++)
        for (size_t row = 0; row < 5; row++) {
            double x = (4 + 2 * cos(2 * M_PI * (double)mx / 8)) / 6;
            double y = (4 + 2 * cos(2 * M_PI * (double)row / 5)) / 6;
            check_close(compliance->weight[mx * 5 + row], x * y, 4 * DBL_EPSILON);
        }
    check_close(compliance->weight[0], 1, 0);
    compliance_destroy(&compliance);
    compliance = make(&(struct grid){8, 1, 1, 1}, &block);
    check_relative(compliance->weight[4], 1.0 / 3, 4 * DBL_EPSILON);
    compliance_destroy(&compliance);
    block.weighting = GAP_DUAL;
    compliance = make(&grid, &block);
    assert_null(compliance->weight);
    compliance_destroy(&compliance);
}

/* All lengths scale alike; 1e-13 leaves room for the rounding of the scaled lengths, which at
 * nu = 0.4999 bulk over shear modulus, 5000, multiplies. */
static void units_do_not_show(void **state) {
    (void)state;
    static const double UNITS[] = {1e-9, 1e6, 1e-150, 1e150};
    static const double POISSON[] = {0.3, 0.4999};
    for (size_t c = 0; c < 16; c++) {
        double unit = UNITS[c / 4];
        struct block block = with_poisson(POISSON[c % 2]);
        block.model = c & 2 ? MODEL_LAYERED : MODEL_HALFSPACE;
        struct compliance *one = make(&(struct grid){16, 12, 3, 2}, &block);
        block.height *= unit;
        struct compliance *scaled = make(&(struct grid){16, 12, 3 * unit, 2 * unit}, &block);
        for (size_t k = 1; k < one->waves; k++)
            check_relative(scaled->length[k] / unit, one->length[k], c % 2 ? 1e-12 : 1e-13);
        compliance_destroy(&one);
        compliance_destroy(&scaled);
    }
}

/* A block of one thin layer under waves of up to 10^6 points is a row of free columns: S = H
 * (1 + O((k dx)^2)). A difference of stiffnesses would leave 1e-4 of it. */
static void long_waves_on_thin_blocks_keep_their_digits(void **state) {
    (void)state;
    static const double POISSON[] = {0, 0.3, 0.4999};
    for (size_t c = 0; c < 3; c++) {
        struct block block = with_poisson(POISSON[c]);
        const struct grid grid = {1 << 20, 1, 1 << 20, 1};
        block.height = 0.5;
        struct compliance *compliance = make(&grid, &block);
        assert_int_equal(compliance->layers, 1);
        for (size_t mx = 1; mx <= 8; mx++)
            check_relative(compliance->length[mx], 0.5, 1e-9);
        compliance_destroy(&compliance);
    }
}

/* S moves in proportion to 1 - 2 nu near nu = 0.5, and by no rounding error that grows as 1/(1 - 2
 * nu). */
static void the_last_poisson_ratio_is_no_different(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{1024, 1, 1, 1}, {32, 24, 1, 1}};
    for (size_t g = 0; g < 2; g++) {
        struct block near = with_poisson(0.5 - 0.5e-6), last = with_poisson(nextafter(0.5, 0));
        struct compliance *a = make(&GRIDS[g], &near), *b = make(&GRIDS[g], &last);
        for (size_t k = 1; k < a->waves; k++)
            check_relative(b->length[k], a->length[k], 1e-5);
        compliance_destroy(&a);
        compliance_destroy(&b);
    }
}

static void destroy_accepts_nothing(void **state) {
    (void)state;
    struct compliance *compliance = NULL;
    compliance_destroy(&compliance);
    compliance_destroy(NULL);
    assert_null(compliance);
}

static void bytes_count_the_arrays(void **state) {
    (void)state;
    struct block dual = LAYERED;
    dual.weighting = GAP_DUAL;
    const struct grid grid = {512, 256, 1, 1};
    double waves = 257.0 * 256;
    double header = sizeof(struct compliance);
    check_close(compliance_bytes(&grid, &LAYERED), header + 16 * waves, 0);
    check_close(compliance_bytes(&grid, &dual), header + 8 * waves, 0);
    check_close(compliance_bytes(&grid, &HALFSPACE), header + 8 * waves, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_what_is_out_of_range),
        cmocka_unit_test(refuses_blocks_of_too_many_layers),
        cmocka_unit_test(layers_fill_the_block),
        cmocka_unit_test(halfspace_is_two_over_k),
        cmocka_unit_test(layers_of_any_depth_are_exact),
        cmocka_unit_test(layered_has_the_symmetries_of_the_cell),
        cmocka_unit_test(waves_along_x_are_plane_strain),
        cmocka_unit_test(groups_of_waves_do_not_show),
        cmocka_unit_test(standard_weights_average_neighbours),
        cmocka_unit_test(units_do_not_show),
        cmocka_unit_test(long_waves_on_thin_blocks_keep_their_digits),
        cmocka_unit_test(the_last_poisson_ratio_is_no_different),
        cmocka_unit_test(destroy_accepts_nothing),
        cmocka_unit_test(bytes_count_the_arrays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
