#include "jobs/contact/case/contact_case_read.h"
#include "core/full/mesh.h"
#include "jobs/contact/case/contact_loads.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/quantity/quantity.h"
#include "jobs/contact/tally/contact_densities.h"
#include "jobs/like/like_hold.h"
#include "jobs/like/like_parameters.h"
#include "jobs/surface/other_law.h"
#include "jobs/surface/surface_counter.h"
#include "jobs/surface/surface_parameters.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>

const struct parameter_table *const CONTACT_TABLES[] = {
    &CONTACT_PARAMETERS, &SURFACE_PARAMETERS, &COUNTER_PARAMETERS,
    &LIKE_PARAMETERS,    &TARGET_PARAMETERS,  CONTACT_QUANTITY_TABLES NULL};

static const double ROUNDING = 1e-9; /* relative: of numbers that should be equal */
enum { BINS_MOST = 10000, PRESSURE_CELLS_MOST = 1000000 };
static const double PAIR_SUMS_MOST = 2e6; /* of contact_densities.h */

/* What a study asks of the contact, read without its surface. Levels and block without faults
 * become those of the case when the surface has none either. */
struct asked {
    size_t level_count; /* 0: at fault */
    double levels[CONTACT_LEVELS_MOST];
    bool block;    /* has no fault */
    double height; /* in height_unit; INFINITY; NaN: that of each model */
    int height_unit;
    double fine; /* in fine_unit; INFINITY; NaN: by transition_depth */
    int fine_unit;
    double modulus; /* E* in Pa of loads in Pa; 0: loads are in E* h' */
    struct counter_body counter;
};

static const char FINE_HEIGHT[] = "/contact/block_fine_height";
static const char COATING[] = "/contact/coating/thickness",
                  COATING_MODULUS[] = "/contact/coating/modulus",
                  COATING_POISSON[] = "/contact/coating/poisson";

/* Reads the coating, whose thickness has yet to be compared with the block's height. */
static void read_coating(struct block *block, struct values *values) {
    double thickness = values_number(values, COATING);
    double modulus = values_number(values, COATING_MODULUS);
    double poisson = values_number(values, COATING_POISSON);
    if (isnan(thickness) && !isnan(modulus))
        values_fault(values, COATING_MODULUS, "belongs to a coating: give its thickness, too");
    if (isnan(thickness) && !isnan(poisson))
        values_fault(values, COATING_POISSON, "belongs to a coating: give its thickness, too");
    if (thickness > 0 && isnan(modulus))
        values_fault(values, COATING, "a coating has a modulus: give /contact/coating/modulus");
    if (thickness > 0)
        block->coating =
            (struct coating){thickness, modulus, isnan(poisson) ? block->poisson : poisson};
}

static const char TIME_LIMIT[] = "/contact/time_limit";

static double given_or(double number, double usual) {
    return isnan(number) ? usual : number;
}

static void read_block(struct contact_case *out, struct asked *asked, struct values *values) {
    int models[CONTACT_MODELS_MOST];
    size_t before = values_fault_count(values);
    struct block block = {.poisson = values_number(values, "/contact/poisson"),
                          .layer_growth = values_number(values, "/contact/layer_growth"),
                          .weighting =
                              (enum gap_weighting)values_choice(values, "/contact/gap_weighting")};
    bool elements = false, fails = false;
    read_coating(&block, values);
    out->model_count = values_choices(values, "/contact/model", models);
    out->kinematics = (enum kinematics)values_choice(values, "/contact/kinematics");
    out->transition_depth = values_number(values, "/contact/transition_depth");
    out->time_limit = given_or(values_number(values, TIME_LIMIT), 0);
    asked->height = values_measure(values, "/contact/block_height", &asked->height_unit);
    asked->fine = values_measure(values, FINE_HEIGHT, &asked->fine_unit);
    for (size_t m = 0; m < out->model_count; m++) {
        out->models[m] = CONTACT_MODELS[models[m]];
        out->blocks[m] = block;
        out->blocks[m].model = out->models[m]->block;
        elements = elements || out->models[m]->elements;
        fails = fails || out->models[m]->may_fail;
        if (block_is_coated(&block) && !out->models[m]->coatings)
            values_fault(values, COATING, "the model %s has no coatings",
                         contact_model_name(out->models[m]));
    }
    if (elements && isinf(asked->height))
        values_fault(
            values, "/contact/block_height",
            "only a halfspace can be infinite, and a block of finite elements is asked for");
    if (!fails && out->model_count > 0 && out->time_limit > 0)
        values_fault(values, TIME_LIMIT, "belongs to the model full, which is not asked for");
    if (!elements && out->model_count > 0 && block.weighting == GAP_DUAL)
        values_fault(values, "/contact/gap_weighting",
                     "\"dual\" belongs to finite elements, and no such model is asked for");
    if (out->asperities && block_is_coated(&block))
        values_fault(values, "/contact/asperities", "\"counted\" is for blocks without a coating");
    asked->block = values_fault_count(values) == before;
}

