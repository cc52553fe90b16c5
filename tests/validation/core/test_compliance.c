/* Protects the compliance of the contact's linear models: the layered block against an assembled
 * stiffness of the same mesh, factorised by CHOLMOD; against the half-space and the exact layer as
 * the mesh is refined; the effect of growing layers; no locking near nu = 0.5.
 *
 * The assembly here shares nothing with core/contact: elements by Gauss quadrature from their
 * strain-displacement matrices, node by node, one load at one node. */
#include "core/contact/compliance.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>

enum { NODES = 8, FREEDOMS = 3 * NODES, STRAINS = 7 };

/* --- one element, corners numbered by bits: x 1, y 2, z 4; two unknowns a node less in a profile
 * --- */

struct element {
    double size[3]; /* dx, dy, h */
    bool flat;      /* plane strain in x and z */
    bool mean_dilatation;
    double poisson;
};

static double side(size_t a, size_t axis) {
    return a >> axis & 1 ? 1 : -1;
}

/* Gradients of the shape functions at a point of [-1, 1]^3; in plane strain nothing depends on y
 * and the corners with y bit 0 stand for both. */
static void gradients(const struct element *e, const double *at, double (*b)[3]) {
    memset(b, 0, NODES * sizeof *b);
    for (size_t a = 0; a < NODES; a++) {
        if (e->flat && (a & 2))
            continue;
        double n[3], d[3];
        for (size_t axis = 0; axis < 3; axis++) {
            n[axis] = (1 + side(a, axis) * at[axis]) / 2;
            d[axis] = side(a, axis) / e->size[axis];
        }
        if (e->flat) {
            n[1] = 1;
            d[1] = 0;
        }
        b[a][0] = d[0] * n[1] * n[2];
        b[a][1] = n[0] * d[1] * n[2];
        b[a][2] = n[0] * n[1] * d[2];
    }
}

