/* Means of a measure over realisations of which some may lack a value. On the finest level, where
 * the most complete model lacks values that another one has in all realisations, the mean is that
 * of the other one over all, less the mean of their difference over those that have both: a control
 * variate (Glasserman 2004, section 4.1). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_MEAN_H
#define RUGO_JOBS_CONTACT_CONTACT_MEAN_H

#include "jobs/contact/contact_tally.h"

struct estimate contact_mean(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model, size_t level, size_t load);
/* The model that such a mean is made by; model_count where it is the plain one. */
size_t contact_mean_control(const struct contact_tally *tally, enum contact_measure measure,
                            size_t model, size_t level, size_t load);

#endif