/* Reads a choice of what is measured on the face as it stands: whether it is not the usual one. */
static bool read_face(const struct contact_case *one_case, const char *path, const char *name,
                      struct values *values) {
    bool stretches = false, chosen = values_choice(values, path) == 1;
    for (size_t m = 0; m < one_case->model_count; m++)
        stretches = stretches || one_case->models[m]->stretches;
    if (!chosen || one_case->model_count == 0)
        return false;
    if (!stretches)
        values_fault(values, path, "\"%s\" belongs to the model full, which is not asked for",
                     name);
    else if (one_case->kinematics == KINEMATICS_SMALL)
        values_fault(values, path,
                     "\"%s\" is of the face as it stands under load, which small strains leave "
                     "as it was; take other kinematics",
                     name);
    return true;
}

static void check_rising(struct values *values, const char *path, size_t n, const double *numbers) {
    for (size_t a = 1; a < n; a++) {
        if (!(numbers[a] > numbers[a - 1])) {
            values_fault(values, path, "must rise; number %zu, %g, does not", a, numbers[a]);
            return;
        }
    }
}

static const char LOAD_VALUES[] = "/contact/pressures/values",
                  SLIP_PRESSURE[] = "/contact/slip/pressure";

/* Reads the unit of loads. */
static void read_load_unit(struct asked *asked, struct values *values) {
    double young = values_number(values, "/contact/young");
    double nu = values_number(values, "/contact/poisson");
    double compliance = (1 - nu * nu) / young;
    if (!isnan(asked->counter.young))
        compliance += (1 - pow(asked->counter.poisson, 2)) / asked->counter.young;
    if (values_choice(values, "/contact/pressures/unit") == LOAD_UNIT_PASCAL)
        asked->modulus = isnan(asked->counter.young) ? young / (1 - nu * nu) : 1 / compliance;
}

/* Checks loads in E* h'. */
static void check_loads(const struct contact_case *one_case, struct values *values) {
    for (size_t k = 0; k < one_case->load_count; k++)
        if (!(one_case->loads[k] > 0 && one_case->loads[k] <= CONTACT_LOAD_MOST)) {
            values_fault(values, LOAD_VALUES, "number %zu is a load of %g E* h'; allowed: (0, %g]",
                         k, one_case->loads[k], CONTACT_LOAD_MOST);
            return;
        }
}

/* Reads the loads of the study; there are none where they are at fault. */
static int read_study_loads(struct contact_case *out, const struct asked *asked,
                            struct values *values, struct error *err) {
    const char *path = LOAD_VALUES;
    double to = values_number(values, "/contact/pressures/to");
    double steps = values_number(values, "/contact/pressures/steps");
    int status = values_numbers(values, path, &out->loads, &out->load_count, err);
    if (status != 0)
        return status;
    if (out->loads != NULL) {
        size_t before = values_fault_count(values);
        bool swept = isnan(steps) && to == out->loads[out->load_count - 1]; /* contact_loads.h */
        if (!swept && (!isnan(to) || !isnan(steps)))
            values_fault(values, path, "give the values, or to and steps, not both");
        check_rising(values, path, out->load_count, out->loads);
        if (values_fault_count(values) > before)
            out->load_count = 0;
        if (!(asked->modulus > 0))
            check_loads(out, values);
        return 0;
    }
    if (asked->modulus > 0 && isnan(to)) {
        values_fault(values, path, "loads in Pa have no default: give values, or to and steps");
        return 0;
    }
    /* A case of a store whose program did not yet write out the loads: they keep their values. */
    to = isnan(to) ? CONTACT_LOAD_HIGHEST : to;
    size_t count = isnan(steps) ? CONTACT_LOADS : (size_t)steps;
    out->loads = array_create(count, sizeof *out->loads);
    if (out->loads == NULL)
        return error_memory(err, count * sizeof *out->loads, "loads");
    out->load_count = count;
    for (size_t k = 0; k < count; k++)
        out->loads[k] = to * (double)(k + 1) / (double)count;
    return 0;
}

static const char SLIDE_TO[] = "/contact/slip/to", SLIDE_STEPS[] = "/contact/slip/steps";

