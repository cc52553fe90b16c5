/* Theories and exact solutions of elastic, frictionless contact, in dimensionless form
 * (FORMULAS.md, sections 11 and 13).
 *
 * load = p/(E* h'), where p is the mean pressure and h' the RMS slope of the surface. Functions
 * return NaN outside their domain. */
#ifndef RUGO_CORE_THEORY_CONTACT_H
#define RUGO_CORE_THEORY_CONTACT_H

#include <stddef.h>

/* Returns Persson's (2001) contact fraction erf(sqrt(2) load), load >= 0. */
double persson_area(double load);
/* Returns the density of the pressure x = p/(E* h') over the nominal area, x >= 0 (its integral
 * over x > 0 is the contact fraction). */
double persson_pressure_pdf(double x, double load);
/* Return the fractions of the cell that bear the hardness, and less than it, of an elastic, ideally
 * plastic block: Persson's theory with a second absorbing end at that pressure. 0 <= load <=
 * hardness; hardness is in E* h', may be INFINITY, and is above 0. */
double persson_plastic_area(double load, double hardness);
double persson_elastic_area(double load, double hardness);

/* Returns the slope kappa of the fraction over the load as the load tends to 0. */
double persson_light_load(void); /* sqrt(8/pi) */
double bgt_light_load(void);     /* sqrt(2 pi); Bush, Gibson & Thomas (1975) */

/* Whole curves for a Gaussian isotropic surface with Nayak parameter alpha > 3/2: the load and the
 * fraction at each of n separations s (in sqrt(m0), from the mean plane; finite), to 1e-11
 * relative. Summits are pressed alone, without interaction. This holds at light load; at high load
 * the fraction exceeds 1, unchecked.
 *
 * bgt: Bush, Gibson & Thomas (1975), elliptic asperities with Nayak's joint density, in the form of
 *   Carbone & Bottiglione (2008).
 * gw_mccool: Greenwood & Williamson (1966) with McCool's (1986) parameters from the moments: equal
 *   spherical asperities, Gaussian heights of summits. */
void bgt_curve(double alpha, size_t n, const double *separation, double *load, double *area);
void gw_mccool_curve(double alpha, size_t n, const double *separation, double *load, double *area);
/* These return the fraction at a given load from 1e-250 to 1e6, by inversion of the above to 1e-11
 * relative. It rises with the load. NaN also when a few hundred bytes cannot be allocated. */
double bgt_area(double load, double alpha);
double gw_mccool_area(double load, double alpha);

/* Returns Westergaard's (1939) contact fraction of one wave z = amplitude cos(2 pi x/wavelength),
 * ratio = p/p* in [0, 1], p* = pi E* amplitude/wavelength. */
double westergaard_area(double ratio);
/* Returns the local over the mean pressure at the position x, in wavelengths from a crest; ratio >
 * 0. */
double westergaard_pressure(double x, double ratio);
/* Returns the mean gap over the amplitude: 1 - ratio + ratio ln(ratio). */
double westergaard_gap(double ratio);

#endif
