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

/* Up to this hardness the waves between the two ends are summed, above it the mirror images of the
 * load; either takes few terms there. */
static const double HARDNESS_OF_WAVES = 1;
enum { WAVES_MOST = 10 }; /* up to that hardness; exp(-100 pi^2/8) is 1e-54 */

/* Returns the term n of the sums over waves without its factor: V/H^2 = 1/(4 H^2). */
static double persson_wave(double n, double load, double hardness) {
    double decay = M_PI * n / hardness;
    return M_2_PI / n * sin(M_PI * n * load / hardness) * exp(-decay * decay / 8);
}

/* Returns the share absorbed at an end that is `first` away, the other end beyond the load: images
 * are mirrored at both ends, 2 H apart. */
static double persson_images(double first, double hardness) {
    double share = 0, last = 1;
    for (int n = 0; last > 0; n++) {
        last = erfc(M_SQRT2 * (2 * n * hardness + first));
        share += last - erfc(M_SQRT2 * (2 * (n + 1) * hardness - first));
    }
    return share;
}

double persson_plastic_area(double load, double hardness) {
    if (!(load >= 0 && load <= hardness && hardness > 0))
        return NAN;
    if (hardness > HARDNESS_OF_WAVES)
        return isinf(hardness) ? 0 : persson_images(hardness - load, hardness);
    double share = load / hardness;
    for (int n = 1; n <= WAVES_MOST; n++)
        share += (n % 2 == 1 ? -1 : 1) * persson_wave(n, load, hardness);
    return fmax(0, share);
}

double persson_elastic_area(double load, double hardness) {
    if (!(load >= 0 && load <= hardness && hardness > 0))
        return NAN;
    if (isinf(hardness))
        return persson_area(load);
    if (hardness > HARDNESS_OF_WAVES)
        return fmax(0,
                    1 - persson_images(load, hardness) - persson_images(hardness - load, hardness));
    double share = 0;
    for (int n = 1; n <= WAVES_MOST; n += 2)
        share += 2 * persson_wave(n, load, hardness);
    return fmax(0, share);
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
