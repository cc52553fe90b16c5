#include "core/statistics/uncertainty/scalar_errors.h"
#include "core/surface/plateau_face.h"
#include <math.h>
#include <stdlib.h>

/* Fourth powers have so long a tail that a map which has few of its far heights underestimates both
 * the kurtosis and its error. This factor on the error corrects for it (FORMULAS.md, F18.16). */
static const double LONG_TAIL = 1.15;

static double total(const double *sums, size_t cells) {
    double all = 0;
    for (size_t cell = 0; cell < cells; cell++)
        all += sums[cell];
    return all;
}

/* Share by which the mean, and tilts where they were taken out, make the mean square height of an
 * open map smaller than that of the endless surface: each takes as much as a slow wave has. */
static double share_lost(const struct cell_heights *h, const struct low_modes *modes) {
    double share = low_modes_variance(modes, h->power[1], h->count) / (h->rms * h->rms);
    return modes->open ? (h->untilted ? 3 : 1) * share : 0;
}

void scalar_errors_heights(const struct cell_heights *h, const struct low_modes *modes,
                           struct scalar_errors *out) {
    double n = h->count, s = h->rms, third = total(h->power[3], h->cells) / n;
    double fourth = total(h->power[4], h->cells) / n, size = total(h->size, h->cells) / n;
    double skewness = third / pow(s, 3), kurtosis = fourth / pow(s, 4), below = 0.5;
    double sa[LOW_CELLS_MOST], sq[LOW_CELLS_MOST], ssk[LOW_CELLS_MOST], sku[LOW_CELLS_MOST];
    for (size_t l = 0; l < h->levels && h->level[l] < h->mean; l++)
        below = h->share[l];
    for (size_t cell = 0; cell < h->cells; cell++) {
        double p0 = h->power[0][cell], p1 = h->power[1][cell] / s;
        double p2 = h->power[2][cell] / (s * s), p3 = h->power[3][cell] / pow(s, 3);
        double p4 = h->power[4][cell] / pow(s, 4);
        sa[cell] = h->size[cell] - p0 * size - p1 * s * (1 - 2 * below);
        sq[cell] = s * (p2 - p0) / 2;
        ssk[cell] = p3 - skewness * p0 - 3 * p1 - 1.5 * skewness * (p2 - p0);
        sku[cell] = p4 - kurtosis * p0 - 4 * skewness * p1 - 2 * kurtosis * (p2 - p0);
    }
    double lost = share_lost(h, modes);
    out->sa = hypot(sqrt(modes->excess[2] * low_modes_variance(modes, sa, n)), lost / 2 * size);
    out->sq = hypot(sqrt(modes->excess[2] * low_modes_variance(modes, sq, n)), lost / 2 * s);
    out->ssk = sqrt(modes->excess[3] * low_modes_variance(modes, ssk, n));
    out->sku = LONG_TAIL * sqrt(modes->excess[2] * low_modes_variance(modes, sku, n));
}

/* What a standardised height changes in RMS height, skewness and kurtosis. */
enum { INFLUENCES = 3 };
static void influences_at(double t, double skewness, double kurtosis, double out[INFLUENCES]) {
    const double square = t * t - 1;
    out[0] = square / 2;
    out[1] = t * t * t - skewness - 3 * t - 1.5 * skewness * square;
    out[2] = t * t * t * t - kurtosis - 4 * skewness * t - 2 * kurtosis * square;
}

/* Their mean squares over a distribution. */
static void influences_of_law(const struct heights *law, const struct height_moments *moments,
                              double out[INFLUENCES]) {
    enum { SCORES = 1600 };
    static const double REACH = 8;
    double weights = 0;
    for (size_t q = 0; q < INFLUENCES; q++)
        out[q] = 0;
    for (size_t n = 0; n < SCORES; n++) {
        const double score = REACH * (2 * ((double)n + 0.5) / SCORES - 1);
        const double weight = exp(-score * score / 2);
        double influences[INFLUENCES];
        influences_at(heights_at_score(law, moments, score), moments->skewness, moments->kurtosis,
                      influences);
        for (size_t q = 0; q < INFLUENCES; q++)
            out[q] += weight * influences[q] * influences[q];
        weights += weight;
    }
    for (size_t q = 0; q < INFLUENCES; q++)
        out[q] /= weights;
}

