#include "jobs/contact/contact_steps.h"
#include "core/nodal/node_table.h"
#include <stdlib.h>
#include <string.h>

/* --- one step --- */

/* Arrays of a step, one after the other; heights and gaps are copied where rows are cut. */
enum step_array { STEP_HEIGHT, STEP_GAP, STEP_PRESSURE, STEP_CONTACT, STEP_DISPLACEMENT };

/* Displacements of meshes are upward, away from the flat. */
static void fill_displacement(const struct contact_block *block, size_t from, double out[3]) {
    size_t d = (size_t)block->mesh->dimension;
    out[0] = block->u[from * d];
    out[1] = d == 3 ? block->u[from * d + 1] : 0;
    out[2] = -block->u[mesh_vertical(block->mesh, from)];
}

static void fill_nodes(struct contact_step *out, const struct contact_step_order *order,
                       const struct contact_state *state, const struct contact_block *block) {
    size_t n = grid_points(&order->grid), nx = order->grid.nx;
    double *values = out->values;
    for (size_t to = 0; to < n; to++) {
        size_t from = to / nx * order->row + to % nx;
        values[STEP_HEIGHT * n + to] = order->z[from];
        values[STEP_GAP * n + to] = state->gap[from];
        values[STEP_PRESSURE * n + to] = state->p[from] / order->unit;
        values[STEP_CONTACT * n + to] = state->p[from] > 0 ? 1 : 0;
        if (block->mesh != NULL)
            fill_displacement(block, from, values + STEP_DISPLACEMENT * n + 3 * to);
    }
}

int contact_step_fill(struct contact_step *out, const struct contact_step_order *order,
                      const struct contact_state *state, struct error *err) {
    size_t n = grid_points(&order->grid);
    struct contact_block block = {.mesh = NULL};
    if (order->model->block_of != NULL)
        block = order->model->block_of(order->solver);
    if (out->values == NULL)
        out->values = array_create((STEP_DISPLACEMENT + 3) * n, sizeof *out->values);
    if (out->values == NULL)
        return error_memory(err, (STEP_DISPLACEMENT + 3) * n * sizeof(double), "a step");
    fill_nodes(out, order, state, &block);
    out->on_mesh = (struct mesh_step){
        .material = block.material, .u = block.u, .face = *state, .unit = order->unit};
    out->step = (struct nodal_step){.load = order->load,
                                    .title = out->title,
                                    .lengths = order->lengths,
                                    .grid = order->grid,
                                    .z = out->values + STEP_HEIGHT * n,
                                    .gap = out->values + STEP_GAP * n,
                                    .p = out->values + STEP_PRESSURE * n,
                                    .contact = out->values + STEP_CONTACT * n,
                                    .mesh = block.mesh};
    if (block.mesh != NULL) {
        out->step.u = out->values + STEP_DISPLACEMENT * n;
        out->step.step = &out->on_mesh;
    }
    if (order->load > 0)
        snprintf(out->title, sizeof out->title,
                 "lengths in %s; pressure and stress in %s; mean pressure %.9g", order->lengths,
                 order->unit_name, state->pressure / order->unit);
    else
        snprintf(out->title, sizeof out->title, "lengths in %s", order->lengths);
    return 0;
}

void contact_step_clear(struct contact_step *step) {
    free(step->values);
    *step = (struct contact_step){0};
}

/* --- all steps of a surface --- */

/* Returns whether the order is for this model. */
static bool is_named(const struct steps_order *order, const struct contact_model *model) {
    return order->model != NULL ? strcmp(contact_model_name(model), order->model) == 0
                                : order->meshed && model->block_of != NULL;
}

static int refuse_without_mesh(struct error *err) {
    size_t t = 0;
    while (CONTACT_MODELS[t] != NULL && CONTACT_MODELS[t]->block_of == NULL)
        t++;
    return error_set(err, ERROR_INPUT, "--mesh needs \"%s\" among /contact/model",
                     CONTACT_MODELS[t] != NULL ? contact_model_name(CONTACT_MODELS[t])
                                               : "a model with a mesh");
}

