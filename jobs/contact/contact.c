/* The kind "contact": rough elastic blocks pressed on a rigid flat, by one or several models
 * (model.h). */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/case/contact_loads.h"
#include "jobs/contact/case/contact_tolerance.h"
#include "jobs/contact/contact_curves.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_scalars.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_steps.h"
#include "jobs/contact/quantity/quantity_scalars.h"
#include "jobs/contact/target/contact_target.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include "schema/result/view.h"
#include <math.h>
#include <stdlib.h>

static int read_case(void *one_case, const cJSON *parameters, double memory_limit,
                     struct fault_list *faults, struct error *err) {
    return contact_case_read(one_case, parameters, memory_limit, faults, err);
}

static void clear_case(void *one_case) {
    contact_case_clear(one_case);
}

static void estimate(const void *one_case, struct study_cost *out) {
    contact_case_estimate(one_case, out);
}

static const struct surface_case *surface_of(const void *one_case) {
    const struct contact_case *contact = one_case;
    return &contact->surface;
}

/* --- realisations --- */

static int shared_create(void *shared, const void *one_case, struct error *err) {
    return contact_compliances_create(shared, one_case, err);
}

static void shared_clear(void *shared) {
    contact_compliances_clear(shared);
}

struct contact_workspace {
    struct contact_scene *scene;
};

static int workspace_create(void *workspace, const void *one_case,
                            const struct surface_basis *basis, const void *shared,
                            struct error *err) {
    struct contact_workspace *work = workspace;
    return contact_scene_create(&work->scene, one_case, &basis->moments, shared, err);
}

static void workspace_clear(void *workspace) {
    struct contact_workspace *work = workspace;
    contact_scene_destroy(&work->scene);
}

static int workspace_set_team(void *workspace, struct team *team, struct error *err) {
    struct contact_workspace *work = workspace;
    return contact_scene_set_team(work->scene, team, err);
}

/* Measures a realisation. It may be stopped between loads and within them, as a load may take
 * minutes. */
static int realise(void *workspace, const struct realisation *realisation, void *tally,
                   double *scalars, struct error *err) {
    struct contact_workspace *work = workspace;
    struct contact_tally *contact = tally;
    contact->realisation = realisation->key.realisation;
    const struct contact_surface surface = {realisation->key, realisation->z};
    contact_scene_set_progress(work->scene, realisation->progress, realisation->stop_context);
    int status = contact_scene_solve(work->scene, &surface, contact, realisation->stop,
                                     realisation->stop_context, err);
    if (status != 0)
        return status;
    status =
        contact_scalars_measure(contact, &realisation->roughness, realisation->moments.nayak_alpha,
                                &realisation->report, scalars, err);
    return status != 0 ? status : contact_tally_add(contact, err);
}

/* --- the tally --- */

static int sums_create(void *tally, const void *one_case, const struct surface_basis *basis,
                       struct error *err) {
    (void)basis;
    return contact_tally_create(tally, one_case, err);
}

static void sums_clear(void *tally) {
    contact_tally_clear(tally);
}

static int merge(void *into, const void *from, struct error *err) {
    return contact_tally_merge(into, from, err);
}

static void put(struct bytes *bytes, const void *tally) {
    contact_tally_put(bytes, tally);
}

static void get(struct byte_reader *reader, void *tally) {
    contact_tally_get(reader, tally);
}

static bool adds_up(const void *tally) {
    return contact_tally_adds_up(tally);
}

/* Returns whether scalars, tally and notes of a block agree on its realisations. */
static bool belongs(const void *tally, const struct block_result *result) {
    const struct contact_tally *contact = tally;
    const struct contact_case *one_case = contact->one_case;
    double scalars = 0, tallied = 0;
    for (uint64_t r = 0; r < result->count; r++)
        scalars += result->scalars[r * result->scalar_count + CONTACT_SCALAR_ITERATIONS];
    for (size_t k = 0; k < one_case->load_count; k++)
        tallied +=
            contact_tally_total(contact, MEASURE_ITERATIONS,
                                contact_case_cell(one_case, 0, one_case->level_count - 1, k));
    bool within = true;
    for (size_t n = 0; n < notes_kept(&contact->notes); n++)
        within = within && contact->notes.kept[n].realisation - result->first < result->count;
    for (size_t r = 0; r < contact->rows.count; r++)
        within = within && contact->rows.realisation[r] - result->first == r;
    return contact->realisations == result->count && scalars == tallied && within;
}

