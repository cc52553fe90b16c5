/* What a value owes to one source of error: what is told less what is true lies within value +-
 * bound. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ERROR_H
#define RUGO_JOBS_CONTACT_CONTACT_ERROR_H

struct contact_error {
    double value; /* NaN: not known at this load */
    double bound, standard_error;
    double order;        /* of the mesh, where the levels show it; else NaN */
    double bound_chance; /* how far chance may bring the bound, one standard error; 0: not told */
};
#endif