static int refuse_model(const struct contact_case *one_case, const char *model, struct error *err) {
    char names[120] = "";
    for (size_t m = 0; m < one_case->model_count; m++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", m > 0 ? ", " : "",
                 contact_model_name(one_case->models[m]));
    }
    return error_set(err, ERROR_INPUT, "the case has no model %.40s; it has %s", model, names);
}

/* Finds the model that is asked for. */
static int find_model(const struct contact_case *one_case, const struct steps_order *order,
                      size_t *out, struct error *err) {
    size_t m = 0;
    while (m < one_case->model_count && !is_named(order, one_case->models[m]))
        m++;
    if (m == one_case->model_count && order->model != NULL)
        return refuse_model(one_case, order->model, err);
    *out = m < one_case->model_count ? m : contact_case_complete(one_case);
    return order->meshed && one_case->models[*out]->block_of == NULL ? refuse_without_mesh(err) : 0;
}

/* What presses a surface. */
struct steps_press {
    const struct contact_case *one_case;
    const struct contact_model *model;
    struct compliance *compliance;
    struct contact_solver *solver;
    double *z; /* on the finest level */
    double rms_slope;
    struct contact_step step;
};

static void press_clear(struct steps_press *press) {
    if (press->solver != NULL)
        press->model->destroy(&press->solver);
    compliance_destroy(&press->compliance);
    contact_step_clear(&press->step);
    free(press->z);
}

static int press_open(struct steps_press *press, const struct steps_order *order, size_t m,
                      struct error *err) {
    const struct contact_case *one_case = press->one_case;
    const struct contact_level *finest = contact_case_finest(one_case);
    size_t points = grid_points(&finest->grid);
    double unused[MODEL_FACTS_MOST];
    struct moments moments = {0};
    press->model = one_case->models[m];
    press->z = array_create(points, sizeof *press->z);
    if (press->z == NULL)
        return error_memory(err, points * sizeof *press->z, "a surface");
    int status =
        spectrum_moments(&one_case->surface.spectrum, &one_case->surface.grid, &moments, err);
    press->rms_slope = moments.rms_slope;
    if (status == 0)
        status = contact_level_sample(finest, &one_case->surface,
                                      &(struct level_source){moments.rms_height, order->key},
                                      order->z, press->z, err);
    if (status == 0)
        status = compliance_create(&press->compliance, &finest->grid, &one_case->blocks[m], err);
    if (status == 0)
        status = press->model->create(&press->solver, one_case, m, press->compliance, err);
    return status != 0 ? status
                       : press->model->begin(press->solver, press->z, order->stop,
                                             order->stop_context, unused, err);
}

/* Adds to the title what strains there are. */
static void name_kinematics(struct steps_press *press) {
    size_t used = strlen(press->step.title);
    if (press->model->kinematics != NULL && press->step.step.load > 0)
        snprintf(press->step.title + used, sizeof press->step.title - used, "; kinematics %s",
                 press->model->kinematics(press->one_case));
}

static int press_load(struct steps_press *press, double load, struct error *err) {
    const struct grid *grid = &contact_case_finest(press->one_case)->grid;
    const struct contact_step_order how = {.model = press->model,
                                           .solver = press->solver,
                                           .grid = *grid,
                                           .row = grid->nx,
                                           .z = press->z,
                                           .load = load,
                                           .unit = press->rms_slope,
                                           .unit_name = "E* h'",
                                           .lengths = "lambda_s"};
    struct contact_pressed pressed = contact_not_pressed();
    int status = press->model->press(press->solver, load * press->rms_slope, &pressed, err);
    if (status != 0)
        return error_context(err, "model %s, load %g", contact_model_name(press->model), load);
    status = contact_step_fill(&press->step, &how, &pressed.state, err);
    name_kinematics(press);
    return status;
}

