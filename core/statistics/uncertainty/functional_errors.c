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

struct weighing {
    const struct material_curve *curve; /* borrowed */
    size_t cells, points;
    uint32_t *count; /* owned; [class*cells + cell] */
    double *z;       /* owned: the heights of a weighted curve, `points` */
    double *share;   /* owned: of each class */
};

static void weighing_clear(struct weighing *w) {
    free(w->count);
    free(w->z);
    free(w->share);
}

/* Returns the class of a height about the mean. */
static size_t class_of(const struct material_curve *curve, double height) {
    const double below = 1 - material_ratio(curve, height);
    const double at = below * CLASSES;
    return !(at > 0) ? 0 : at >= CLASSES - 1 ? CLASSES - 1 : (size_t)at;
}

static int weighing_create(struct weighing *w, const struct measured_map *map,
                           const struct material_curve *curve, const struct low_modes *modes,
                           struct error *err) {
    const struct grid *grid = map->grid;
    *w = (struct weighing){.curve = curve, .cells = modes->cells_x * modes->cells_y};
    w->points = curve->n < POINTS_MOST ? curve->n : POINTS_MOST;
    w->count = array_create(CLASSES * w->cells, sizeof *w->count);
    w->z = array_create(w->points, sizeof *w->z);
    w->share = array_create(CLASSES, sizeof *w->share);
    if (w->count == NULL || w->z == NULL || w->share == NULL) {
        weighing_clear(w);
        return error_memory(err, CLASSES * w->cells * sizeof *w->count, "heights by cell");
    }
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            const double z = map->z[j * grid->nx + i];
            const size_t cell = cell_of(j, modes->cells_y, grid->ny) * modes->cells_x +
                                cell_of(i, modes->cells_x, grid->nx);
            if (!isnan(z))
                w->count[class_of(curve, z - curve->mean) * w->cells + cell]++;
        }
    return 0;
}

/* Makes the curve of heights that count 1 + part times the wave of their cell. Within a class all
 * count alike. */
static void weigh(struct weighing *w, const double *wave, double part) {
    double all = 0, below = 0, mean = 0;
    for (size_t k = 0; k < CLASSES; k++) {
        w->share[k] = 0;
        for (size_t cell = 0; cell < w->cells; cell++)
            w->share[k] += (1 + part * wave[cell]) * (double)w->count[k * w->cells + cell];
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
