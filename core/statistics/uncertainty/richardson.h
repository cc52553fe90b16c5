/* Discretisation error of a value on the finest of several mesh levels, estimated from its changes
 * from level to level (FORMULAS.md, F15.3). With f(h) = f_limit + c h^q, f on the finest level less
 * the limit is factor * (f_next - f_finest), factor = 1/(r^q - 1) and r = h_next/h_finest > 1.
 *
 * This is the error, with its sign, only where the changes of three levels shrink by about the
 * known order of the quantity. Otherwise these changes bound the error on both sides. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_RICHARDSON_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_RICHARDSON_H

#include <stdbool.h>

/* Of one value from level to level. */
struct mesh_changes {
    double fine;         /* finest less next */
    double coarse;       /* next less third; NaN: there is no third level */
    double fine_ratio;   /* h_next/h_finest */
    double coarse_ratio; /* h_third/h_next */
};
/* Finest less limit lies within error +- bound. */
struct mesh_error {
    double error;  /* 0 where no order is seen */
    double bound;  /* NaN where fine is */
    double weight; /* by how much a change of `fine` changes error and bound together */
    double order;  /* seen on the three levels; NaN: none, or not near the known one */
};
/* order: the one that is known of the quantity. */
struct mesh_error mesh_error(const struct mesh_changes *changes, double order);

#endif