/* --- results --- */

static int result(const void *one_case, const struct surface_basis *basis, const void *tally,
                  const struct realisations *realisations, struct case_result *out,
                  struct error *err) {
    const struct contact_tally *contact = tally;
    int status = contact_scalars(one_case, &basis->moments, contact, realisations, out, err);
    if (status == 0)
        status = quantity_scalars(contact, out, err);
    if (status == 0)
        status = contact_curves(one_case, basis->modes, &basis->moments, contact, out, err);
    if (status == 0)
        status = companions_curves(contact, out, err);
    return status != 0 ? status : notes_result(&contact->notes, out, err);
}

/* --- values of single realisations, for differences of cases by pairs --- */

/* Finds the measure whose mean a curve is. */
static bool measure_of_curve(const struct curve *curve, enum contact_measure *measure) {
    for (*measure = 0; *measure < MEASURE_OWN; ++*measure)
        if (same_text(measure_row(*measure)->quantity, curve->quantity) &&
            same_text(measure_row(*measure)->series, curve->series))
            return true;
    return false;
}

static bool point_values(const void *of, const struct curve *curve, size_t at,
                         struct point_values *out) {
    const struct contact_tally *tally = of;
    const struct contact_case *one_case = tally->one_case;
    enum contact_measure measure;
    size_t column, model = 0;
    while (model < one_case->model_count &&
           !same_text(contact_model_name(one_case->models[model]), curve->model))
        model++;
    if (model == one_case->model_count ||
        !same_number(curve->level, contact_case_finest(one_case)->points) ||
        !measure_of_curve(curve, &measure) ||
        at >= contact_case_points(one_case, measure_row(measure)->by) ||
        !contact_rows_column(one_case, model, measure, &column))
        return false;
    column += contact_case_point(one_case, measure_row(measure)->by, at);
    *out = (struct point_values){tally->rows.values + column, tally->rows.width};
    return true;
}

/* Computes the fit of the first model over its first n loads, n > 0, for every realisation. */
static int fit_rows(const struct contact_tally *tally, enum contact_measure fit, size_t n,
                    double *values, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    const struct contact_rows *rows = &tally->rows;
    double *fits = array_create(MEASURE_FITS * n, sizeof *fits);
    size_t column = 0;
    if (fits == NULL)
        return error_memory(err, MEASURE_FITS * n * sizeof *fits, "fits");
    contact_rows_column(one_case, 0, MEASURE_EDGES, &column);
    for (size_t r = 0; r < rows->count; r++) {
        contact_measure_fits(n, one_case->loads, rows->values + r * rows->width + column, fits, n);
        values[r] = fits[(size_t)(fit - MEASURE_KAPPA) * n + n - 1];
    }
    free(fits);
    return 0;
}

static int scalar_values(const void *of, const struct realisations *realisations, size_t scalar,
                         double *values, double *weights, struct error *err) {
    const struct contact_tally *tally = of;
    enum contact_measure fit;
    size_t loads;
    (void)weights;
    if (!contact_scalar_fit(tally, scalar, &fit, &loads)) {
        realisations_column(realisations, scalar, values);
        return 0;
    }
    for (size_t r = 0; r < tally->rows.count; r++)
        values[r] = NAN;
    return loads > 0 ? fit_rows(tally, fit, loads, values, err) : 0;
}

/* --- one surface --- */

/* Returns the block of the first linear model; a half-space without one. */
static struct block block_of(const struct contact_case *one_case) {
    for (size_t m = 0; m < one_case->model_count; m++)
        if (one_case->models[m]->block_of == NULL)
            return one_case->blocks[m];
    return (struct block){.model = MODEL_HALFSPACE, .height = INFINITY};
}

static void copy_fields(const struct grid *grid, const struct contact_state *state, double slope,
                        double *gap, double *pressure) {
    for (size_t i = 0; i < grid_points(grid); i++) {
        gap[i] = state->gap[i];
        pressure[i] = state->p[i] / slope;
    }
}

