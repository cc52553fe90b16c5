/* Where sums of differences and of pressures stand in a tally, and how many of them there are. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PLACES_H
#define RUGO_JOBS_CONTACT_CONTACT_PLACES_H

#include "jobs/contact/contact_case.h"

/* Levels on which pressures are counted. */
static inline size_t places_counted_levels(const struct contact_case *one_case) {
    return one_case->level_count > 1 ? 2 : 1;
}

static inline size_t places_pressures(const struct contact_case *one_case) {
    return one_case->model_count * places_counted_levels(one_case) * one_case->pdf_count *
           contact_case_bins(one_case);
}

/* Place of a level's difference from the next coarser one. */
static inline size_t places_level(const struct contact_case *one_case, size_t model, size_t level,
                                  size_t load) {
    return (model * (one_case->level_count - 1) + level - 1) * one_case->load_count + load;
}

/* Place of a model's difference from the most complete one, which has none, among those on the
 * finest level (level 0) and their changes from level - 1 to level. */
static inline size_t places_model(const struct contact_case *one_case, size_t model, size_t level,
                                  size_t load) {
    size_t other = model - (model > contact_case_complete(one_case));
    return (other * one_case->level_count + level) * one_case->load_count + load;
}

static inline size_t places_models(const struct contact_case *one_case) {
    return (one_case->model_count - 1) * one_case->level_count * one_case->load_count;
}

/* Differences of blocks, if any is probed. */
static inline size_t places_blocks(const struct contact_case *one_case) {
    return one_case->low_blocks ? one_case->model_count * one_case->load_count : 0;
}

/* Differences between the control and the probe, if there are both. */
static inline size_t places_probe(const struct contact_case *one_case) {
    bool both =
        contact_case_is_probed(one_case) && contact_case_control(one_case) < one_case->model_count;
    return both ? one_case->load_count : 0;
}

/* Differences of the surface found by a path from the own one, if any is found again; and how many
 * there are. */
static inline size_t places_path(const struct contact_case *one_case, size_t path, size_t load) {
    return path * one_case->load_count + load;
}
static inline size_t places_paths(const struct contact_case *one_case) {
    return contact_case_has_paths(one_case) ? places_path(one_case, SURFACE_PATHS, 0) : 0;
}

#endif
