#include "jobs/like/like_case.h"
#include "core/surface/conditional.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double ROUNDING = 1e-6;    /* relative, of the spacing of points */
static const double NANOSECONDS = 1000; /* to measure a point of a sub-map */

static int read_points(struct like_case *out, struct values *values, bool profile,
                       struct error *err) {
    static const char path[] = "/surface/like/points";
    double *points;
    size_t n;
    int status = values_numbers(values, path, &points, &n, err);
    if (status != 0)
        return status;
    if (points == NULL || n != (profile ? 1 : 2))
        values_fault(values, path, "a measured %s has %s", profile ? "profile" : "surface",
                     profile ? "[nx] points" : "[nx, ny] points");
    else {
        out->nx = (size_t)points[0];
        out->ny = profile ? 1 : (size_t)points[1];
    }
    free(points);
    return 0;
}

static int read_measured(struct like_case *out, struct values *values, struct error *err) {
    static const char path[] = "/surface/like/measured";
    int quantities[PATCH_QUANTITY_COUNT];
    double *measured;
    size_t n, count = values_choices(values, "/surface/like/quantities", quantities);
    int status = values_numbers(values, path, &measured, &n, err);
    if (status != 0)
        return status;
    if (measured != NULL && n != count)
        values_fault(values, path, "%zu values of %zu quantities", n, count);
    for (size_t a = 0; measured != NULL && n == count && a < n; a++)
        out->measured[quantities[a]] = measured[a];
    free(measured);
    return 0;
}

/* Reads several maps. */
static int read_maps(struct like_case *out, struct values *values, struct error *err) {
    static const char path[] = "/surface/like/maps";
    double *numbers;
    size_t n;
    int status = values_numbers(values, path, &numbers, &n, err);
    if (status != 0 || numbers == NULL)
        return status;
    out->map_count = n / LIKE_MAP_NUMBERS;
    if (n % LIKE_MAP_NUMBERS != 0 || out->map_count > JOINT_PATCHES_MOST)
        values_fault(values, path, "%zu numbers; allowed: %d of each of 2 to %d maps", n,
                     (int)LIKE_MAP_NUMBERS, (int)JOINT_PATCHES_MOST);
    else
        for (size_t m = 0; m < out->map_count; m++) {
            const double *of = numbers + m * LIKE_MAP_NUMBERS;
            out->maps[m] = (struct like_map){
                (size_t)of[0], (size_t)of[1], of[2], {.longest = of[3], .shortest = of[4]}};
            if (!(of[0] >= 2 && of[1] >= 1 && of[0] * of[1] <= SURFACE_POINTS_MOST && of[2] > 0) ||
                (out->maps[m].ny == 1) != (out->ny == 1))
                values_fault(values, path, "map %zu has %g by %g points, %g apart", m + 1, of[0],
                             of[1], of[2]);
        }
    const double between = values_number(values, "/surface/like/between");
    out->between = isnan(between) ? 0 : between;
    free(numbers);
    return 0;
}

/* Reads what was fitted, and what of it the map leaves open. */
static void read_fitted(struct like_case *out, struct values *values) {
    int held[LIKE_HELD_COUNT];
    size_t count = values_choices(values, "/surface/like/held", held);
    out->detrend = (enum detrend)values_choice(values, "/surface/like/detrend");
    out->spectrum = (enum like_spectrum)values_choice(values, "/surface/like/spectrum");
    out->heights = (enum like_heights)values_choice(values, "/surface/like/heights");
    out->uncertainty = (enum like_uncertainty)values_choice(values, "/surface/like/uncertainty");
    for (size_t h = 0; h < count; h++)
        out->held[held[h]] = true;
}

/* Returns how many spacings of the surface's grid one of the map has; 0 where that is no whole
 * number. 0 also where the map is larger than half of the cell: its opposite rims would be
 * neighbours. */
static size_t stride_of(const struct like_case *like, const struct grid *grid, double spacing) {
    double stride = rint(spacing / grid_dx(grid));
    bool whole = stride >= 1 && fabs(spacing / grid_dx(grid) - stride) <= ROUNDING * stride;
    bool fits = whole && 2 * stride * (double)like->nx <= (double)grid->nx &&
                (grid_is_profile(grid) || 2 * stride * (double)like->ny <= (double)grid->ny);
    return fits ? (size_t)stride : 0;
}

/* Checks the digest. A file without one is reported before a case is made
 * (schema/study/study_reader.c). */
static void check_digest(struct values *values) {
    static const char path[] = "/surface/like/sha256";
    const char *digest = values_text(values, path);
    if (digest == NULL || strspn(digest, "0123456789abcdef") != strlen(digest))
        values_fault(values, path, "a SHA-256 digest has 64 of the digits 0 to 9 and a to f");
}

/* Draws need cells of twice the sides of the map. */
static void check_cell(const struct like_case *like, struct values *values) {
    const double points = (like->ny == 1 ? 2 : 4) * (double)like->nx * (double)like->ny;
    if (like->uncertainty == LIKE_UNCERTAINTY_POSTERIOR && points > SURFACE_POINTS_MOST)
        values_fault(values, "/surface/like/uncertainty",
                     "cells of twice the sides of the map have %.3g points; %.0f are allowed, and "
                     "\"none\" needs no such cells",
                     points, SURFACE_POINTS_MOST);
}