/* Checks the turning points of the flat. */
static void check_turns(const double *turns, size_t count, size_t steps, struct values *values) {
    const size_t going_on = contact_loads_turns(turns, count);
    if (going_on < count) {
        values_fault(values, SLIDE_TO,
                     "number %zu, %g, is no turning point: from %g the flat comes to %g; allowed: "
                     "numbers that go forth and back",
                     going_on, turns[going_on], going_on > 1 ? turns[going_on - 2] : 0,
                     going_on > 0 ? turns[going_on - 1] : 0);
        return;
    }
    if (count * steps >= CONTACT_LOADS_MOST)
        values_fault(values, SLIDE_STEPS,
                     "%zu steps to each of %zu turning points; allowed: %d in all", steps, count,
                     CONTACT_LOADS_MOST - 1);
}

/* Fills the path of the flat: evenly spaced points from one turning point to the next. */
static int fill_slide(struct contact_case *out, const double *turns, size_t count,
                      struct error *err) {
    const size_t steps = out->slide_steps;
    out->slide = array_create(count * steps + 1, sizeof *out->slide);
    if (out->slide == NULL)
        return error_memory(err, (count * steps + 1) * sizeof *out->slide, "a path of the flat");
    contact_loads_path(turns, count, steps, out->slide);
    out->slide_count = count * steps + 1;
    return 0;
}

static int read_slide(struct contact_case *out, struct values *values, struct error *err) {
    /* Unless given. Sharp summits slide fully after 4 mu at most, Gaussian faces after 2. */
    enum { STEPS = 30 };
    const double usual = 4 * out->friction, steps = values_number(values, SLIDE_STEPS);
    double *turns = NULL;
    size_t count = 0, before = values_fault_count(values);
    if (!contact_case_slides(out))
        return 0;
    int status = values_numbers(values, SLIDE_TO, &turns, &count, err);
    out->slide_steps = isnan(steps) ? STEPS : (size_t)steps;
    check_turns(turns, count, out->slide_steps, values);
    if (status == 0 && values_fault_count(values) == before)
        status = fill_slide(out, turns != NULL ? turns : &usual, turns != NULL ? count : 1, err);
    free(turns);
    return status;
}

/* Reads the loads, with those that friction adds. */
static int read_loads(struct contact_case *out, const struct asked *asked, struct values *values,
                      struct error *err) {
    size_t before = values_fault_count(values);
    int status = read_study_loads(out, asked, values, err);
    if (status != 0 || !(out->friction > 0) || out->load_count == 0 ||
        values_fault_count(values) > before)
        return status;
    double held = values_number(values, SLIP_PRESSURE);
    double highest = out->loads[out->load_count - 1];
    if (isnan(held))
        held = highest;
    if (held > highest || (held < highest && out->hardness > 0)) {
        values_fault(values, SLIP_PRESSURE, "%g, and the highest load is %g; allowed: %s", held,
                     highest, out->hardness > 0 ? "with a hardness that one" : "none above it");
        return 0;
    }
    size_t room = out->load_count + CONTACT_LOADS_ADDED;
    double *loads = realloc(out->loads, room * sizeof *loads);
    if (loads == NULL)
        return error_memory(err, room * sizeof *loads, "loads");
    out->loads = loads;
    out->slip_load = contact_case_slides(out) ? contact_loads_hold(loads, &out->load_count, held)
                                              : contact_loads_add(loads, &out->load_count, held);
    return 0;
}

static void read_estimators(struct contact_case *out, struct values *values) {
    static const char path[] = "/contact/estimators";
    int chosen[AREA_ESTIMATORS];
    size_t n = values_choices(values, path, chosen);
    bool all = n == 0, wanted[AREA_ESTIMATORS] = {false};
    for (size_t a = 0; a < n; a++)
        wanted[chosen[a]] = true;
    bool profile = surface_case_dimension(values) == 1;
    if (wanted[AREA_PERIMETER] && profile)
        values_fault(values, path, "\"perimeter\" is for surfaces, and this is a profile");
    out->nodes = all || wanted[AREA_NODES];
    out->edges = all || wanted[AREA_EDGES];
    out->perimeter = wanted[AREA_PERIMETER] || (all && !profile);
}

static void read_asperities(struct contact_case *out, struct values *values) {
    static const char path[] = "/contact/asperities";
    out->asperities = values_choice(values, path) == ASPERITIES_COUNTED;
    if (out->asperities && surface_case_dimension(values) == 1)
        values_fault(values, path, "\"counted\" is for surfaces, and this is a profile");
}

