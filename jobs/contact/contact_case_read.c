#include "jobs/contact/contact_case_read.h"
#include "core/full/mesh.h"
#include "jobs/contact/contact_cell.h"
#include "jobs/contact/contact_generation.h"
#include "jobs/contact/contact_loads.h"
#include "jobs/contact/contact_probe.h"
#include <math.h>
#include <stdlib.h>

static const double ROUNDING = 1e-9; /* relative: numbers that are meant to be equal */
enum { BINS_MOST = 10000, PRESSURE_CELLS_MOST = 1000000 };

/* Reads the height of the block in lambda_s: INFINITY, or NaN where it is not given. */
static int read_height(const struct contact_case *one_case, struct values *values, double *out,
                       struct error *err) {
    int unit;
    *out = values_measure(values, "/contact/block_height", &unit);
    if (!isfinite(*out) || one_case->surface.grid.nx == 0)
        return 0;
    if (unit == HEIGHT_LENGTHS) {
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

/* Checks what each model alone asks of the case. */
static int check_models(struct contact_case *out, struct values *values, struct error *err) {
    int status = 0;
    for (size_t m = 0; m < out->model_count && status == 0; m++)
        if (out->models[m]->check != NULL)
            status = out->models[m]->check(out, m, values, err);
    return status;
}

static int read_blocks(struct contact_case *out, struct values *values, struct error *err) {
    int models[CONTACT_MODELS_MOST];
    double height, poisson = values_number(values, "/contact/poisson");
    double growth = values_number(values, "/contact/layer_growth");
    bool elements = false;
    out->model_count = values_choices(values, "/contact/model", models);
    out->kinematics = (enum kinematics)values_choice(values, "/contact/kinematics");
    out->transition_depth = values_number(values, "/contact/transition_depth");
    enum gap_weighting weighting =
        (enum gap_weighting)values_choice(values, "/contact/gap_weighting");
    int status = read_height(out, values, &height, err);
    if (status != 0)
        return status;
    for (size_t m = 0; m < out->model_count; m++) {
        const struct contact_model *model = out->models[m] = CONTACT_MODELS[models[m]];
        elements = elements || model->elements;
        out->blocks[m] = (struct block){
            .model = model->block,
            .poisson = poisson,
            .height = !isnan(height) ? height
                                     : model->default_height * surface_case_longest(&out->surface),
            .layer_growth = growth,
            .weighting = weighting};
    }
    if (elements && isinf(height))
        values_fault(
            values, "/contact/block_height",
            "only a halfspace can be infinite, and a block of finite elements is asked for");
    if (!elements && out->model_count > 0 && weighting == GAP_DUAL)
        values_fault(values, "/contact/gap_weighting",
                     "\"dual\" belongs to finite elements, and no such model is asked for");
    return check_models(out, values, err);
}

static void check_rising(struct values *values, const char *path, size_t n, const double *numbers) {
    for (size_t a = 1; a < n; a++) {
        if (!(numbers[a] > numbers[a - 1])) {
            values_fault(values, path, "must rise; number %zu, %g, does not", a, numbers[a]);
            return;
        }
    }
}

static int read_loads(struct contact_case *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/pressures/values";
    double to = values_number(values, "/contact/pressures/to");
    double steps = values_number(values, "/contact/pressures/steps");
    int status = values_numbers(values, path, &out->loads, &out->load_count, err);
    if (status != 0)
        return status;
    if (out->loads != NULL) {
        bool swept = isnan(steps) && to == out->loads[out->load_count - 1]; /* contact_loads.h */
        if (!swept && (!isnan(to) || !isnan(steps)))
            values_fault(values, path, "give the values, or to and steps, not both");
        check_rising(values, path, out->load_count, out->loads);
        return 0;
    }
    /* A case of a store whose program did not yet write out the loads: they stay as they were. */
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

static void read_estimators(struct contact_case *out, struct values *values) {
    static const char path[] = "/contact/estimators";
    int chosen[AREA_ESTIMATORS];
    size_t n = values_choices(values, path, chosen);
    bool all = n == 0, wanted[AREA_ESTIMATORS] = {false};
    for (size_t a = 0; a < n; a++)
        wanted[chosen[a]] = true;
    if (wanted[AREA_PERIMETER] && out->surface.dimension == 1)
        values_fault(values, path, "\"perimeter\" is for surfaces, and this is a profile");
    out->nodes = all || wanted[AREA_NODES];
    out->edges = all || wanted[AREA_EDGES];
    out->perimeter = wanted[AREA_PERIMETER] || (all && out->surface.dimension == 2);
}

/* The mesh of `points` a shortest wave; false, and a fault, where it cannot be sampled exactly. A
 * grid of two points a shortest wave holds that wave at its Nyquist frequency, as half of itself,
 * so that it cannot be resampled; but it can be part of a finer one. */
static bool level_make(struct contact_level *out, const struct contact_case *one_case,
                       double points, const char *path, struct values *values) {
    const struct grid *own = &one_case->surface.grid;
    struct grid grid;
    if (!surface_case_grid(&one_case->surface, points, path, values, &grid))
        return false;
    bool part = own->nx % grid.nx == 0 && own->ny % grid.ny == 0;
    *out = (struct contact_level){
        .points = points, .grid = grid, .stride = part ? own->nx / grid.nx : 0};
    if (part || surface_band_fits(one_case->band, &grid))
        return true;
    values_fault(
        values, path,
        "%g points a shortest wave, %zu in all, neither hold the %zu waves of the surface nor "
        "divide its own %zu points (points_per_wavelength)",
        points, grid.nx, one_case->band.x, own->nx);
    return false;
}

/* Rectangles may be rounded up so far that the finer of two levels has fewer points. */
static bool is_finer(const struct contact_level *level, const struct contact_level *before) {
    bool rectangle = level->grid.nx != level->grid.ny && !grid_is_profile(&level->grid);
    return rectangle ? level->grid.nx > before->grid.nx : level->grid.nx != before->grid.nx;
}

static int read_levels(struct contact_case *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/levels";
    double *points;
    size_t n;
    int status = values_numbers(values, path, &points, &n, err);
    if (status != 0 || out->surface.grid.nx == 0) { /* at fault already */
        free(points);
        return status;
    }
    check_rising(values, path, n, points);
    double own = values_number(values, "/surface/points_per_wavelength");
    for (size_t l = 0; l < (n > 0 ? n : 1); l++) {
        struct contact_level *level = &out->levels[out->level_count];
        if (level_make(level, out, n > 0 ? points[l] : own, path, values))
            out->level_count++;
    }
    for (size_t l = 1; l < out->level_count; l++)
        if (!is_finer(&out->levels[l], &out->levels[l - 1])) {
            values_fault(values, path, "%g and %g give the same grid of %zu points a side",
                         out->levels[l - 1].points, out->levels[l].points, out->levels[l].grid.nx);
            break;
        }
    free(points);
    return 0;
}

/* Checks the layers that a block takes on one grid, and where a model meshes them (write_mesh) the
 * nodes; false after a fault. */
static bool check_mesh(const struct contact_level *level, const struct block *block,
                       const struct contact_model *model, struct values *values) {
    double thickness[LAYERS_MOST];
    if (!isfinite(block->height) || !isfinite(block->layer_growth))
        return true; /* at fault already, or no mesh */
    size_t layers = block_layers(&level->grid, block, thickness);
    double nodes = model->write_mesh != NULL ? mesh_nodes_bound(&level->grid, layers) : 0;
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

/* Returns the position of a load among the study's; load_count where it is none of them. */
static size_t load_find(const struct contact_case *one_case, double load) {
    size_t k = 0;
    while (k < one_case->load_count && !(fabs(one_case->loads[k] - load) <= ROUNDING * load))
        k++;
    return k;
}

static int read_pdf(struct contact_case *out, struct values *values, struct error *err) {
    static const char path[] = "/contact/pressure_pdf/at";
    double *at;
    values_bins(values, "/contact/pressure_pdf/bins", BINS_MOST, &out->pressure);
    int status = values_numbers(values, path, &at, &out->pdf_count, err);
    if (status != 0)
        return status;
    bool given = at != NULL;
    out->pdf_count = given ? out->pdf_count : 1;
    out->pdf_loads = array_create(out->pdf_count, sizeof *out->pdf_loads);
    if (out->pdf_loads == NULL) {
        free(at);
        return error_memory(err, out->pdf_count * sizeof *out->pdf_loads, "loads");
    }
    if (given)
        check_rising(values, path, out->pdf_count, at);
    else if (out->load_count > 0)
        out->pdf_loads[0] = out->load_count - 1;
    for (size_t a = 0; given && a < out->pdf_count && out->load_count > 0; a++) {
        out->pdf_loads[a] = load_find(out, at[a]);
        if (out->pdf_loads[a] == out->load_count)
            values_fault(values, path, "%g is none of the study's pressures", at[a]);
    }
    free(at);
    if (out->pdf_count * (out->pressure.count + 2) > PRESSURE_CELLS_MOST)
        values_fault(values, path, "%zu loads of %zu bins are too many: at most %d in all",
                     out->pdf_count, out->pressure.count, PRESSURE_CELLS_MOST);
    return 0;
}

static int read_contact(struct contact_case *out, struct values *values, struct error *err) {
    const struct surface_case *surface = &out->surface;
    out->tolerance = values_number(values, "/contact/tolerance");
    out->stiffness = values_choice(values, "/contact/stiffness") != STIFFNESS_OMITTED;
    if (surface->grid.nx > 0)
        out->band = surface_case_own_band(surface);
    read_estimators(out, values);
    int status = read_blocks(out, values, err);
    if (status == 0)
        status = read_loads(out, values, err);
    if (status == 0)
        status = read_levels(out, values, err);
    if (status == 0)
        status = read_pdf(out, values, err);
    if (status == 0)
        check_meshes(out, values);
    return status;
}

/* Whether the map was pressed to the loads of the case. */
static bool same_loads(const struct contact_case *one_case, size_t n, const double *loads,
                       double scale) {
    bool same = n == one_case->load_count && scale == one_case->surface.spectrum.scale_value;
    for (size_t k = 0; k < n && same; k++)
        same = loads[k] == one_case->loads[k];
    return same && like_case_is_cut(&one_case->like);
}

/* Reads the contact of a measured surface, where it is that of this case. */
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

/* What low blocks, the length of the cell and the way to the surface change is told on a mesh as
 * coarse as will do. */
static void choose_probes(struct contact_case *out, struct values *values) {
    for (size_t m = 0; m < out->model_count; m++)
        out->low_blocks = out->low_blocks || contact_case_block_bound(out, m) > CONTACT_BLOCK_LOW;
    if (out->low_blocks)
        out->probe = contact_probe_level(out);
    if (values_choice(values, "/contact/cell_error") == CELL_ERROR_PROBED)
        contact_cell_choose(out);
    if (values_choice(values, "/contact/generation_error") == GENERATION_ERROR_PROBED)
        contact_generation_choose(out);
}

int contact_case_read(struct contact_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err) {
    struct values *values = NULL;
    *out = (struct contact_case){0};
    int status = values_create(&values, parameters, CONTACT_TABLES, faults, err);
    if (status == 0)
        status = surface_case_fill(&out->surface, values, err);
    if (status == 0)
        status = like_case_fill(&out->like, values, &out->surface, err);
    if (status == 0)
        status = read_contact(out, values, err);
    if (status == 0)
        status = read_like(out, values, err);
    if (status == 0)
        status = values_status(values, err);
    if (status == 0)
        choose_probes(out, values);
    else
        contact_case_clear(out);
    values_destroy(&values);
    return status;
}
