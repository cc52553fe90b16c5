#include "jobs/like/like_draw.h"
#include "core/cost.h"
#include "core/surface/conditional.h"
#include "core/surface/height_table.h"
#include "core/surface/modes.h"
#include "core/surface/spectrum.h"
#include "core/surface/translation/translation.h"
#include "jobs/like/like_estimate.h"
#include "jobs/like/like_joint.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

/* One of several maps. */
enum { MAP_BIT = 40 }; /* random numbers of each */
struct map_draw {
    struct grid grid, cell;  /* of a sub-map, and of the surfaces that it is cut from */
    struct generator *whole; /* owned, as the next, one block */
    double *cell_z, *z;
};

struct like_draw {
    const struct like_case *like;
    const struct surface_case *base;
    struct grid cell;        /* of the surfaces that are cut */
    struct like_case cut;    /* how they are */
    struct generator *whole; /* owned, as all below: of these surfaces; NULL: there are none */
    struct like_patch *patch;
    struct map_draw maps[JOINT_PATCHES_MOST]; /* of several maps, in place of both */
    double *cut_z;                            /* of their cell */
    double *z, *gaussian; /* of the cell of the case; the latter NULL until it is wanted */
    /* of the last draw */
    struct surface_case surface; /* borrows from the case and from what follows */
    struct like_estimate estimate;
    struct height_table *heights;
    struct translation *translation;
    struct generator *generator;
    struct grooves grooves;
    /* asked while surfaces are made; may be NULL */
    int (*stop)(void *context);
    void *stop_context; /* borrowed */
};

/* Frees what the last draw made. */
static void draw_clear(struct like_draw *draw) {
    generator_destroy(&draw->generator);
    translation_destroy(&draw->translation);
    height_table_destroy(&draw->heights);
    like_estimate_clear(&draw->estimate);
}

void like_draw_destroy(struct like_draw **draw) {
    struct like_draw *gone = *draw;
    if (gone == NULL)
        return;
    draw_clear(gone);
    generator_destroy(&gone->whole);
    for (size_t m = 0; m < JOINT_PATCHES_MOST; m++) {
        generator_destroy(&gone->maps[m].whole);
        free(gone->maps[m].cell_z);
    }
    like_patch_destroy(&gone->patch);
    free(gone->cut_z);
    free(gone->z);
    free(gone->gaussian);
    free(gone);
    *draw = NULL;
}

/* Returns a cell of twice the sides of the map, with the spacing of its points. */
static struct grid cell_of(const struct like_case *like) {
    const bool profile = like->ny == 1;
    const size_t nx = surface_case_side(2 * (double)like->nx - 0.5);
    const size_t ny = profile ? 1 : surface_case_side(2 * (double)like->ny - 0.5);
    return (struct grid){nx, ny, like->spacing * (double)nx,
                         like->spacing * (double)(profile ? nx : ny)};
}

/* Returns how a sub-map is cut from it. */
static struct like_case cut_of(const struct like_case *like) {
    struct like_case cut = *like;
    cut.stride = 1;
    return cut;
}

/* Returns the integral of the mean square slope of a law from its roll-off to a wave number, but
 * for a factor. */
static double slope_square(const struct spectrum *law, bool profile, double shortest) {
    const double d = profile ? 1 : 2, from = 2 * M_PI / law->wavelength_long;
    const double rolloff = 2 * M_PI / law->wavelength_rolloff, to = 2 * M_PI / shortest;
    const double fall = d + 2 * law->hurst, power = d + 2 - fall;
    const double end = fmin(rolloff, to);
    const double even = (pow(end, d + 2) - pow(fmin(from, end), d + 2)) / (d + 2);
    const double falling = to <= rolloff        ? 0
                           : fabs(power) < 1e-9 ? log(to / rolloff)
                                                : (pow(to / rolloff, power) - 1) / power;
    return even + pow(rolloff, d + 2) * falling;
}

/* Makes surfaces of one of several maps: without the waves that its points do not hold, and with
 * the density of the law. */