static int read_levels(struct asked *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/levels";
    double *points;
    size_t n, before = values_fault_count(values);
    int status = values_numbers(values, path, &points, &n, err);
    if (status != 0)
        return status;
    check_rising(values, path, n, points);
    for (size_t l = 0; l < n; l++)
        out->levels[l] = points[l];
    if (n == 0)
        out->levels[0] = values_number(values, "/surface/points_per_wavelength");
    if (values_fault_count(values) == before)
        out->level_count = n > 0 ? n : 1;
    free(points);
    return 0;
}

/* Returns the position of a load among the study's; load_count if it is none of them. */
static size_t load_find(const struct contact_case *one_case, double load) {
    size_t k = 0;
    while (k < one_case->load_count && !(fabs(one_case->loads[k] - load) <= ROUNDING * load))
        k++;
    return k;
}

/* Reads a list of loads out of the study's as their positions; *out stays NULL where there is none.
 */
static int read_listed(size_t **out, size_t *count, const struct contact_case *one_case,
                       const char *path, struct values *values, struct error *err) {
    double *at;
    int status = values_numbers(values, path, &at, count, err);
    if (status != 0 || at == NULL)
        return status;
    size_t *found = array_create(*count, sizeof *found);
    if (found == NULL)
        status = error_memory(err, *count * sizeof *found, "loads");
    check_rising(values, path, *count, at);
    for (size_t a = 0; found != NULL && a < *count && one_case->load_count > 0; a++) {
        found[a] = load_find(one_case, at[a]);
        if (found[a] == one_case->load_count)
            values_fault(values, path, "%g is none of the study's pressures", at[a]);
    }
    *out = found;
    free(at);
    return status;
}

static int read_pdf(struct contact_case *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/pressure_pdf/at";
    values_bins(values, "/contact/pressure_pdf/bins", BINS_MOST, &out->pressure);
    int status = read_listed(&out->pdf_loads, &out->pdf_count, out, path, values, err);
    if (status != 0)
        return status;
    if (out->pdf_loads != NULL && out->hardness > 0)
        values_fault(values, path,
                     "many pressures are the hardness, so that they have no density; plastic_area "
                     "and plastic_load say how many");
    out->pdf_pairs = values_choice(values, "/contact/pressure_pdf/pairs") == PAIRS_COUNTED;
    if (out->pdf_loads == NULL) {
        out->pdf_count = out->hardness > 0 ? (size_t)0 : 1;
        out->pdf_loads = array_create(1, sizeof *out->pdf_loads);
        if (out->pdf_loads == NULL)
            return error_memory(err, sizeof *out->pdf_loads, "loads");
        out->pdf_loads[0] = out->load_count > 0 ? out->load_count - 1 : 0;
    }
    if (out->pdf_count * (out->pressure.count + 2) > PRESSURE_CELLS_MOST)
        values_fault(values, path, "%zu loads of %zu bins are too many: at most %d in all",
                     out->pdf_count, out->pressure.count, PRESSURE_CELLS_MOST);
    return 0;
}

/* Reads the realisations whose nodes are written, and the loads of these files. */
static int read_kept(struct contact_case *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/keep/realisations", loads[] = "/contact/keep/loads";
    int status = values_numbers(values, path, &out->kept, &out->kept_count, err);
    if (status != 0)
        return status;
    check_rising(values, path, out->kept_count, out->kept);
    for (size_t a = 0; a < out->kept_count; a++)
        if (out->kept[a] != floor(out->kept[a]))
            values_fault(values, path, "%g is no whole number", out->kept[a]);
    status = read_listed(&out->kept_loads, &out->kept_load_count, out, loads, values, err);
    if (out->kept_load_count > 0 && out->kept_count == 0)
        values_fault(values, loads, "loads of no realisation: give /contact/keep/realisations");
    return status;
}

static const char COUNTER_YOUNG[] = "/counter_surface/young";

/* Checks what a second face, or its body, excludes. An elastic counter body adds its compliance to
 * that of the block. The sum is one E*, with which all results scale, where both are infinite
 * half-spaces. */
