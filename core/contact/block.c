#include "core/contact/block.h"
#include <math.h>

double gap_weight_symbol(size_t mode, size_t n) {
    return (2 + cos(2 * M_PI * (double)mode / (double)n)) / 3;
}

static int refuse(struct error *err, const char *what, double value, const char *allowed) {
    return error_set(err, ERROR_INPUT, "%s = %g; allowed: %s", what, value, allowed);
}

static int layered_check(const struct block *block, struct error *err) {
    if (!(block->height > 0 && isfinite(block->height)))
        return refuse(err, "block height", block->height, "above 0, finite for a layered block");
    if (!(block->layer_growth >= 1 && block->layer_growth <= 2))
        return refuse(err, "layer growth", block->layer_growth, "1 to 2");
    if (block->weighting != GAP_STANDARD && block->weighting != GAP_DUAL)
        return error_set(err, ERROR_INPUT, "gap weighting %d is unknown", (int)block->weighting);
    return 0;
}

static int coating_check(const struct block *block, struct error *err) {
    const struct coating *coating = &block->coating;
    if (coating->thickness == 0)
        return 0;
    if (!(coating->thickness > 0 && coating->thickness < INFINITY))
        return refuse(err, "coating thickness", coating->thickness, "0 (none) or above, finite");
    if (!(coating->thickness < block->height))
        return error_set(err, ERROR_INPUT,
                         "coating thickness = %g; allowed: below the block height, %g",
                         coating->thickness, block->height);
    if (!(coating->modulus >= COATING_LEAST && coating->modulus <= COATING_MOST))
        return refuse(err, "modulus of the coating over that of the block", coating->modulus,
                      "0.001 to 1000");
    if (!(coating->poisson >= 0 && coating->poisson < 0.5))
        return refuse(err, "Poisson's ratio of the coating", coating->poisson,
                      "0 or more, below 0.5");
    return 0;
}

static int model_check(const struct block *block, struct error *err) {
    switch (block->model) {
    case MODEL_HALFSPACE:
        if (!(block->height > 0))
            return refuse(err, "block height", block->height, "above 0, or infinite");
        return 0;
    case MODEL_LAYERED:
        return layered_check(block, err);
    }
    return error_set(err, ERROR_INPUT, "contact model %d is unknown", (int)block->model);
}

int block_check(const struct block *block, struct error *err) {
    if (!(block->poisson >= 0 && block->poisson < 0.5))
        return refuse(err, "Poisson's ratio", block->poisson, "0 or more, below 0.5");
    int status = model_check(block, err);
    return status != 0 ? status : coating_check(block, err);
}

double block_coating_stiffness(const struct block *block) {
    const struct coating *coating = &block->coating;
    if (!block_is_coated(block))
        return 1;
    return coating->modulus * (1 - block->poisson * block->poisson) /
           (1 - coating->poisson * coating->poisson);
}

/* Fills a part of a block with layers that grow from *layer on, in units of `first`. Returns their
 * number, at most `room`, or 0 where they are too many. */
static size_t fill_part(double part, double first, double growth, size_t room, double *layer,
                        double *thickness) {
    /* A rounding error of the height adds no layer. */
    double height = part / first * (1 - 1e-12), total = 0;
    size_t count = 0;
    while (count < room && (count == 0 || total < height)) {
        thickness[count++] = *layer;
        total += *layer;
        *layer *= growth;
    }
    if (!(total >= height && isfinite(total)))
        return 0;
    for (size_t k = 0; k < count; k++)
        thickness[k] *= part / total;
    return count;
}

size_t block_layers(const struct grid *grid, const struct block *block, double *thickness) {
    const double growth = block->layer_growth, coated = block->coating.thickness;
    double first = grid_dx(grid), layer = 1;
    size_t coating = 0;
    if (!grid_is_profile(grid))
        first = fmin(first, grid_dy(grid));
    if (block_is_coated(block)) {
        coating = fill_part(coated, first, growth, LAYERS_MOST, &layer, thickness);
        if (coating == 0)
            return 0;
    }
    size_t below = fill_part(block->height - coated, first, growth, LAYERS_MOST - coating, &layer,
                             thickness + coating);
    return below > 0 ? coating + below : 0;
}
