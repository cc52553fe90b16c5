#include "jobs/statistics/statistics_draws.h"
#include "core/cost.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/surface_pass.h"
#include "jobs/like/like_hold.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct statistics_draws {
    const struct statistics_case *one_case;
    struct like_draw *draw; /* owned, as the lists and counts */
    struct summit_list summits[SIDES];
    struct summit_counts counts;
    struct summit_scales own; /* of the case */
};

int statistics_draws_create(struct statistics_draws **out, const struct statistics_case *one_case,
                            const struct moments *moments, struct error *err) {
    *out = NULL;
    if (!like_draw_applies(&one_case->like))
        return 0;
    struct statistics_draws *draws = array_create(1, sizeof *draws);
    if (draws == NULL)
        return error_memory(err, sizeof *draws, "draws of surfaces");
    draws->one_case = one_case;
    draws->own = summit_scales(one_case, moments);
    int status = like_draw_create(&draws->draw, &one_case->like, &one_case->surface, err);
    if (status == 0)
        status = summit_counts_create(&draws->counts, one_case, err);
    if (status != 0)
        statistics_draws_destroy(&draws);
    *out = draws;
    return status;
}

void statistics_draws_destroy(struct statistics_draws **draws) {
    struct statistics_draws *gone = *draws;
    if (gone == NULL)
        return;
    like_draw_destroy(&gone->draw);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&gone->summits[side]);
    summit_counts_clear(&gone->counts);
    free(gone);
    *draws = NULL;
}

/* --- one draw --- */

/* Finds the summits and pits of a drawn surface, which has a band and a function of its own. */
static int find_summits(struct statistics_draws *draws, const struct like_drawn *drawn,
                        struct error *err) {
    const struct grid *grid = &drawn->surface->grid;
    const bool limited =
        surface_case_band_limited(drawn->surface) || drawn->modes->translation != NULL;
    struct statistics_case one_case = *draws->one_case; /* borrows */
    struct summit_finder *finder = NULL;
    one_case.surface = *drawn->surface;
    int status = summit_finder_create(&finder, grid, one_case.stencil, one_case.curvature,
                                      limited ? drawn->modes->mode_x : grid->nx / 2,
                                      limited ? drawn->modes->mode_y : grid->ny / 2, err);
    if (status == 0)
        status = statistics_case_translate(&one_case, finder, drawn->modes->height, err);
    if (status == 0) {
        const struct surface_pass pass = {.finder = finder,
                                          .summits = &draws->summits[SIDE_SUMMITS],
                                          .pits = &draws->summits[SIDE_PITS]};
        summit_finder_gaussian(finder, drawn->gaussian);
        status = surface_pass_run(&pass, grid, drawn->z, err);
    }
    if (status == 0 && statistics_case_symmetric(draws->one_case))
        status = summit_list_append(&draws->summits[SIDE_SUMMITS], &draws->summits[SIDE_PITS], err);
    summit_finder_destroy(&finder);
    return status;
}

static int measure_scalars(const struct statistics_draws *draws, const struct like_drawn *drawn,
                           double scalars[SCALAR_COUNT], struct error *err) {
    const struct grid *grid = &drawn->surface->grid;
    struct roughness roughness;
    struct moments moments;
    int status = 0;
    roughness_measure(grid, drawn->z, &roughness);
    if (surface_case_band_limited(drawn->surface))
        modes_moments(drawn->own, &moments);
    else
        status = roughness_spectral(grid, drawn->z, &moments, err);
    if (status == 0)
        statistics_scalars_measure(
            draws->one_case, &drawn->moments,
            &(struct realisation_measures){&roughness, &moments, draws->summits, &drawn->report},
            scalars);
    return status;
}

/* Adds scalars to the sums behind those of curves, and which of them there are to the counts behind
 * theirs. */
static void scalars_add(const struct statistics_case *one_case, size_t group,
                        const double scalars[SCALAR_COUNT], struct statistics_groups *sums) {
    const struct group_offsets offset = statistics_group_offsets(one_case);
    double values[SCALAR_OWN];
    uint64_t present[SCALAR_OWN];
    for (size_t a = 0; a < SCALAR_OWN; a++) {
        present[a] = isfinite(scalars[a]) ? 1 : 0;
        values[a] = present[a] != 0 ? scalars[a] : 0;
    }
    statistics_groups_count(sums, group, offset.counts, SCALAR_OWN, present);
    statistics_groups_sum(sums, group, offset.sums, SCALAR_OWN, values);
}