static void check_counter(const struct contact_case *one_case, const struct asked *asked,
                          struct values *values) {
    bool elastic = !isnan(asked->counter.young);
    if (!asked->counter.given)
        return;
    if (values_is_given(values, "/surface/like/file"))
        values_fault(values, "/surface/like/file",
                     "a surface like a measured one is compared with it as one face; allowed: "
                     "one of like and counter_surface");
    for (size_t m = 0; m < one_case->model_count; m++) {
        const struct contact_model *model = one_case->models[m];
        if (!model->counter_faces)
            values_fault(values, "/contact/model",
                         "the model %s has the shape of one rough face, and counter_surface is a "
                         "second one; allowed: halfspace, layered",
                         contact_model_name(model));
        else if (elastic && (model->elements || isfinite(asked->height)))
            values_fault(values, COUNTER_YOUNG,
                         "%g: below an elastic counter body the block must be an infinite "
                         "half-space, and %s has a height; leave young out, or take the model "
                         "halfspace without block_height",
                         asked->counter.young, contact_model_name(model));
    }
    if (elastic && one_case->model_count > 0 && block_is_coated(&one_case->blocks[0]))
        values_fault(values, COUNTER_YOUNG,
                     "%g: a coating is on a block with a rigid counter body; leave young out",
                     asked->counter.young);
    if (elastic && one_case->friction > 0 &&
        asked->counter.poisson != values_number(values, "/contact/poisson"))
        values_fault(values, "/counter_surface/poisson",
                     "%g: how both bodies give along the face is known of one Poisson's ratio, "
                     "that of /contact/poisson; allowed with friction: the same, or none",
                     asked->counter.poisson);
}

/* Checks what rests on one face alone, of two faces that have no fault. */
static void check_faces(const struct surface_case *surface, struct values *values) {
    static const char path[] = "/contact/law_difference";
    if (surface->counter == NULL || surface_case_gaussian(surface))
        return;
    if (values_choice(values, path) != COMPANION_NONE)
        values_fault(values, path,
                     "the other law of heights is not known of two faces whose heights are not "
                     "Gaussian; allowed: \"none\"");
}

/* Reads all that needs no surface. */
static int read_alone(struct contact_case *out, struct asked *asked, struct values *values,
                      struct error *err) {
    out->tolerance = values_number(values, "/contact/tolerance");
    out->stiffness = values_choice(values, "/contact/stiffness") != STIFFNESS_OMITTED;
    read_estimators(out, values);
    read_asperities(out, values);
    read_block(out, asked, values);
    double friction = values_number(values, "/contact/friction");
    out->friction = friction > 0 ? friction : 0;
    out->current_areas = read_face(out, "/contact/areas", "current", values);
    out->normal_gaps = read_face(out, "/contact/gap_direction", "normal", values);
    contact_quantities_read(out, values);
    check_counter(out, asked, values);
    read_load_unit(asked, values);
    int status = read_loads(out, asked, values, err);
    if (status == 0)
        status = read_slide(out, values, err);
    if (status == 0)
        status = read_levels(asked, values, err);
    if (status == 0)
        status = read_pdf(out, values, err);
    return status == 0 ? read_kept(out, values, err) : status;
}

/* --- on the surface --- */

/* Checks the memory of the surface, before what takes as much memory and time is computed of it. */
static bool fits_memory(const struct surface_case *surface, double limit, struct values *values) {
    double bytes = surface_case_bytes(surface);
    if (!(limit > 0) || bytes <= limit)
        return true;
    values_fault(values, "/surface/points_per_wavelength",
                 "a surface of %zu by %zu points takes %.3g GiB; allowed: %.3g GiB on this machine",
                 surface->grid.nx, surface->grid.ny, bytes / 0x1p30, limit / 0x1p30);
    return false;
}

/* Finds the height in lambda_s of the block that is asked for. */
static int block_height(const struct contact_case *one_case, const struct asked *asked,
                        struct values *values, double *out, struct error *err) {
    *out = asked->height;
    if (!isfinite(asked->height))
        return 0;
    if (asked->height_unit == HEIGHT_LENGTHS) {
        *out *= surface_case_longest(&one_case->surface);
        return 0;
    }
    double rms_height, rms_slope;
    int status = contact_case_scale(one_case, &rms_height, &rms_slope, err);
    *out *= rms_height;
    if (status == 0 && isnan(rms_height))
        values_fault(values, "/contact/block_height",
                     "rms_heights need the scale of the surface: give rms_slope or rms_height");
    return status;
}

/* The scale of a surface sums over all of its waves, some seconds for as many points. */
#define SCALE_POINTS_MOST 134217728.0

/* Returns whether the scale can be computed where it is needed: for blocks in RMS heights, and by
 * models whose own check needs it. */