/* Returns how many loads lead to the kept ones: a state of `full` is the one that its loads led to.
 */
static size_t loads_to_kept(const struct contact_case *one_case) {
    return one_case->kept_loads != NULL ? one_case->kept_loads[one_case->kept_load_count - 1] + 1
                                        : one_case->load_count;
}

int contact_press_steps(const void *of, const struct steps_order *order,
                        const struct steps_sink *sink, struct error *err) {
    const struct contact_case *one_case = of;
    struct steps_press press = {.one_case = one_case};
    size_t m = 0, count = order->load_count > 0 ? order->load_count : one_case->load_count;
    size_t given = count, put = 0; /* to the sink: in all, and so far */
    const double *loads = order->load_count > 0 ? order->loads : one_case->loads;
    const size_t *kept = order->kept ? one_case->kept_loads : NULL;
    if (kept != NULL) {
        given = one_case->kept_load_count;
        count = loads_to_kept(one_case);
    }
    int status = find_model(one_case, order, &m, err);
    if (status == 0)
        status = press_open(&press, order, m, err);
    for (size_t k = 0; k < count && status == 0; k++) {
        bool stopped = order->stop != NULL && order->stop(order->stop_context) != 0;
        status = stopped ? error_set(err, ERROR_STOPPED, "stopped at load %zu of %zu", k, count)
                         : press_load(&press, loads[k], err);
        if (status == 0 && (kept == NULL || kept[put] == k))
            status = sink->put(sink->context, &press.step.step, put++, given, err);
    }
    press_clear(&press);
    return status;
}

/* --- steps that are kept --- */

_Static_assert((int)KEPT_MODELS_MOST >= (int)CONTACT_MODELS_MOST, "a case has more models");

struct kept_steps contact_kept_steps(const void *of) {
    const struct contact_case *one_case = of;
    bool all = one_case->kept_load_count == 0;
    struct kept_steps out = {.count = one_case->kept_count,
                             .load_count = all ? one_case->load_count : one_case->kept_load_count,
                             .model_count = one_case->model_count,
                             .realisations = one_case->kept};
    for (size_t m = 0; m < out.model_count; m++)
        out.models[m] = contact_model_name(one_case->models[m]);
    return out;
}

/* Bytes of a VTU file by node, measured: of a face (base64), and of a block's nodes (text) under
 * profiles and surfaces, of 2000 and 13 000 elements. */
static const double FACE_BYTES = 120, PROFILE_BYTES = 140, BLOCK_BYTES = 230;

/* Returns the bytes of one load by a model. */
static double step_bytes(const struct contact_case *one_case, size_t m, const struct grid *grid) {
    const struct contact_model *model = one_case->models[m];
    double face = (double)grid_points(grid);
    if (model->nodes == NULL)
        return face * (FACE_BYTES + node_table_row_bytes(false));
    return face * node_table_row_bytes(true) +
           model->nodes(one_case, m, grid) * (grid_is_profile(grid) ? PROFILE_BYTES : BLOCK_BYTES);
}

struct study_kept contact_kept_cost(const struct contact_case *one_case, double generation) {
    const struct grid *grid = &contact_case_finest(one_case)->grid;
    const struct kept_steps kept = contact_kept_steps(one_case);
    struct study_kept out = {.path = "/contact/keep/realisations"};
    if (kept.count == 0)
        return (struct study_kept){.path = NULL};
    out.past = (uint64_t)kept.realisations[kept.count - 1] + 1;
    const double share = (double)loads_to_kept(one_case) / (double)one_case->load_count;
    for (size_t m = 0; m < one_case->model_count; m++) {
        out.seconds += generation + share * one_case->models[m]->seconds(one_case, m, grid);
        out.bytes += (double)kept.load_count * step_bytes(one_case, m, grid);
    }
    out.seconds *= (double)kept.count;
    out.bytes *= (double)kept.count;
    return out;
}
