/* All that one realisation is solved with: the compliance of every model and level, which threads
 * share, and a thread's own solvers. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SCENE_H
#define RUGO_JOBS_CONTACT_CONTACT_SCENE_H

#include "jobs/contact/contact_generation.h"
#include "jobs/contact/contact_tally.h"

/* By model and level; they tell areas where edges of contact lie. Immutable. */
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
void contact_scene_destroy(struct contact_scene **scene);
/* Returns the bytes of both, without the surface itself, the probe and what stands beside it. */
double contact_scene_plain_bytes(const struct contact_case *one_case);

/* Solves every level, model and load of a realisation into the tally's values. stop is asked before
 * each load, and within loads by models that take long; non-zero ends it with ERROR_STOPPED.
 * ERROR_NUMERIC names model, level and load.
 *
 * Where a model that may fail finds no answer, the realisation has no values of it on that level
 * from that load on: that is no error, but a note of the tally. */
int contact_scene_solve(struct contact_scene *scene, const struct contact_surface *surface,
                        struct contact_tally *tally, int (*stop)(void *context), void *context,
                        struct error *err);

#endif
