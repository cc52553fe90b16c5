/* The model "full": finite elements on the rough geometry itself (core/full). */
#include "core/contact/patches.h"
#include "core/cost.h"
#include "core/full/full.h"
#include "jobs/contact/case/contact_case.h"
#include <math.h>
#include <stdlib.h>

static const double ROUNDING = 1e-9; /* relative */
/* Elements may have edges of slope 6 (core/full/mesh.c), which the steepest ones reach then. */
static const double SLOPE_MOST = 2;
/* Least height of a block in RMS heights. Layers fold over valleys deeper than two thirds of the
 * block. Of Gaussian profiles of 32 to 2048 points and surfaces of 16 or 32 a side none mesh at 1,
 * few to most at 2 and 3, all at 4. */
static const double HEIGHT_LEAST = 4;
/* The error of columns of elements that widen from a depth of 8 of their widths on, the default, on
 * meshes of any fineness. It is at most these shares of areas (too small), and of gaps (too large)
 * and stiffnesses of profiles, and a tenth of them of surfaces; it falls with the square of the
 * depth. Measured on profiles of wavelength ratio 8 at 16 and 64 points a shortest wave against
 * columns of one width, loads of 0.01 to 0.5: areas 0.05 (Poisson's ratio 0), 0.17 (0.3) and 0.27 %
 * (0.5), gaps 0.17, 0.49 and 0.54 %. A depth of 16 leaves a fifth of it. */
static const double WIDENING_DEPTH = 8, WIDENING_AREA = 0.003, WIDENING_GAP = 0.008,
                    WIDENING_SURFACE = 0.1;
/* Measures, facts and scalars of this model's own. */
enum {
    FULL_CUTS,    /* of load steps */
    FULL_CHANGES, /* of single nodes of the active set */
    FULL_DEEPEST, /* node below the flat */
    FULL_BALANCE, /* |sum of contact forces/load - 1| */
    FULL_STRETCH  /* area of the nodes in contact under load, over that undeformed */
};
static const struct model_curve CURVES[] = {
    {"stretch", "contact area now/undeformed", FULL_STRETCH},
    {"load_cuts", "load steps made smaller", FULL_CUTS},
    {"set_changes", "changes of single nodes of the active set", FULL_CHANGES}};
enum { FACT_SLOPE, FACT_QUALITY }; /* mesh.h */
enum full_scalar {
    SCALAR_LOAD_REACHED, /* the last load with values; 0: no mesh, or no equilibrium */
    SCALAR_ITERATIONS,   /* Newton's, of all loads, as the cuts */
    SCALAR_CUTS,
    SCALAR_CHANGES,     /* of single nodes of the active set, of all loads */
    SCALAR_BALANCE,     /* largest, as the penetrations, which are in RMS heights */
    SCALAR_PENETRATION, /* of the nodes */
    SCALAR_WEIGHTED_PENETRATION,
    SCALAR_STRETCH, /* at the last load reached */
    SCALAR_SLOPE,   /* steepest edge of the face; none without a mesh, as the next */
    SCALAR_QUALITY, /* least Jacobian over edges of the undeformed elements */
    SCALAR_COUNT
};
static const char *const SCALARS[SCALAR_COUNT] = {
    [SCALAR_LOAD_REACHED] = "full_load_reached",
    [SCALAR_ITERATIONS] = "full_iterations",
    [SCALAR_CUTS] = "full_load_cuts",
    [SCALAR_CHANGES] = "full_set_changes",
    [SCALAR_BALANCE] = "full_force_balance",
    [SCALAR_PENETRATION] = "full_penetration",
    [SCALAR_WEIGHTED_PENETRATION] = "full_weighted_penetration",
    [SCALAR_STRETCH] = "full_stretch",
    [SCALAR_SLOPE] = "full_steepest_slope",
    [SCALAR_QUALITY] = "full_mesh_quality",
};

static const char *kinematics_name(const struct contact_case *one_case) {
    return choice_name(KINEMATICS_CHOICES, (int)one_case->kinematics);
}

