/* The surface of a given spectrum that is nearest to another one: phases stay, amplitudes are given
 * (FORMULAS.md, F5.1). */
#ifndef RUGO_CORE_SURFACE_IMPOSE_H
#define RUGO_CORE_SURFACE_IMPOSE_H

#include "core/surface/spectrum.h"
#include <complex.h>

/* Gives a half spectrum, as transforms on the grid and band of modes have it, these amplitudes,
 * laid out as modes->power; all other modes become zero. */
void amplitudes_impose(const struct modes *modes, const double *amplitude,
                       double complex *spectrum);

#endif
