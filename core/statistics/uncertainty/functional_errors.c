#include "core/statistics/uncertainty/functional_errors.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Heights are counted by cell in classes of equal shares, and curves have POINTS_MOST heights. */
enum { CLASSES = 4096, POINTS_MOST = 65536 };
enum { FUNCTIONALS = sizeof(struct functional) / sizeof(double) };
enum { LAWS = sizeof(struct plateau_law) / sizeof(double), VALUES = FUNCTIONALS + LAWS };
_Static_assert(FUNCTIONALS * sizeof(double) == sizeof(struct functional), "doubles alone");
_Static_assert(LAWS * sizeof(double) == sizeof(struct plateau_law), "doubles alone");

/* Weights are 1 and up to this share of a wave of mean square 1 more or less: they stay above 0,
 * and what they change is about half of a standard error of a map. */
static const double WEIGHT = 0.5;

/* What rests on far heights is wrong by more than a map shows that has few of them: as the kurtosis
 * in F18.16, by factors that were measured (F18.61); the valleys of a stratified face are the
 * fewest. */
static const double FAR_HEIGHTS = 1.1, FEW_VALLEYS = 1.15, ANY = 1.06;

/* How many heights of a cell are in a class; few cells have some of each class. */
struct heights_in {
    uint32_t cell, count;
};

struct weighing {
    const struct material_curve *curve; /* borrowed */
    size_t cells, points;
    size_t first[CLASSES + 1];  /* of each class, among ... */
    struct heights_in *heights; /* ... these, owned */
    double *z;                  /* owned: the heights of a weighted curve, `points` */
    double *share;              /* owned: of each class */
};

static void weighing_clear(struct weighing *w) {
    free(w->heights);
    free(w->z);
    free(w->share);
}

/* Returns the class of a height about the mean. */
static size_t class_of(const struct material_curve *curve, double height) {
    const double below = 1 - material_ratio(curve, height);
    const double at = below * CLASSES;
    return !(at > 0) ? 0 : at >= CLASSES - 1 ? CLASSES - 1 : (size_t)at;
}

/* Fills counts, [class*cells + cell]; returns how many of them are not 0. */
static size_t heights_count(const struct weighing *w, const struct measured_map *map,
                            const struct low_modes *modes, uint32_t *count) {
    const struct grid *grid = map->grid;
    size_t some = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            const double z = map->z[j * grid->nx + i];
            const size_t cell = cell_of(j, modes->cells_y, grid->ny) * modes->cells_x +
                                cell_of(i, modes->cells_x, grid->nx);
            if (!isnan(z) && count[class_of(w->curve, z - w->curve->mean) * w->cells + cell]++ == 0)
                some++;
        }
    return some;
}

static int weighing_create(struct weighing *w, const struct measured_map *map,
                           const struct material_curve *curve, const struct low_modes *modes,
                           struct error *err) {
    *w = (struct weighing){.curve = curve, .cells = modes->cells_x * modes->cells_y};
    w->points = curve->n < POINTS_MOST ? curve->n : POINTS_MOST;
    uint32_t *count = array_create(CLASSES * w->cells, sizeof *count);
    const size_t some = count != NULL ? heights_count(w, map, modes, count) : 0;
    w->heights = array_create(some, sizeof *w->heights);
    w->z = array_create(w->points, sizeof *w->z);
    w->share = array_create(CLASSES, sizeof *w->share);
    if (count == NULL || w->heights == NULL || w->z == NULL || w->share == NULL) {
        free(count);
        weighing_clear(w);
        return error_memory(err, CLASSES * w->cells * sizeof *count, "heights by cell");
    }
    for (size_t k = 0, at = 0; k < CLASSES; k++) {
        for (size_t cell = 0; cell < w->cells; cell++)
            if (count[k * w->cells + cell] > 0)
                w->heights[at++] = (struct heights_in){(uint32_t)cell, count[k * w->cells + cell]};
        w->first[k + 1] = at;
    }
    free(count);
    return 0;
}

/* Makes the curve of heights that count 1 + part times the wave of their cell. Within a class all
 * count alike. */
static void weigh(struct weighing *w, const double *wave, double part) {
    double all = 0, below = 0, mean = 0;
    for (size_t k = 0; k < CLASSES; k++) {
        w->share[k] = 0;
        for (size_t h = w->first[k]; h < w->first[k + 1]; h++)
            w->share[k] += (1 + part * wave[w->heights[h].cell]) * (double)w->heights[h].count;
        all += w->share[k];
    }
    size_t k = 0;
    for (size_t point = 0; point < w->points; point++) {
        const double wanted = ((double)point + 0.5) / (double)w->points * all;
        while (k + 1 < CLASSES && below + w->share[k] <= wanted)
            below += w->share[k++];
        const double within = w->share[k] > 0 ? fmin((wanted - below) / w->share[k], 1) : 0;
        w->z[point] = material_height(w->curve, 1 - ((double)k + within) / CLASSES);
        mean += w->z[point] / (double)w->points;
    }
    for (size_t point = 0; point < w->points; point++)
        w->z[point] -= mean;
}

/* Measures the parameters of the weighted curve. */
static void measure(const struct weighing *w, bool stratified, double out[VALUES]) {
    const struct material_curve curve = {.n = w->points, .z = w->z};
    struct functional found;
    struct plateau_law plateau;
    for (size_t v = FUNCTIONALS; v < VALUES; v++)
        out[v] = (double)NAN;
    functional_measure(&curve, &found);
    memcpy(out, &found, sizeof found);
    if (!stratified)
        return;
    plateau_fit(&curve, &plateau);
    memcpy(out + FUNCTIONALS, &plateau, sizeof plateau);
}