/* Checks the surface for finite elements on the true geometry, for which its slopes matter. */
static int check(struct contact_case *one_case, size_t model, struct values *values,
                 struct error *err) {
    const struct surface_case *surface = &one_case->surface;
    double rms_height, rms_slope;
    if (!contact_case_has_scale(one_case)) {
        values_fault(
            values, "/surface/rms_slope",
            "the model full needs the scale of the surface, whose slopes count in it: give "
            "rms_slope or rms_height");
        return 0;
    }
    int status = contact_case_scale(one_case, &rms_height, &rms_slope, err);
    if (status != 0)
        return status;
    double height = one_case->blocks[model].height / rms_height;
    if (rms_slope > SLOPE_MOST)
        values_fault(
            values,
            surface->spectrum.scale == SCALE_RMS_SLOPE ? "/surface/rms_slope"
                                                       : "/surface/rms_height",
            "RMS slope %.4g: the model full can mesh surfaces up to about %g, whose steepest "
            "edges are three times as steep",
            rms_slope, SLOPE_MOST);
    else if (height < HEIGHT_LEAST * (1 - ROUNDING))
        values_fault(
            values, "/contact/block_height",
            "%.4g RMS heights of the surface: the model full needs %g or more; the layers of "
            "lower blocks fold over the surface's valleys",
            height, HEIGHT_LEAST);
    one_case->rms_slope = rms_slope;
    one_case->rms_height = rms_height;
    return 0;
}

static int face_fits(const struct block *block, double rms_slope, double rms_height,
                     struct error *err) {
    double height = block->height / rms_height;
    if (rms_slope > SLOPE_MOST)
        return error_set(err, ERROR_INPUT,
                         "RMS slope %.4g: the model full can mesh surfaces up to about %g; "
                         "--filter S=LENGTH takes short waves out, which are the steepest",
                         rms_slope, SLOPE_MOST);
    if (height < HEIGHT_LEAST * (1 - ROUNDING))
        return error_set(err, ERROR_INPUT,
                         "the block is %.4g RMS heights high: the model full needs %g or more, as "
                         "layers of lower blocks fold over valleys; take a larger --height",
                         height, HEIGHT_LEAST);
    return 0;
}

/* --- errors --- */

static double mesh_floor(int dimension, enum measure_field field, double transition_depth) {
    double profile = field == FIELD_GAP ? WIDENING_GAP : WIDENING_AREA;
    double usual = dimension == 1 ? profile : WIDENING_SURFACE * profile;
    return usual * pow(WIDENING_DEPTH / transition_depth, 2);
}

/* --- cost --- */

static double bytes(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    const struct block *block = &one_case->blocks[model];
    struct full_options options = contact_case_full_options(one_case, grid);
    struct full_size size = cost_full_size(grid, block, &options, one_case->rms_slope);
    /* its states lend patches no memory */
    return cost_full_bytes(grid, block, &options, &size) + patch_finder_bytes(grid);
}

/* Returns the seconds of the loads without jumps, without a limit. */
static double smooth_seconds(const struct contact_case *one_case, const struct grid *grid,
                             const struct full_size *size) {
    double loads =
        cost_full_loads(grid, size, one_case->rms_slope, one_case->load_count, one_case->loads);
    return cost_full_contact(grid, size, loads);
}

static struct cost_jumps jumps(const struct contact_case *one_case, size_t model,
                               const struct grid *grid) {
    struct full_options options = contact_case_full_options(one_case, grid);
    struct full_size size =
        cost_full_size(grid, &one_case->blocks[model], &options, one_case->rms_slope);
    if (one_case->loads == NULL)
        return (struct cost_jumps){0};
    return cost_full_jumps(
        grid, &size, contact_case_wave(one_case, grid), one_case->rms_slope,
        one_case->loads[one_case->load_count - 1],
        cost_jumps_most(one_case->time_limit, smooth_seconds(one_case, grid, &size)));
}

static double seconds(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    struct full_options options = contact_case_full_options(one_case, grid);
    struct full_size size =
        cost_full_size(grid, &one_case->blocks[model], &options, one_case->rms_slope);
    double expected = smooth_seconds(one_case, grid, &size) + jumps(one_case, model, grid).seconds;
    return one_case->time_limit > 0 ? fmin(expected, one_case->time_limit) : expected;
}

/* --- solving --- */

struct contact_solver {
    struct full *full;
    struct material material;
    double transforms; /* of the same cost as its work */
};

static void destroy(struct contact_solver **solver) {
    if (*solver != NULL)
        full_destroy(&(*solver)->full);
    free(*solver);
    *solver = NULL;
}

