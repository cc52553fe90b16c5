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

struct statistics_law {
    const struct statistics_case *one_case;
    struct subset due;
    struct other_law *law;        /* owned, as all below */
    struct summit_finder *finder; /* NULL without such surfaces */
    struct summit_list summits[SIDES];
};

static struct subset due_of(const struct surface_case *surface) {
    double points = (double)grid_points(&surface->grid);
    double own = 1e-9 * cost_generation(&surface->options, &surface->grid) * points;
    double other = other_law_seconds(surface) / cost_caches(points);
    return subset_each(subset_interval(other, TIME_SHARE * own, 1));
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
                          struct error *err) {
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
    free(gone);
    *law = NULL;
}

int statistics_law_measure(struct statistics_law *law, struct random_key key,
                           double scalars[SCALAR_COUNT], struct error *err) {
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
    return 0;
}

double statistics_law_bytes(const struct statistics_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    const struct surface_band band = surface_case_sampled_band(surface);
    bool wanted = !surface_case_translated(surface) &&
                  summit_needs_band(one_case->stencil, one_case->curvature);
    if (!other_law_applies(surface))
        return 0;
    return other_law_bytes(surface) +
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
        for (size_t r = 0; r < n; r++)
            other[r] -= own[r];
        struct estimate change = estimate_mean(n, other);
        if (!isnan(change.standard_error)) /* one pair shows no scatter */
            out->of[LAW_OWN[a]] = change;
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

int statistics_law_differences(const struct statistics_case *one_case,
                               const struct realisations *realisations, struct case_result *out,
                               struct error *err) {
    struct changes changes;
    if (!other_law_applies(&one_case->surface))
        return 0;
    int status = changes_measure(realisations, &changes, err);
    if (status != 0)
        return status;
    scalars_put(&changes, out);
    return 0;
}