int functional_errors_measure(struct functional_errors *out, const struct measured_map *map,
                              const struct material_curve *curve, const struct map_chance *chance,
                              struct error *err) {
    const struct low_modes *modes = &chance->modes;
    struct weighing w;
    struct plateau_law plateau;
    double power[VALUES] = {0}, none = (double)NAN;
    for (size_t v = 0; v < VALUES; v++)
        power[v] = chance->told ? 0 : none;
    if (chance->told) {
        int status = weighing_create(&w, map, curve, modes, err);
        if (status != 0)
            return status;
        plateau_fit(curve, &plateau);
        for (size_t m = 0; m < modes->count; m++) {
            double more[VALUES], less[VALUES];
            weigh(&w, modes->value[m], WEIGHT);
            measure(&w, isfinite(plateau.ratio), more);
            weigh(&w, modes->value[m], -WEIGHT);
            measure(&w, isfinite(plateau.ratio), less);
            for (size_t v = 0; v < VALUES; v++)
                power[v] += pow((more[v] - less[v]) / (2 * WEIGHT), 2) / (double)modes->count;
        }
        weighing_clear(&w);
    }
    for (size_t v = 0; v < VALUES; v++)
        power[v] = ANY * sqrt(modes->excess[2] * power[v]);
    memcpy(&out->found, power, sizeof out->found);
    memcpy(&out->plateau, power + FUNCTIONALS, sizeof out->plateau);
    double *const far[] = {&out->found.line.pk,   &out->found.line.vk,      &out->found.secant.pk,
                           &out->found.secant.vk, &out->found.xp,           &out->found.vmp,
                           &out->found.vvv,       &out->plateau.plateau_rms};
    for (size_t v = 0; v < sizeof far / sizeof *far; v++)
        *far[v] *= FAR_HEIGHTS / ANY;
    out->plateau.valley_rms *= FEW_VALLEYS / ANY;
    out->plateau.valley_mean *= FEW_VALLEYS / ANY;
    return 0;
}

/* --- tilts --- */

/* Heights of a law at equal steps of probability, on a lattice of positions. */
enum { LAW_HEIGHTS = 1024, POSITIONS = 8 };
/* Sizes of tilts, of equal shares of the distribution of Rayleigh. */
enum { TILTS = 4 };

/* A tilt of mean square 1 over the positions. */
static double tilt_at(size_t position) {
    static const double ROOT_12 = 3.4641016151377544;
    return ROOT_12 * (((double)position + 0.5) / POSITIONS - 0.5);
}

/* Fills the parameters of heights of a law from which tilts along both axes are taken. */
static int tilted_measure(const double law[LAW_HEIGHTS], double along, double across,
                          double out[FUNCTIONALS], struct error *err) {
    const struct grid grid = {LAW_HEIGHTS, POSITIONS * POSITIONS, 1, 1};
    double *z = array_create(grid_points(&grid), sizeof *z);
    if (z == NULL)
        return error_memory(err, grid_points(&grid) * sizeof *z, "tilted heights");
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct material_curve curve;
    struct functional found;
    for (size_t position = 0; position < grid.ny; position++)
        for (size_t n = 0; n < LAW_HEIGHTS; n++)
            z[position * LAW_HEIGHTS + n] = law[n] + along * tilt_at(position % POSITIONS) +
                                            across * tilt_at(position / POSITIONS);
    int status = material_curve_create(&curve, &map, err);
    free(z);
    if (status != 0)
        return status;
    functional_measure(&curve, &found);
    material_curve_clear(&curve);
    memcpy(out, &found, sizeof found);
    return 0;
}

int functional_errors_by_law(struct functional_errors *out, const struct map_chance *chance,
                             const struct heights *law, const struct height_moments *moments,
                             bool profile, struct error *err) {
    const struct cell_heights *heights = chance->heights;
    if (!chance->told || !chance->modes.open || !heights->untilted)
        return 0;
    const double amplitude =
        sqrt(low_modes_variance(&chance->modes, heights->power[1], heights->count));
    double z[LAW_HEIGHTS], none[FUNCTIONALS], all[FUNCTIONALS], square[FUNCTIONALS] = {0};
    for (size_t n = 0; n < LAW_HEIGHTS; n++)
        z[n] = heights->rms * heights_quantile(law, moments, ((double)n + 0.5) / LAW_HEIGHTS);
    int status = tilted_measure(z, 0, 0, none, err);
    for (size_t t = 0; t < TILTS && status == 0; t++) {
        const double size = amplitude * sqrt(-2 * log(1 - ((double)t + 0.5) / TILTS));
        const double turn = M_PI / 2 * ((double)t + 0.5) / TILTS;
        double tilted[FUNCTIONALS];
        status = profile ? tilted_measure(z, size * M_SQRT1_2, 0, tilted, err)
                         : tilted_measure(z, size * cos(turn), size * sin(turn), tilted, err);
        for (size_t v = 0; v < FUNCTIONALS && status == 0; v++)
            square[v] += pow(tilted[v] - none[v], 2) / TILTS;
    }
    memcpy(all, &out->found, sizeof all);
    for (size_t v = 0; v < FUNCTIONALS && status == 0; v++)
        all[v] = sqrt(all[v] * all[v] + square[v]);
    memcpy(&out->found, all, sizeof all);
    return status;
}
