#include "jobs/maps/map_remedies.h"
#include "core/map/preparation/line_losses.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Widens an interval of a positive value by what an error of its logarithm adds to it. */
static void widen(struct interval *interval, double error) {
    static const double SCORE = 1.960;
    interval->low =
        interval->value * exp(-hypot(log(interval->value / interval->low), SCORE * error));
    interval->high =
        interval->value * exp(hypot(log(interval->high / interval->value), SCORE * error));
}

/* Adds errors of mean squares, as shares of them. */
static void losses_add(const struct line_losses *lost, const struct areal *areal,
                       struct scalar_errors *out) {
    out->sa = hypot(out->sa, lost->height / 2 * areal->sa);
    out->sq = hypot(out->sq, lost->height / 2 * areal->sq);
    out->m0 = hypot(out->m0, lost->height);
    out->slope = hypot(out->slope, lost->slope / 2);
    out->m2 = hypot(out->m2, lost->slope);
    out->area = hypot(out->area, lost->slope);
    out->m4 = hypot(out->m4, lost->bend);
    out->curvature = hypot(out->curvature, lost->curvature / 2);
    out->alpha = hypot(out->alpha, lost->height + lost->bend - 2 * lost->slope);
}

/* Heights of a curve are in proportion to the RMS height. */
static void losses_add_functional(const struct line_losses *lost, struct map_functional *out) {
    const struct functional *f = &out->found;
    struct functional *e = &out->errors.found;
    const struct {
        double value, *error;
    } heights[] = {{f->line.k, &e->line.k},
                   {f->line.pk, &e->line.pk},
                   {f->line.vk, &e->line.vk},
                   {f->secant.k, &e->secant.k},
                   {f->secant.pk, &e->secant.pk},
                   {f->secant.vk, &e->secant.vk},
                   {f->xp, &e->xp},
                   {f->vmp, &e->vmp},
                   {f->vmc, &e->vmc},
                   {f->vvc, &e->vvc},
                   {f->vvv, &e->vvv}};
    for (size_t n = 0; n < sizeof heights / sizeof *heights; n++)
        *heights[n].error = hypot(*heights[n].error, lost->height / 2 * heights[n].value);
}

/* What lines lose is of slopes across them alone. */
static void losses_add_directions(const struct line_losses *lost, struct isotropy *out) {
    const double size = out->anisotropy;
    out->anisotropy_error = hypot(out->anisotropy_error, lost->slope);
    out->ratio_error = hypot(out->ratio_error, out->ratio * lost->slope / (1 - size * size));
    out->direction_error = fmin(hypot(out->direction_error, lost->slope / (2 * size)), M_PI / 4);
}

static void lines_add(const struct map_remedied *found, const struct line_losses *lost) {
    losses_add(lost, found->areal, found->errors);
    losses_add(lost, found->areal, found->moment_errors);
    losses_add_functional(lost, found->functional);
    losses_add_directions(lost, &found->directions->fine);
    losses_add_directions(lost, &found->directions->coarse);
    for (int s = 0; s < MAP_STENCILS; s++) {
        struct map_summits *summits = &found->parameters->summits[s];
        summits->errors.height_deviation =
            hypot(summits->errors.height_deviation, lost->height / 2 * summits->height_deviation);
    }
    for (size_t n = 0; n < found->scales->count; n++) {
        struct map_scale *scale = &found->scales->scale[n];
        scale->height_error = hypot(scale->height_error, lost->slope / 2 * scale->found.height);
        scale->slope_error = hypot(scale->slope_error, lost->slope / 2 * scale->found.slope);
        scale->curvature_error =
            hypot(scale->curvature_error, lost->curvature / 2 * scale->found.curvature);
    }
    if (found->spectra->has_fit && found->spectra->fit.fitted) {
        widen(&found->spectra->fit.rms_height, lost->height / 2);
        if (isfinite(found->spectra->fit.nayak_alpha.value)) /* which has the mean square height */
            widen(&found->spectra->fit.nayak_alpha, lost->height);
    }
}

/* Relative errors of RMS slope and curvature. */
struct lost_waves {
    double slope, curvature;
};

static void noise_add(const struct lost_waves *lost, struct scalar_errors *out) {
    const double slope = lost->slope, curvature = lost->curvature;
    out->slope = hypot(out->slope, slope);
    out->m2 = hypot(out->m2, 2 * slope);
    out->area = hypot(out->area, 2 * slope);
    out->curvature = hypot(out->curvature, curvature);
    out->m4 = hypot(out->m4, 2 * curvature);
    out->alpha = hypot(out->alpha, 2 * fabs(curvature - 2 * slope));
}

/* Returns what is left of a wave's slope by differences over a length. */
static double left_of_slope(double wavelength, double length) {
    const double phase = M_PI * length / wavelength;
    return fabs(sin(phase)) / phase;
}

/* It is the shortest waves that are not known: longer differences have less of them. */
static void noise_add_scales(const struct lost_waves *lost, double shortest,
                             struct map_scales *scales) {
    const struct scale *first = &scales->scale[0].found;
    for (size_t n = 0; n < scales->count; n++) {
        struct map_scale *scale = &scales->scale[n];
        const double left =
            left_of_slope(shortest, scale->found.length) / left_of_slope(shortest, first->length);
        const double slope =
            lost->slope * fmin(pow(left * first->slope / scale->found.slope, 2), 1);
        const double curvature =
            lost->curvature *
            fmin(pow(left * left * first->curvature / scale->found.curvature, 2), 1);
        scale->height_error = hypot(scale->height_error, scale->found.height * slope);
        scale->slope_error = hypot(scale->slope_error, scale->found.slope * slope);
        scale->curvature_error = hypot(scale->curvature_error, scale->found.curvature * curvature);
    }
}