static int map_fill(struct map_draw *out, const struct like_map *map,
                    const struct surface_case *surface, const struct surface_options *options,
                    struct error *err) {
    const bool profile = map->ny == 1;
    const size_t points = map->nx * map->ny;
    struct spectrum spectrum = surface->spectrum;
    struct moments moments;
    out->grid = (struct grid){map->nx, map->ny, map->spacing * (double)map->nx,
                              map->spacing * (double)map->ny};
    out->cell.nx = surface_case_side(2 * (double)map->nx - 0.5);
    out->cell.ny = profile ? 1 : surface_case_side(2 * (double)map->ny - 0.5);
    out->cell.lx = map->spacing * (double)out->cell.nx;
    out->cell.ly = profile ? out->cell.lx : map->spacing * (double)out->cell.ny;
    int status = spectrum_moments(&surface->spectrum, &surface->grid, &moments, err);
    if (status != 0)
        return status;
    spectrum.translation = NULL;
    spectrum.scale = SCALE_RMS_SLOPE;
    spectrum.scale_value = moments.rms_slope;
    if (spectrum.type == SPECTRUM_SELF_AFFINE && spectrum.wavelength_short < 2 * map->spacing) {
        const double shortest = fmin(2 * map->spacing, spectrum.wavelength_long);
        spectrum.scale_value *= sqrt(slope_square(&spectrum, profile, shortest) /
                                     slope_square(&spectrum, profile, spectrum.wavelength_short));
        spectrum.wavelength_short = shortest;
        spectrum.wavelength_rolloff = fmax(spectrum.wavelength_rolloff, shortest);
    }
    status = generator_create(&out->whole, &spectrum, &out->cell, options, err);
    if (status != 0)
        return status;
    out->cell_z = array_create(grid_points(&out->cell) + points, sizeof *out->cell_z);
    out->z = out->cell_z != NULL ? out->cell_z + grid_points(&out->cell) : NULL;
    return out->cell_z != NULL
               ? 0
               : error_memory(err, grid_points(&out->cell) * sizeof *out->cell_z, "a surface");
}

static int maps_fill(struct like_draw *draw, const struct surface_options *options,
                     struct error *err) {
    struct surface_options gaussian = *options;
    int status = 0;
    if (options->law == LAW_TRANSLATION) /* its law is that of the cell of the case */
        gaussian.heights = (struct heights){.type = HEIGHTS_GAUSSIAN};
    for (size_t m = 0; m < draw->like->map_count && status == 0; m++)
        status = map_fill(&draw->maps[m], &draw->like->maps[m], draw->base, &gaussian, err);
    return status;
}

static int draw_fill(struct like_draw *draw, struct error *err) {
    const struct surface_case *surface = draw->base;
    const size_t points = grid_points(&surface->grid);
    struct surface_options options = surface->options;
    options.amplitudes = AMPLITUDES_RANDOM; /* a patch is not of a surface with an exact spectrum */
    struct error reason = {0};
    if (draw->like->map_count > 0) {
        draw->z = array_create(points, sizeof *draw->z);
        return draw->z != NULL ? maps_fill(draw, &options, err)
                               : error_memory(err, points * sizeof *draw->z, "a surface");
    }
    struct spectrum rest = surface->spectrum; /* the map was fitted without its grooves */
    rest.grooves = NULL;
    int status = generator_create(&draw->whole, &rest, &draw->cell, &options, &reason);
    if (status != 0 && status != ERROR_INPUT)
        return error_set(err, status, "%s", reason.text);
    status = like_patch_create(&draw->patch, &draw->cut, &draw->cell, err);
    if (status != 0)
        return status;
    draw->cut_z = array_create(grid_points(&draw->cell), sizeof *draw->cut_z);
    draw->z = array_create(points, sizeof *draw->z);
    return draw->cut_z != NULL && draw->z != NULL
               ? 0
               : error_memory(err, points * sizeof *draw->z, "a surface");
}

