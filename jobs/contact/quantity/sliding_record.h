/* Points of curves by sliding, filled as a solver goes along the path of the flat: between two of
 * its states values go evenly. Private to jobs/contact/quantity. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_SLIDING_RECORD_H
#define RUGO_JOBS_CONTACT_QUANTITY_SLIDING_RECORD_H

#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"

/* What is known of a state, in the order of the measures. */
enum {
    SAMPLE_FORCE,
    SAMPLE_STICK_AREA,
    SAMPLE_STICK_LOAD,
    SAMPLE_AREA,
    SAMPLE_GAP,
    SAMPLE_DISSIPATION,
    SLIDING_BY_NODES,
    SAMPLE_STICK_EDGES = SLIDING_BY_NODES, /* from here on those of SLIDING_EDGES */
    SAMPLE_AREA_EDGES,
    SAMPLE_STICK_UNKNOWN,
    SLIDING_VALUES
};
_Static_assert((int)SLIDING_MEASURE + SAMPLE_DISSIPATION == (int)SLIDING_DISSIPATION &&
                   (int)SLIDING_EDGES_MEASURE + SAMPLE_STICK_UNKNOWN - SLIDING_BY_NODES ==
                       (int)SLIDING_STICK_UNKNOWN,
               "values of a state");

/* One state of a solver. */
struct sliding_sample {
    double sliding;            /* of the flat over the mean of the face, over the RMS height */
    double of[SLIDING_VALUES]; /* NaN: not known */
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