/* Rows xx, yy, zz, yz, xz, xy (engineering shear), trace; columns 3 a + axis. */
static void strain_matrix(double (*b)[3], double (*strain)[FREEDOMS]) {
    static const size_t SHEAR[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    memset(strain, 0, STRAINS * sizeof *strain);
    for (size_t a = 0; a < NODES; a++)
        for (size_t axis = 0; axis < 3; axis++) {
            strain[axis][3 * a + axis] = b[a][axis];
            strain[6][3 * a + axis] = b[a][axis];
            for (size_t shear = 0; shear < 3; shear++) {
                if (SHEAR[shear][0] == axis)
                    strain[3 + shear][3 * a + axis] = b[a][SHEAR[shear][1]];
                if (SHEAR[shear][1] == axis)
                    strain[3 + shear][3 * a + axis] = b[a][SHEAR[shear][0]];
            }
        }
}

static void element_stiffness(const struct element *e, double (*k)[FREEDOMS]) {
    double modulus = 1 - e->poisson * e->poisson;
    double lambda = modulus * e->poisson / ((1 + e->poisson) * (1 - 2 * e->poisson));
    double mu = modulus / (2 * (1 + e->poisson)), ratio = mu / (lambda + 2 * mu);
    double local = e->mean_dilatation ? 2 / (1 + ratio * ratio) - 3 * mu : lambda;
    double b[NODES][3], strain[STRAINS][FREEDOMS], mean[FREEDOMS] = {0};
    double weight = e->size[0] * (e->flat ? 1 : e->size[1]) * e->size[2] / 8;
    const double factor[STRAINS] = {2 * mu, 2 * mu, 2 * mu, mu, mu, mu, local};
    memset(k, 0, FREEDOMS * sizeof *k);
    for (size_t q = 0; q < 8; q++) {
        double at[3] = {side(q, 0) / sqrt(3), side(q, 1) / sqrt(3), side(q, 2) / sqrt(3)};
        gradients(e, at, b);
        strain_matrix(b, strain);
        for (size_t i = 0; i < FREEDOMS; i++) {
            mean[i] += strain[6][i] / 8;
            for (size_t j = 0; j < FREEDOMS; j++)
                for (size_t s = 0; s < STRAINS; s++)
                    k[i][j] += weight * factor[s] * strain[s][i] * strain[s][j];
        }
    }
    for (size_t i = 0; i < FREEDOMS; i++)
        for (size_t j = 0; j < FREEDOMS; j++)
            k[i][j] += 8 * weight * (lambda - local) * mean[i] * mean[j];
}

/* --- the assembled block --- */

struct model {
    struct grid grid;
    struct block block;
    bool mean_dilatation;
    size_t layers;
    double thickness[LAYERS_MOST];
    cholmod_common common;
    cholmod_triplet *triplet;
};

/* Number of an unknown, or -1 where it is held: Z of the far side, X and Y of one of its nodes (no
 * force acts on them), Y of a profile. */
static int unknown(const struct model *model, size_t level, size_t j, size_t i, size_t axis) {
    size_t nx = model->grid.nx, ny = model->grid.ny, node = (level * ny + j) * nx + i;
    bool profile = grid_is_profile(&model->grid);
    bool far_side = level == model->layers;
    if ((profile && axis == 1) || (far_side && axis == 2) || (far_side && i + j == 0))
        return -1;
    return (int)(3 * node + axis);
}

static int element_unknown(const struct model *model, size_t k, size_t j, size_t i, size_t f) {
    size_t a = f / 3;
    if (grid_is_profile(&model->grid) && (a & 2))
        return -1;
    size_t right = (i + (a & 1)) % model->grid.nx, back = (j + (a >> 1 & 1)) % model->grid.ny;
    return unknown(model, a & 4 ? k : k + 1, back, right, f % 3);
}

static void triplet_add(cholmod_triplet *t, int row, int column, double value) {
    if (row < 0 || column < 0 || row < column)
        return; /* held, or of the upper half */
    assert_true(t->nnz < t->nzmax);
    ((int *)t->i)[t->nnz] = row;
    ((int *)t->j)[t->nnz] = column;
    ((double *)t->x)[t->nnz++] = value;
}

static void assemble(struct model *model) {
    size_t nx = model->grid.nx, ny = model->grid.ny, levels = model->layers + 1;
    size_t unknowns = 3 * nx * ny * levels;
    size_t most = nx * ny * model->layers * FREEDOMS * FREEDOMS + unknowns;
    bool profile = grid_is_profile(&model->grid);
    double k[FREEDOMS][FREEDOMS];
    model->triplet =
        cholmod_allocate_triplet(unknowns, unknowns, most, -1, CHOLMOD_REAL, &model->common);
    assert_non_null(model->triplet);
    for (size_t layer = 0; layer < model->layers; layer++) {
        struct element element = {
            {grid_dx(&model->grid), profile ? 1 : grid_dy(&model->grid), model->thickness[layer]},
            profile,
            model->mean_dilatation,
            model->block.poisson};
        element_stiffness(&element, k);
        for (size_t j = 0; j < ny; j++)
            for (size_t i = 0; i < nx; i++)
                for (size_t e = 0; e < FREEDOMS * FREEDOMS; e++)
                    triplet_add(model->triplet, element_unknown(model, layer, j, i, e / FREEDOMS),
                                element_unknown(model, layer, j, i, e % FREEDOMS),
                                k[e / FREEDOMS][e % FREEDOMS]);
    }
    for (size_t u = 0; u < unknowns; u++) /* a held unknown is a lone 1 */
        if (unknown(model, u / (3 * nx * ny), u / (3 * nx) % ny, u / 3 % nx, u % 3) < 0)
            triplet_add(model->triplet, (int)u, (int)u, 1);
}

/* Z of the face (ny rows of nx) under a unit force at its first node. */
static void face_response(struct model *model, double *z) {
    cholmod_common *common = &model->common;
    assemble(model);
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(model->triplet, 0, common);
    cholmod_factor *factor = cholmod_analyze(matrix, common);
    assert_true(cholmod_factorize(matrix, factor, common));
    assert_int_equal(common->status, CHOLMOD_OK);
    cholmod_dense *load = cholmod_zeros(matrix->nrow, 1, CHOLMOD_REAL, common);
    ((double *)load->x)[2] = 1;
    cholmod_dense *solution = cholmod_solve(CHOLMOD_A, factor, load, common);
    assert_non_null(solution);
    for (size_t n = 0; n < grid_points(&model->grid); n++)
        z[n] = ((double *)solution->x)[3 * n + 2];
    cholmod_free_dense(&solution, common);
    cholmod_free_dense(&load, common);
    cholmod_free_factor(&factor, common);
    cholmod_free_sparse(&matrix, common);
    cholmod_free_triplet(&model->triplet, common);
}

/* S of all waves, in the layout of compliance.h: the force at one node holds all waves alike. */
static double *assembled_lengths(const struct grid *grid, const struct block *block,
                                 bool mean_dilatation) {
    struct model *model = calloc(1, sizeof *model);
    size_t nx = grid->nx, ny = grid->ny;
    double *z = calloc(nx * ny, sizeof *z);
    double *length = calloc((nx / 2 + 1) * ny, sizeof *length);
    assert_true(model && z && length);
    model->grid = *grid;
    model->block = *block;
    model->mean_dilatation = mean_dilatation;
    model->layers = block_layers(grid, block, model->thickness);
    cholmod_start(&model->common);
    face_response(model, z);
    cholmod_finish(&model->common);
    double area = grid_dx(grid) * (ny == 1 ? 1 : grid_dy(grid));
    for (size_t mx = 0; mx <= nx / 2; mx++)
        for (size_t row = 0; row < ny; row++)
            for (size_t n = 0; n < nx * ny; n++)
                length[mx * ny + row] += area * z[n] *
                                         cos(2 * M_PI *
                                             ((double)(mx * (n % nx) % nx) / (double)nx +
                                              (double)(row * (n / nx) % ny) / (double)ny));
    free(z);
    free(model);
    return length;
}

static struct compliance *make(const struct grid *grid, const struct block *block) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    if (compliance_create(&compliance, grid, block, &err))
        fail_msg("%s", err.text);
    return compliance;
}