/* Refuses faces of other kinds than the map's. */
static void check_faces(const struct like_case *like, struct values *values,
                        const struct surface_case *surface) {
    static const char RMS_RATIO[] = "/surface/plateau/rms_ratio";
    if (surface != NULL && surface->grooves != NULL && isnan(like->groove_depth_error))
        values_fault(values, "/surface/grooves/period",
                     "a surface like a measured one has the grooves of the map; allowed: one of "
                     "grooves and like");
    const bool given =
        like->spectrum == LIKE_SPECTRUM_GIVEN && like->heights == LIKE_HEIGHTS_GIVEN && !like->hold;
    if (values_is_given(values, RMS_RATIO) && !given)
        values_fault(values, RMS_RATIO,
                     "a surface like a measured one has the spectrum and the heights of the map; "
                     "allowed: one of like and plateau, or a spectrum (hurst) beside the plateau");
}

int like_case_fill(struct like_case *out, struct values *values, const struct surface_case *surface,
                   struct error *err) {
    *out = (struct like_case){.given = values_text(values, "/surface/like/file") != NULL};
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++)
        out->measured[a] = NAN;
    if (!out->given)
        return 0;
    check_digest(values);
    out->hold = values_flag(values, "/surface/like/hold");
    const double spacing = values_number(values, "/surface/like/spacing");
    out->spacing = spacing;
    read_fitted(out, values);
    out->groove_depth_error = values_number(values, "/surface/like/groove_depth_error");
    out->noise = values_number(values, "/surface/like/noise");
    check_faces(out, values, surface);
    size_t before = values_fault_count(values);
    int status = read_points(out, values, surface_case_dimension(values) == 1, err);
    if (status == 0)
        status = read_maps(out, values, err);
    if (isnan(spacing))
        values_fault(values, "/surface/like/spacing", "missing: distance of the points of the map");
    if (status == 0)
        check_cell(out, values);
    if (status == 0 && surface != NULL && !out->hold && values_fault_count(values) == before)
        out->stride = stride_of(out, &surface->grid, spacing);
    return status == 0 ? read_measured(out, values, err) : status;
}

struct like_patch {
    const struct like_case *like; /* borrowed */
    const struct grid *of;        /* borrowed: of the surface */
    struct grid grid;
    double *z; /* owned */
};

int like_patch_create(struct like_patch **out, const struct like_case *like,
                      const struct grid *grid, struct error *err) {
    struct like_patch *patch = array_create(1, sizeof *patch);
    if (patch == NULL)
        return error_memory(err, sizeof *patch, "a sub-map of a surface");
    double spacing = grid_dx(grid) * (double)like->stride;
    patch->like = like;
    patch->of = grid;
    patch->grid =
        (struct grid){like->nx, like->ny, spacing * (double)like->nx, spacing * (double)like->ny};
    patch->z = array_create(grid_points(&patch->grid), sizeof *patch->z);
    if (patch->z == NULL) {
        like_patch_destroy(&patch);
        return error_memory(err, like->nx * like->ny * sizeof(double), "a sub-map of a surface");
    }
    *out = patch;
    return 0;
}

void like_patch_destroy(struct like_patch **patch) {
    if (*patch == NULL)
        return;
    free((*patch)->z);
    free(*patch);
    *patch = NULL;
}

static int add_noise(struct like_patch *patch, struct random_key key, struct error *err) {
    const size_t points = grid_points(&patch->grid);
    double *noise = array_create(points, sizeof *noise);
    if (noise == NULL)
        return error_memory(err, points * sizeof *noise, "noise of a sub-map");
    conditional_noise(key, points, noise);
    for (size_t p = 0; p < points; p++)
        patch->z[p] += patch->like->noise * noise[p];
    free(noise);
    return 0;
}

int like_patch_cut(struct like_patch *patch, struct random_key key, const double *z,
                   const double **heights, struct error *err) {
    const struct like_case *like = patch->like;
    struct trend trend;
    for (size_t j = 0; j < like->ny; j++)
        for (size_t i = 0; i < like->nx; i++)
            patch->z[j * like->nx + i] = z[(j * patch->of->nx + i) * like->stride];
    *heights = patch->z;
    int status = like->noise > 0 ? add_noise(patch, key, err) : 0;
    return status == 0 ? detrend(&patch->grid, patch->z, like->detrend, &trend, err) : status;
}

int like_patch_measure(struct like_patch *patch, struct random_key key, const double *z,
                       double out[PATCH_QUANTITY_COUNT], struct error *err) {
    const double *heights;
    int status = like_patch_cut(patch, key, z, &heights, err);
    if (status != 0)
        return status;
    const struct measured_map map = {&patch->grid, heights, BOUNDARY_OPEN};
    return patch_measure(&map, out, err);
}

double like_patch_bytes(const struct like_case *like) {
    /* heights twice, and a correlation of twice the sides with its transform */
    return like_case_is_cut(like) ? 16.0 * sizeof(double) * (double)like->nx * (double)like->ny : 0;
}

double like_patch_seconds(const struct like_case *like) {
    double points = like_case_is_cut(like) ? (double)like->nx * (double)like->ny : 0;
    return 1e-9 * NANOSECONDS * points;
}
