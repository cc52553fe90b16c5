/* Nayak's (1971) theory of the summits of Gaussian isotropic surfaces, in the normalisation of
 * FORMULAS.md, section 6: z* = z/sqrt(m0), t1 = -sqrt(3/m4) kappa_m, kappa_m = -(z_xx + z_yy)/2.
 * Functions return NaN for alpha <= 3/2 or a NaN argument, and are stable for every alpha > 3/2. */
#ifndef RUGO_CORE_THEORY_NAYAK_H
#define RUGO_CORE_THEORY_NAYAK_H

/* These return the probability density of summit heights (F6.2), and its integral from -infinity
 * (F6.3). */
double nayak_summit_pdf(double z, double alpha);
double nayak_summit_cdf(double z, double alpha);
/* Returns the joint density of summit height and equivalent curvature (F6.1); 0 for t1 >= 0. */
double nayak_joint_pdf(double z, double t1, double alpha);
/* Returns the expected mean curvature of summits at height z over sqrt(m4) (F6.5). */
double nayak_mean_curvature(double z, double alpha);
/* Returns summits per area (F6.7); m2 and m4 are the isotropic moments. NaN unless both are finite,
 * m2 > 0 and m4 >= 0. */
double nayak_summit_density(double m2, double m4);
/* Return mean and variance of summit heights z* (F6.4), and the mean of kappa_m/sqrt(m4) over all
 * summits (F6.5). */
double nayak_summit_mean(double alpha);
double nayak_summit_variance(double alpha);
double nayak_overall_curvature(void);

/* Peaks of profiles, alpha = m0 m4/m2^2 > 1 (F7.1, F7.2; Rice 1945; Cartwright & Longuet-Higgins
 * 1956): density of peak heights, its integral, joint density with t1 = z''/sqrt(m4) < 0, expected
 * curvature -z''/sqrt(m4) of peaks at height z, and peaks per length. */
/* Computes density and mean curvature at a height together, at the cost of one. */
void profile_peak(double z, double alpha, double *pdf, double *curvature);
double profile_peak_pdf(double z, double alpha);
double profile_peak_cdf(double z, double alpha);
double profile_peak_joint_pdf(double z, double t1, double alpha);
double profile_mean_curvature(double z, double alpha);
double profile_peak_density(double m2, double m4);

/* Expected values of the summits of a surface (dimension 2: F6.4, F6.5, F6.7, F6.11) or the peaks
 * of a profile (dimension 1: F7.2 to F7.4). */
struct summit_expectation {
    double density;                                                        /* per area (length) */
    double height_mean, height_variance, height_skewness, height_kurtosis; /* of z* */
    double curvature; /* mean curvature over sqrt(m4), over all summits */
};
struct summit_expectation summit_expectation(int dimension, double m2, double m4, double alpha);

#endif
