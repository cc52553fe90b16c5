/* Heights of a translated surface in units of its RMS height, as a rising function of its Gaussian
 * field; and those of the mirrored surface -z, whose summits are the pits of z. The field has the
 * distribution of its mirror image, so that -z is translated from such a field by -f(-g). */
#ifndef RUGO_CORE_THEORY_TRANSLATED_HEIGHTS_H
#define RUGO_CORE_THEORY_TRANSLATED_HEIGHTS_H

#include "core/surface/translation/height_function.h"
#include <stdbool.h>

struct translated_heights {
    const struct height_function *function; /* borrowed */
    bool mirrored;
};

static inline struct height_slope translated_heights_at(const struct translated_heights *heights,
                                                        double gaussian) {
    if (!heights->mirrored)
        return height_function_at(heights->function, gaussian);
    struct height_slope at = height_function_at(heights->function, -gaussian);
    return (struct height_slope){-at.height, at.slope};
}

static inline double translated_heights_inverse(const struct translated_heights *heights,
                                                double height) {
    return heights->mirrored ? -height_function_inverse(heights->function, -height)
                             : height_function_inverse(heights->function, height);
}

#endif
