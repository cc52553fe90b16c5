#include "jobs/statistics/statistics_law.h"
#include "core/cost.h"
#include "core/statistics/surface_pass.h"
#include "jobs/subset.h"
#include "jobs/surface/other_law.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Time for surfaces of the other law, over that of the case without. */
static const double TIME_SHARE = 0.08;
/* Of the first realisations each fourth has them, so that small studies have eight. */
enum { FIRST_INTERVAL = 4 };

struct statistics_law {
    const struct statistics_case *one_case;
    struct subset due;
    struct other_law *law;        /* owned, as all below */
    struct summit_finder *finder; /* NULL without such surfaces */
    struct summit_list summits[SIDES];
    struct summit_counts counts;
    struct summit_scales scales[PAIR_SURFACES];
};

static fixed_point counts_total(const uint64_t *count, size_t n) {
    fixed_point total = 0;
    for (size_t a = 0; a < n; a++)
        total += count[a];
    return total;
}

static struct subset due_of(const struct surface_case *surface) {
    double points = (double)grid_points(&surface->grid);
    double own = 1e-9 * cost_generation(&surface->options, &surface->grid) * points;
    double other = other_law_seconds(surface) / cost_caches(points);
    struct subset due = subset_each(subset_interval(other, TIME_SHARE * own, 1));
    due.first_interval = due.first_interval < FIRST_INTERVAL ? due.first_interval : FIRST_INTERVAL;
    return due;
}

/* Makes a finder for surfaces of the other law, which have their own band and function. */
static int finder_create(struct statistics_law *law, struct error *err) {
    struct statistics_case other = *law->one_case; /* borrows */
    const struct modes *modes = other_law_modes(law->law);
    const double *gaussian = NULL;
    other.surface = *other_law_surface(law->law);
    bool limited = surface_case_band_limited(&other.surface) || modes->translation != NULL;
    const struct grid *grid = &other.surface.grid;
    int status = summit_finder_create(&law->finder, grid, other.stencil, other.curvature,
                                      limited ? modes->mode_x : grid->nx / 2,
                                      limited ? modes->mode_y : grid->ny / 2, err);
    if (status == 0)
        status = statistics_case_translate(&other, law->finder, modes->height, err);
    if (status == 0 && statistics_case_wants_gaussian(&other))
        status = other_law_keep_gaussian(law->law, &gaussian, err);
    if (status == 0)
        summit_finder_gaussian(law->finder, gaussian);
    return status;
}

int statistics_law_create(struct statistics_law **out, const struct statistics_case *one_case,
                          const struct moments *moments, struct error *err) {
    *out = NULL;
    if (!other_law_applies(&one_case->surface))
        return 0;
    struct statistics_law *law = array_create(1, sizeof *law);
    if (law == NULL)
        return error_memory(err, sizeof *law, "the other law of heights");
    law->one_case = one_case;
    law->due = due_of(&one_case->surface);
    int status = other_law_create(&law->law, &one_case->surface, err);
    if (status == 0 && other_law_surface(law->law) != NULL)
        status = finder_create(law, err);
    if (status == 0 && law->finder != NULL) {
        law->scales[PAIR_OWN] = summit_scales(one_case, moments);
        law->scales[PAIR_OTHER] = summit_scales(one_case, other_law_moments(law->law));
        status = summit_counts_create(&law->counts, one_case, err);
    }
    if (status != 0)
        statistics_law_destroy(&law);
    *out = law;
    return status;
}

void statistics_law_destroy(struct statistics_law **law) {
    struct statistics_law *gone = *law;
    if (gone == NULL)
        return;
    other_law_destroy(&gone->law);
    summit_finder_destroy(&gone->finder);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&gone->summits[side]);
    summit_counts_clear(&gone->counts);
    free(gone);
    *law = NULL;
}

void statistics_pair_add(const struct statistics_case *one_case, struct summit_counts *counts,
                         const struct summit_scales *scales, size_t group, const double *z,
                         const struct summit_list summits[], struct statistics_groups *sums) {
    sums->realisations[group]++;
    histogram_add(&one_case->height, grid_points(&one_case->surface.grid), z, scales->height,
                  counts->height);
    statistics_groups_count(sums, group, statistics_group_offsets(one_case).height,
                            cells_of(&one_case->height), counts->height);
    summit_counts_zero(counts, one_case);
    for (size_t side = 0; side < statistics_case_sides(one_case); side++) {
        summit_counts_fill(counts, one_case, scales, &summits[side]);
        statistics_groups_side(sums, one_case, group, side, counts);
        summit_counts_zero(counts, one_case);
    }
}

