/* The realisations that a side solve takes. An error of a source is estimated from pairs of solves
 * on some realisations of a case, since differences scatter less than values. */
#ifndef RUGO_JOBS_SUBSET_H
#define RUGO_JOBS_SUBSET_H

#include "schema/study/study.h"
#include <stdbool.h>
#include <stdint.h>

/* Each first_interval-th of the first realisations, and each interval-th of the others. */
struct subset {
    uint64_t first, first_interval, interval; /* interval 0: no realisation */
};

static inline bool subset_has(const struct subset *subset, uint64_t realisation) {
    uint64_t interval = realisation < subset->first ? subset->first_interval : subset->interval;
    return subset->interval != 0 && realisation % interval == 0;
}

/* Returns a number that counts up from 0 along the realisations of a subset; early ones may share
 * theirs with later ones. */
static inline uint64_t subset_ordinal(const struct subset *subset, uint64_t realisation) {
    return realisation / (realisation < subset->first ? subset->first_interval : subset->interval);
}

/* Makes the subset of each interval-th realisation. Among the first STUDY_EARLY at least each
 * eighth is in it, so that small studies have some. */
static inline struct subset subset_each(uint64_t interval) {
    const uint64_t first_interval = 8;
    return (struct subset){STUDY_EARLY, interval > first_interval ? first_interval : interval,
                           interval};
}

/* Returns the interval at which a solve of so many seconds takes no more than is allowed a
 * realisation: `least` times a power of two, up to 2^20. */
static inline uint64_t subset_interval(double seconds, double allowed, uint64_t least) {
    const uint64_t most = UINT64_C(1) << 20;
    uint64_t interval = least;
    while (interval < most && !(seconds <= (double)interval * allowed))
        interval *= 2;
    return interval;
}

#endif
