#include "core/contact/compliance.h"
#include "core/contact/coating.h"
#include "core/contact/free_space.h"
#include "core/contact/layered.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>

static size_t wave_count(const struct grid *grid) {
    return (grid->nx / 2 + 1) * grid->ny;
}

bool compliance_has_weight(const struct block *block) {
    return block->model == MODEL_LAYERED && block->weighting == GAP_STANDARD;
}

/* S of an elastic layer whose far side stays flat and free of shear (F10.2). q = exp(-2kH) is
 * factored out of the hyperbolic functions, so that no term overflows or cancels. */
static double block_compliance(double k, double height) {
    double x = 2 * k * height;
    if (isinf(x))
        return 2 / k;
    if (!(x > 0))
        return height;
    double q = exp(-x), e = -expm1(-x);
    return 2 / k * e / (1 + q + 2 * q * (x / e));
}

double block_compliance_exact(double k, const struct block *block) {
    return block_is_coated(block) ? coating_compliance(k, block)
                                  : block_compliance(k, block->height);
}

static void halfspace_lengths(struct compliance *compliance) {
    const struct grid *grid = &compliance->grid;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++)
            compliance->length[mx * grid->ny + row] =
                mx == 0 && row == 0 ? 0
                                    : block_compliance_exact(transform_wave_number(grid, mx, row),
                                                             &compliance->block);
}

static void weight_symbols(struct compliance *compliance) {
    const struct grid *grid = &compliance->grid;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++)
            compliance->weight[mx * grid->ny + row] =
                gap_weight_symbol(mx, grid->nx) *
                gap_weight_symbol(transform_row_mode(grid, row), grid->ny);
}

/* Refuses lengths whose ratios overflow or underflow a double. */
static int lengths_check(const struct compliance *compliance, struct error *err) {
    for (size_t k = 1; k < compliance->waves; k++)
        if (!(compliance->length[k] > 0 && isfinite(compliance->length[k])))
            return error_set(err, ERROR_INPUT,
                             "block height %g on a cell of length %g: their ratio is out of range",
                             compliance->block.height, compliance->grid.lx);
    return 0;
}

static int compliance_allocate(struct compliance *compliance, struct error *err) {
    size_t waves = compliance->waves;
    compliance->length = array_create(waves, sizeof *compliance->length);
    if (compliance_has_weight(&compliance->block))
        compliance->weight = array_create(waves, sizeof *compliance->weight);
    if (compliance->length == NULL ||
        (compliance_has_weight(&compliance->block) && compliance->weight == NULL))
        return error_memory(err, waves * sizeof *compliance->length, "the compliance");
    return 0;
}

static int compliance_fill(struct compliance *compliance, struct error *err) {
    int status = 0;
    if (compliance->open)
        return free_space_symbol(&compliance->grid, &compliance->waved, &compliance->block,
                                 compliance->length, err);
    if (compliance->block.model == MODEL_LAYERED)
        status = layered_lengths(&compliance->grid, &compliance->block, compliance->length,
                                 &compliance->layers, err);
    else
        halfspace_lengths(compliance);
    if (compliance->weight != NULL)
        weight_symbols(compliance);
    return status != 0 ? status : lengths_check(compliance, err);
}

int compliance_check_spacings(const struct grid *grid, struct error *err) {
    enum { RATIO_MOST = 100 };
    const double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    if (fmax(dx, dy) <= RATIO_MOST * fmin(dx, dy))
        return 0;
    return error_set(
        err, ERROR_INPUT,
        "points %g by %g apart: contact can be computed where one spacing is at most %d "
        "times the other",
        dx, dy, RATIO_MOST);
}

static int open_check(const struct grid *grid, const struct block *block, struct error *err) {
    if (block->model != MODEL_HALFSPACE)
        return error_set(err, ERROR_INPUT,
                         "a map that does not repeat is pressed on a half-space alone: a mesh of "
                         "finite elements needs a periodic cell");
    if (!isinf(block->height))
        return error_set(err, ERROR_INPUT,
                         "block height %g under a map that does not repeat; allowed: infinite",
                         block->height);
    return compliance_check_spacings(grid, err);
}

static int create(struct compliance **out, const struct grid *grid, const struct block *block,
                  bool open, struct error *err) {
    *out = NULL;
    int status = grid_check(grid, err);
    if (status == 0)
        status = block_check(block, err);
    if (status == 0 && open)
        status = open_check(grid, block, err);
    if (status != 0)
        return status;
    struct compliance *compliance = array_create(1, sizeof *compliance);
    if (compliance == NULL)
        return error_memory(err, sizeof *compliance, "the compliance");
    *compliance = (struct compliance){.grid = *grid, .block = *block, .open = open, .waved = *grid};
    if (open)
        free_space_padded(grid, block, &compliance->waved);
    status = grid_check(&compliance->waved, err);
    compliance->waves = wave_count(&compliance->waved);
    if (status == 0)
        status = compliance_allocate(compliance, err);
    if (status == 0)
        status = compliance_fill(compliance, err);
    if (status != 0)
        compliance_destroy(&compliance);
    *out = compliance;
    return status;
}

int compliance_create(struct compliance **out, const struct grid *grid, const struct block *block,
                      struct error *err) {
    return create(out, grid, block, false, err);
}

int compliance_create_open(struct compliance **out, const struct grid *grid,
                           const struct block *block, struct error *err) {
    return create(out, grid, block, true, err);
}

void compliance_destroy(struct compliance **compliance) {
    if (compliance == NULL || *compliance == NULL)
        return;
    free((*compliance)->length);
    free((*compliance)->weight);
    free(*compliance);
    *compliance = NULL;
}

double compliance_bytes(const struct grid *grid, const struct block *block) {
    size_t columns = grid->nx / 2 + 1; /* grid_check has not passed yet: the product may overflow */
    double waves = (double)columns * (double)grid->ny;
    return sizeof(struct compliance) +
           waves * sizeof(double) * (compliance_has_weight(block) ? 2 : 1);
}
