#include "jobs/contact/contact_scene.h"
#include "core/contact/patches.h"
#include "core/contact/pressures.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_steps.h"
#include "jobs/contact/model/model_linear.h"
#include "jobs/contact/quantity/quantity.h"
#include "jobs/publishing_cost.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How much of a realisation is done, in estimated seconds. */
struct scene_progress {
    void (*report)(void *context, double share); /* may be NULL */
    void *context;
    double loads[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST]; /* of all loads */
    double quantities[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST];
    double whole;           /* with companions */
    double before, current; /* done before what is at work, and the whole of that */
};

struct contact_scene {
    const struct contact_case *one_case;
    double rms_slope, rms_height; /* of the prescribed spectrum */
    struct contact_solver *solvers[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST];
    struct area_workspace *areas[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST];
    struct pressures *pressures[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST]; /* NULL: not counted */
    double *shares;                                                        /* of pressures */
    struct patch_finder *finders[CONTACT_LEVELS_MOST];
    struct contact_quantities quantities[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST];
    struct companion_bench *companions;
    struct scene_progress progress;
    double *z; /* heights on a level; room for the finest */
};

int contact_compliances_create(struct contact_compliances *out, const struct contact_case *one_case,
                               struct error *err) {
    int status = 0;
    *out = (struct contact_compliances){0};
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        for (size_t l = 0; l < one_case->level_count && status == 0; l++) {
            status = compliance_create(&out->of[m][l], &one_case->levels[l].grid,
                                       &one_case->blocks[m], err);
        }
    if (status != 0)
        contact_compliances_clear(out);
    return status;
}

void contact_compliances_clear(struct contact_compliances *compliances) {
    for (size_t m = 0; m < CONTACT_MODELS_MOST; m++)
        for (size_t l = 0; l < CONTACT_LEVELS_MOST; l++)
            compliance_destroy(&compliances->of[m][l]);
}

static struct quantity_scene quantity_scene_of(const struct contact_case *one_case, size_t model,
                                               size_t level) {
    return (struct quantity_scene){.one_case = one_case,
                                   .grid = one_case->levels[level].grid,
                                   .block = one_case->blocks[model],
                                   .exact = linear_is_exact(one_case->models[model]),
                                   .slides = one_case->models[model]->slides};
}

static int scene_fill(struct contact_scene *scene, const struct contact_compliances *compliances,
                      struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    int status = 0;
    for (size_t l = 0; l < one_case->level_count && status == 0; l++) {
        status = patch_finder_create(&scene->finders[l], &one_case->levels[l].grid, err);
        for (size_t m = 0; m < one_case->model_count && status == 0; m++) {
            status = area_workspace_create(&scene->areas[m][l], compliances->of[m][l], err);
            if (status == 0)
                status = one_case->models[m]->create(&scene->solvers[m][l], one_case, m,
                                                     compliances->of[m][l], err);
            const struct quantity_scene quantities = quantity_scene_of(one_case, m, l);
            if (status == 0)
                status = contact_quantities_create(&scene->quantities[m][l], &quantities, err);
            if (status == 0 && contact_tally_counts(one_case, l))
                status = pressures_create(&scene->pressures[m][l], scene->areas[m][l], err);
        }
    }
    if (status != 0)
        return status;
    size_t points = grid_points(&contact_case_finest(one_case)->grid);
    size_t bins = contact_case_bins(one_case);
    scene->z = array_create(points, sizeof *scene->z);
    scene->shares = array_create(bins, sizeof *scene->shares);
    return scene->z != NULL && scene->shares != NULL
               ? 0
               : error_memory(err, (points + bins) * sizeof(double), "a surface");
}

