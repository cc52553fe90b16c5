/* The lay of a surface whose waves are longer in one direction than across it: its spectral density
 * is that of ellipses, C(kx, ky) = f(k'), with k' as below. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_LAY_H
#define RUGO_CORE_STATISTICS_SPECTRA_LAY_H

#include <math.h>
#include <stdbool.h>

struct lay {
    double ratio; /* of wavelengths along the lay to those across; 1: there is none */
    double angle; /* from x to the lay, counter-clockwise, radians in (-pi/2, pi/2] */
    /* Standard errors, of the logarithm of the ratio and of the angle in radians; 0: given. */
    double ratio_error, angle_error;
};
#define LAY_NONE ((struct lay){.ratio = 1})

static inline bool lay_is_plain(const struct lay *lay) {
    return lay->ratio == 1;
}

/* Axes of a lay: a wave vector (x, y) has the components (along_x x + along_y y) along it, already
 * times the ratio, and (across_x x + across_y y) across it. */
struct lay_frame {
    double along_x, along_y, across_x, across_y;
};
static inline struct lay_frame lay_frame_of(const struct lay *lay) {
    const double sine = sin(lay->angle), cosine = cos(lay->angle);
    return (struct lay_frame){lay->ratio * cosine, lay->ratio * sine, -sine, cosine};
}
/* Returns k', the wave number across the lay that has the density of a wave vector. */
static inline double lay_length(const struct lay_frame *frame, double x, double y) {
    return hypot(frame->along_x * x + frame->along_y * y,
                 frame->across_x * x + frame->across_y * y);
}

#endif