int statistics_draws_measure(struct statistics_draws *draws, const struct realisation *realisation,
                             const struct summit_list own[], const double scalars[SCALAR_COUNT],
                             struct statistics_groups pairs[PAIR_SURFACES], struct error *err) {
    const struct subset due = like_draw_due();
    const struct random_key key = realisation->key;
    struct error reason = {0};
    struct like_drawn drawn;
    double others[SCALAR_COUNT];
    if (draws == NULL || !subset_has(&due, key.realisation))
        return 0;
    const struct statistics_case *one_case = draws->one_case;
    like_draw_set_stop(draws->draw, realisation->stop, realisation->stop_context);
    int status =
        like_draw_make(draws->draw, key, statistics_case_wants_gaussian(one_case), &drawn, &reason);
    if (status == ERROR_INPUT || status == ERROR_NUMERIC)
        return 0;
    if (status != 0)
        return error_set(err, status, "%s", reason.text);
    status = find_summits(draws, &drawn, err);
    if (status == 0)
        status = measure_scalars(draws, &drawn, others, err);
    if (status != 0)
        return status;
    const struct summit_scales scales = summit_scales(one_case, &drawn.moments);
    const size_t group = (size_t)key.realisation;
    statistics_pair_add(one_case, &draws->counts, &draws->own, group, realisation->z, own,
                        &pairs[PAIR_OWN]);
    statistics_pair_add(one_case, &draws->counts, &scales, group, drawn.z, draws->summits,
                        &pairs[PAIR_OTHER]);
    scalars_add(one_case, group, scalars, &pairs[PAIR_OWN]);
    scalars_add(one_case, group, others, &pairs[PAIR_OTHER]);
    return 0;
}

/* --- sums and cost --- */

int statistics_draws_sums(struct statistics_groups pairs[PAIR_SURFACES],
                          const struct statistics_case *one_case, struct error *err) {
    const struct group_offsets offset = statistics_group_offsets(one_case);
    int status = 0;
    for (size_t a = 0; a < PAIR_SURFACES && status == 0 && like_draw_applies(&one_case->like); a++)
        status = statistics_groups_create(&pairs[a], offset.counts + SCALAR_OWN,
                                          offset.sums + SCALAR_OWN, err);
    return status;
}

bool statistics_draws_fit(const struct statistics_groups pairs[PAIR_SURFACES],
                          uint64_t realisations) {
    uint64_t all = 0;
    bool fit = true;
    if (pairs[PAIR_OWN].counts == 0)
        return true;
    for (size_t g = 0; g < GROUPS && fit; g++) {
        const uint64_t own = pairs[PAIR_OWN].realisations[g];
        fit = own <= 1 && own == pairs[PAIR_OTHER].realisations[g];
        all += own;
    }
    return fit && all <= realisations && all <= LIKE_DRAWS;
}

double statistics_draws_bytes(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    const struct group_offsets offset = statistics_group_offsets(one_case);
    const struct surface_band band = surface_case_sampled_band(surface);
    const bool wanted = statistics_case_wants_gaussian(one_case);
    if (!like_draw_applies(&one_case->like))
        return 0;
    return like_draw_bytes(&one_case->like, surface) + summit_counts_bytes(one_case) +
           summit_finder_bytes(&surface->grid, one_case->stencil, one_case->curvature, band.x,
                               band.y, wanted) +
           PAIR_SURFACES *
               statistics_groups_bytes(offset.counts + SCALAR_OWN, offset.sums + SCALAR_OWN);
}

double statistics_draws_seconds(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    const struct surface_band band = surface_case_sampled_band(surface);
    const double points = (double)grid_points(&surface->grid);
    if (!like_draw_applies(&one_case->like))
        return 0;
    return like_draw_seconds(&one_case->like, surface) +
           2e-9 * cost_caches(points) *
               cost_summits(one_case->stencil, one_case->curvature, &surface->grid, band.x, band.y);
}

/* --- errors --- */

/* Returns whether the parameters of surfaces bear on a scalar of a realisation. */
static bool is_open(size_t scalar) {
    return scalar < SCALAR_GENERATOR_ITERATIONS;
}

static struct scalar_error scalar_error_of(const struct statistics_case *one_case,
                                           const struct statistics_groups pairs[PAIR_SURFACES],
                                           size_t at) {
    const struct statistics_groups *own = &pairs[PAIR_OWN], *drawn = &pairs[PAIR_OTHER];
    const struct group_offsets offset = statistics_group_offsets(one_case);
    double mean = 0, square = 0;
    size_t n = 0;
    for (size_t g = 0; g < GROUPS && own->counts > 0; g++) {
        const size_t count = g * own->counts + offset.counts + at;
        const size_t sum = g * own->sums + offset.sums + at;
        if (own->count[count] == 0 || drawn->count[count] == 0)
            continue;
        double change = exact_sum_value(&drawn->sum[sum]) - exact_sum_value(&own->sum[sum]);
        double from = change - mean;
        mean += from / (double)++n;
        square += from * (change - mean);
    }
    const struct like_error error =
        like_draw_error(mean, n > 1 ? sqrt(square / ((double)n - 1)) : 0, n);
    return (struct scalar_error){.applies = true,
                                 .known = !isnan(error.value),
                                 .value = isnan(error.value) ? 0 : error.value,
                                 .bound = isnan(error.bound) ? 0 : error.bound,
                                 .standard_error =
                                     isnan(error.standard_error) ? 0 : error.standard_error};
}

