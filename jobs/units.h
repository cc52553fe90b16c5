/* Physical units of results. All that is computed and stored is dimensionless. Units come in here
 * alone, when results are read to be shown. */
#ifndef RUGO_JOBS_UNITS_H
#define RUGO_JOBS_UNITS_H

#include "schema/result/result.h"

/* Sets the units of axes and scalars by the parameters and the scalars of the result, of any kind.
 * Lengths need /surface/unit, pressures E in Pa: /contact/young of a case with that parameter, or
 * with loads in Pa. What is not known stays without a unit. */
void units_set(struct case_result *result);
/* The same by what is known of the contact of a map, by its scalars rms_height and rms_slope. */
struct map_scales {
    bool profile;
    double metres;      /* of a unit of length; NaN: not known, as all below */
    double modulus;     /* E* in Pa */
    double resistivity; /* of both bodies together: ohm m, or to heat m K/W */
    bool heat;
};
void units_set_of_map(struct case_result *result, const struct map_scales *known);
/* Finds lambda_s in metres and E* in Pa, NaN where not known, by parameters alone. */
void units_scales(const struct case_result *result, double *metres, double *modulus);

#endif
