/* Contact areas under load, from those of the undeformed face (F14.5). They are fractions of the
 * periodic cell, whose area stays. */
#ifndef RUGO_CORE_CONTACT_STRETCH_H
#define RUGO_CORE_CONTACT_STRETCH_H

#include <math.h>

/* Returns the area of the open face over its undeformed area, to first order: the part in contact
 * shrinks under its pressure, and the open face, which carries none, fills the cell by an even
 * strain. pressure: mean over the cell, in E*. */
static inline double stretch_open(double poisson, double pressure) {
    return 1 + (1 - 2 * poisson) / (1 - poisson) * pressure;
}

/* Returns the fraction in contact under load when the open face has grown by a factor. */
static inline double stretch_fraction(double fraction, double open) {
    return fraction - (1 - fraction) * (open - 1);
}

/* The same where the stretch of the nodes in contact, a share `nodes` of the face, is measured
 * (F14.6), so that the first order is not needed. Returns that stretch: where a face overhangs,
 * cells that are turned over count against those in contact, which then seem more than the whole.
 */
static inline double stretch_touching(double nodes, double stretch) {
    return stretch * nodes > 1 + 1e-9 ? 1 / nodes : stretch;
}
/* Returns the factor of the open face, for stretch_fraction, from stretch_touching(). */
static inline double stretch_rest(double nodes, double touching) {
    return nodes < 1 ? (1 - touching * nodes) / (1 - nodes) : 1;
}

/* Beyond this strain, of the open face or where it touches, the first order does not hold. */
#define STRETCH_MOST 0.5
/* Returns the area `fraction` shrunk by `shrinks`; NaN where a strain is beyond STRETCH_MOST. */
static inline double stretch_held(double fraction, double open, double shrinks) {
    return open - 1 <= STRETCH_MOST && shrinks <= STRETCH_MOST * fraction ? fraction - shrinks
                                                                          : (double)NAN;
}
/* Returns the same of a face that grows by stretch_open(). */
static inline double stretch_first_order(double fraction, double open) {
    return stretch_held(fraction, open, (1 - fraction) * (open - 1));
}
/* Returns the same of a map in free space, over its undeformed area: the part in contact shrinks,
 * and no side holds what is around it. */
static inline double stretch_free(double fraction, double open) {
    return stretch_held(fraction, open, open - 1);
}

#endif
