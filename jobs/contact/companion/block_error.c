#include "jobs/contact/companion/block_error.h"
#include "core/contact/compliance.h"
#include <math.h>

/* With a larger bound of its relative change the error of the height is estimated. */
static const double BLOCK_LOW = 1e-4;
/* The relative error of the block is that of a half-space on a coarse mesh; for other models and
 * meshes it holds within this part of itself. */
static const double BLOCK_MARGIN = 0.25;

double block_bound(const struct block *block, double longest) {
    static const double SAFETY = 10;
    double height = block->height;
    if (block_is_coated(block)) {
        struct block infinite = *block;
        double k = 2 * M_PI / longest;
        infinite.height = INFINITY;
        return SAFETY *
               fabs(1 - block_compliance_exact(k, block) / block_compliance_exact(k, &infinite));
    }
    /* 1 - (cosh 2x - 1)/(sinh 2x + 2x) (compliance.h), in a form without overflow and
     * cancellation. */
    double x = 2 * M_PI * height / longest;
    double falling = exp(-2 * x);
    if (!(falling > 0))
        return 0;
    return SAFETY * 2 * falling * (1 + 2 * x - falling) / (1 - falling * falling + 4 * x * falling);
}

bool block_is_low(double bound) {
    return bound > BLOCK_LOW;
}

struct contact_error block_error_high(double y, double bound) {
    return (struct contact_error){.value = 0 * y, .bound = bound * fabs(y), .order = NAN};
}

struct contact_error block_error_low(double y, double block, struct estimate change) {
    double scale = block != 0 ? y / block : (double)NAN;
    return (struct contact_error){.value = scale * change.value,
                                  .bound = BLOCK_MARGIN * fabs(scale * change.value),
                                  .standard_error = fabs(scale) * change.standard_error,
                                  .order = NAN};
}
