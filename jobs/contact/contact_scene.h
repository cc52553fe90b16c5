/* The solvers of a realisation: the compliance of every model and level, which threads share, and a
 * thread's own solvers. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SCENE_H
#define RUGO_JOBS_CONTACT_CONTACT_SCENE_H

#include "jobs/contact/companion/companion.h"

/* Compliances by model and level, by which areas between edges of contact are estimated.
 * Immutable. */
struct contact_compliances {
    struct compliance *of[CONTACT_MODELS_MOST][CONTACT_LEVELS_MOST]; /* owned */
};
int contact_compliances_create(struct contact_compliances *out, const struct contact_case *one_case,
                               struct error *err);
void contact_compliances_clear(struct contact_compliances *compliances);

struct contact_scene;
/* Borrows all three. moments: of the prescribed spectrum, which sets the scale. */
int contact_scene_create(struct contact_scene **out, const struct contact_case *one_case,
                         const struct moments *moments,
                         const struct contact_compliances *compliances, struct error *err);
/* Lets a team of threads work along, with the same digits; borrowed. ERROR_MEMORY. */
int contact_scene_set_team(struct contact_scene *scene, struct team *team, struct error *err);
/* Sets what contact_scene_solve passes the share of its work that is done, by estimated times,
 * after each load and each step of a path; NULL, the initial value: nothing. */
void contact_scene_set_progress(struct contact_scene *scene,
                                void (*progress)(void *context, double share), void *context);
void contact_scene_destroy(struct contact_scene **scene);

/* Solves every level, model and load of a realisation into the tally's values. stop is called
 * before each load, and within loads by models that take long; non-zero ends it with ERROR_STOPPED.
 * ERROR_NUMERIC names model, level and load.
 *
 * If a model that may fail finds no solution, the realisation has no values of it on that level
 * from that load on: this is no error, but a note of the tally. */
int contact_scene_solve(struct contact_scene *scene, const struct contact_surface *surface,
                        struct contact_tally *tally, int (*stop)(void *context), void *context,
                        struct error *err);

/* Estimates memory, time and error of one realisation before anything ran. */
void contact_case_estimate(const struct contact_case *one_case, struct study_cost *out);

#endif