static void scalars_put(const struct statistics_case *one_case,
                        const struct statistics_groups pairs[PAIR_SURFACES],
                        struct case_result *out) {
    for (size_t at = 0; at < SCALAR_OWN; at++)
        for (size_t s = 0; s < out->scalar_count && is_open(at); s++)
            if (strcmp(out->scalars[s].name, statistics_scalar_name(at)) == 0 &&
                !isnan(out->scalars[s].value))
                out->scalars[s].errors[ERROR_PATCH] = scalar_error_of(one_case, pairs, at);
}

/* A change that no pair shows is not known to be none. */
static struct like_error point_error(const struct statistics_case *one_case,
                                     const struct statistics_groups pairs[PAIR_SURFACES],
                                     const struct curve *curve, size_t at) {
    struct point_groups own, drawn;
    statistics_groups_point(&pairs[PAIR_OWN], one_case, curve, at, &own);
    statistics_groups_point(&pairs[PAIR_OTHER], one_case, curve, at, &drawn);
    const struct estimate_groups minuend = {drawn.counted, drawn.things};
    const struct estimate_groups subtrahend = {own.counted, own.things};
    const struct pair_estimate change = estimate_group_pairs(GROUPS, &minuend, &subtrahend);
    const bool seen = own.informative + drawn.informative > 0 && change.pairs > 1;
    return like_draw_error(change.value, change.deviation, seen ? change.pairs : 0);
}

static int curve_put(const struct statistics_case *one_case,
                     const struct statistics_groups pairs[PAIR_SURFACES], struct curve *curve,
                     struct case_result *out, struct error *err) {
    struct curve_error *error = &curve->errors[ERROR_PATCH];
    struct point_groups groups;
    error->applies = true;
    if (pairs[PAIR_OWN].counts == 0 || curve->columns > 0 ||
        !statistics_groups_point(&pairs[PAIR_OWN], one_case, curve, 0, &groups))
        return 0;
    double *room = result_numbers(out, 3 * curve->n);
    if (room == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for errors by the patch");
    for (size_t a = 0; a < curve->n; a++) {
        const struct like_error point = point_error(one_case, pairs, curve, a);
        room[a] = point.value;
        room[curve->n + a] = point.bound;
        room[2 * curve->n + a] = point.standard_error;
    }
    error->value = room;
    error->bound = room + curve->n;
    error->standard_error = room + 2 * curve->n;
    return 0;
}

/* Of surfaces that hold the patch realisations are the draws. */
static int held_put(struct curve *curve, size_t n, struct case_result *out, struct error *err) {
    struct curve_error *error = &curve->errors[ERROR_PATCH];
    error->applies = true;
    if (curve->columns > 0 || curve->standard_error == NULL)
        return 0;
    double *room = result_numbers(out, 3 * curve->n);
    if (room == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for errors by the patch");
    for (size_t a = 0; a < curve->n; a++) {
        const struct like_error point =
            like_hold_error(curve->standard_error[a] * sqrt((double)n), n);
        room[a] = point.value;
        room[curve->n + a] = point.bound;
        room[2 * curve->n + a] = point.standard_error;
    }
    error->value = room;
    error->bound = room + curve->n;
    error->standard_error = room + 2 * curve->n;
    return 0;
}

static int held_errors(struct case_result *out, struct error *err) {
    const size_t n = (size_t)out->realisations;
    int status = 0;
    for (size_t s = 0; s < out->scalar_count; s++) {
        struct scalar *scalar = &out->scalars[s];
        const struct like_error error =
            like_hold_error(scalar->standard_error * sqrt((double)n), n);
        if (isnan(scalar->value))
            continue;
        const bool known = isfinite(error.bound);
        scalar->errors[ERROR_PATCH] =
            (struct scalar_error){.applies = true,
                                  .known = known,
                                  .bound = known ? error.bound : 0,
                                  .standard_error = known ? error.standard_error : 0};
    }
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = held_put(&out->curves[a], n, out, err);
    return status;
}

int statistics_draws_errors(const struct statistics_case *one_case,
                            const struct statistics_groups pairs[PAIR_SURFACES],
                            struct case_result *out, struct error *err) {
    int status = 0;
    if (one_case->like.given && one_case->like.hold)
        return held_errors(out, err);
    if (!like_draw_applies(&one_case->like))
        return 0;
    scalars_put(one_case, pairs, out);
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = curve_put(one_case, pairs, &out->curves[a], out, err);
    return status;
}
