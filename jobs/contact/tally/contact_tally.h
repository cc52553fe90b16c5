/* The tally of contact: exact sums and counts, and a row of values for each realisation, encoded
 * into a partial result.
 *
 * Each realisation is solved for every model, level and load. Each of these is a cell
 * (contact_case_cell) with a value of each measure, or none (NaN): the measure is not defined
 * there, or the model found no solution. Differences between levels and between models are summed
 * separately. As both have the same surface, their errors are those of pairs. Some realisations
 * also have companions (companion/companion_plan.h), with values and sums of their own. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_TALLY_H
#define RUGO_JOBS_CONTACT_CONTACT_TALLY_H

#include "jobs/contact/companion/companion_tally.h"
#include "jobs/contact/tally/contact_densities.h"
#include "jobs/contact/tally/contact_rows.h"
#include "jobs/notes.h"
#include <math.h>

/* Indices of sums: those of each measure, by cell; then differences of the paired measures. */
enum {
    SUMS_LEVELS = MEASURE_COUNT,                /* a level less the next coarser one; by model,
                                                   level but the coarsest, and load */
    SUMS_MODELS = SUMS_LEVELS + MEASURE_PAIRED, /* a model less the most complete one: on the
                                                   finest level, and its changes between levels; by
                                                   model, these and load */
    CONTACT_SUMS = SUMS_MODELS + MEASURE_PAIRED
};
struct contact_tally {
    const struct contact_case *one_case; /* borrowed */
    uint64_t realisations;
    struct contact_sums sums[CONTACT_SUMS];
    struct tally_total points; /* of the finest level */
    struct tally pressures;    /* by model, counted level (the finest first), load of pdf_loads,
                                  bin with under- and overflow; in parts of a node's
                                  undeformed area, CONTACT_AREA_PARTS of them; adding up to the area
                                  by edges */
    struct contact_densities densities; /* of the same areas, for differences */
    struct notes notes;       /* why a model has no values, one for each realisation and level */
    struct contact_rows rows; /* values of each realisation */
    uint64_t realisation;     /* number of the present realisation */
    double *values;           /* owned: of the present realisation, by measure and cell */
    double facts[CONTACT_MODELS_MOST][MODEL_FACTS_MOST]; /* the same, on the finest level */
    struct companion_tally companions[COMPANION_COUNT];
};
int contact_tally_create(struct contact_tally *out, const struct contact_case *one_case,
                         struct error *err);
void contact_tally_clear(struct contact_tally *tally);
double contact_tally_bytes(const struct contact_case *one_case);

/* Returns the values of a measure of the present realisation, by cell; NaN until they are set. */
static inline double *contact_tally_values(struct contact_tally *tally,
                                           enum contact_measure measure) {
    return tally->values + (size_t)measure * contact_case_cells(tally->one_case);
}
/* Returns the same of a series of a companion of the case, by load; measure: below MEASURE_PAIRED.
 */
static inline double *contact_tally_series(struct contact_tally *tally,
                                           enum companion_name companion, size_t series,
                                           enum contact_measure measure) {
    return tally->companions[companion].values +
           companion_cell(tally->one_case, series, measure, 0);
}
/* Exact sums of areas by pressure resolve a node's area into so many parts. */
#define CONTACT_AREA_PARTS ((uint64_t)1 << 20)
/* Adds areas by pressure, shares[contact_case_bins] of the cell, on a level for which
 * contact_tally_counts returns true. at: position in pdf_loads. */
void contact_tally_pressures(struct contact_tally *tally, size_t model, size_t level, size_t at,
                             const double *shares);
/* Returns whether pressures are counted on a level: the two finest, or all for pairs. */
bool contact_tally_counts(const struct contact_case *one_case, size_t level);
/* Ends the present realisation: adds its values, and the next one begins. On failure nothing is
 * added. */
int contact_tally_add(struct contact_tally *tally, struct error *err);

struct estimate contact_tally_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t cell);
/* Returns the exact sum over the realisations. */
double contact_tally_total(const struct contact_tally *tally, enum contact_measure measure,
                           size_t cell);
/* Counts the realisations without a value. */
uint64_t contact_tally_valueless(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t cell);
/* Return means of the paired differences. For a level, not the coarsest one: it less the next
 * coarser. For a model: it less the most complete one (for which it is NaN) on the finest level,
 * and the change of that from the next coarser level to a level, not the coarsest. */
struct estimate contact_tally_level(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t level, size_t load);
struct estimate contact_tally_model(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t load);
struct estimate contact_tally_model_level(const struct contact_tally *tally,
                                          enum contact_measure measure, size_t model, size_t level,
                                          size_t load);
/* Return the means of a series of a companion of the case and of one of its pairs, over the
 * realisations that have it. */
struct estimate contact_tally_companion(const struct contact_tally *tally,
                                        enum companion_name companion, size_t series,
                                        enum contact_measure measure, size_t load);
struct estimate contact_tally_pair(const struct contact_tally *tally, enum companion_name companion,
                                   size_t pair, enum contact_measure measure, size_t load);
/* Counts the values of a series of a companion of the case: one a draw. */
uint64_t contact_tally_draws(const struct contact_tally *tally, enum companion_name companion,
                             size_t series, enum contact_measure measure, size_t load);
/* Counts the differences of a pair: one a draw in which both series have a value. */
uint64_t contact_tally_pairs(const struct contact_tally *tally, enum companion_name companion,
                             size_t pair, enum contact_measure measure, size_t load);
/* Return the mean of a measure over realisations of which some may lack a value, and the model by
 * which it is made; model_count for a plain mean. On the finest level the most complete model may
 * lack values that another one has in all realisations. Its mean is then that of the other model
 * over all, less the mean difference over the realisations that have both: a control variate
 * (Glasserman 2004, section 4.1). */
struct estimate contact_mean(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model, size_t level, size_t load);
size_t contact_mean_control(const struct contact_tally *tally, enum contact_measure measure,
                            size_t model, size_t level, size_t load);
/* Fills areas of all bins, without under- and overflow, over that of the cell, over the
 * realisations with values there. */
void contact_tally_pressure_shares(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at, struct estimate *out);
/* Returns the first cell of the pressures of a model, level and load; its cells are underflow, the
 * bins, overflow. */
size_t contact_tally_pressure_cell(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at);

/* As job_kind has them. adds_up returns whether counts are possible and agree with each other. */
void contact_tally_put(struct bytes *bytes, const struct contact_tally *tally);
void contact_tally_get(struct byte_reader *reader, struct contact_tally *tally);
bool contact_tally_adds_up(const struct contact_tally *tally);
int contact_tally_merge(struct contact_tally *into, const struct contact_tally *from,
                        struct error *err);

#endif