/* Presses a surface once, on the block of the first linear model, or on a half-space if there is
 * none. */
static int press(const struct realisation *realisation, double load, double *gap, double *pressure,
                 struct error *err) {
    const struct contact_case *contact_case = realisation->study;
    const struct grid *grid = &contact_case->surface.grid;
    const struct block block = block_of(contact_case);
    struct contact_options options = contact_case_options(contact_case);
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct contact_state state;
    struct moments moments = {0};
    options.without_tangent = true;
    int status = spectrum_moments(&contact_case->surface.spectrum, grid, &moments, err);
    if (status == 0)
        status = compliance_create(&compliance, grid, &block, err);
    if (status == 0)
        status = contact_create(&contact, compliance, &options, err);
    if (status == 0) {
        contact_set_stop(contact, realisation->stop, realisation->stop_context);
        status = contact_begin(contact, realisation->z, err);
    }
    if (status == 0)
        status = contact_press(contact, load * moments.rms_slope, &state, err);
    if (status == 0)
        copy_fields(grid, &state, moments.rms_slope, gap, pressure);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    return status;
}

/* Adds the contact of a measured map to `like`, unless no solution is found for it. */
static int measure_like(const void *one_case, const double *z, cJSON *like, struct error *err) {
    const struct contact_case *contact = one_case;
    size_t n = contact->load_count;
    if (!like_case_is_cut(&contact->like))
        return 0;
    double *areas = array_create(2 * n, sizeof *areas);
    if (areas == NULL)
        return error_memory(err, 2 * n * sizeof *areas, "contact of a map");
    int status = companion_like_measure(contact, z, areas, areas + n, err);
    bool all = status == 0, put = true;
    for (size_t k = 0; k < 2 * n && all; k++)
        all = isfinite(areas[k]);
    if (all)
        put =
            field_put(like, "contact_loads", json_numbers(contact->loads, n)) &&
            field_put(like, "contact_scale", json_number(contact->surface.spectrum.scale_value)) &&
            field_put(like, "contact_areas", json_numbers(areas, n)) &&
            field_put(like, "contact_gaps", json_numbers(areas + n, n));
    free(areas);
    return put ? status : error_memory(err, 2 * n * sizeof *areas, "contact of a map");
}

/* --- how results are shown: the contact area over the load --- */

static const char *const SCALARS[] = {"kappa", "erf_kappa", NULL};
static const char *const LEFT_OUT[] = {"persson_light_load", "bgt_light_load", NULL};
static const char *const DENSITIES[] = {"contact_pressure_pdf", NULL};
static const struct logarithmic_picture LOGARITHMIC[] = {{"contact_area", "light"}, {NULL, NULL}};
static const struct quantity_table TABLE = {
    .quantity = "contact_area",
    .title = "contact area",
    .value = "area",
    .x = "load",
    .error_words = {[ERROR_DISCRETISATION] = "mesh"},
    .legend =
        "load: p/(E* h'_rms); area: A/A0, +- one standard error; errors (reported - true) in "
        "percent of it (<2: below 2, not resolved): mesh, from the limit of the levels; cell, from "
        "a very long one; block, from an infinitely high one; model, from the limit of the most "
        "complete one",
    .scalars = SCALARS,
    .left_out = LEFT_OUT,
};
static const struct series_name SERIES_NAMES[] = {{"wave", NULL, NULL, "per longest wave"},
                                                  {"cell", NULL, NULL, "in the cell"},
                                                  {NULL, NULL, NULL, NULL}};