static void expect_progress(struct contact_scene *scene) {
    const struct contact_case *one_case = scene->one_case;
    struct scene_progress *progress = &scene->progress;
    progress->whole = companions_seconds(one_case);
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count; m++) {
            const struct quantity_scene quantities = quantity_scene_of(one_case, m, l);
            progress->loads[m][l] =
                one_case->models[m]->seconds(one_case, m, &one_case->levels[l].grid);
            progress->quantities[m][l] = contact_quantities_seconds(&quantities);
            progress->whole += progress->loads[m][l] + progress->quantities[m][l];
        }
}

void contact_scene_set_progress(struct contact_scene *scene,
                                void (*progress)(void *context, double share), void *context) {
    scene->progress.report = progress;
    scene->progress.context = context;
}

/* Reports that so much is done of what is at work. */
static void report_part(void *context, double part) {
    const struct scene_progress *progress = context;
    double done = progress->before + part * progress->current;
    if (progress->report != NULL && progress->whole > 0)
        progress->report(progress->context, fmin(done / progress->whole, 1));
}

/* Goes on to what takes so many seconds. */
static void begin_part(struct scene_progress *progress, double seconds) {
    progress->before += progress->current;
    progress->current = seconds;
    report_part(progress, 0);
}

int contact_scene_create(struct contact_scene **out, const struct contact_case *one_case,
                         const struct moments *moments,
                         const struct contact_compliances *compliances, struct error *err) {
    struct contact_scene *scene = array_create(1, sizeof *scene);
    if (scene == NULL)
        return error_memory(err, sizeof *scene, "a contact scene");
    scene->one_case = one_case;
    scene->rms_slope = moments->rms_slope;
    scene->rms_height = moments->rms_height;
    int status = scene_fill(scene, compliances, err);
    if (status == 0)
        status = companion_bench_create(&scene->companions, one_case, moments, err);
    if (status == 0)
        expect_progress(scene);
    if (status != 0)
        contact_scene_destroy(&scene);
    *out = scene;
    return status;
}

int contact_scene_set_team(struct contact_scene *scene, struct team *team, struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    int status = 0;
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count && status == 0; m++) {
            const struct contact_model *model = one_case->models[m];
            status = area_workspace_set_team(scene->areas[m][l], team, err);
            if (status == 0 && model->set_team != NULL)
                status = model->set_team(scene->solvers[m][l], team, err);
        }
    return status;
}

void contact_scene_destroy(struct contact_scene **scene) {
    struct contact_scene *s = *scene;
    if (s == NULL)
        return;
    for (size_t l = 0; l < CONTACT_LEVELS_MOST; l++) {
        patch_finder_destroy(&s->finders[l]);
        for (size_t m = 0; m < CONTACT_MODELS_MOST; m++) {
            contact_quantities_clear(&s->quantities[m][l]);
            pressures_destroy(&s->pressures[m][l]);
            area_workspace_destroy(&s->areas[m][l]);
            if (s->solvers[m][l] != NULL)
                s->one_case->models[m]->destroy(&s->solvers[m][l]);
        }
    }
    companion_bench_destroy(&s->companions);
    free(s->z);
    free(s->shares);
    free(s);
    *scene = NULL;
}

static struct measure_context context_of(struct contact_scene *scene, size_t model, size_t level) {
    return (struct measure_context){.one_case = scene->one_case,
                                    .area = scene->areas[model][level],
                                    .finder = scene->finders[level],
                                    .quantities = &scene->quantities[model][level],
                                    .points =
                                        (double)grid_points(&scene->one_case->levels[level].grid),
                                    .rms_slope = scene->rms_slope,
                                    .rms_height = scene->rms_height,
                                    .scaled = contact_case_has_scale(scene->one_case)};
}

/* Puts the measures of a solved load into a cell. */
static int measure(struct contact_scene *scene, size_t model, size_t level,
                   const struct contact_pressed *pressed, struct contact_tally *tally, size_t cell,
                   struct error *err) {
    const struct measure_context context = context_of(scene, model, level);
    double values[MEASURE_OWN];
    int status = contact_measure(&context, pressed, values, err);
    if (status != 0)
        return status;
    for (size_t a = 0; a < MEASURE_OWN; a++)
        contact_tally_values(tally, (enum contact_measure)a)[cell] = values[a];
    for (size_t a = 0; a < MODEL_MEASURES_MOST; a++)
        contact_tally_values(tally, (enum contact_measure)(MEASURE_OWN + a))[cell] =
            pressed->own[a];
    return 0;
}

