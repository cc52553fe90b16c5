#include "core/map/artefacts/map_artefacts.h"
#include "core/map/preparation/despike.h"
#include "core/statistics/grooves/map_grooves.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SPIKE = 8; /* robust deviations, as --despike takes them */

/* Whether heights along one axis are the same but for rounding, as in a profile that was drawn out:
 * its lines are one and say no more than one. */
static bool is_drawn_out(const struct map_differences *differences, int axis) {
    static const double ROUNDING = 1e-12;
    const double other = differences->axis[1 - axis].first;
    return !(other > ROUNDING * differences->axis[axis].first);
}

int map_artefacts_find_stored(const struct grid *grid, const double *z, struct map_artefacts *out,
                              struct error *err) {
    struct map_differences differences;
    map_differences_measure(grid, z, &differences);
    out->sought = true;
    int status = height_steps_find(grid, z, &differences, &out->steps, err);
    for (int axis = 0; axis < 2 && status == 0; axis++) {
        out->columns[axis] = (struct repeated_lines){0};
        if (grid_is_profile(grid) ? axis == 0 : !is_drawn_out(&differences, axis))
            status = repeated_lines_find(grid, z, axis, &differences, out->steps.step,
                                         &out->columns[axis], err);
    }
    return status;
}

/* Takes the spikes out of a copy of the map, and compares its differences. Half a step of the
 * heights counts as a deviation, so that points which are one step off are none. */
static int find_spikes(const struct grid *grid, const double *z, double step, double *copy,
                       const struct map_differences *differences, struct map_differences *without,
                       struct map_spikes *out, struct error *err) {
    struct despike_result done;
    const int axes = grid_is_profile(grid) ? 1 : 2;
    double with_first[2] = {0}, without_first[2] = {0};
    *out = (struct map_spikes){.slope = 1};
    *without = *differences;
    int status = despike(grid, copy, SPIKE, &done, err);
    if (status != 0 || done.spikes == 0)
        return status;
    const double least = fmax(1, step / 2 / done.deviation);
    if (least > 1) {
        memcpy(copy, z, grid_points(grid) * sizeof *copy);
        status = despike(grid, copy, SPIKE * least, &done, err);
    }
    if (status != 0 || done.spikes == 0)
        return status;
    out->count = done.spikes;
    out->largest = done.largest / least;
    map_differences_measure(grid, copy, without);
    for (int axis = 0; axis < axes; axis++) {
        const struct differences *with = &differences->axis[axis], *left = &without->axis[axis];
        with_first[axis] = with->first;
        without_first[axis] = left->first;
        out->curvature = fmax(out->curvature, 1 - left->second / with->second);
    }
    out->slope =
        sqrt(differences_square(grid, without_first) / differences_square(grid, with_first));
    return 0;
}

/* Lines that repeat their neighbours make waves of two, and those of a drawn-out profile have means
 * alone: neither is compared. */
static int find_lines(const struct grid *grid, const double *z,
                      const struct map_differences *differences, struct map_artefacts *out,
                      struct error *err) {
    static const struct line_offsets NONE = {.p_value = (double)NAN, .slope = 1};
    struct line_offsets found[2] = {NONE, NONE};
    int status = 0, tests = 0;
    for (int along = SCAN_ALONG_X; along <= SCAN_ALONG_Y && status == 0; along++) {
        const int across = along == SCAN_ALONG_X ? 1 : 0;
        if (map_columns_found(out, across) || is_drawn_out(differences, across))
            continue;
        status =
            line_offsets_measure(grid, z, (enum scan_axis)along, differences, &found[along], err);
        tests += isnan(found[along].p_value) ? 0 : 1;
    }
    const struct line_offsets *x = &found[SCAN_ALONG_X], *y = &found[SCAN_ALONG_Y];
    const bool by_y = isnan(x->p_value) || (y->found && y->curvature > x->curvature);
    out->lines_along = by_y ? SCAN_ALONG_Y : SCAN_ALONG_X;
    out->lines = by_y ? *y : *x;
    out->lines.p_value = fmin(tests * out->lines.p_value, 1);
    return status;
}

