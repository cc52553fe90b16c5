#include "core/surface/plateau_face.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

static double density(double score) {
    return exp(-score * score / 2) / sqrt(2 * M_PI);
}

struct stratified_heights stratified_heights_of(double valley, double plateau, double offset) {
    const double spread = hypot(valley, plateau), score = offset / spread;
    const double first = gsl_cdf_ugaussian_P(score), second = gsl_cdf_ugaussian_Q(score);
    const double mean = offset * second - spread * density(score);
    const double square = valley * valley * first + (plateau * plateau + offset * offset) * second -
                          offset * spread * density(score);
    return (struct stratified_heights){.valley = valley,
                                       .plateau = plateau,
                                       .offset = offset,
                                       .mean = mean,
                                       .deviation = sqrt(square - mean * mean),
                                       .valley_share = first};
}

double stratified_cdf(const struct stratified_heights *heights, double z) {
    const double at = heights->mean + z * heights->deviation;
    const double first = at / heights->valley;
    const double second = (at - heights->offset) / heights->plateau;
    const double below = gsl_cdf_ugaussian_P(first), other = gsl_cdf_ugaussian_P(second);
    return below + other * gsl_cdf_ugaussian_Q(first); /* keeps the digits of the lower tail */
}

/* Of smooth integrands that vanish at both ends the trapezoidal rule converges faster than any
 * power of the step. */
struct height_moments stratified_moments(const struct stratified_heights *heights) {
    static const double REACH = 12, STEP = 0.1; /* in deviations, of the narrower law */
    const double valley = heights->valley, plateau = heights->plateau, offset = heights->offset;
    const double low = fmin(-REACH * valley, offset - REACH * plateau);
    const double high = fmin(REACH * valley, offset + REACH * plateau);
    const size_t count = (size_t)ceil((high - low) / (STEP * fmin(valley, plateau)));
    const double step = (high - low) / (double)count;
    double third = 0, fourth = 0;
    for (size_t n = 0; n <= count; n++) {
        const double z = low + (double)n * step, first = z / valley,
                     second = (z - offset) / plateau;
        const double p = density(first) / valley * gsl_cdf_ugaussian_Q(second) +
                         density(second) / plateau * gsl_cdf_ugaussian_Q(first);
        const double about = (z - heights->mean) / heights->deviation;
        third += p * pow(about, 3);
        fourth += p * pow(about, 4);
    }
    return (struct height_moments){.mean = heights->mean,
                                   .deviation = heights->deviation,
                                   .skewness = third * step,
                                   .kurtosis = fourth * step,
                                   .lowest = -(double)INFINITY,
                                   .highest = (double)INFINITY};
}

double stratified_offset(double rms_ratio, double material_ratio) {
    return (1 - rms_ratio) * gsl_cdf_ugaussian_Qinv(material_ratio);
}
