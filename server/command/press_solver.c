#include "server/command/press_solver.h"
#include "core/contact/stretch.h"
#include "core/map/mirror.h"
#include "core/statistics/local_wave.h"
#include "core/statistics/open_roughness.h"
#include <math.h>

void press_release(struct press *press) {
    patch_finder_destroy(&press->patches);
    area_workspace_destroy(&press->areas);
    contact_destroy(&press->contact);
    full_destroy(&press->full);
    compliance_destroy(&press->compliance);
    press->state = (struct contact_state){0};
}

void press_clear(struct press *press) {
    press_release(press);
    *press = (struct press){0};
}

/* Slopes of maps that do not repeat are those inside of them; maps too small for the polynomials
 * have those between their points. */
static int measure_open(struct press *press, const struct height_map *map, struct error *err) {
    const struct measured_map open = {&map->grid, map->z, BOUNDARY_OPEN};
    struct moments moments;
    struct roughness roughness;
    int status = local_moments_measure(&open, &moments, err);
    if (status != 0)
        return status;
    open_roughness_measure(&open, &roughness);
    press->slope = isfinite(moments.rms_slope) ? moments.rms_slope : roughness.rms_slope;
    press->height = roughness.rms_height;
    return 0;
}

static int measure_periodic(struct press *press, const struct height_map *map, struct error *err) {
    struct moments moments;
    int status = roughness_spectral(&map->grid, map->z, &moments, err);
    if (status != 0)
        return status;
    press->slope = moments.rms_slope;
    press->height = moments.rms_height;
    return 0;
}

static int measure(struct press *press, const struct height_map *map, bool periodic,
                   struct error *err) {
    int status = periodic ? measure_periodic(press, map, err) : measure_open(press, map, err);
    if (status == 0 && !(press->slope > 0))
        return error_set(err, ERROR_INPUT, "the map is flat, so that no load has a meaning");
    return status;
}

static int solvers_create(struct press *press, const struct press_block *asked, struct error *err) {
    bool meshed = asked->model != PRESS_HALFSPACE, open = asked->boundary == PRESS_OPEN;
    double lengths = meshed && !(asked->lengths > 0) ? 1.5 : asked->lengths;
    const struct grid *grid = &press->grid;
    const struct block block = {.model = meshed ? MODEL_LAYERED : MODEL_HALFSPACE,
                                .poisson = asked->poisson,
                                .height = lengths > 0 ? lengths * grid->lx : INFINITY,
                                .layer_growth = 1.1,
                                .weighting = GAP_STANDARD};
    int status = open ? compliance_create_open(&press->compliance, grid, &block, err)
                      : compliance_create(&press->compliance, grid, &block, err);
    if (status == 0 && asked->model == PRESS_FULL)
        status = full_create(&press->full, grid, &block, &FULL_DEFAULTS, err);
    else if (status == 0)
        status = contact_create(&press->contact, press->compliance, &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = area_workspace_create(&press->areas, press->compliance, err);
    if (status == 0)
        status = patch_finder_create(&press->patches, grid, err);
    if (status == 0 && open)
        patch_finder_open(press->patches);
    return status;
}

int press_begin(struct press *press, struct height_map *map, const struct press_block *block,
                struct error *err) {
    press->map = map->grid;
    press->copies = 1;
    if (block->boundary == PRESS_OPEN && block->model != PRESS_HALFSPACE)
        return error_set(err, ERROR_INPUT,
                         "the map does not repeat, and --model %s needs a block that does: "
                         "--boundary mirrored or periodic makes it one, or --model halfspace",
                         block->model == PRESS_FULL ? "full" : "layered");
    int status = measure(press, map, block->boundary == PRESS_PERIODIC, err);
    if (status == 0 && block->boundary == PRESS_MIRRORED) {
        status = height_map_mirror(map, err);
        press->copies = grid_is_profile(&map->grid) ? 2 : 4;
    }
    press->grid = map->grid;
    if (status == 0)
        status = solvers_create(press, block, err);
    if (status != 0)
        return status;
    press->full_contact = NAN;
    if (press->full != NULL)
        return full_begin(press->full, map->z, err);
    status = contact_begin(press->contact, map->z, err);
    if (status == 0 && !press->compliance->open)
        press->full_contact = contact_full_pressure(press->contact);
    return status;
}

/* Areas of a face that has grown sideways: as studies tell them. */
static void stretch(struct contact_area *area, double now) {
    double open = area->nodes < 1 ? (1 - now * area->nodes) / (1 - area->nodes) : 1;
    area->edges = stretch_fraction(area->edges, open);
    area->perimeter = stretch_fraction(area->perimeter, open);
    area->nodes *= now;
    area->lower *= now;
    area->upper *= now;
}

static double largest(size_t n, const double *p) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, p[i]);
    return most;
}

int press_load(struct press *press, double pressure, double values[PRESS_VALUES],
               struct error *err) {
    struct contact_state *state = &press->state;
    struct full_report report = {.stretch = NAN};
    struct contact_area area;
    struct patches patches;
    int status = press->full != NULL ? full_press(press->full, pressure, state, &report, err)
                                     : contact_press(press->contact, pressure, state, err);
    if (status != 0)
        return status;
    contact_area(press->areas, state, &area);
    patches_find(press->patches, state->p, &patches, NULL);
    if (isfinite(report.stretch))
        stretch(&area, report.stretch);
    values[PRESS_LOAD] = pressure / press->slope;
    values[PRESS_EDGES] = area.edges;
    values[PRESS_NODES] = area.nodes;
    values[PRESS_LOWER] = area.lower;
    values[PRESS_UPPER] = area.upper;
    values[PRESS_PERIMETER] = area.perimeter;
    values[PRESS_PEAK] = largest(grid_points(&press->grid), state->p) / press->slope;
    values[PRESS_APPROACH] = state->approach / press->height;
    values[PRESS_MEAN_GAP] = area.mean_gap / press->height;
    values[PRESS_STIFFNESS] =
        isfinite(state->stiffness) ? state->stiffness * press->height / press->slope : (double)NAN;
    values[PRESS_PATCHES] = (double)patches.count / press->copies;
    values[PRESS_CONTACT_NODES] = (double)state->nodes / press->copies;
    values[PRESS_ITERATIONS] =
        press->full != NULL ? (double)report.newton : (double)state->iterations;
    values[PRESS_VIOLATION] = state->violation;
    return 0;
}
