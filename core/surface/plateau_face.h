/* Stratified faces, as honing leaves them: at each point the lower of two independent Gaussian
 * surfaces (FORMULAS.md, F18.37). The first has the valleys; the second is the plateau to which its
 * hills were worn down. Heights are about the mean of the face. */
#ifndef RUGO_CORE_SURFACE_PLATEAU_FACE_H
#define RUGO_CORE_SURFACE_PLATEAU_FACE_H

#include "core/surface/height_moments.h"
#include "core/surface/modes.h"
#include "core/surface/surface_options.h"

/* The second surface. Its random numbers are its own (PLATEAU_BIT of random.h). Neither surface may
 * be translated, have heights that are not Gaussian, or a counter face. */
struct plateau_face {
    struct spectrum spectrum; /* its scale is not used */
    struct surface_options options;
    double rms_ratio; /* its RMS height over that of the first, above 0 */
    double offset;    /* its mean above that of the first, in RMS heights of the first */
};

/* Returns the spectrum of the plateau of a stratified face, whose valleys have this RMS height on
 * the grid. */
struct spectrum plateau_spectrum(const struct spectrum *valleys, double rms_height);

/* What the lower of two independent normal variables has: the first of mean 0 and deviation
 * `valley`, the second of mean `offset` and deviation `plateau` (F18.60; Clark 1961). */
struct stratified_heights {
    double valley, plateau, offset; /* in any one unit */
    double mean, deviation;         /* of the lower one */
    double valley_share;            /* probability that the first is the lower one */
};
/* Computes the other fields from the first three, deviations being above 0. */
struct stratified_heights stratified_heights_of(double valley, double plateau, double offset);
/* Returns the probability of heights below z, in deviations about the mean of the lower one. */
double stratified_cdf(const struct stratified_heights *heights, double z);
/* Returns its moments, by quadrature; the mean is that about the mean of the first. */
struct height_moments stratified_moments(const struct stratified_heights *heights);
/* Returns the offset, in deviations of the first, at which the straight lines of both on a normal
 * plot cross at a material ratio (Smq) in (0, 1); rms_ratio is not 1. */
double stratified_offset(double rms_ratio, double material_ratio);

#endif