static const struct shown_name NAMES[] = {
    {"p/(E* h'_rms)", "load", "load p/(E* h'_rms)"},
    {"local p/(E* h'_rms)", "local pressure", "local pressure p/(E* h'_rms)"},
    {"A/A0", "contact area", "contact area A/A0"},
    {"K sqrt(m0)/(E* h'_rms)", "stiffness", "stiffness K sqrt(m0)/(E* h'_rms)"},
    {"G (rho1 + rho2) sqrt(m0)/(2 h'_rms)", "conductance",
     "conductance G (rho1 + rho2) sqrt(m0)/(2 h'_rms)"},
    {"Kt sqrt(m0)/(E* h'_rms)", "tangential stiffness",
     "tangential stiffness Kt sqrt(m0)/(E* h'_rms)"},
    {"Q/(mu P)", "tangential load", "tangential load Q/(mu P)"},
    {"sliding/sqrt(m0)", "sliding", "sliding/sqrt(m0)"},
    {"Q/P", "tangential force", "tangential over normal force Q/P"},
    {"leak over that of the mean gap", "leak", NULL},
    {"share of directions that are open", "open share", NULL},
    {"percolates", "open directions", NULL},
    {"effective_medium", "effective medium", NULL},
    {"percolation_load", "load at which the gap closes", NULL},
    {"percolation_area", "area at which the gap closes", NULL},
    {"mean patch/cell", "mean patch area", "mean patch area/A0"},
    {"mean patch/lambda_l", "mean patch length", "mean patch length/lambda_l"},
    {"mean patch/lambda_l^2", "mean patch area", "mean patch area/lambda_l^2"},
    {"largest patch/cell", "largest patch area", "largest patch area/A0"},
    {"points x transforms", "work", "work, points × transforms"},
    {"contact_pressure_pdf", "pressure density", NULL},
    {"patch_count", "number of contact patches", NULL},
    {"patch_mean_area", "mean patch area", NULL},
    {"patch_largest_area", "largest patch area", NULL},
    {"iterations", "iterations of the solver", NULL},
    {"work", "work of the solver", NULL},
    {"nodes_lower", "nodes, lower bracket", NULL},
    {"nodes_upper", "nodes, upper bracket", NULL},
    {"edges_stretched", "edges, stretched", NULL},
    {"persson_light_load", "Persson, light load", NULL},
    {"bgt_light_load", "BGT, light load", NULL},
    {"gw_mccool", "GW (McCool)", NULL},
    {"kappa", "slope at light load", "slope at light load kappa"},
    {"kappa.theory", "Persson", NULL},
    {"erf_kappa.theory", "Persson", NULL},
    {"erf_kappa", "slope of the error function", "slope of the error function kappa"},
    {"eps_h", "error of the heights", "error of the heights eps_h"},
    {"eps_s", "error of the spectrum", "error of the spectrum eps_s"},
    {"nayak_alpha", "Nayak parameter", "Nayak parameter alpha"},
    {NULL, NULL, NULL}};
static const struct result_view VIEW = {.table = &TABLE,
                                        .densities = DENSITIES,
                                        .logarithmic = LOGARITHMIC,
                                        .series_names = SERIES_NAMES,
                                        .names = NAMES};

/* As study_kind.fill has it. */
static int complete_case(const cJSON *document, cJSON *parameters, struct error *err) {
    int status = surface_law_complete(document, parameters, err);
    if (status == 0)
        status = contact_tolerance_fill(document, parameters, err);
    return status == 0 ? contact_loads_fill(document, parameters, err) : status;
}

const struct job_kind CONTACT_KIND = {
    .study = {.name = "contact",
              .tables = CONTACT_TABLES,
              .default_realisations = 20,
              .check = kind_check,
              .fill = complete_case,
              .expand = contact_target_expand},
    .scalar = contact_scalar_name,
    .view = &VIEW,
    .case_size = sizeof(struct contact_case),
    .read = read_case,
    .clear = clear_case,
    .estimate = estimate,
    .surface = surface_of,
    .shared_size = sizeof(struct contact_compliances),
    .shared_create = shared_create,
    .shared_clear = shared_clear,
    .workspace_size = sizeof(struct contact_workspace),
    .workspace_create = workspace_create,
    .workspace_clear = workspace_clear,
    .workspace_set_team = workspace_set_team,
    .tally_size = sizeof(struct contact_tally),
    .tally_create = sums_create,
    .tally_clear = sums_clear,
    .stops_half_way = true,
    .realise = realise,
    .merge = merge,
    .format = 0x434f, /* "CO" */
    .format_version = 16,
    .put = put,
    .get = get,
    .adds_up = adds_up,
    .belongs = belongs,
    .result = result,
    .answer = contact_target_answer,
    .point_values = point_values,
    .scalar_values = scalar_values,
    .press = press,
    .press_steps = contact_press_steps,
    .kept = contact_kept_steps,
    .measure_like = measure_like,
};
