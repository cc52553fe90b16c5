#include "jobs/contact/contact_generation_errors.h"
#include "jobs/contact/contact_mean.h"
#include <math.h>

/* As a change vanishes somewhere between loads where its sign is one and the other, loads within
 * this ratio of each other share the largest of theirs. */
static const double NEAR_LOADS = 2;
static const double ROUNDING = 1e-9; /* of ratios that are meant to be round */

/* Chance does not go on: what longer iterations change grows with what is left to half of eps_h
 * (surface_paths_drift) by no more than what is beyond its standard error. */
static struct estimate drift_of(const struct contact_tally *tally, enum contact_measure measure,
                                size_t load) {
    struct estimate longer = contact_tally_path(tally, measure, PATH_LONGER, load);
    double factor = surface_paths_drift(contact_tally_halvings(tally));
    double seen = fabs(longer.value), beyond = factor * fmax(0, seen - longer.standard_error);
    if (isnan(longer.value) || seen >= beyond)
        return (struct estimate){seen, longer.standard_error};
    return (struct estimate){beyond, factor * longer.standard_error};
}

/* Of one load alone, relative to the own surfaces of the pairs. */
static struct estimate bound_of(const struct contact_tally *tally, enum contact_measure measure,
                                size_t load) {
    size_t cell = contact_case_path_cell(tally->one_case, PATHS_OWN, load);
    double own = fabs(contact_tally_mean(tally, measure, cell).value);
    struct estimate other = contact_tally_path(tally, measure, PATH_OTHER, load);
    struct estimate drift = drift_of(tally, measure, load);
    return (struct estimate){(fabs(other.value) + drift.value) / own,
                             hypot(other.standard_error, drift.standard_error) / own};
}

/* The change is that of a half-space on a coarse mesh; of other models and meshes it is the same
 * share. The error may be on either side: the bound is on both. */
bool contact_generation_errors(const struct contact_tally *tally, enum contact_measure measure,
                               size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count, finest = one_case->level_count - 1;
    bool any = false;
    if (!contact_case_has_paths(one_case))
        return false;
    for (size_t k = 0; k < n; k++) {
        struct estimate own = bound_of(tally, measure, k);
        out[k] = (struct contact_error){
            .value = own.value, .standard_error = own.standard_error, .order = NAN};
    }
    for (size_t k = 0; k < n; k++)
        for (size_t other = 0; other < n; other++) {
            double ratio = one_case->loads[k] / one_case->loads[other];
            if (fmax(ratio, 1 / ratio) <= NEAR_LOADS * (1 + ROUNDING))
                out[k].bound = fmax(out[k].bound, out[other].value);
        }
    for (size_t k = 0; k < n; k++) {
        double y = fabs(contact_mean(tally, measure, model, finest, k).value);
        bool known = !isnan(out[k].value * y);
        out[k].value = known ? 0 : (double)NAN;
        out[k].bound = known ? out[k].bound * y : (double)NAN;
        out[k].standard_error *= y;
        any = any || known;
    }
    return any;
}

/* Of the density at bin b, by which share of itself a stretch of pressures by a share changes it:
 * that of q(x) to c^2 q(c x), which keeps the load. */
static double sensitivity(size_t n, const double *x, const double *y, size_t b) {
    size_t left = b > 0 ? b - 1 : b, right = b + 1 < n ? b + 1 : b;
    double slope = right > left ? (y[right] - y[left]) / (x[right] - x[left]) : 0;
    return 2 * y[b] + fabs(x[b] * slope);
}

bool contact_generation_pressures(const struct contact_tally *tally, size_t model, size_t at,
                                  const double *x, const double *y, struct contact_error *room,
                                  double *bound, double *standard_error) {
    const struct contact_case *one_case = tally->one_case;
    size_t load = one_case->pdf_loads[at], n = one_case->pressure.count;
    if (!contact_generation_errors(tally, MEASURE_EDGES, model, room) || isnan(room[load].value))
        return false;
    double area = contact_mean(tally, MEASURE_EDGES, model, one_case->level_count - 1, load).value;
    for (size_t b = 0; b < n; b++) {
        double by = sensitivity(n, x, y, b) / area;
        bound[b] = by * room[load].bound;
        standard_error[b] = by * room[load].standard_error;
    }
    return true;
}
