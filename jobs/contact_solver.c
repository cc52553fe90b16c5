#include "jobs/contact_solver.h"
#include <stdlib.h>

/* A freedom of the finite elements with its rows of the stiffness and of what it is solved by; as
 * measured. */
static const double PROFILE_BYTES = 1400, SURFACE_BYTES = 6500;

/* One of linear and full. */
struct contact_solver {
    struct contact *linear;
    struct full *full;
    struct full_report report;
};

struct block contact_linear_block(const struct block *block) {
    struct block linear = *block;
    if (linear.model == MODEL_FULL)
        linear.model = MODEL_LAYERED;
    return linear;
}

int contact_solver_create(struct contact_solver **out, const struct contact_case *study,
                          size_t model, const struct compliance *compliance, struct error *err) {
    struct contact_solver *solver = array_create(1, sizeof *solver);
    int status = 0;
    if (solver == NULL)
        status = error_memory(err, sizeof *solver, "a contact solver");
    else if (contact_case_is_full(study, model)) {
        struct full_options options = FULL_DEFAULTS;
        options.kinematics = study->kinematics;
        options.tolerance = study->tolerance;
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

double contact_full_freedoms(const struct grid *grid, const struct block *block) {
    double thickness[LAYERS_MOST];
    size_t layers = block_layers(grid, block, thickness), axes = grid_is_profile(grid) ? 2 : 3;
    return layers == 0 ? 0 : (double)((layers + 1) * axes) * (double)grid_points(grid);
}

double contact_solver_bytes(const struct contact_case *study, size_t model,
                            const struct grid *grid) {
    double bytes = contact_bytes(grid);
    if (contact_case_is_full(study, model))
        bytes += (grid_is_profile(grid) ? PROFILE_BYTES : SURFACE_BYTES) *
                 contact_full_freedoms(grid, &study->blocks[model]);
    return bytes;
}

int contact_solver_begin(struct contact_solver *s, const double *z, struct error *err) {
    return s->full != NULL ? full_begin(s->full, z, err) : contact_begin(s->linear, z, err);
}

int contact_solver_press(struct contact_solver *s, double pressure, struct contact_state *out,
                         const struct full_report **report, struct error *err) {
    *report = s->full != NULL ? &s->report : NULL;
    return s->full != NULL ? full_press(s->full, pressure, out, &s->report, err)
                           : contact_press(s->linear, pressure, out, err);
}

struct full *contact_solver_full(struct contact_solver *s) {
    return s->full;
}
