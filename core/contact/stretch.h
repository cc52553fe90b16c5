/* Contact areas as they are under load, from those of the undeformed face (F14.5). Fractions of the
 * periodic cell, whose area stays. */
#ifndef RUGO_CORE_CONTACT_STRETCH_H
#define RUGO_CORE_CONTACT_STRETCH_H

/* Returns how many times as large as undeformed the open face is, to first order: what touches
 * shrinks under its pressure, and the open face, which carries none, fills the cell by an even
 * strain. pressure: mean over the cell, in E*. */
static inline double stretch_open(double poisson, double pressure) {
    return 1 + (1 - 2 * poisson) / (1 - poisson) * pressure;
}

/* Returns the fraction in contact under load when the open part of the face has grown by a factor.
 */
static inline double stretch_fraction(double fraction, double open) {
    return fraction - (1 - fraction) * (open - 1);
}

#endif