static bool scale_fits(const struct contact_case *one_case, const struct asked *asked,
                       struct values *values) {
    const struct grid *grid = &one_case->surface.grid;
    bool needed = isfinite(asked->height) && asked->height_unit != HEIGHT_LENGTHS;
    needed = needed || asked->modulus > 0 || one_case->hardness > 0;
    needed = needed || (isfinite(asked->fine) && asked->fine_unit == HEIGHT_RMS_HEIGHTS);
    for (size_t m = 0; m < one_case->model_count; m++)
        needed = needed || one_case->models[m]->check != NULL;
    if (!needed || !contact_case_has_scale(one_case) ||
        (double)grid_points(grid) <= SCALE_POINTS_MOST)
        return true;
    values_fault(values, "/surface/points_per_wavelength",
                 "%zu by %zu points: blocks in rms_heights, loads in Pa, a hardness, and the model "
                 "full, need "
                 "the RMS height and slope of the surface, which are computed of %.0f points at "
                 "most. Give block_height in lengths, or take fewer points",
                 grid->nx, grid->ny, SCALE_POINTS_MOST);
    return false;
}

/* Columns of one width, as deep as the block may be. */
#define FINE_WHOLE 1e9

/* Sets the depth of the fine zone in lambda_s. On the coarsest mesh it is a width of the wide
 * columns at least. */
static int set_fine_height(struct contact_case *out, const struct asked *asked,
                           struct values *values, struct error *err) {
    static const double TRANSITION = 8; /* unless given */
    double rms_height = 1, rms_slope;
    bool meshed = false;
    if (isnan(asked->fine) || out->level_count == 0)
        return 0;
    for (size_t m = 0; m < out->model_count; m++)
        meshed = meshed || out->models[m]->mesh_floor != NULL;
    int status = isfinite(asked->fine) && asked->fine_unit == HEIGHT_RMS_HEIGHTS
                     ? contact_case_scale(out, &rms_height, &rms_slope, err)
                     : 0;
    if (status != 0)
        return status;
    out->fine_height = isinf(asked->fine) ? FINE_WHOLE : asked->fine * rms_height;
    if (!meshed)
        values_fault(values, FINE_HEIGHT, "belongs to the model full, which is not asked for");
    else if (out->transition_depth != TRANSITION)
        values_fault(values, FINE_HEIGHT, "give it or transition_depth, not both");
    else if (isnan(out->fine_height))
        values_fault(values, FINE_HEIGHT,
                     "rms_heights need the scale of the surface: give rms_slope or rms_height");
    else if (!(contact_case_transition(out, &out->levels[0].grid) >= 1))
        values_fault(values, FINE_HEIGHT,
                     "%.4g lambda_s is less than two columns of the mesh of %g points a shortest "
                     "wave, the least that a fine zone takes",
                     out->fine_height, out->levels[0].points);
    return 0;
}

/* Brings loads in Pa to E* h'. */
static int convert_loads(struct contact_case *out, const struct asked *asked, struct values *values,
                         struct error *err) {
    double rms_height, rms_slope;
    if (!(asked->modulus > 0))
        return 0;
    int status = contact_case_scale(out, &rms_height, &rms_slope, err);
    if (status == 0 && isnan(rms_slope))
        values_fault(values, "/contact/pressures/unit",
                     "Pa needs the scale of the surface: give rms_slope or rms_height");
    if (status != 0 || isnan(rms_slope))
        return status;
    for (size_t k = 0; k < out->load_count; k++)
        out->loads[k] /= asked->modulus * rms_slope;
    check_loads(out, values);
    return 0;
}

/* Sets the block of each model, and checks whether the model can have it. */
static int set_blocks(struct contact_case *out, const struct asked *asked, struct values *values,
                      struct error *err) {
    double height, longest = surface_case_longest(&out->surface);
    size_t before = values_fault_count(values);
    int status = block_height(out, asked, values, &height, err);
    bool whole = values_fault_count(values) == before;
    for (size_t m = 0; m < out->model_count && whole && status == 0; m++) {
        const struct contact_model *model = out->models[m];
        struct block *block = &out->blocks[m];
        block->height = !isnan(height) ? height : model->default_height * longest;
        if (block_is_coated(block) && !(block->coating.thickness < block->height))
            values_fault(values, COATING, "%g lambda_s, and the block of %s is %g lambda_s high",
                         block->coating.thickness, contact_model_name(model), block->height);
        if (model->check != NULL)
            status = model->check(out, m, values, err);
    }
    return status;
}

/* Makes the mesh of `points` a shortest wave; false, and a fault, where it cannot be sampled
 * exactly. A grid of two points a shortest wave has that wave at its Nyquist frequency, where half
 * of it is lost: it cannot be resampled, but it may be every n-th point of a finer one. */
