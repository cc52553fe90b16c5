#include "core/contact/area_law.h"
#include "core/contact/edge/edge_area.h"
#include "core/contact/mesh_error.h"
#include <math.h>
#include <stdlib.h>

/* The double sine has about WAVE_STEPS points a wave and is pressed at several positions on the
 * grid, on unequal spacings also with x and y exchanged, so that it does not matter which is which.
 * At the lower loads its patches are as large as those of a rough surface with 8 points a
 * shortest wave. */
enum { WAVE_STEPS = 20, POSITIONS = 16, LOADS = 5 };
/* Pressures over that of full contact, and the contact fractions there: limits of a half-space's at
 * 256 and 512 points a wave (tests/bench/core/bench_edges.c prints them). */
static const double LOAD[LOADS] = {0.05, 0.1, 0.2, 0.5, 0.7};
static const double FRACTION[LOADS] = {0.112986, 0.190605, 0.345222, 0.704224, 0.839958};

/* Normal equations of a + weighting b + patch c = 0 over loads and positions, and then of
 * d + weighting b + patch_of_nodes c = 0. */
struct squares {
    double ab, ac, bb, bc, cc, dc;
};

static void squares_add(struct squares *s, double a, double b, double c, double d) {
    s->dc += d * c;
    s->ab += a * b;
    s->ac += a * c;
    s->bb += b * b;
    s->bc += b * c;
    s->cc += c * c;
}

static void squares_solve(const struct squares *s, bool weighted, struct area_law *out) {
    double determinant = s->bb * s->cc - s->bc * s->bc;
    out->weighting = 1;
    if (weighted && determinant > 0)
        out->weighting = (s->bc * s->ac - s->cc * s->ab) / determinant;
    out->patch = -(s->ac + out->weighting * s->bc) / s->cc;
    out->patch_of_nodes = -(s->dc + out->weighting * s->bc) / s->cc;
}

struct double_sine {
    struct grid grid;
    struct compliance *compliance;
    struct contact *contact;
    struct mesh_error_workspace *mesh_error;
    struct edge_scan *scan;
    double *z;
};

static void double_sine_close(struct double_sine *wave) {
    mesh_error_destroy(&wave->mesh_error);
    contact_destroy(&wave->contact);
    compliance_destroy(&wave->compliance);
    free(wave->z);
    edge_scan_destroy(&wave->scan);
}

static int double_sine_open(struct double_sine *wave, const struct edge_law *law,
                            const struct grid *grid, const struct block *block, struct error *err) {
    double dx = grid_dx(grid), dy = grid_dy(grid), length = WAVE_STEPS * fmax(dx, dy);
    struct block deep = *block;
    size_t nx = (size_t)(length / dx + 0.5), ny = (size_t)(length / dy + 0.5);
    *wave = (struct double_sine){.grid = {nx, ny, (double)nx * dx, (double)ny * dy}};
    deep.height = block->model == MODEL_HALFSPACE ? INFINITY : 1.5 * length;
    wave->z = array_create(nx * ny, sizeof *wave->z);
    int status = wave->z == NULL ? error_memory(err, nx * ny * sizeof *wave->z, "a double sine")
                                 : compliance_create(&wave->compliance, &wave->grid, &deep, err);
    if (status == 0)
        status = contact_create(&wave->contact, wave->compliance, &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = mesh_error_create(&wave->mesh_error, wave->compliance, err);
    if (status == 0)
        status = edge_scan_create(&wave->scan, law, &wave->grid, false, err);
    return status;
}

/* Fills z with the wave of amplitude dx at one of its positions, which fill a cell of the grid
 * evenly, and are followed by these with x and y exchanged. */
static void wave_shift(struct double_sine *wave, size_t which) {
    const struct grid *grid = &wave->grid;
    const double position = (double)(which % POSITIONS);
    const double first = 0.37 + 0.6180339887498949 * position,
                 second = 0.21 + 0.7548776662466927 * position;
    const double x = which < POSITIONS ? first : second, y = which < POSITIONS ? second : first;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            wave->z[j * grid->nx + i] = grid_dx(grid) *
                                        cos(2 * M_PI * ((double)i + x) / (double)grid->nx) *
                                        cos(2 * M_PI * ((double)j + y) / (double)grid->ny);
}

static int add_loads(struct double_sine *wave, const struct area_law *law, struct squares *sums,
                     struct error *err) {
    double full = M_PI * grid_dx(&wave->grid) * hypot(1 / wave->grid.lx, 1 / wave->grid.ly);
    int status = contact_begin(wave->contact, wave->z, err);
    for (size_t k = 0; status == 0 && k < LOADS; k++) {
        struct contact_state state;
        struct edge_area area;
        struct mesh_error error;
        status = contact_press(wave->contact, LOAD[k] * full, &state, err);
        if (status != 0)
            break;
        edge_area_measure(wave->scan, &state, &area);
        mesh_error_measure(wave->mesh_error, &state, &error);
        double rate = state.tangent != NULL ? area.rate * state.stiffness : 0;
        double moved = rate * error.compliance, counted = area.nodes - law->overlap * area.sides;
        squares_add(sums, (area.straight + moved) / FRACTION[k] - 1,
                    rate * error.weighting / FRACTION[k], area.patches / FRACTION[k],
                    (counted + moved) / FRACTION[k] - 1);
    }
    return status;
}

static int make_edges(struct area_law *out, const struct grid *grid, const struct block *block,
                      struct error *err) {
    int status = edge_law_make(grid, block, &out->edge, err);
    /* The boundary of cells along a straight edge is 4/pi times as long as the edge, averaged over
     * angles. */
    out->overlap = status == 0 ? M_PI / 4 * edge_overlap(&out->edge) : 0;
    return status;
}

int area_law_make(const struct grid *grid, const struct block *block, struct area_law *out,
                  struct error *err) {
    struct double_sine wave = {0};
    struct squares squares = {0};
    struct block bare = *block;
    int status = compliance_check_spacings(grid, err);
    bare.coating = (struct coating){0};
    if (status == 0)
        status = make_edges(out, grid, &bare, err);
    if (status != 0)
        return status;
    out->patch = out->patch_of_nodes = 0;
    out->weighting = 1;
    if (grid_is_profile(grid))
        return block_is_coated(block) ? make_edges(out, grid, block, err) : 0;
    status = double_sine_open(&wave, &out->edge, grid, &bare, err);
    /* On equal spacings exchanged positions would add the same again. */
    const size_t positions = grid_dx(grid) == grid_dy(grid) ? POSITIONS : 2 * POSITIONS;
    for (size_t a = 0; status == 0 && a < positions; a++) {
        wave_shift(&wave, a);
        status = add_loads(&wave, out, &squares, err);
    }
    if (status == 0)
        squares_solve(&squares, compliance_has_weight(block), out);
    double_sine_close(&wave);
    if (status == 0 && block_is_coated(block))
        status = make_edges(out, grid, block, err);
    return status != 0 ? error_context(err, "law of contact areas") : 0;
}
