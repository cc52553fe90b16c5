#include "core/surface/surface.h"
#include "core/surface/transform.h"

int surface_resample(const struct grid *from, const double *z, const struct grid *to, double *out,
                     size_t mode_x, size_t mode_y, struct error *err) {
    struct transform *coarse = NULL, *fine = NULL;
    int status = transform_create(&coarse, from, mode_x, mode_y, err);
    if (status == 0)
        status = transform_create(&fine, to, mode_x, mode_y, err);
    if (status == 0) {
        transform_forward(coarse, z);
        transform_pad(coarse, fine);
        transform_inverse(fine, out);
    }
    transform_destroy(&coarse);
    transform_destroy(&fine);
    return status;
}