static bool level_make(struct contact_level *out, const struct contact_case *one_case,
                       double points, const char *path, struct values *values) {
    const struct grid *own = &one_case->surface.grid;
    struct grid grid;
    if (!surface_case_grid(&one_case->surface, points, path, values, &grid))
        return false;
    bool part = own->nx % grid.nx == 0 && own->ny % grid.ny == 0;
    *out = (struct contact_level){
        .points = points, .grid = grid, .stride = part ? own->nx / grid.nx : 0};
    if (part || (one_case->surface.plateau == NULL && surface_band_fits(one_case->band, &grid)))
        return true;
    if (one_case->surface.plateau != NULL)
        values_fault(values, path,
                     "%g points a shortest wave, %zu in all: a stratified face has kinks, and its "
                     "meshes are every n-th of its own %zu points; allowed: levels that divide "
                     "points_per_wavelength, the finest being equal to it",
                     points, grid.nx, own->nx);
    else
        values_fault(values, path,
                     "%g points a shortest wave, %zu in all, neither hold the %zu waves of the "
                     "surface nor divide its own %zu points (points_per_wavelength)",
                     points, grid.nx, one_case->band.x, own->nx);
    return false;
}

/* Returns whether a level is finer. Rectangles may be rounded up so far that the finer of two
 * levels has fewer points. */
static bool is_finer(const struct contact_level *level, const struct contact_level *before) {
    bool rectangle = level->grid.nx != level->grid.ny && !grid_is_profile(&level->grid);
    return rectangle ? level->grid.nx > before->grid.nx : level->grid.nx != before->grid.nx;
}

/* Makes the meshes of the levels; those that cannot be made are faults. */
static void set_levels(struct contact_case *out, const struct asked *asked, struct values *values) {
    static const char path[] = "/contact/levels";
    for (size_t l = 0; l < asked->level_count; l++) {
        struct contact_level *level = &out->levels[out->level_count];
        if (level_make(level, out, asked->levels[l], path, values))
            out->level_count++;
    }
    for (size_t l = 1; l < out->level_count; l++)
        if (!is_finer(&out->levels[l], &out->levels[l - 1])) {
            values_fault(values, path, "%g and %g give the same grid of %zu points a side",
                         out->levels[l - 1].points, out->levels[l].points, out->levels[l].grid.nx);
            return;
        }
}

/* Checks the layers of a block on one grid, and for a model that meshes them (block_of) the
 * nodes; false after a fault. */
static bool check_mesh(const struct contact_level *level, const struct block *block,
                       const struct contact_model *model, struct values *values) {
    double thickness[LAYERS_MOST];
    size_t layers = block_layers(&level->grid, block, thickness);
    double nodes = model->block_of != NULL ? mesh_nodes_bound(&level->grid, layers) : 0;
    if (layers == 0)
        values_fault(values, "/contact/block_height",
                     "the block takes more than %d layers at %g points a shortest wave; take "
                     "a lower block, or a larger layer_growth",
                     LAYERS_MOST, level->points);
    else if (nodes > MESH_NODES_MOST)
        values_fault(
            values, "/contact/model",
            "%s: %zu layers under %zu by %zu points would have up to %.2g nodes; the model "
            "can mesh %.2g. Take fewer points_per_wavelength (levels), or a smaller cell",
            contact_model_name(model), layers, level->grid.nx, level->grid.ny, nodes,
            MESH_NODES_MOST);
    return layers != 0 && nodes <= MESH_NODES_MOST;
}

static void check_meshes(const struct contact_case *one_case, struct values *values) {
    bool good = true;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; good && one_case->models[m]->elements && l < one_case->level_count; l++)
            good =
                check_mesh(&one_case->levels[l], &one_case->blocks[m], one_case->models[m], values);
}

/* Checks the nodes of the face alone, as a block has a layer of elements at least. This comes
 * before the scale of the surface is computed, which sums over all of its waves. */
static bool faces_fit(const struct contact_case *one_case, struct values *values) {
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; one_case->models[m]->block_of != NULL && l < one_case->level_count;
             l++) {
            const struct grid *grid = &one_case->levels[l].grid;
            if (mesh_nodes_bound(grid, 1) <= MESH_NODES_MOST)
                continue;
            values_fault(values, "/contact/model",
                         "%s: the face alone, %zu by %zu points, has more nodes than the %.2g that "
                         "the model can mesh. Take fewer points_per_wavelength (levels), or a "
                         "smaller cell",
                         contact_model_name(one_case->models[m]), grid->nx, grid->ny,
                         MESH_NODES_MOST);
            return false;
        }
    return true;
}

/* Checks the sums by pairs of densities, which partial results hold. */
static void check_pairs(const struct contact_case *one_case, struct values *values) {
    if (contact_densities_size(one_case) > PAIR_SUMS_MOST)
        values_fault(values, "/contact/pressure_pdf/bins",
                     "differences of densities between %zu models on %zu levels, at %zu loads of "
                     "%zu bins, take %.2g sums: at most %.2g",
                     one_case->model_count, one_case->level_count, one_case->pdf_count,
                     one_case->pressure.count, contact_densities_size(one_case), PAIR_SUMS_MOST);
}