/* Tallies areas by pressure, by edges and as they are under load. Forces are over undeformed
 * areas. Of the face as it stands, which has more area than the cell, the mean is as much lower. */
static int count_pressures(struct contact_scene *scene, size_t model, size_t level, size_t load,
                           const struct contact_pressed *pressed, struct contact_tally *tally,
                           struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    struct contact_state state = pressed->state;
    state.pressure /= 1 + pressed->face_tilt;
    size_t cell = contact_case_cell(one_case, model, level, load);
    double area = contact_tally_values(tally, MEASURE_EDGES)[cell];
    for (size_t a = 0; a < one_case->pdf_count; a++) {
        if (one_case->pdf_loads[a] != load)
            continue;
        int status = pressures_share(scene->pressures[model][level], &state, area,
                                     &one_case->pressure, scene->rms_slope, scene->shares, err);
        if (status != 0)
            return status;
        contact_tally_pressures(tally, model, level, a, scene->shares);
    }
    return 0;
}

/* Solves one load from the last. */
static int solve_load(struct contact_scene *scene, size_t m, size_t level, size_t k,
                      const struct contact_stopper *stopper, struct contact_pressed *out,
                      struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    *out = contact_not_pressed();
    if (stopper->stop(stopper->context) != 0)
        return error_set(err, ERROR_STOPPED, "stopped at load %zu of %zu", k, one_case->load_count);
    int status = one_case->models[m]->press(scene->solvers[m][level],
                                            one_case->loads[k] * scene->rms_slope, out, err);
    if (status != 0 && !isnan(out->reached))
        error_context(err, "load %g, reached %.4g", one_case->loads[k],
                      out->reached / scene->rms_slope);
    else if (status != 0)
        error_context(err, "load %g", one_case->loads[k]);
    return status;
}

/* Solves all loads below the highest in falling order, and what is made of all loads together. */
static int solve_back(struct contact_scene *scene, size_t m, size_t level,
                      struct contact_tally *tally, const struct contact_stopper *stopper,
                      struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    struct measure_context context = context_of(scene, m, level);
    const size_t cells = contact_case_cells(one_case);
    double *values = contact_tally_values(tally, (enum contact_measure)0) +
                     contact_case_cell(one_case, m, level, 0);
    int status = 0;
    for (size_t k = one_case->load_count - 1; one_case->unloads && k-- > 0 && status == 0;) {
        struct contact_pressed pressed;
        status = solve_load(scene, m, level, k, stopper, &pressed, err);
        if (status == 0)
            contact_quantities_measure_falling(one_case, &context, &pressed.state, cells,
                                               values + k);
        report_part(&scene->progress, 1 - (double)k / (2 * (double)one_case->load_count));
    }
    context.stop = stopper->stop;
    context.stop_context = stopper->context;
    context.progress = report_part;
    context.progress_context = &scene->progress;
    begin_part(&scene->progress, scene->progress.quantities[m][level]);
    return status != 0 ? status
                       : contact_quantities_complete(context.quantities, &context, scene->z, cells,
                                                     values, err);
}