/* Grooves along the scan lines, every few of them, have heights that neighbours have not, either.
 * So offsets count only where they are left without them. */
static int find_lines_beside_grooves(const struct grid *grid, double *z,
                                     const struct map_differences *differences,
                                     struct map_artefacts *out, struct error *err) {
    const struct measured_map map = {grid, z, BOUNDARY_OPEN};
    struct map_differences without;
    struct map_grooves grooves;
    int status = find_lines(grid, z, differences, out, err);
    if (status != 0 || !out->lines.found)
        return status;
    status = map_grooves_find(&grooves, &map, err);
    if (status != 0 || grooves.families == 0)
        return status;
    map_grooves_take(&grooves, grid, z);
    map_differences_measure(grid, z, &without);
    return find_lines(grid, z, &without, out, err);
}

int map_artefacts_find_left(const struct grid *grid, const double *z, struct map_artefacts *out,
                            struct error *err) {
    const size_t points = grid_points(grid);
    struct map_differences differences, without;
    double *copy = array_create(points, sizeof *copy);
    if (copy == NULL)
        return error_memory(err, points * sizeof *copy, "a map without spikes");
    memcpy(copy, z, points * sizeof *copy);
    map_differences_measure(grid, z, &differences);
    int status =
        find_spikes(grid, z, out->steps.step, copy, &differences, &without, &out->spikes, err);
    height_steps_weigh(grid, &without, &out->steps);
    if (status == 0)
        status = find_lines_beside_grooves(grid, copy, &without, out, err);
    free(copy);
    return status;
}

bool map_steps_found(const struct map_artefacts *artefacts) {
    const struct height_steps *steps = &artefacts->steps;
    return steps->step > 0 && !artefacts->smoothed &&
           artefact_counts(steps->slope, steps->curvature);
}

/* Rough parts of skewed heights with a lay hold single points of up to 12.5 deviations, and
 * repeated columns some of up to 20. */
bool map_spikes_found(const struct map_artefacts *artefacts) {
    static const double SURE = 16, AMONG_REPEATED = 64, SHARE = 0.02;
    const struct map_spikes *spikes = &artefacts->spikes;
    if (map_columns_count(artefacts, 0) || map_columns_count(artefacts, 1))
        return spikes->largest > AMONG_REPEATED;
    return spikes->largest > SURE || spikes->curvature > SHARE;
}

bool map_spikes_count(const struct map_artefacts *artefacts) {
    const struct map_spikes *spikes = &artefacts->spikes;
    return map_spikes_found(artefacts) && artefact_counts(spikes->slope, spikes->curvature);
}

bool map_columns_found(const struct map_artefacts *artefacts, int axis) {
    return artefacts->columns[axis].copies + artefacts->columns[axis].between > 0;
}

bool map_columns_count(const struct map_artefacts *artefacts, int axis) {
    const struct repeated_lines *columns = &artefacts->columns[axis];
    return (double)(columns->copies + columns->between) >
           ARTEFACT_SHARE_MOST * (double)columns->lines;
}

bool map_artefacts_count(const struct map_artefacts *artefacts) {
    return map_steps_found(artefacts) || map_spikes_count(artefacts) || artefacts->lines.found ||
           map_columns_count(artefacts, 0) || map_columns_count(artefacts, 1);
}

bool map_artefacts_bend(const struct map_artefacts *artefacts, bool noise_found) {
    const bool noise = map_steps_found(artefacts) || map_spikes_count(artefacts);
    return (noise && !noise_found) || artefacts->lines.found || map_columns_count(artefacts, 0) ||
           map_columns_count(artefacts, 1);
}

double map_artefacts_slope(const struct map_artefacts *artefacts) {
    const double steps = map_steps_found(artefacts) ? artefacts->steps.slope : 1;
    const double lines = artefacts->lines.found ? artefacts->lines.slope : 1;
    const double spikes = map_spikes_found(artefacts) ? artefacts->spikes.slope : 1;
    return spikes * sqrt(fmax(steps * steps + lines * lines - 1, 0));
}