int like_draw_create(struct like_draw **out, const struct like_case *like,
                     const struct surface_case *surface, struct error *err) {
    struct like_draw *draw = array_create(1, sizeof *draw);
    if (draw == NULL)
        return error_memory(err, sizeof *draw, "draws of surfaces");
    draw->like = like;
    draw->base = surface;
    draw->cell = cell_of(like);
    draw->cut = cut_of(like);
    int status = draw_fill(draw, err);
    if (status != 0)
        like_draw_destroy(&draw);
    *out = draw;
    return status;
}

/* --- the parameters --- */

/* Fits sub-maps of other surfaces of the case together, as the maps were. Maps differ in their
 * scale as the measured ones do. */
static int estimate_maps(struct like_draw *draw, struct random_key key, struct error *err) {
    const struct like_case *like = draw->like;
    const struct like_choices choices = {like->spectrum, like->heights, like->detrend, false, true};
    struct measured_map maps[JOINT_PATCHES_MOST];
    struct spectrum_fit_request trusted[JOINT_PATCHES_MOST];
    struct like_joint joint;
    key.sequence ^= UINT64_C(1) << SUBMAP_BIT;
    for (size_t m = 0; m < like->map_count; m++) {
        struct map_draw *map = &draw->maps[m];
        struct trend trend;
        double normal;
        key.sequence += UINT64_C(1) << MAP_BIT;
        int status = generator_run(map->whole, key, map->cell_z, NULL, err);
        if (status != 0)
            return status;
        conditional_noise(key, 1, &normal);
        const double factor = exp(like->between * normal / 2);
        for (size_t p = 0; p < grid_points(&map->grid); p++)
            map->z[p] = factor * map->cell_z[p / map->grid.nx * map->cell.nx + p % map->grid.nx];
        status = detrend(&map->grid, map->z, like->detrend, &trend, err);
        if (status != 0)
            return status;
        maps[m] = (struct measured_map){&map->grid, map->z, BOUNDARY_OPEN};
        trusted[m] = like->maps[m].trusted;
    }
    return like_joint_measure(&draw->estimate, &joint, like->map_count, maps, trusted,
                              draw->base->spectrum.wavelength_long, &choices, err);
}

/* Fits a sub-map of another surface of the case, as the map was fitted. */
static int estimate_draw(struct like_draw *draw, struct random_key key, struct error *err) {
    const struct like_case *like = draw->like;
    const struct grid grid = {like->nx, like->ny, like->spacing * (double)like->nx,
                              like->spacing * (double)like->ny};
    const struct like_choices choices = {like->spectrum, like->heights, like->detrend, false, true};
    const double *heights;
    if (like->map_count > 0)
        return estimate_maps(draw, key, err);
    key.sequence ^= UINT64_C(1) << SUBMAP_BIT;
    if (draw->whole == NULL)
        return error_set(err, ERROR_INPUT,
                         "the points of the map do not hold the waves of the case");
    int status = generator_run(draw->whole, key, draw->cut_z, NULL, err);
    if (status == 0)
        status = like_patch_cut(draw->patch, key, draw->cut_z, &heights, err);
    if (status != 0)
        return status;
    const struct measured_map map = {&grid, heights, BOUNDARY_OPEN};
    return like_estimate_measure(&draw->estimate, &map, &choices, err);
}

static void set_scale(struct like_draw *draw) {
    struct spectrum *spectrum = &draw->surface.spectrum;
    if (draw->like->held[LIKE_HELD_SCALE])
        return;
    spectrum->scale = SCALE_RMS_SLOPE;
    spectrum->scale_value = draw->estimate.rms_slope;
}

static void set_lay(struct like_draw *draw) {
    if (draw->like->held[LIKE_HELD_LAY])
        return;
    draw->surface.spectrum.anisotropy = draw->estimate.lay.ratio;
    draw->surface.spectrum.lay_angle = draw->estimate.lay.angle;
}

