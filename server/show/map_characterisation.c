#include "server/show/map_characterisation.h"
#include "core/map/detrend.h"
#include "core/statistics/areal.h"
#include "core/statistics/height_quantiles.h"
#include "core/statistics/roughness.h"
#include "core/statistics/scales.h"
#include "core/statistics/seam.h"
#include "core/statistics/windowed_psd.h"
#include <math.h>

enum { BOUNDARY_AUTO, BOUNDARY_AS_OPEN, BOUNDARY_AS_PERIODIC };
enum { DETREND_AUTO, DETREND_FIRST };

/* What is done to the map, and what was seen before. */
struct decision {
    enum boundary boundary;
    const char *reason; /* of the boundary; static */
    enum detrend detrend;
    struct seam seam;
    double holes; /* share of the points */
    struct trend trend;
};

static int check_request(const struct height_map *map, const struct map_request *request,
                         double holes, struct error *err) {
    if (holes == 1)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    if (holes > 0 && request->boundary == BOUNDARY_AS_PERIODIC) {
        int status = height_map_check_whole(map, err);
        return status == 0 ? 0 : error_context(err, "a periodic map");
    }
    return 0;
}

static void choose_boundary(struct decision *decision, int request) {
    bool rough = seam_is_rough(&decision->seam);
    bool open =
        request == BOUNDARY_AS_OPEN || (request == BOUNDARY_AUTO && (rough || decision->holes > 0));
    decision->boundary = open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
    decision->reason = request != BOUNDARY_AUTO ? "option" : decision->holes > 0 ? "holes" : "seam";
}

/* The seam is looked at as the map is measured, but for a trend that only an open map loses. */
static int decide(struct decision *decision, struct height_map *map,
                  const struct map_request *request, struct error *err) {
    bool given = request->detrend != DETREND_AUTO;
    *decision = (struct decision){
        .holes = (double)height_map_holes(map) / (double)grid_points(&map->grid),
        .detrend = given ? (enum detrend)(request->detrend - DETREND_FIRST) : DETREND_NONE};
    int status = check_request(map, request, decision->holes, err);
    if (status == 0 && given)
        status = detrend(&map->grid, map->z, decision->detrend, &decision->trend, err);
    if (status == 0)
        status = seam_measure(&map->grid, map->z, &decision->seam, err);
    if (status != 0)
        return status;
    choose_boundary(decision, request->boundary);
    if (given || decision->boundary == BOUNDARY_PERIODIC)
        return 0;
    decision->detrend = DETREND_PLANE;
    return detrend(&map->grid, map->z, decision->detrend, &decision->trend, err);
}

static void add_decision(struct characterisation *out, const struct decision *decision,
                         bool profile) {
    static const char GROUP[] = "map";
    static const char *const DETRENDS[] = {"none", "mean", "plane", "quadratic"};
    const struct trend *trend = &decision->trend;
    characterisation_add_text(out, GROUP, "boundary",
                              decision->boundary == BOUNDARY_OPEN ? "open" : "periodic");
    characterisation_add_text(out, GROUP, "boundary_by", decision->reason);
    characterisation_add(out, GROUP, "seam_x", decision->seam.x);
    characterisation_add(out, GROUP, "seam_y", profile ? (double)NAN : decision->seam.y);
    characterisation_add(out, GROUP, "holes", decision->holes);
    characterisation_add_text(out, GROUP, "psd_window",
                              decision->boundary == BOUNDARY_OPEN ? "hann" : "none");
    characterisation_add_text(out, GROUP, "detrend", DETRENDS[decision->detrend]);
    if (decision->detrend != DETREND_NONE)
        characterisation_add(out, GROUP, "trend_height", trend->height);
    if (decision->detrend >= DETREND_PLANE) {
        characterisation_add(out, GROUP, "trend_slope_x", trend->slope_x);
        characterisation_add(out, GROUP, "trend_slope_y", trend->slope_y);
    }
    if (decision->detrend == DETREND_QUADRATIC) {
        characterisation_add(out, GROUP, "trend_bend_xx", trend->bend_xx);
        characterisation_add(out, GROUP, "trend_bend_xy", trend->bend_xy);
        characterisation_add(out, GROUP, "trend_bend_yy", trend->bend_yy);
    }
}

