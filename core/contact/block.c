#include "core/contact/block.h"
#include <math.h>

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

int block_check(const struct block *block, struct error *err) {
    if (!(block->poisson >= 0 && block->poisson < 0.5))
        return refuse(err, "Poisson's ratio", block->poisson, "0 or more, below 0.5");
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

size_t block_layers(const struct grid *grid, const struct block *block, double *thickness) {
    double first = grid_dx(grid);
    if (!grid_is_profile(grid))
        first = fmin(first, grid_dy(grid));
    /* In units of the first layer; a rounding error of the height adds no layer. */
    double height = block->height / first * (1 - 1e-12), total = 0, layer = 1;
    size_t count = 0;
    do {
        thickness[count++] = layer;
        total += layer;
        layer *= block->layer_growth;
    } while (total < height && count < LAYERS_MOST);
    if (!(total >= height && isfinite(total)))
        return 0;
    for (size_t k = 0; k < count; k++)
        thickness[k] *= block->height / total;
    return count;
}