static void set_spectrum(struct like_draw *draw) {
    const struct like_estimate *estimate = &draw->estimate;
    struct spectrum *spectrum = &draw->surface.spectrum;
    if (draw->like->spectrum == LIKE_SPECTRUM_GIVEN)
        return;
    if (draw->like->spectrum == LIKE_SPECTRUM_TABLE) {
        spectrum->table_count = estimate->table.count;
        spectrum->table_wave_number = estimate->table.wave_number;
        spectrum->table_density = estimate->table.density;
    } else {
        const struct spectrum *law = &estimate->self_affine;
        const double rolloff = spectrum->wavelength_long / spectrum->wavelength_rolloff;
        spectrum->hurst = law->hurst;
        spectrum->wavelength_short = law->wavelength_short;
        spectrum->wavelength_long = law->wavelength_long;
        spectrum->wavelength_rolloff =
            draw->like->held[LIKE_HELD_ROLLOFF]
                ? fmax(law->wavelength_long / rolloff, law->wavelength_short)
                : law->wavelength_rolloff;
    }
    set_scale(draw);
    set_lay(draw);
}

static int set_heights(struct like_draw *draw, struct error *err) {
    const struct like_estimate *estimate = &draw->estimate;
    struct heights *heights = &draw->surface.options.heights;
    if (draw->like->heights == LIKE_HEIGHTS_FIT)
        *heights = (struct heights){.type = estimate->distribution,
                                    .shape = isnan(estimate->shape) ? 0 : estimate->shape};
    if (draw->like->heights != LIKE_HEIGHTS_QUANTILES)
        return 0;
    int status = height_table_of_quantiles(&draw->heights, estimate->quantile_count,
                                           estimate->probability, estimate->quantile, err);
    heights->table = draw->heights;
    return status;
}

/* The law of a translation follows from the spectrum and the heights. */
static int set_translation(struct like_draw *draw, struct error *err) {
    struct surface_case *surface = &draw->surface;
    surface->spectrum.translation = NULL;
    surface->translation = NULL;
    if (surface->options.law != LAW_TRANSLATION ||
        surface->options.heights.type == HEIGHTS_GAUSSIAN)
        return 0;
    int status = translation_create(&draw->translation, &surface->spectrum, surface->dimension,
                                    &surface->options.heights, err);
    surface->spectrum.translation = draw->translation;
    surface->translation = draw->translation;
    return status;
}

/* Draws the depths of the grooves, which are those of the map to its error, whatever the scale of
 * the random part is. */
static int set_grooves(struct like_draw *draw, struct random_key key, struct error *err) {
    const struct surface_case *base = draw->base;
    struct surface_case *surface = &draw->surface;
    struct moments of_case, drawn;
    double u[2];
    if (base->grooves == NULL)
        return 0;
    int status = spectrum_moments(&base->spectrum, &base->grid, &of_case, err);
    if (status == 0)
        status = spectrum_moments(&surface->spectrum, &surface->grid, &drawn, err);
    if (status != 0)
        return status;
    random_uniform(key, STREAM_GROOVES, GROOVE_FAMILIES_MOST, 2, u); /* those before are phases */
    const double normal[GROOVE_FAMILIES_MOST] = {sqrt(-2 * log1p(-u[0])) * cos(2 * M_PI * u[1]),
                                                 sqrt(-2 * log1p(-u[0])) * sin(2 * M_PI * u[1])};
    const double error = isnan(draw->like->groove_depth_error) ? 0 : draw->like->groove_depth_error;
    draw->grooves = *base->grooves;
    for (size_t f = 0; f < draw->grooves.families && f < GROOVE_FAMILIES_MOST; f++)
        draw->grooves.family[f].depth *=
            fmax(1 + error * normal[f], 0) * of_case.rms_height / drawn.rms_height;
    surface->grooves = &draw->grooves;
    surface->spectrum.grooves = &draw->grooves;
    return 0;
}

/* --- the surface --- */