/* Solves all loads of one model and level in rising order, each from the last. */
static int solve_loads(struct contact_scene *scene, size_t m, size_t level,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    const struct contact_model *model = one_case->models[m];
    struct contact_solver *solver = scene->solvers[m][level];
    double unused[MODEL_FACTS_MOST];
    bool finest = level + 1 == one_case->level_count;
    const double passes = (double)one_case->load_count * (one_case->unloads ? 2 : 1);
    begin_part(&scene->progress, scene->progress.loads[m][level]);
    int status = model->begin(solver, scene->z, stopper->stop, stopper->context,
                              finest ? tally->facts[m] : unused, err);
    for (size_t k = 0; k < one_case->load_count && status == 0; k++) {
        struct contact_pressed pressed;
        status = solve_load(scene, m, level, k, stopper, &pressed, err);
        if (status == 0)
            status = measure(scene, m, level, &pressed, tally,
                             contact_case_cell(one_case, m, level, k), err);
        if (status == 0 && contact_tally_counts(one_case, level))
            status = count_pressures(scene, m, level, k, &pressed, tally, err);
        report_part(&scene->progress, (double)(k + 1) / passes);
    }
    return status != 0 ? status : solve_back(scene, m, level, tally, stopper, err);
}

/* Adds to an error "model layered, level 6", with the kinematics of a model that has several. */
static void name_model(const struct contact_case *one_case, size_t m, size_t level,
                       struct error *err) {
    const struct contact_model *model = one_case->models[m];
    double points = one_case->levels[level].points;
    if (model->kinematics != NULL)
        error_context(err, "model %s (%s), level %g", contact_model_name(model),
                      model->kinematics(one_case), points);
    else
        error_context(err, "model %s, level %g", contact_model_name(model), points);
}

/* Solves a model. If it may fail and finds no solution, a note gives the reason. */
static int solve_model(struct contact_scene *scene, size_t m, size_t level,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    struct error why = {0};
    int status = solve_loads(scene, m, level, tally, stopper, &why);
    if (status == 0)
        return 0;
    name_model(one_case, m, level, &why);
    bool unsolved = status == ERROR_NUMERIC || status == ERROR_INPUT;
    if (unsolved && one_case->models[m]->may_fail) {
        notes_add(&tally->notes, tally->realisation, why.text);
        return 0;
    }
    return error_set(err, status, "%s", why.text);
}

int contact_scene_solve(struct contact_scene *scene, const struct contact_surface *surface,
                        struct contact_tally *tally, int (*stop)(void *context), void *context,
                        struct error *err) {
    const struct contact_case *one_case = scene->one_case;
    const struct contact_stopper stopper = {stop, context};
    const struct level_source source = {scene->rms_height, surface->key};
    int status = 0;
    scene->progress.before = scene->progress.current = 0;
    for (size_t l = 0; l < one_case->level_count && status == 0; l++) {
        status = contact_level_sample(&one_case->levels[l], &one_case->surface, &source, surface->z,
                                      scene->z, err);
        for (size_t m = 0; m < one_case->model_count && status == 0; m++)
            status = solve_model(scene, m, l, tally, &stopper, err);
    }
    begin_part(&scene->progress, companions_seconds(one_case));
    if (status == 0)
        status = companion_bench_solve(scene->companions, surface, tally, &stopper, err);
    return status;
}

/* --- the cost of a case, estimated before anything ran --- */

/* Curves of a model and level, beside those of quantities that the case asks for: areas by four or
 * five estimators, and eight others. */
enum { LEVEL_CURVES = 13 };

/* A few realisations may take a second already; a worker that is lost then loses no more than
 * these. */
enum { RUNS_MOST = 20 };

static double case_seconds(const struct contact_case *one_case) {
    size_t solved = one_case->model_count * one_case->level_count;
    size_t densities = one_case->model_count * one_case->pdf_count;
    size_t curves = (LEVEL_CURVES + one_case->asked.measures) * solved;
    return publishing_cost(curves + densities, curves * contact_case_slots(one_case) +
                                                   densities * one_case->pressure.count);
}

