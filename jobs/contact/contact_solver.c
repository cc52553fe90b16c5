#include "jobs/contact/contact_solver.h"
#include <math.h>
#include <stdlib.h>

/* One of linear and full. */
struct contact_solver {
    struct contact *linear;
    struct full *full;
    double transforms; /* that its work is worth */
    struct full_report report;
};

struct block contact_linear_block(const struct block *block) {
    struct block linear = *block;
    if (linear.model == MODEL_FULL)
        linear.model = MODEL_LAYERED;
    return linear;
}

struct full_options contact_full_options(const struct contact_case *study) {
    struct full_options options = FULL_DEFAULTS;
    options.kinematics = study->kinematics;
    options.transition = study->transition_depth;
    options.tolerance = study->tolerance;
    return options;
}

int contact_solver_create(struct contact_solver **out, const struct contact_case *study,
                          size_t model, const struct compliance *compliance, struct error *err) {
    struct contact_solver *solver = array_create(1, sizeof *solver);
    int status = 0;
    if (solver == NULL)
        status = error_memory(err, sizeof *solver, "a contact solver");
    else if (contact_case_is_full(study, model)) {
        struct full_options options = contact_full_options(study);
        solver->transforms = cost_full_transforms(&compliance->grid);
        status =
            full_create(&solver->full, &compliance->grid, &study->blocks[model], &options, err);
    } else {
        struct contact_options options = CONTACT_DEFAULTS;
        options.tolerance = study->tolerance;
        status = contact_create(&solver->linear, compliance, &options, err);
    }
    if (status != 0)
        contact_solver_destroy(&solver);
    *out = solver;
    return status;
}

void contact_solver_destroy(struct contact_solver **solver) {
    struct contact_solver *s = *solver;
    if (s == NULL)
        return;
    contact_destroy(&s->linear);
    full_destroy(&s->full);
    free(s);
    *solver = NULL;
}

struct full_size contact_full_size(const struct contact_case *study, size_t model,
                                   const struct grid *grid) {
    struct full_options options = contact_full_options(study);
    return cost_full_size(grid, &study->blocks[model], &options, study->rms_slope);
}

double contact_solver_bytes(const struct contact_case *study, size_t model,
                            const struct grid *grid) {
    if (!contact_case_is_full(study, model))
        return contact_bytes(grid);
    struct full_size size = contact_full_size(study, model, grid);
    struct full_options options = contact_full_options(study);
    return cost_full_bytes(grid, &study->blocks[model], &options, &size);
}

int contact_solver_begin(struct contact_solver *s, const double *z, int (*stop)(void *context),
                         void *context, struct error *err) {
    if (s->full == NULL)
        return contact_begin(s->linear, z, err);
    full_set_stop(s->full, stop, context);
    return full_begin(s->full, z, err);
}

const struct mesh *contact_solver_mesh(const struct contact_solver *s) {
    return s->full != NULL ? full_mesh(s->full) : NULL;
}

int contact_solver_press(struct contact_solver *s, double pressure, struct contact_state *out,
                         const struct full_report **report, struct error *err) {
    *report = s->full != NULL ? &s->report : NULL;
    if (s->full == NULL)
        return contact_press(s->linear, pressure, out, err);
    int status = full_press(s->full, pressure, out, &s->report, err);
    if (status == 0)
        out->work *= s->transforms;
    return status;
}
