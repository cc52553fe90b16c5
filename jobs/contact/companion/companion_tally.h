/* What a tally holds of a companion: the values of the present realisation, and sums of them and
 * of their differences. A case without the companion has none of these. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COMPANION_TALLY_H
#define RUGO_JOBS_CONTACT_COMPANION_COMPANION_TALLY_H

#include "jobs/contact/tally/contact_sums.h"

struct companion_tally {
    double *values; /* owned: by draw, series, measure below measure_paired and load; NaN: none */
    size_t draw;    /* that is being solved */
    size_t draws;   /* of the present realisation, 1 until it has more */
    struct contact_sums sums;        /* by series, measure and load */
    struct contact_sums differences; /* by pair of the plan, measure and load */
};

/* Returns the index of a series or pair, a measure and a load. */
static inline size_t companion_cell(const struct contact_case *one_case, size_t series,
                                    enum contact_measure measure, size_t load) {
    return (series * measure_paired(one_case) + (size_t)measure) * contact_case_slots(one_case) +
           load;
}
/* Returns the values of a series of the draw that is being solved, by measure and load. */
static inline double *companion_series(const struct contact_case *one_case,
                                       const struct companion_tally *tally, size_t series) {
    return tally->values + tally->draw * tally->sums.counts.size +
           companion_cell(one_case, series, 0, 0);
}

/* plan: that of the companion in the case. After a failure it is to be cleared. */
int companion_tally_create(struct companion_tally *out, const struct contact_case *one_case,
                           const struct companion_plan *plan, struct error *err);
void companion_tally_clear(struct companion_tally *tally);
double companion_tally_bytes(const struct contact_case *one_case,
                             const struct companion_plan *plan);
/* Empties the values of the present realisation. */
void companion_tally_begin(struct companion_tally *tally);
/* Adds the values of all draws of the present realisation. */
void companion_tally_add(struct companion_tally *tally, const struct contact_case *one_case,
                         const struct companion_plan *plan);
bool companion_tally_fits(const struct companion_tally *tally, const struct companion_plan *plan,
                          uint64_t realisations);
void companion_tally_put(struct bytes *bytes, const struct companion_tally *tally);
void companion_tally_get(struct byte_reader *reader, struct companion_tally *tally);
void companion_tally_merge(struct companion_tally *into, const struct companion_tally *from);

#endif
