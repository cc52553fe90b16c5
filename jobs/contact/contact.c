/* The kind "contact": rough elastic blocks pressed on a rigid flat, a scene over models (model.h).
 */
#include "jobs/contact/contact_case_read.h"
#include "jobs/contact/contact_curves.h"
#include "jobs/contact/contact_like.h"
#include "jobs/contact/contact_loads.h"
#include "jobs/contact/contact_pairs.h"
#include "jobs/contact/contact_press.h"
#include "jobs/contact/contact_scalars.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_target.h"
#include "jobs/contact/contact_view.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdlib.h>

static int read_case(void *one_case, const cJSON *parameters, struct fault_list *faults,
                     struct error *err) {
    return contact_case_read(one_case, parameters, faults, err);
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

/* Whether to stop is asked between and within loads, which may take minutes. */
static int realise(void *workspace, const struct realisation *realisation, void *tally,
                   double *scalars, struct error *err) {
    struct contact_workspace *work = workspace;
    struct contact_tally *contact = tally;
    contact->realisation = realisation->key.realisation;
    const struct contact_surface surface = {realisation->key, realisation->z, &realisation->report};
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

/* Scalars, tally and notes of a block must tell of the same realisations. */
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

/* --- what comes out --- */

static int result(const void *one_case, const struct surface_basis *basis, const void *tally,
                  const struct realisations *realisations, struct case_result *out,
                  struct error *err) {
    const struct contact_tally *contact = tally;
    int status = contact_scalars(one_case, &basis->moments, contact, realisations, out, err);
    if (status == 0)
        status = contact_curves(one_case, basis->modes, &basis->moments, contact, out, err);
    if (status == 0)
        status = contact_like_curves(contact, out, err);
    return status != 0 ? status : notes_result(&contact->notes, out, err);
}

static bool point_values(const void *tally, const struct curve *curve, size_t at,
                         struct point_values *out) {
    return contact_point_values(tally, curve, at, out);
}

static int scalar_values(const void *tally, const struct realisations *realisations, size_t scalar,
                         double *values, double *weights, struct error *err) {
    (void)weights;
    return contact_scalar_values(tally, realisations, scalar, values, err);
}

/* Nothing is told of a map on which no answer is found. */
static int measure_like(const void *one_case, const double *z, cJSON *like, struct error *err) {
    const struct contact_case *contact = one_case;
    size_t n = contact->load_count;
    if (!like_case_is_cut(&contact->like))
        return 0;
    double *areas = array_create(2 * n, sizeof *areas);
    if (areas == NULL)
        return error_memory(err, 2 * n * sizeof *areas, "contact of a map");
    int status = contact_like_measure(contact, z, areas, areas + n, err);
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

/* The first model that has a mesh writes it. */
static int write_mesh(const char *path, const void *one_case, const double *z, double pressure,
                      struct error *err) {
    const struct contact_case *contact = one_case;
    for (size_t m = 0; m < contact->model_count; m++)
        if (contact->models[m]->write_mesh != NULL)
            return contact->models[m]->write_mesh(path, contact, m, z, pressure, err);
    size_t t = 0;
    while (CONTACT_MODELS[t] != NULL && CONTACT_MODELS[t]->write_mesh == NULL)
        t++;
    return error_set(err, ERROR_INPUT, "--mesh needs \"%s\" among /contact/model",
                     CONTACT_MODELS[t] != NULL ? contact_model_name(CONTACT_MODELS[t])
                                               : "a model with a mesh");
}

const struct job_kind CONTACT_KIND = {
    .study = {.name = "contact",
              .tables = CONTACT_TABLES,
              .default_realisations = 20,
              .check = kind_check,
              .fill = contact_loads_fill,
              .expand = contact_target_expand},
    .scalar = contact_scalar_name,
    .view = &CONTACT_VIEW,
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
    .tally_size = sizeof(struct contact_tally),
    .tally_create = sums_create,
    .tally_clear = sums_clear,
    .stops_half_way = true,
    .realise = realise,
    .merge = merge,
    .format = 0x434f, /* "CO" */
    .format_version = 13,
    .put = put,
    .get = get,
    .adds_up = adds_up,
    .belongs = belongs,
    .result = result,
    .answer = contact_target_answer,
    .point_values = point_values,
    .scalar_values = scalar_values,
    .press = contact_press_once,
    .write_mesh = write_mesh,
    .measure_like = measure_like,
};
