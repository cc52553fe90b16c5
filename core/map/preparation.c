#include "core/map/preparation.h"
#include "core/map/crop.h"
#include "core/map/gaussian_filter.h"
#include "core/map/membrane.h"
#include "core/map/preparation_internal.h"
#include "core/plain_text.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void preparation_note(struct preparation_record *record, const char *name, const char *format,
                      ...) {
    if (record->count == PREPARATION_STEPS_MOST)
        return;
    struct preparation_step *step = &record->steps[record->count++];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(step->text, sizeof step->text, format, arguments);
    va_end(arguments);
    text_make_plain(step->text);
    step->name = name;
}

/* --- crop --- */

static int crop(struct preparation_record *record, struct height_map *map,
                const struct preparation *asked, struct error *err) {
    const struct grid before = map->grid;
    const double spacing[2] = {grid_dx(&before), grid_dy(&before)};
    size_t points[4];
    if (asked->crop[2].value == 0)
        return 0;
    for (size_t c = 0; c < 4; c++) {
        const struct asked_length *length = &asked->crop[c];
        double count = length->value;
        if (length->has_unit) {
            int status = preparation_length(&count, map, length, "--crop", err);
            if (status != 0)
                return status;
            count = round(count / spacing[c % 2]);
        }
        points[c] = (size_t)(count < 1e15 ? count : 1e15);
    }
    int status = map_crop(map, points[0], points[1], points[2], points[3], err);
    if (status != 0)
        return error_context(err, "--crop");
    preparation_note(record, "crop", "columns %zu to %zu, rows %zu to %zu of %zu by %zu points",
                     points[0], points[0] + points[2] - 1, points[1], points[1] + points[3] - 1,
                     before.nx, before.ny);
    return 0;
}

/* --- boundary and trend --- */

static int check_holes(const struct height_map *map, const struct preparation *asked, double holes,
                       struct error *err) {
    if (holes == 1)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    if (holes > 0 && !asked->fill && asked->boundary == ASK_BOUNDARY_PERIODIC) {
        int status = height_map_check_whole(map, err);
        return status == 0 ? 0 : error_context(err, "a periodic map");
    }
    return 0;
}

static void decide_boundary(struct preparation_record *record, enum asked_boundary asked) {
    bool rough = seam_is_rough(&record->seam);
    bool open =
        asked == ASK_BOUNDARY_OPEN || (asked == ASK_BOUNDARY_AUTO && (rough || record->holes > 0));
    record->boundary = open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
    record->boundary_by = asked != ASK_BOUNDARY_AUTO ? "option"
                          : record->holes > 0        ? "holes"
                                                     : "seam";
}

/* The seam is looked at as the map is measured, but for a trend that only an open map loses. */
static int level(struct preparation_record *record, struct height_map *map,
                 const struct preparation *asked, struct error *err) {
    bool given = asked->detrend != ASK_DETREND_AUTO;
    record->holes = (double)height_map_holes(map) / (double)grid_points(&map->grid);
    record->detrend = given ? (enum detrend)(asked->detrend - ASK_DETREND_NONE) : DETREND_NONE;
    int status = check_holes(map, asked, record->holes, err);
    if (status == 0 && given)
        status = detrend(&map->grid, map->z, record->detrend, &record->trend, err);
    if (status == 0)
        status = seam_measure(&map->grid, map->z, &record->seam, err);
    if (status != 0)
        return status;
    decide_boundary(record, asked->boundary);
    if (!given && record->boundary == BOUNDARY_OPEN) {
        record->detrend = DETREND_PLANE;
        status = detrend(&map->grid, map->z, record->detrend, &record->trend, err);
    }
    static const char *const NAMES[] = {"none", "mean", "plane", "quadratic"};
    if (status == 0 && record->detrend != DETREND_NONE)
        preparation_note(record, "detrend", "%s%s, of least squares", NAMES[record->detrend],
                         given ? "" : " (an open map)");
    return status;
}

static int fill(struct preparation_record *record, struct height_map *map, struct error *err) {
    const size_t holes = height_map_holes(map);
    int status = membrane_fill(&map->grid, map->z, record->boundary, err);
    if (status != 0)
        return error_context(err, "--fill");
    preparation_note(record, "fill", "%zu holes, %.4g %% of the points, by the smoothest membrane",
                     holes, 100 * record->holes);
    return 0;
}

static int filter_one(struct preparation_record *record, struct height_map *map,
                      const struct asked_length *asked, bool keeps_long_waves, bool robust,
                      struct error *err) {
    const char *option = keeps_long_waves ? "--filter S" : "--filter L";
    struct gaussian_filter filter = {.keeps_long_waves = keeps_long_waves, .robust = robust};
    struct gaussian_filter_result result;
    char cut_off[40], weights[60] = "";
    if (asked->value == 0)
        return 0;
    int status = preparation_length(&filter.cut_off, map, asked, option, err);
    if (status != 0)
        return status;
    status = gaussian_filter_run(&map->grid, map->z, record->boundary, &filter, &result, err);
    if (status != 0)
        return error_context(err, "%s", option);
    if (robust)
        snprintf(weights, sizeof weights, ", %zu steps of weights, %.3g %% rejected", result.steps,
                 100 * result.rejected);
    preparation_note(
        record, keeps_long_waves ? "s_filter" : "l_filter",
        "%s, cut-off %s, of which the mean has %.4g %%%s", robust ? "robust Gaussian" : "Gaussian",
        preparation_length_text(map, filter.cut_off, cut_off), 100 * result.transmission, weights);
    return 0;
}

static int filter(struct preparation_record *record, struct height_map *map,
                  const struct preparation *asked, struct error *err) {
    const struct asked_length *first = &asked->short_waves, *second = &asked->long_waves;
    char short_cut_off[40], long_cut_off[40];
    if (first->value > 0 && second->value > 0 && !(first->value < second->value))
        return error_set(err, ERROR_INPUT,
                         "--filter S=%s and L=%s leave no waves: the cut-off of S must be shorter",
                         preparation_length_text(map, first->value, short_cut_off),
                         preparation_length_text(map, second->value, long_cut_off));
    int status = filter_one(record, map, first, true, asked->robust, err);
    return status == 0 ? filter_one(record, map, second, false, asked->robust, err) : status;
}

static int taper(struct preparation_record *record, struct height_map *map, enum map_window window,
                 struct error *err) {
    int status = height_map_check_whole(map, err);
    if (status != 0)
        return error_context(err, "--window, before which --fill fills holes");
    record->window_power = map_taper(&map->grid, map->z, window);
    record->boundary = BOUNDARY_PERIODIC;
    record->boundary_by = "window";
    preparation_note(record, "window", "%s, 1 in the middle, mean square %.6g",
                     window == MAP_WINDOW_HANN ? "Hann" : "Tukey, a tenth at each side",
                     record->window_power);
    return 0;
}

int preparation_run(struct preparation_record *record, struct height_map *map,
                    const struct preparation *asked, struct error *err) {
    record->window_power = 1;
    int status = preparation_units(record, map, asked, err);
    if (status == 0)
        status = crop(record, map, asked, err);
    if (status == 0)
        status = level(record, map, asked, err);
    if (status == 0 && asked->fill)
        status = fill(record, map, err);
    if (status == 0)
        status = filter(record, map, asked, err);
    if (status == 0)
        status = preparation_resample(record, map, asked, err);
    if (status == 0 && asked->window != MAP_WINDOW_NONE)
        status = taper(record, map, asked->window, err);
    return status;
}