int statistics_law_measure(struct statistics_law *law, const struct realisation *realisation,
                           const struct summit_list own[],
                           struct statistics_groups pairs[PAIR_SURFACES],
                           double scalars[SCALAR_COUNT], struct error *err) {
    const struct random_key key = realisation->key;
    if (law == NULL || law->finder == NULL || !subset_has(&law->due, key.realisation))
        return 0;
    const struct grid *grid = &law->one_case->surface.grid;
    const struct moments *moments = other_law_moments(law->law);
    struct surface_report report;
    struct roughness roughness;
    double others[SCALAR_COUNT];
    const struct surface_pass pass = {.finder = law->finder,
                                      .summits = &law->summits[SIDE_SUMMITS],
                                      .pits = &law->summits[SIDE_PITS]};
    const double *z;
    other_law_set_stop(law->law, realisation->stop, realisation->stop_context);
    int status = other_law_make(law->law, key, &z, &report, err);
    if (status == 0)
        status = surface_pass_run(&pass, grid, z, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    statistics_scalars_measure(
        law->one_case, moments,
        &(struct realisation_measures){&roughness, moments, law->summits, &report}, others);
    for (size_t a = 0; a < LAW_COUNT; a++)
        scalars[SCALAR_LAW + a] = others[LAW_OWN[a]];
    size_t group = group_of(subset_ordinal(&law->due, key.realisation));
    statistics_pair_add(law->one_case, &law->counts, &law->scales[PAIR_OWN], group, realisation->z,
                        own, &pairs[PAIR_OWN]);
    statistics_pair_add(law->one_case, &law->counts, &law->scales[PAIR_OTHER], group, z,
                        law->summits, &pairs[PAIR_OTHER]);
    return 0;
}

double statistics_law_bytes(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    const struct surface_band band = surface_case_sampled_band(surface);
    bool wanted = !surface_case_translated(surface) &&
                  summit_needs_band(one_case->stencil, one_case->curvature);
    if (!other_law_applies(surface))
        return 0;
    return other_law_bytes(surface) + summit_counts_bytes(one_case) +
           summit_finder_bytes(&surface->grid, one_case->stencil, one_case->curvature, band.x,
                               band.y, wanted) +
           (wanted ? (double)grid_points(&surface->grid) * sizeof(double) : 0);
}

double statistics_law_seconds(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    return other_law_applies(surface)
               ? other_law_seconds(surface) / (double)due_of(surface).interval
               : 0;
}

double statistics_law_beyond_seconds(const struct statistics_case *one_case, uint64_t realisation) {
    const struct surface_case *surface = &one_case->surface;
    if (!other_law_applies(surface))
        return 0;
    const struct subset due = due_of(surface);
    return other_law_seconds(surface) *
           ((subset_has(&due, realisation) ? 1 : 0) - 1 / (double)due.interval);
}

/* --- pairs of surfaces --- */

/* The changes of each own scalar that is measured again; else NaN. */
struct changes {
    struct estimate of[SCALAR_OWN];
};

static int changes_measure(const struct realisations *realisations, struct changes *out,
                           struct error *err) {
    size_t n = (size_t)realisations->count;
    double *other = array_create(2 * n, sizeof *other), *own = other != NULL ? other + n : NULL;
    if (other == NULL)
        return error_memory(err, 2 * n * sizeof *other, "scalars");
    for (size_t a = 0; a < SCALAR_OWN; a++)
        out->of[a] = (struct estimate){NAN, NAN};
    for (size_t a = 0; a < LAW_COUNT; a++) {
        realisations_column(realisations, SCALAR_LAW + a, other);
        realisations_column(realisations, LAW_OWN[a], own);
        size_t pairs = 0;
        for (size_t r = 0; r < n; r++) {
            other[r] -= own[r];
            pairs += isfinite(other[r]) ? 1 : 0;
        }
        out->of[LAW_OWN[a]] = estimate_of_few(estimate_mean(n, other), pairs);
    }
    free(other);
    return 0;
}

/* --- scalars --- */

static struct scalar *scalar_at(const struct case_result *result, size_t at) {
    for (size_t a = 0; a < result->scalar_count; a++)
        if (strcmp(result->scalars[a].name, statistics_scalar_name(at)) == 0)
            return &result->scalars[a];
    return NULL;
}

static void scalar_put(struct case_result *out, size_t at, struct estimate change, double scale) {
    struct scalar *scalar = scalar_at(out, at);
    if (scalar == NULL || isnan(scalar->value))
        return;
    scalar->law_difference = scale * change.value;
    scalar->law_standard_error = scale * change.standard_error;
}

/* Densities change in proportion to the numbers of summits and pits. */
static void densities_put(const struct changes *changes, size_t number, struct case_result *out) {
    const struct scalar *count = scalar_at(out, number);
    for (size_t density = number + 1; density <= number + 2 && count != NULL; density++) {
        const struct scalar *scalar = scalar_at(out, density);
        if (scalar != NULL)
            scalar_put(out, density, changes->of[number], scalar->value / count->value);
    }
}

static void scalars_put(const struct changes *changes, struct case_result *out) {
    for (size_t a = 0; a < LAW_COUNT; a++)
        scalar_put(out, LAW_OWN[a], changes->of[LAW_OWN[a]], 1);
    densities_put(changes, SCALAR_SUMMITS, out);
    densities_put(changes, SCALAR_PITS, out);
}

/* --- curves --- */

/* Returns the standard error of a share of independent things, over the width of its bin. What was
 * not counted could have been counted once. */
static double counting_error(const struct point_groups *groups, double width) {
    double counted = 0, things = 0;
    for (size_t g = 0; g < GROUPS; g++) {
        counted += groups->counted[g] * width;
        things += groups->things[g];
    }
    double share = fmin(fmax(counted, 1), fmax(things - 1, 1)) / things;
    return sqrt(share * (1 - share) / things) / width;
}

/* Fewer groups than this do not show the scatter of a mean. */
enum { GROUPS_LEAST = 4 };

/* Few groups do not show the scatter of what is rare; its error is at least that of counting. */
static struct estimate point_change(const struct statistics_groups pairs[PAIR_SURFACES],
                                    const struct statistics_case *one_case,
                                    const struct curve *curve, size_t at) {
    struct point_groups own, other;
    statistics_groups_point(&pairs[PAIR_OWN], one_case, curve, at, &own);
    statistics_groups_point(&pairs[PAIR_OTHER], one_case, curve, at, &other);
    const struct estimate_groups minuend = {other.counted, other.things};
    const struct estimate_groups subtrahend = {own.counted, own.things};
    struct pair_estimate change = estimate_group_pairs(GROUPS, &minuend, &subtrahend);
    double width = statistics_curve_width(one_case, curve);
    size_t informative = own.informative < other.informative ? own.informative : other.informative;
    bool seen = own.informative + other.informative > 0;
    bool known = change.pairs > 1 && (width > 0 ? seen : informative >= GROUPS_LEAST);
    if (!known || isnan(change.value))
        return (struct estimate){NAN, NAN};
    struct estimate out =
        estimate_of_few((struct estimate){change.value, change.standard_error}, change.pairs);
    if (width > 0 && informative < TALLY_RARE)
        out.standard_error = fmax(
            out.standard_error, hypot(counting_error(&own, width), counting_error(&other, width)));
    return out;
}

static int curve_put(const struct statistics_groups pairs[PAIR_SURFACES],
                     const struct statistics_case *one_case, struct curve *curve,
                     struct case_result *out, struct error *err) {
    struct point_groups groups;
    bool any = false;
    if (curve->columns > 0 ||
        !statistics_groups_point(&pairs[PAIR_OWN], one_case, curve, 0, &groups))
        return 0;
    double *difference = result_numbers(out, 2 * curve->n);
    if (difference == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for law differences");
    for (size_t a = 0; a < curve->n; a++) {
        struct estimate change = point_change(pairs, one_case, curve, a);
        difference[a] = change.value;
        difference[curve->n + a] = change.standard_error;
        any = any || !isnan(change.value);
    }
    if (any) {
        curve->law_difference = difference;
        curve->law_standard_error = difference + curve->n;
    }
    return 0;
}

int statistics_law_differences(const struct statistics_case *one_case,
                               const struct realisations *realisations,
                               const struct statistics_groups pairs[PAIR_SURFACES],
                               struct case_result *out, struct error *err) {
    struct changes changes;
    if (!other_law_applies(&one_case->surface))
        return 0;
    int status = changes_measure(realisations, &changes, err);
    if (status != 0)
        return status;
    scalars_put(&changes, out);
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = curve_put(pairs, one_case, &out->curves[a], out, err);
    return status;
}

/* --- what readers check --- */

/* Returns whether each group has as many heights as its surfaces have points, and each summit in
 * both histograms. */
static bool groups_add_up(const struct statistics_groups *groups,
                          const struct statistics_case *one_case) {
    struct group_offsets offset = statistics_group_offsets(one_case);
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    fixed_point points = (fixed_point)grid_points(&one_case->surface.grid);
    bool fit = true;
    for (size_t g = 0; g < GROUPS && fit; g++) {
        const uint64_t *count = groups->count + g * groups->counts;
        fit = counts_total(count + offset.height, heights) == points * groups->realisations[g];
        for (size_t side = 0; side < SIDES; side++)
            fit = fit && counts_total(count + offset.summit[side], heights) ==
                             counts_total(count + offset.equivalent[side], curvatures);
    }
    return fit;
}

bool statistics_law_fits(const struct statistics_groups pairs[PAIR_SURFACES],
                         const struct statistics_tally *tally) {
    const struct statistics_groups *own = &pairs[PAIR_OWN], *other = &pairs[PAIR_OTHER];
    fixed_point realisations = 0;
    if (own->counts == 0)
        return true;
    for (size_t g = 0; g < GROUPS; g++) {
        realisations += own->realisations[g];
        if (own->realisations[g] != other->realisations[g])
            return false;
    }
    return realisations <= tally->points.realisations && groups_add_up(own, tally->one_case) &&
           groups_add_up(other, tally->one_case);
}