/* Conditioning of the assembled matrix, about (layers)^2 x lambda/mu (5000 at nu = 0.4999), times
 * the rounding of a double leaves 1e-10 or so. */
static void layered_is_the_assembled_block(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{32, 1, 1, 9}, {17, 1, 3, 9}, {2, 1, 1, 1},
                                        {6, 6, 2, 2},  {5, 8, 1, 1},  {7, 5, 3, 1},
                                        {4, 2, 1, 5},  {2, 2, 1, 1},  {3, 3, 1, 1}};
    static const double POISSON[] = {0, 0.3, 0.49, 0.4999};
    static const struct {
        double height, growth;
    } BLOCKS[] = {{0.02, 1}, {0.3, 1.2}, {1.5, 1.5}, {8, 2}};
    double worst = 0;
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++)
        for (size_t c = 0; c < 16; c++) {
            const struct grid *grid = &GRIDS[g];
            struct block block = {.model = MODEL_LAYERED,
                                  .poisson = POISSON[c % 4],
                                  .height = BLOCKS[c / 4].height * grid->lx,
                                  .layer_growth = BLOCKS[c / 4].growth};
            double *expected = assembled_lengths(grid, &block, true);
            struct compliance *compliance = make(grid, &block);
            for (size_t k = 1; k < compliance->waves; k++) {
                check_relative(compliance->length[k], expected[k], 1e-9);
                worst = fmax(worst, fabs(compliance->length[k] / expected[k] - 1));
            }
            check_close(compliance->length[0], 0, 0);
            compliance_destroy(&compliance);
            free(expected);
        }
    print_message("layered against CHOLMOD: largest relative difference %.1e\n", worst);
}

/* S of the wave with one period along x (and one along y), in a square cell of length 1. */
static double first_wave(size_t nx, size_t ny, const struct block *block) {
    struct grid grid = {nx, ny, 1, 1};
    struct compliance *compliance = make(&grid, block);
    double length = compliance->length[ny + (ny > 1)];
    compliance_destroy(&compliance);
    return length;
}

/* Relative errors of the layered block at 8, 16, 32 and 64 points a wave. They are at most `most`
 * at 16 points, and fall as the points to the power of `order`. The next term of the error changes
 * this power by up to `slack` at 16 points and half of it from 32 on. */
static void check_convergence(struct block block, bool surface, double most, double order,
                              double slack) {
    double before = 0;
    for (size_t n = 8; n <= 64; n *= 2) {
        size_t ny = surface ? n : 1;
        block.model = MODEL_LAYERED;
        double mesh = first_wave(n, ny, &block);
        block.model = MODEL_HALFSPACE;
        double error = mesh / first_wave(n, ny, &block) - 1;
        if (n == 16)
            check_close(error, most / 2, most / 2);
        if (n > 8)
            check_close(log2(before / error), order, n == 16 ? slack : slack / 2);
        before = error;
    }
}

static const double POISSON[] = {0, 0.3, 0.49, 0.4999};

