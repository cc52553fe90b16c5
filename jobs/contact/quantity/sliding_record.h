/* Points of curves by sliding, filled as a solver goes along the path of the flat: between two of
 * its states values go evenly. Private to jobs/contact/quantity. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_SLIDING_RECORD_H
#define RUGO_JOBS_CONTACT_QUANTITY_SLIDING_RECORD_H

#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"

enum { SLIDING_VALUES = SLIDING_DISSIPATION - SLIDING_FORCE + 1 };

/* One state of a solver. */
struct sliding_sample {
    double sliding;            /* of the flat over the mean of the face, over the RMS height */
    double of[SLIDING_VALUES]; /* from SLIDING_FORCE on; NaN: not known */
};
/* Returns a sample of which nothing is known. */
struct sliding_sample sliding_sample_none(void);

struct sliding_record {
    const struct contact_case *one_case; /* borrowed, as the next */
    double *values;                      /* [measure * stride + point], of all measures */
    size_t stride;
    size_t next; /* point without values; the last state lies before it */
    struct sliding_sample last;
};
/* Begins with the state before the flat moves, the first point. */
void sliding_record_begin(struct sliding_record *record, const struct sliding_sample *start);
/* Goes on to another state, and fills the points up to it. */
void sliding_record_add(struct sliding_record *record, const struct sliding_sample *sample);
/* Returns the turning point that the path goes to at the next point. */
size_t sliding_record_turn(const struct sliding_record *record);
static inline bool sliding_record_is_full(const struct sliding_record *record) {
    return record->next >= record->one_case->slide_count;
}

#endif