static void influences_of_map(const struct measured_map *map, double out[INFLUENCES]) {
    const size_t points = grid_points(map->grid);
    struct average mean = {0}, powers[3] = {0}, squares[INFLUENCES] = {0};
    for (size_t point = 0; point < points; point++)
        average_add(&mean, map->z[point]);
    const double middle = average_value(&mean);
    for (size_t point = 0; point < points; point++)
        for (int power = 2; power <= 4; power++)
            average_add(&powers[power - 2], pow(map->z[point] - middle, power));
    const double rms = sqrt(average_value(&powers[0]));
    const double skewness = average_value(&powers[1]) / pow(rms, 3);
    const double kurtosis = average_value(&powers[2]) / pow(rms, 4);
    for (size_t point = 0; point < points; point++) {
        double influences[INFLUENCES];
        influences_at((map->z[point] - middle) / rms, skewness, kurtosis, influences);
        for (size_t q = 0; q < INFLUENCES; q++)
            average_add(&squares[q], influences[q] * influences[q]);
    }
    for (size_t q = 0; q < INFLUENCES; q++)
        out[q] = average_value(&squares[q]);
}

/* A law that only just fits may have far longer tails than the surface: more is not believed. */
static const double FAR_MOST = 3;

/* Replaces the mean squares that influences have over a law by the factors that they are to errors
 * from the map; applies that of the RMS height. */
static void law_apply(struct scalar_errors *errors, const struct measured_map *map,
                      double influences[INFLUENCES]) {
    double found[INFLUENCES];
    influences_of_map(map, found);
    for (size_t q = 0; q < INFLUENCES; q++)
        influences[q] = fmin(sqrt(influences[q] / found[q]), FAR_MOST);
    errors->sq *= influences[0];
    errors->m0 *= influences[0];
}

void scalar_errors_by_law(struct scalar_errors *errors, const struct measured_map *map,
                          const struct heights *law, const struct height_moments *moments) {
    double factor[INFLUENCES];
    influences_of_law(law, moments, factor);
    law_apply(errors, map, factor);
    errors->ssk *= factor[1];
    errors->sku *= fmax(factor[2] / LONG_TAIL, 1); /* which is in the law */
}

/* Of a stratified face the law is that of few valleys, and as uncertain: as of functional
 * parameters that rest on far heights (F18.61). */
static const double FEW_VALLEYS = 1.1;

void scalar_errors_by_strata(struct scalar_errors *errors, const struct measured_map *map,
                             const struct plateau_law *law) {
    enum { STEPS = 4000 };
    static const double REACH = 8; /* RMS heights of either */
    const struct stratified_heights heights = stratified_heights_of(
        law->valley_rms, law->plateau_rms, law->plateau_mean - law->valley_mean);
    const struct height_moments moments = stratified_moments(&heights);
    const double most =
        (heights.offset + REACH * heights.plateau - heights.mean) / heights.deviation;
    const double least =
        (fmin(-REACH * heights.valley, heights.offset - REACH * heights.plateau) - heights.mean) /
        heights.deviation;
    const double step = (most - least) / STEPS;
    double factor[INFLUENCES] = {0}, below = 0;
    for (size_t n = 0; n < STEPS; n++) {
        const double next = stratified_cdf(&heights, least + ((double)n + 1) * step);
        double influences[INFLUENCES];
        influences_at(least + ((double)n + 0.5) * step, moments.skewness, moments.kurtosis,
                      influences);
        for (size_t q = 0; q < INFLUENCES; q++)
            factor[q] += (next - below) * influences[q] * influences[q];
        below = next;
    }
    law_apply(errors, map, factor);
    errors->ssk *= FEW_VALLEYS * factor[1];
    errors->sku *= fmax(factor[2], 1); /* beside LONG_TAIL */
}

/* Fills the deviations from the mean by cell, over the mean and the number of all; returns the
 * mean. */
static double deviations_fill(const double *counts, const double *sums, size_t cells, double *out) {
    double n = total(counts, cells), mean = total(sums, cells) / n;
    for (size_t cell = 0; cell < cells; cell++)
        out[cell] = (sums[cell] - mean * counts[cell]) / (mean * n);
    return mean;
}

