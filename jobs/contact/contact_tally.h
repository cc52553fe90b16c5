/* What a block of realisations adds up to: exact sums and counts, and a row of values a
 * realisation, encoded into a partial result.
 *
 * Each realisation is solved for every model, level and load (a cell of contact_case_cell; some
 * for those of the probe, of other lengths and found in other ways, too) and gives a value of each
 * measure there, or none (NaN): a measure that is not defined there, or any where a model found no
 * answer. Differences between levels and between models are summed on their own: both see the same
 * surface, so that their errors are those of pairs. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_TALLY_H
#define RUGO_JOBS_CONTACT_CONTACT_TALLY_H

#include "jobs/contact/contact_rows.h"
#include "jobs/notes.h"
#include "jobs/tally.h"

/* Sums over the realisations that have a value in a cell, and how many these are. */
struct contact_sums {
    struct tally_sums sums;
    struct tally counts;
};
/* Which sums: those of each measure, by cell; then differences of the paired measures. */
enum {
    SUMS_LEVELS = MEASURE_COUNT,                 /* a level less the next coarser one; by model,
                                                    level but the coarsest, and load */
    SUMS_MODELS = SUMS_LEVELS + MEASURE_PAIRED,  /* a model less the most complete one: on the
                                                    finest level, and its changes between levels; by
                                                    model, these and load */
    SUMS_BLOCKS = SUMS_MODELS + MEASURE_PAIRED,  /* probe: a model's block less the half-space; by
                                                    model and load */
    SUMS_PROBE = SUMS_BLOCKS + MEASURE_PAIRED,   /* coarsest level of the control: that less the
                                                    half-space of the probe; by load */
    SUMS_PATHS = SUMS_PROBE + MEASURE_PAIRED,    /* the surface found by a path less the own one: by
                                                    path and load */
    SUMS_HALVINGS = SUMS_PATHS + MEASURE_PAIRED, /* log2 of eps_h over that after longer iterations:
                                                    one sum, if any surface is found again */
    CONTACT_SUMS
};
struct contact_tally {
    const struct contact_case *one_case; /* borrowed */
    uint64_t realisations;
    struct contact_sums sums[CONTACT_SUMS];
    struct tally_total points; /* of the finest level */
    struct tally pressures;    /* by model, level (the finest, then the next coarser one), load of
                                  pdf_loads, bin with under- and overflow; in parts of a node's
                                  undeformed area, CONTACT_AREA_PARTS of them; adding up to the area
                                  by edges */
    struct notes notes;        /* why a model has no values, a realisation and level */
    struct contact_rows rows;  /* values of each realisation */
    uint64_t realisation;      /* the one under way, for these */
    double *values;            /* owned: the realisation under way, by measure and cell */
    double facts[CONTACT_MODELS_MOST][MODEL_FACTS_MOST]; /* the same, on the finest level */
    double halvings;                                     /* the same, of SUMS_HALVINGS */
};
int contact_tally_create(struct contact_tally *out, const struct contact_case *one_case,
                         struct error *err);
void contact_tally_clear(struct contact_tally *tally);
double contact_tally_bytes(const struct contact_case *one_case);

/* Exact sums resolve 2^-60. What falls with the load is summed over a power of two near it, which
 * costs no digits, so that light loads keep theirs: values are summed times this. */
double contact_tally_scale(const struct contact_case *one_case, enum contact_measure measure,
                           size_t load);

/* The realisation under way: values of a measure, by cell; NaN until they are set. */
static inline double *contact_tally_values(struct contact_tally *tally,
                                           enum contact_measure measure) {
    return tally->values + (size_t)measure * contact_case_all_cells(tally->one_case);
}
/* Exact sums of areas by pressure hold this part of a node's. */
#define CONTACT_AREA_PARTS ((uint64_t)1 << 20)
/* Adds areas by pressure, shares[contact_case_bins] of the cell, on a level, one of those that
 * contact_tally_counts tells. at: position in pdf_loads. */
void contact_tally_pressures(struct contact_tally *tally, size_t model, size_t level, size_t at,
                             const double *shares);
/* Returns whether pressures are counted on a level: the two finest. */
bool contact_tally_counts(const struct contact_case *one_case, size_t level);
/* Ends the realisation: adds its values, and the next one begins. On failure it is none. */
int contact_tally_add(struct contact_tally *tally, struct error *err);

struct estimate contact_tally_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t cell);
/* Returns the exact sum over the realisations. */
double contact_tally_total(const struct contact_tally *tally, enum contact_measure measure,
                           size_t cell);
/* Counts the realisations without a value. */
uint64_t contact_tally_valueless(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t cell);
/* Means of the paired differences: of a level, not the coarsest one, less the next coarser; of a
 * model less the most complete one, for which it is NaN, on the finest level; and the change of
 * that from the next coarser level to a level, not the coarsest. */
struct estimate contact_tally_level(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t level, size_t load);
struct estimate contact_tally_model(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t load);
struct estimate contact_tally_model_level(const struct contact_tally *tally,
                                          enum contact_measure measure, size_t model, size_t level,
                                          size_t load);
/* Likewise of the block of a model less the half-space, by the realisations that were probed. */
struct estimate contact_tally_block(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t load);
/* Means over the realisations that have them, at least two, else NaN: on the half-space of the
 * probe, of the surfaces of the case, and of those of another length. */
struct estimate contact_tally_own_length(const struct contact_tally *tally,
                                         enum contact_measure measure, size_t load);
struct estimate contact_tally_other_length(const struct contact_tally *tally,
                                           enum contact_measure measure, enum contact_length length,
                                           size_t load);
/* Likewise of the surface found by a path less the own one; and by how many powers of two eps_h
 * falls with longer iterations, in the mean. */
struct estimate contact_tally_path(const struct contact_tally *tally, enum contact_measure measure,
                                   enum surface_path path, size_t load);
double contact_tally_halvings(const struct contact_tally *tally);
/* Areas of all bins, without under- and overflow, over that of the cell, over the realisations with
 * values there. */
void contact_tally_pressure_shares(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at, struct estimate *out);
/* Returns the first cell of the pressures of a model, level and load, which are underflow, the
 * bins, overflow. */
size_t contact_tally_pressure_cell(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at);

/* These are what job_kind asks for. Counts that add up are possible, and belong together. */
void contact_tally_put(struct bytes *bytes, const struct contact_tally *tally);
void contact_tally_get(struct byte_reader *reader, struct contact_tally *tally);
bool contact_tally_adds_up(const struct contact_tally *tally);
int contact_tally_merge(struct contact_tally *into, const struct contact_tally *from,
                        struct error *err);

#endif