static int add_scales(struct characterisation *out, const struct measured_map *map,
                      struct error *err) {
    static const char GROUP[] = "scales";
    struct scale scales[SCALES_MOST];
    size_t count = scales_measure(map, scales);
    double *length = characterisation_column(out, GROUP, "length", count);
    double *height = characterisation_column(out, GROUP, "rms_height", count);
    double *slope = characterisation_column(out, GROUP, "rms_slope", count);
    double *curvature = characterisation_column(out, GROUP, "rms_curvature", count);
    if (length == NULL || height == NULL || slope == NULL || curvature == NULL)
        return error_memory(err, count * sizeof *length, "a table of scales");
    for (size_t n = 0; n < count; n++) {
        length[n] = scales[n].length;
        height[n] = scales[n].height;
        slope[n] = scales[n].slope;
        curvature[n] = scales[n].curvature;
    }
    return 0;
}

static int add_quantiles(struct characterisation *out, const struct measured_map *map, size_t n,
                         struct error *err) {
    static const char GROUP[] = "quantiles";
    size_t count = height_quantiles_count(n);
    if (count == 0)
        return 0;
    double *probability = characterisation_column(out, GROUP, "probability", count);
    double *quantile = characterisation_column(out, GROUP, "quantile", count);
    if (probability == NULL || quantile == NULL)
        return error_memory(err, count * sizeof *quantile, "quantiles of the heights");
    return height_quantiles_measure(map, n, probability, quantile, err);
}

static int add_psd(struct characterisation *out, const struct measured_map *map,
                   struct error *err) {
    static const char GROUP[] = "psd";
    size_t bins = radial_bins(map->grid);
    double *wave_number = characterisation_column(out, GROUP, "wave_number", bins);
    double *density = characterisation_column(out, GROUP, "density", bins);
    if (wave_number == NULL || density == NULL)
        return error_memory(err, bins * sizeof *density, "a spectral density");
    return map->boundary == BOUNDARY_OPEN
               ? windowed_psd_measure(map, wave_number, density, err)
               : psd_measure(map->grid, map->z, wave_number, density, err);
}

static int add_acf(struct characterisation *out, const struct correlation *correlation,
                   struct error *err) {
    static const char GROUP[] = "acf";
    size_t rings = correlation_rings(correlation);
    double *lag = characterisation_column(out, GROUP, "lag", rings);
    double *mean = characterisation_column(out, GROUP, "correlation", rings);
    if (lag == NULL || mean == NULL)
        return error_memory(err, rings * sizeof *mean, "an autocorrelation");
    correlation_radial(correlation, lag, mean);
    return 0;
}

static int add_areal(struct characterisation *out, const struct measured_map *map,
                     const struct correlation *correlation, struct error *err) {
    static const char GROUP[] = "areal";
    struct areal areal;
    int status = areal_measure(map, correlation, &areal, err);
    if (status != 0)
        return status;
    const struct {
        const char *name;
        double value;
    } rows[] = {{"Sa", areal.sa},   {"Sq", areal.sq},   {"Ssk", areal.ssk}, {"Sku", areal.sku},
                {"Sp", areal.sp},   {"Sv", areal.sv},   {"Sz", areal.sz},   {"Sdq", areal.sdq},
                {"Sdr", areal.sdr}, {"Sal", areal.sal}, {"Str", areal.str}, {"Spd", areal.spd},
                {"Spc", areal.spc}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        characterisation_add(out, GROUP, rows[r].name, rows[r].value);
    return 0;
}

static int add_correlated(struct characterisation *out, const struct measured_map *map,
                          struct error *err) {
    struct correlation *correlation = NULL;
    int status = correlation_create(&correlation, map, err);
    if (status == 0 && !grid_is_profile(map->grid))
        status = add_areal(out, map, correlation, err);
    if (status == 0)
        status = add_scales(out, map, err);
    if (status == 0)
        status = add_psd(out, map, err);
    if (status == 0)
        status = add_acf(out, correlation, err);
    correlation_destroy(&correlation);
    return status;
}

int map_characterise(struct characterisation *out, struct height_map *map,
                     const struct map_request *request, enum boundary *boundary,
                     struct error *err) {
    struct decision decision;
    const struct grid *grid = &map->grid;
    int status = decide(&decision, map, request, err);
    if (status != 0)
        return status;
    const struct measured_map measured = {grid, map->z, decision.boundary};
    *boundary = decision.boundary;
    add_decision(out, &decision, grid_is_profile(grid));
    if (decision.boundary == BOUNDARY_OPEN)
        status = characterise_open(out, &measured, err);
    else
        status = characterise_heights(out, grid, map->z, grid->nx / 2, grid->ny / 2, err);
    if (status == 0)
        status = add_correlated(out, &measured, err);
    size_t heights = grid_points(grid) - height_map_holes(map);
    return status == 0 ? add_quantiles(out, &measured, heights, err) : status;
}