/* Returns the bytes of a scene and its compliances, without the surface itself and companions. */
static double plain_bytes(const struct contact_case *one_case) {
    double bytes = 8.0 * (double)grid_points(&contact_case_finest(one_case)->grid);
    for (size_t l = 0; l < one_case->level_count; l++) {
        const struct grid *grid = &one_case->levels[l].grid;
        for (size_t m = 0; m < one_case->model_count; m++) {
            const struct quantity_scene quantities = quantity_scene_of(one_case, m, l);
            bytes += contact_quantities_bytes(&quantities);
            if (contact_tally_counts(one_case, l))
                bytes += pressures_bytes(grid, one_case->band.x, one_case->band.y);
            bytes += area_workspace_bytes(grid, &one_case->blocks[m]) +
                     one_case->models[m]->bytes(one_case, m, grid) +
                     compliance_bytes(grid, &one_case->blocks[m]);
        }
    }
    return bytes;
}

/* Returns the scatter of the area at the lightest load, where it is largest. */
static double area_scatter(const struct contact_case *one_case) {
    const struct surface_case *surface = &one_case->surface;
    bool affine = surface->spectrum.type == SPECTRUM_SELF_AFFINE;
    double ratio = surface->wavelength_ratio * surface_case_times_longest(surface) *
                   surface_case_times_shortest(surface);
    struct height_moments moments = {0};
    bool known;
    if (surface_case_heights(surface, &moments, &known, NULL) != 0 || !known)
        moments.skewness = 0;
    return cost_area_scatter(&(struct area_scatter){
        .dimension = surface->dimension,
        .fixed = surface->options.amplitudes == AMPLITUDES_FIXED && surface->counter == NULL &&
                 surface->plateau == NULL,
        .long_waves = surface_case_mean_side(surface) / surface_case_times_longest(surface),
        .ratio = ratio > 1 ? ratio : 1,
        .hurst = affine ? surface->spectrum.hurst : NAN,
        .skewness = moments.skewness,
        .load = one_case->loads[0]});
}

void contact_case_estimate(const struct contact_case *one_case, struct study_cost *out) {
    const struct surface_case *surface = &one_case->surface;
    const struct grid *finest = &contact_case_finest(one_case)->grid;
    struct cost_jumps jumps = {0};
    surface_case_estimate(surface, out);
    out->tolerance = one_case->tolerance;
    out->fine_height = 0;
    for (size_t m = 0; m < one_case->model_count; m++)
        if (one_case->fine_height > 0 && one_case->models[m]->mesh_floor != NULL)
            out->fine_height = fmin(one_case->fine_height, one_case->blocks[m].height);
    out->nx = finest->nx;
    out->ny = finest->ny;
    out->memory_bytes = surface_case_bytes(surface) + plain_bytes(one_case) +
                        companions_bytes(one_case) + contact_tally_bytes(one_case) + PROCESS_BYTES;
    out->seconds = 1e-4 + 1e-9 * surface_case_nanoseconds(surface, &surface->grid) *
                              (double)grid_points(&surface->grid);
    out->kept = contact_kept_cost(one_case, out->seconds);
    for (size_t l = 0; l < one_case->level_count; l++)
        for (size_t m = 0; m < one_case->model_count; m++) {
            const struct quantity_scene quantities = quantity_scene_of(one_case, m, l);
            out->seconds += one_case->models[m]->seconds(one_case, m, &one_case->levels[l].grid) +
                            contact_quantities_seconds(&quantities);
            jumps = cost_jumps_sum(jumps, contact_quantities_jumps(&quantities));
            if (one_case->models[m]->jumps != NULL)
                jumps = cost_jumps_sum(
                    jumps, one_case->models[m]->jumps(one_case, m, &one_case->levels[l].grid));
        }
    out->rare_seconds = jumps.seconds;
    out->rare_variance = jumps.variance;
    out->rare_most = jumps.most;
    out->seconds += companions_seconds(one_case);
    out->result_bytes = contact_rows_bytes(one_case);
    out->runs_most = RUNS_MOST;
    for (uint64_t r = 0; r < STUDY_EARLY; r++)
        out->early_seconds[r] = companions_beyond_seconds(one_case, r);
    out->case_seconds = case_seconds(one_case);
    out->relative_error = area_scatter(one_case);
}