static int keep_gaussian(struct like_draw *draw, struct error *err) {
    const size_t points = grid_points(&draw->base->grid);
    if (draw->gaussian == NULL)
        draw->gaussian = array_create(points, sizeof *draw->gaussian);
    if (draw->gaussian == NULL)
        return error_memory(err, points * sizeof *draw->gaussian, "a Gaussian field");
    generator_keep_gaussian(draw->generator, draw->gaussian);
    return 0;
}

void like_draw_set_stop(struct like_draw *draw, int (*stop)(void *context), void *context) {
    draw->stop = stop;
    draw->stop_context = context;
    if (draw->whole != NULL)
        generator_set_stop(draw->whole, stop, context);
    for (size_t m = 0; m < draw->like->map_count; m++)
        generator_set_stop(draw->maps[m].whole, stop, context);
}

int like_draw_make(struct like_draw *draw, struct random_key key, bool gaussian,
                   struct like_drawn *out, struct error *err) {
    struct surface_case *surface = &draw->surface;
    draw_clear(draw);
    *surface = *draw->base;
    surface->options.stop = draw->stop;
    surface->options.stop_context = draw->stop_context;
    *out = (struct like_drawn){.surface = surface, .z = draw->z};
    int status = estimate_draw(draw, key, err);
    if (status != 0)
        return status;
    set_spectrum(draw);
    status = set_heights(draw, err);
    if (status == 0)
        status = set_translation(draw, err);
    if (status == 0)
        status = set_grooves(draw, key, err);
    if (status == 0)
        status = generator_create(&draw->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    const bool kept = gaussian && surface_case_translated(surface);
    if (status == 0 && kept)
        status = keep_gaussian(draw, err);
    if (status == 0)
        status = generator_run(draw->generator, key, draw->z, &out->report, err);
    if (status != 0)
        return status;
    out->modes = generator_modes(draw->generator);
    out->own = generator_drawn(draw->generator);
    out->gaussian = kept ? draw->gaussian : NULL;
    modes_moments(out->modes, &out->moments);
    return 0;
}

/* --- cost and error --- */

/* Returns the surface that sub-maps are cut from; borrows. */
static struct surface_case whole_of(const struct like_case *like,
                                    const struct surface_case *surface) {
    struct surface_case whole = *surface;
    whole.grid = cell_of(like);
    return whole;
}

static double seconds_of(const struct surface_case *surface) {
    const double points = (double)grid_points(&surface->grid);
    return 1e-9 * surface_case_nanoseconds(surface, &surface->grid) * points * cost_caches(points);
}

double like_draw_bytes(const struct like_case *like, const struct surface_case *surface) {
    static const double OF_A_FIT = 200; /* bytes of a point of the map */
    const struct surface_case whole = whole_of(like, surface);
    const struct like_case cut = cut_of(like);
    double others = 0;
    for (size_t m = 0; m < like->map_count; m++)
        others += 2 * OF_A_FIT * (double)like->maps[m].nx * (double)like->maps[m].ny;
    return others + surface_case_bytes(surface) + surface_case_bytes(&whole) +
           like_patch_bytes(&cut) + OF_A_FIT * (double)like->nx * (double)like->ny;
}

double like_draw_seconds(const struct like_case *like, const struct surface_case *surface) {
    static const double OF_A_FIT = 4; /* times the measuring of a sub-map */
    const struct surface_case whole = whole_of(like, surface);
    const struct like_case cut = cut_of(like);
    double others = 0;
    for (size_t m = 0; m < like->map_count; m++)
        others += OF_A_FIT * 1e-6 * (double)like->maps[m].nx * (double)like->maps[m].ny;
    return others + seconds_of(surface) + seconds_of(&whole) + OF_A_FIT * like_patch_seconds(&cut);
}

struct like_error like_draw_error(double mean, double deviation, size_t n) {
    static const double QUANTILE = 0.975;
    if (n < 2)
        return (struct like_error){(double)NAN, (double)NAN, (double)NAN};
    const double number = (double)n, student = gsl_cdf_tdist_Pinv(QUANTILE, number - 1);
    return (struct like_error){mean, student * deviation * sqrt(1 + 1 / number),
                               deviation / sqrt(number)};
}
