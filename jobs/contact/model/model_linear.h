/* What the linear models share: all but their compliance. */
#ifndef RUGO_JOBS_CONTACT_MODEL_MODEL_LINEAR_H
#define RUGO_JOBS_CONTACT_MODEL_MODEL_LINEAR_H

#include "jobs/contact/case/contact_case.h"

/* Functions of a struct contact_model. */
double linear_bytes(const struct contact_case *one_case, size_t model, const struct grid *grid);
double linear_seconds(const struct contact_case *one_case, size_t model, const struct grid *grid);
int linear_create(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err);
void linear_destroy(struct contact_solver **solver);
int linear_set_team(struct contact_solver *solver, struct team *team, struct error *err);
int linear_begin(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err);
int linear_press(struct contact_solver *solver, double pressure, struct contact_pressed *out,
                 struct error *err);
double linear_full_pressure(const struct contact_solver *solver);

/* Initialises the members of a struct contact_model that are the same in all linear ones. */
#define LINEAR_MODEL                                                                               \
    .yields = true, .coatings = true, .counter_faces = true, .bytes = linear_bytes,                \
    .seconds = linear_seconds, .create = linear_create, .destroy = linear_destroy,                 \
    .set_team = linear_set_team, .begin = linear_begin, .press = linear_press,                     \
    .full_pressure = linear_full_pressure

/* Returns whether a model is linear and presses a half-space or an exact layer. */
bool linear_is_exact(const struct contact_model *model);

#endif