/* Blocks 2 cells high feel their far side by exp(-8 pi), 1e-11: half-spaces. In a profile, where
 * the term in (k dx)^2 is gone, the error at 8, 16, 32 points is 0.41, 0.027, 0.0017 % for nu = 0,
 * 0.85, 0.060, 0.0039 % for 0.3, 1.4, 0.10, 0.0069 % for 0.4999. On a surface the wave runs along
 * the diagonal, where a third of that term is left, at 5.7, 11.3, 22.6 points: 7 to 11, 1.3 to 2.1,
 * 0.31 to 0.47 %. */
static void deep_blocks_converge_to_the_halfspace(void **state) {
    (void)state;
    for (size_t c = 0; c < 4; c++) {
        struct block block = {.poisson = POISSON[c], .height = 2, .layer_growth = 1};
        check_convergence(block, false, 0.0011, 4, 0.3);
        check_convergence(block, true, 0.022, 2, 0.5);
    }
}

/* The flat, shear-free far side counts where 2 k H is small, and there the error is of second
 * order: with 2 layers at 16 points 1.1 to 1.6 %, on a surface 3.2 to 4.0 %; less in higher blocks.
 */
static void shallow_blocks_converge_to_the_exact_layer(void **state) {
    (void)state;
    static const double HEIGHTS[] = {0.125, 0.25};
    for (size_t c = 0; c < 8; c++) {
        struct block block = {
            .poisson = POISSON[c % 4], .height = HEIGHTS[c / 4], .layer_growth = 1};
        check_convergence(block, false, 0.017, 2, 0.5);
        check_convergence(block, true, 0.041, 2, 0.5);
    }
}

/* The error of growing layers: they make every wave stiffer by much the same share, since each wave
 * meets layers of the same thickness over wavelength. Bounds: 1.1 times what is seen at nu = 0.3,
 * the largest of all waves of at least 8 points. */
static void growing_layers_stiffen_a_little(void **state) {
    (void)state;
    static const struct {
        double growth, most; /* relative to equal layers */
        size_t layers;
    } ROWS[] = {{1.05, 7e-4, 62}, {1.1, 1.5e-3, 39}, {1.2, 5e-3, 24}, {1.5, 1.7e-2, 13}};
    const struct grid grid = {256, 1, 1, 1};
    struct block block = {.model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1};
    struct compliance *equal = make(&grid, &block);
    assert_int_equal(equal->layers, 384);
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        block.layer_growth = ROWS[r].growth;
        struct compliance *growing = make(&grid, &block);
        assert_int_equal(growing->layers, ROWS[r].layers);
        double largest = 0;
        for (size_t mx = 1; mx <= 32; mx++)
            largest = fmax(largest, fabs(growing->length[mx] / equal->length[mx] - 1));
        check_close(largest, ROWS[r].most / 2, ROWS[r].most / 2);
        compliance_destroy(&growing);
    }
    compliance_destroy(&equal);
}

/* E* = 1 for both, so that a half-space is as compliant at nu = 0.4999 as at 0.3, and the meshes
 * differ by 0.5 % at 16 points. Fully integrated, the element has a fifth of the compliance left.
 */
static void nearly_incompressible_blocks_do_not_lock(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{16, 1, 1, 1}, {16, 8, 1, 0.5}};
    for (size_t g = 0; g < 2; g++) {
        struct block block = {
            .model = MODEL_LAYERED, .poisson = 0.3, .height = 1, .layer_growth = 1.1};
        struct compliance *steel = make(&GRIDS[g], &block);
        block.poisson = 0.4999;
        struct compliance *rubber = make(&GRIDS[g], &block);
        double *full = assembled_lengths(&GRIDS[g], &block, false);
        size_t k = GRIDS[g].ny; /* mx = 1, my = 0 */
        check_relative(rubber->length[k], steel->length[k], 2e-3);
        check_close(full[k] / steel->length[k], 0.16, 0.05);
        /* The shortest waves too: 2 points a wave, of which no more is asked than a likeness. */
        for (k = 1; k < steel->waves; k++)
            check_relative(rubber->length[k], steel->length[k], 0.5);
        free(full);
        compliance_destroy(&steel);
        compliance_destroy(&rubber);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layered_is_the_assembled_block),
        cmocka_unit_test(deep_blocks_converge_to_the_halfspace),
        cmocka_unit_test(shallow_blocks_converge_to_the_exact_layer),
        cmocka_unit_test(growing_layers_stiffen_a_little),
        cmocka_unit_test(nearly_incompressible_blocks_do_not_lock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
