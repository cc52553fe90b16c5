/* Hertz's contacts of one summit (F11.3), against which solvers are held. */
#ifndef RUGO_TESTS_SUPPORT_HERTZ_H
#define RUGO_TESTS_SUPPORT_HERTZ_H

#include <math.h>

/* Half-width of a line contact: a^2 = 4 P R/(pi E*). load_over_modulus: P/E*, P the load per
 * length. */
static inline double hertz_line_half_width(double load_over_modulus, double radius) {
    return 2 * sqrt(load_over_modulus * radius / M_PI);
}

/* Radius of a circular contact: a^3 = 3 P R/(4 E*). load_over_modulus: P/E*, P the force. */
static inline double hertz_sphere_radius(double load_over_modulus, double radius) {
    return cbrt(0.75 * load_over_modulus * radius);
}

#endif