/* Sets the hardness over E*, which loads must be below. */
static int set_yield(struct contact_case *out, struct values *values, struct error *err) {
    struct moments moments;
    if (!(out->hardness > 0))
        return 0;
    for (size_t k = 0; k < out->load_count; k++)
        if (!(out->loads[k] < out->hardness)) {
            values_fault(values, LOAD_VALUES,
                         "number %zu is a load of %g E* h', and nothing bears a load of the "
                         "hardness, %g E* h', or more",
                         k, out->loads[k], out->hardness);
            return 0;
        }
    int status = spectrum_moments(&out->surface.spectrum, &out->surface.grid, &moments, err);
    if (status == 0)
        out->yield = out->hardness * moments.rms_slope;
    return status;
}

/* Sets levels and blocks on the surface of the case, which has no fault. */
static int set_on_surface(struct contact_case *out, const struct asked *asked,
                          struct values *values, struct error *err) {
    out->band = surface_case_sampled_band(&out->surface);
    out->two_faces = out->surface.counter != NULL;
    set_levels(out, asked, values);
    check_pairs(out, values);
    size_t before = values_fault_count(values);
    if (!asked->block || !faces_fit(out, values) || !scale_fits(out, asked, values))
        return 0;
    int status = convert_loads(out, asked, values, err);
    if (status == 0)
        status = set_yield(out, values, err);
    if (status == 0)
        status = set_blocks(out, asked, values, err);
    if (status == 0)
        status = set_fine_height(out, asked, values, err);
    if (status == 0 && values_fault_count(values) == before)
        check_meshes(out, values);
    return status;
}

/* Returns whether the map was pressed to the loads of the case. */
static bool same_loads(const struct contact_case *one_case, size_t n, const double *loads,
                       double scale) {
    bool same = n == one_case->load_count && scale == one_case->surface.spectrum.scale_value;
    for (size_t k = 0; k < n && same; k++)
        same = loads[k] == one_case->loads[k];
    return same && like_case_is_cut(&one_case->like);
}

/* Reads the contact of a measured surface, if it is that of this case. */
static int read_like(struct contact_case *out, struct values *values, struct error *err) {
    double scale = values_number(values, "/surface/like/contact_scale"), *loads = NULL;
    size_t n = 0, areas = 0, gaps = 0;
    int status = values_numbers(values, "/surface/like/contact_loads", &loads, &n, err);
    if (status == 0)
        status =
            values_numbers(values, "/surface/like/contact_areas", &out->like_areas, &areas, err);
    if (status == 0)
        status = values_numbers(values, "/surface/like/contact_gaps", &out->like_gaps, &gaps, err);
    if (status == 0 && (n != areas || n != gaps))
        values_fault(values, "/surface/like/contact_areas", "%zu areas and %zu gaps at %zu loads",
                     areas, gaps, n);
    else if (status == 0 && !same_loads(out, n, loads, scale)) {
        free(out->like_areas);
        free(out->like_gaps);
        out->like_areas = out->like_gaps = NULL;
    }
    free(loads);
    return status;
}

int contact_case_read(struct contact_case *out, const cJSON *parameters, double memory_limit,
                      struct fault_list *faults, struct error *err) {
    struct values *values = NULL;
    struct asked asked = {0};
    const struct surface_case *surface;
    *out = (struct contact_case){0};
    int status = values_create(&values, parameters, CONTACT_TABLES, faults, err);
    if (status == 0)
        status = surface_case_fill(&out->surface, values, &surface, err);
    if (status == 0)
        status = surface_counter_fill(&out->surface, parameters, values, &surface, err);
    if (status == 0) {
        double poisson = values_number(values, "/contact/poisson");
        asked.counter = surface_counter_body(parameters, values, poisson);
        check_faces(&out->surface, values);
        status = like_case_fill(&out->like, values, surface, err);
    }
    if (status == 0 && surface != NULL)
        status = like_hold_read(&out->surface, &out->like, values, err);
    if (status == 0)
        status = read_alone(out, &asked, values, err);
    if (status == 0 && surface != NULL && fits_memory(surface, memory_limit, values))
        status = set_on_surface(out, &asked, values, err);
    if (status == 0)
        status = read_like(out, values, err);
    if (status == 0)
        status = values_status(values, err);
    if (status == 0)
        companions_plan(out, values);
    else
        contact_case_clear(out);
    values_destroy(&values);
    return status;
}
