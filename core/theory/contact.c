#include "core/theory/contact.h"
#include <math.h>

double persson_area(double load) {
    return load >= 0 ? erf(M_SQRT2 * load) : NAN;
}

double persson_pressure_pdf(double x, double load) {
    if (!(x >= 0 && load >= 0))
        return NAN;
    /* exp(-2 (x - load)^2) - exp(-2 (x + load)^2), V = 1/4, without their cancellation. */
    double apart = x - load;
    return -sqrt(2 / M_PI) * exp(-2 * apart * apart) * expm1(-8 * x * load);
}

double persson_light_load(void) {
    return sqrt(8 / M_PI);
}

double bgt_light_load(void) {
    return sqrt(2 * M_PI);
}

double westergaard_area(double ratio) {
    return ratio >= 0 && ratio <= 1 ? M_2_PI * asin(sqrt(ratio)) : NAN;
}

double westergaard_pressure(double x, double ratio) {
    if (!(isfinite(x) && ratio > 0 && ratio <= 1))
        return NAN;
    double psi = M_PI * (x - round(x)); /* from the nearest crest */
    double below_edge = ratio - sin(psi) * sin(psi);
    return below_edge > 0 ? 2 * cos(psi) / ratio * sqrt(below_edge) : 0;
}

double westergaard_gap(double ratio) {
    if (!(ratio >= 0 && ratio <= 1))
        return NAN;
    /* The block sinks under its mean pressure as under an array of flat punches of the contact's
     * width, d(gap)/d(ratio) = ln(ratio) (Johnson 1985). This is the integral, zero at full
     * contact. */
    return ratio > 0 ? (1 - ratio) + ratio * log(ratio) : 1;
}
