#include "jobs/contact/model/model_linear.h"
#include "core/contact/stretch.h"
#include <stdlib.h>

struct contact_solver {
    struct contact *contact;
    double poisson;
    bool strains; /* sideways, as one bare face does */
};

double linear_seconds(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    bool elements = one_case->blocks[model].model == MODEL_LAYERED;
    return contact_case_linear_seconds(one_case, grid, elements, one_case->pdf_count);
}

double linear_bytes(const struct contact_case *one_case, size_t model, const struct grid *grid) {
    const struct contact_options options = contact_case_options(one_case);
    return contact_bytes(grid, &one_case->blocks[model], &options);
}

int linear_create(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err) {
    const struct contact_options options = contact_case_options(one_case);
    struct contact_solver *solver = array_create(1, sizeof *solver);
    if (solver == NULL)
        return error_memory(err, sizeof *solver, "a contact solver");
    solver->poisson = one_case->blocks[model].poisson;
    solver->strains = !block_is_coated(&one_case->blocks[model]) && !one_case->two_faces;
    int status = contact_create(&solver->contact, compliance, &options, err);
    if (status != 0)
        linear_destroy(&solver);
    *out = solver;
    return status;
}

void linear_destroy(struct contact_solver **solver) {
    if (*solver != NULL)
        contact_destroy(&(*solver)->contact);
    free(*solver);
    *solver = NULL;
}

int linear_set_team(struct contact_solver *solver, struct team *team, struct error *err) {
    return contact_set_team(solver->contact, team, err);
}

int linear_begin(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err) {
    (void)facts;
    contact_set_stop(solver->contact, stop, context);
    return contact_begin(solver->contact, z, err);
}

int linear_press(struct contact_solver *solver, double pressure, struct contact_pressed *out,
                 struct error *err) {
    /* Of a coated face, and of two rough faces, it is not known (F22.6, F25.5). */
    out->open_stretch = solver->strains ? stretch_open(solver->poisson, pressure) : (double)NAN;
    return contact_press(solver->contact, pressure, &out->state, err);
}

double linear_full_pressure(const struct contact_solver *solver) {
    return contact_full_pressure(solver->contact);
}

bool linear_is_exact(const struct contact_model *model) {
    return model->press == linear_press && model->block == MODEL_HALFSPACE;
}