/* Adds what differences next to the sides have less than others: where noise was taken out, waves
 * go on beyond them as their mirror images. Nothing of maps that repeat. */
static int sides_add(const struct measured_map *map, struct lost_waves *out, struct error *err) {
    const bool profile = grid_is_profile(map->grid);
    struct grid inner = *map->grid;
    if (map->boundary != BOUNDARY_OPEN)
        return 0;
    inner.nx -= 2;
    inner.lx = (double)inner.nx * grid_dx(map->grid);
    if (!profile) {
        inner.ny -= 2;
        inner.ly = (double)inner.ny * grid_dy(map->grid);
    }
    double *z = array_create(grid_points(&inner), sizeof *z);
    if (z == NULL)
        return error_memory(err, grid_points(&inner) * sizeof *z, "a map without its sides");
    for (size_t j = 0; j < inner.ny; j++)
        memcpy(z + j * inner.nx, map->z + (j + (profile ? 0 : 1)) * map->grid->nx + 1,
               inner.nx * sizeof *z);
    struct roughness all, inside;
    open_roughness_measure(map, &all);
    open_roughness_measure(&(struct measured_map){&inner, z, BOUNDARY_OPEN}, &inside);
    free(z);
    out->slope = hypot(out->slope, inside.rms_slope / all.rms_slope - 1);
    out->curvature = hypot(out->curvature, inside.rms_curvature / all.rms_curvature - 1);
    return 0;
}

/* What steps leave in the share of heights below one: 2 cosine cos(2 pi z/step), and so on, beside
 * 1 in their density. */
struct ripple {
    double step, cosine, sine;
    const struct material_curve *curve; /* borrowed */
};

static struct ripple ripple_find(const struct measured_map *map, double step,
                                 const struct material_curve *curve) {
    struct average cosine = {0}, sine = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++) {
        average_add(&cosine, cos(2 * M_PI * map->z[point] / step));
        average_add(&sine, sin(2 * M_PI * map->z[point] / step));
    }
    return (struct ripple){step, average_value(&cosine), average_value(&sine), curve};
}

/* Returns by how much the height is off that a share of the points lies above. */
static double ripple_shift(const struct ripple *ripple, double share) {
    const struct material_curve *curve = ripple->curve;
    const double phase = 2 * M_PI * (curve->mean + material_height(curve, share)) / ripple->step;
    return fabs(ripple->cosine * sin(phase) - ripple->sine * cos(phase)) * ripple->step / M_PI;
}

/* Adds to volumes and heights by share what is left of steps: heights are near the steps where the
 * map is level. */
static int steps_add(struct map_functional *out, const struct measured_map *map, double step,
                     struct error *err) {
    struct material_curve curve;
    struct functional *e = &out->errors.found;
    int status = material_curve_create(&curve, map, err);
    if (status != 0)
        return status;
    const struct ripple ripple = ripple_find(map, step, &curve);
    const double peaks = 0.1 * ripple_shift(&ripple, 0.1);
    const double material = 0.8 * ripple_shift(&ripple, 0.8);
    const double voids = 0.9 * ripple_shift(&ripple, 0.1);
    const double valleys = 0.2 * ripple_shift(&ripple, 0.8);
    e->vmp = hypot(e->vmp, peaks);
    e->vmc = hypot(e->vmc, hypot(peaks, material));
    e->vvc = hypot(e->vvc, hypot(voids, valleys));
    e->vvv = hypot(e->vvv, valleys);
    e->xp = hypot(e->xp, hypot(ripple_shift(&ripple, 0.025), ripple_shift(&ripple, 0.5)));
    material_curve_clear(&curve);
    return 0;
}

/* Summits are as curved as the surface is, and their density goes with (curvature/slope)^2. */
static void noise_add_summits(const struct lost_waves *lost, struct map_summits *out) {
    struct summit_errors *errors = &out->errors;
    errors->curvature_mean = hypot(errors->curvature_mean, lost->curvature * out->curvature_mean);
    errors->density =
        hypot(errors->density, 2 * fabs(lost->curvature - lost->slope) * out->density);
}

/* Moments inside and refined summits leave the sides out. */
static int denoised_add(const struct map_remedied *found, const struct measured_map *map,
                        const struct preparation_record *record, struct error *err) {
    struct lost_waves lost = {record->denoised_slope, record->denoised_curvature};
    noise_add(&lost, found->moment_errors);
    noise_add_summits(&lost, &found->parameters->summits[SUMMITS_REFINED]);
    const int status = sides_add(map, &lost, err);
    noise_add(&lost, found->errors);
    noise_add_scales(&lost, record->denoised_to, found->scales);
    for (int s = 0; s < SUMMITS_REFINED; s++)
        noise_add_summits(&lost, &found->parameters->summits[s]);
    /* it ends where waves were removed, as far as the fit before knew */
    found->spectra->fit.short_wavelength.low = (double)NAN;
    found->spectra->fit.short_wavelength.high = (double)NAN;
    return status;
}

int map_remedies_add(const struct map_remedied *found, const struct measured_map *map,
                     const struct preparation_record *record, struct error *err) {
    struct line_losses lost;
    int status = line_losses_measure(map, record->lines, record->lines_along, &lost, err);
    if (status == 0 && record->lines != SCAN_LINES_NONE)
        lines_add(found, &lost);
    if (status == 0 && record->denoised)
        status = denoised_add(found, map, record, err);
    if (status == 0 && record->denoised && record->artefacts.steps.step > 0)
        status = steps_add(found->functional, map, record->artefacts.steps.step, err);
    return status;
}