static int create(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err) {
    const struct grid *grid = &compliance->grid;
    struct full_options options =
        contact_case_limited_options(one_case, grid, &one_case->blocks[model]);
    struct contact_solver *solver = array_create(1, sizeof *solver);
    if (solver == NULL)
        return error_memory(err, sizeof *solver, "a contact solver");
    solver->transforms = cost_full_transforms(grid);
    solver->material = material_of(one_case->blocks[model].poisson, one_case->kinematics);
    int status = full_create(&solver->full, grid, &one_case->blocks[model], &options, err);
    if (status != 0)
        destroy(&solver);
    *out = solver;
    return status;
}

static int begin(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err) {
    full_set_stop(solver->full, stop, context);
    int status = full_begin(solver->full, z, err);
    if (status != 0)
        return status;
    const struct mesh *mesh = full_mesh(solver->full);
    facts[FACT_SLOPE] = mesh->slope;
    facts[FACT_QUALITY] = mesh->quality;
    return 0;
}

/* Presses. Areas are stretched unless strains are small, or nothing is in contact. */
static int press(struct contact_solver *solver, double pressure, struct contact_pressed *out,
                 struct error *err) {
    struct full_report report = {.reached = NAN};
    int status = full_press(solver->full, pressure, &out->state, &report, err);
    out->reached = report.reached;
    if (status != 0)
        return status;
    out->state.work *= solver->transforms;
    if (report.kinematics != KINEMATICS_SMALL && isfinite(report.stretch))
        out->stretch = report.stretch;
    out->open_stretch = report.open_stretch;
    out->face_tilt = report.face_tilt;
    out->contact_tilt = report.contact_tilt;
    out->own[FULL_CUTS] = (double)report.cuts;
    out->own[FULL_CHANGES] = (double)report.changes;
    out->own[FULL_DEEPEST] = report.penetration;
    out->own[FULL_BALANCE] = fabs(report.balance);
    out->own[FULL_STRETCH] = report.stretch;
    return 0;
}

static void measure(const struct model_values *values, double *out) {
    const double *const *own = &values->of[MEASURE_OWN];
    size_t n = values->load_count, solved = 0;
    while (solved < n && !isnan(values->of[MEASURE_ITERATIONS][solved]))
        solved++;
    out[SCALAR_LOAD_REACHED] = solved > 0 ? values->loads[solved - 1] : 0;
    out[SCALAR_ITERATIONS] = model_sum(n, values->of[MEASURE_ITERATIONS]);
    out[SCALAR_CUTS] = model_sum(n, own[FULL_CUTS]);
    out[SCALAR_CHANGES] = model_sum(n, own[FULL_CHANGES]);
    out[SCALAR_BALANCE] = model_largest(n, own[FULL_BALANCE]);
    out[SCALAR_PENETRATION] = model_largest(n, own[FULL_DEEPEST]);
    out[SCALAR_WEIGHTED_PENETRATION] = model_largest(n, values->of[MEASURE_PENETRATION]);
    if (solved > 0)
        out[SCALAR_STRETCH] = own[FULL_STRETCH][solved - 1];
    out[SCALAR_SLOPE] = values->facts[FACT_SLOPE];
    out[SCALAR_QUALITY] = values->facts[FACT_QUALITY];
}

static double nodes(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    struct full_options options = contact_case_full_options(one_case, grid);
    double dimension = grid_is_profile(grid) ? 2 : 3;
    return (double)full_degrees_of_freedom(grid, &one_case->blocks[model], &options) / dimension;
}

static struct contact_block block_of(struct contact_solver *solver) {
    return (struct contact_block){.mesh = full_mesh(solver->full),
                                  .u = full_displacement(solver->full),
                                  .material = solver->material};
}

const struct contact_model FULL_MODEL = {
    .rank = 2,
    .block = MODEL_LAYERED,
    .elements = true,
    .may_fail = true,
    .stretches = true,
    .slides = true,
    .default_height = 1.5,
    .tolerance = 1e-9,
    .curve_count = sizeof CURVES / sizeof *CURVES,
    .curves = CURVES,
    .scalar_count = SCALAR_COUNT,
    .scalars = SCALARS,
    .kinematics = kinematics_name,
    .check = check,
    .face_fits = face_fits,
    .mesh_floor = mesh_floor,
    .bytes = bytes,
    .seconds = seconds,
    .jumps = jumps,
    .times_linear = 20,
    .create = create,
    .destroy = destroy,
    .begin = begin,
    .press = press,
    .measure = measure,
    .nodes = nodes,
    .block_of = block_of,
};