void scalar_errors_differences(const struct cell_differences *d, const struct cell_heights *h,
                               const struct low_modes *modes, struct scalar_errors *out) {
    size_t cells = modes->cells_x * modes->cells_y;
    double m0[LOW_CELLS_MOST], m2[LOW_CELLS_MOST], m4[LOW_CELLS_MOST], alpha[LOW_CELLS_MOST];
    double curvature[LOW_CELLS_MOST], area[LOW_CELLS_MOST], bends[LOW_CELLS_MOST];
    deviations_fill(h->power[0], h->power[2], cells, m0);
    deviations_fill(d->count, d->slope, cells, m2);
    deviations_fill(d->count, d->bend, cells, m4);
    deviations_fill(d->count, d->curvature, cells, curvature);
    double developed = deviations_fill(d->count, d->area, cells, area);
    for (size_t cell = 0; cell < cells; cell++) {
        bends[cell] = m4[cell] - 2 * m2[cell];
        alpha[cell] = m0[cell] + bends[cell];
        area[cell] *= developed / (developed - 1);
    }
    double lost = share_lost(h, modes);
    out->m0 = hypot(sqrt(modes->excess[2] * low_modes_variance(modes, m0, 1)), lost);
    out->m2 = sqrt(low_modes_variance_within(modes, m2, d->count, 1));
    out->m4 = sqrt(low_modes_variance_within(modes, m4, d->count, 1));
    out->bends = sqrt(low_modes_variance_within(modes, bends, d->count, 1));
    out->alpha =
        hypot(sqrt(modes->excess[2] * low_modes_variance_within(modes, alpha, d->count, 1)), lost);
    out->area = sqrt(low_modes_variance_within(modes, area, d->count, 1));
    out->slope = out->m2 / 2;
    out->curvature = sqrt(low_modes_variance_within(modes, curvature, d->count, 1)) / 2;
}

void scalar_errors_inside(const struct scalar_errors *all, double share,
                          struct scalar_errors *out) {
    const double wider = 1 / sqrt(share);
    *out = *all;
    out->slope *= wider;
    out->curvature *= wider;
    out->m2 *= wider;
    out->m4 *= wider;
    out->bends *= wider;
    out->alpha = hypot(all->alpha, sqrt(1 / share - 1) * all->bends);
}

void summit_errors_measure(const struct summit_list *list, double density, const struct grid *grid,
                           const double *searched, const struct cell_heights *heights,
                           const struct low_modes *modes, struct summit_errors *out) {
    size_t cells = modes->cells_x * modes->cells_y;
    double count[LOW_CELLS_MOST] = {0}, height[LOW_CELLS_MOST] = {0};
    double spread[LOW_CELLS_MOST] = {0}, curvature[LOW_CELLS_MOST] = {0};
    double n = (double)list->count, mean = 0, variance = 0, bend = 0, none = (double)NAN;
    *out = (struct summit_errors){none, none, none, none};
    if (list->count < 2)
        return;
    for (size_t a = 0; a < list->count; a++) {
        mean += list->summits[a].height / n;
        bend += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - mean, 2) / n;
    for (size_t a = 0; a < list->count; a++) {
        const struct summit *summit = &list->summits[a];
        size_t cx = (size_t)(summit->x / grid->lx * (double)modes->cells_x);
        size_t cy =
            grid_is_profile(grid) ? 0 : (size_t)(summit->y / grid->ly * (double)modes->cells_y);
        cx = cx < modes->cells_x ? cx : modes->cells_x - 1;
        cy = cy < modes->cells_y ? cy : modes->cells_y - 1;
        size_t cell = cy * modes->cells_x + cx;
        count[cell]++;
        height[cell] += summit->height - mean;
        spread[cell] += pow(summit->height - mean, 2) - variance;
        curvature[cell] += summit->curvature - bend;
    }
    double all = total(searched, cells);
    for (size_t cell = 0; cell < cells; cell++) {
        count[cell] -= n * searched[cell] / all;
        height[cell] -= heights->power[1][cell] * n / heights->count;
    }
    out->density = density * sqrt(low_modes_variance_within(modes, count, searched, n));
    out->height_mean = sqrt(low_modes_variance_within(modes, height, searched, n));
    out->height_deviation =
        sqrt(modes->excess[2] * low_modes_variance_within(modes, spread, searched, n) / variance) /
        2;
    out->curvature_mean = sqrt(low_modes_variance_within(modes, curvature, searched, n));
}

int summit_cells_count(const struct measured_map *map, const struct low_modes *modes, size_t before,
                       size_t after, double *searched, struct error *err) {
    const struct grid *grid = map->grid;
    unsigned char *whole = array_create(grid_points(grid), 1);
    if (whole == NULL)
        return error_memory(err, grid_points(grid), "marks of a map");
    map_mark_whole(map, before, after, whole);
    for (size_t cell = 0; cell < modes->cells_x * modes->cells_y; cell++)
        searched[cell] = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t cx = 0; cx < modes->cells_x; cx++) {
            size_t cell = cell_of(j, modes->cells_y, grid->ny) * modes->cells_x + cx;
            size_t end = cell_begin(cx + 1, modes->cells_x, grid->nx);
            for (size_t i = cell_begin(cx, modes->cells_x, grid->nx); i < end; i++)
                searched[cell] += whole[j * grid->nx + i];
        }
    free(whole);
    return 0;
}
