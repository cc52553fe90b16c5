/* Loads that rise or fall to a goal in steps, each of which a solver brings to equilibrium, and
 * jumps where no equilibrium is near the last one (F14.10). Private to core/full.
 *
 * The load is any number that says how far a solver has gone: a mean pressure, or a part of a step
 * along the face. Lengths are in the mesh's unit. */
#ifndef RUGO_CORE_FULL_LOAD_STEPS_H
#define RUGO_CORE_FULL_LOAD_STEPS_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Iterations of Newton's method after which a careful load is given up; and of a round under drag,
 * the second where the face meets itself, and of a careful step, since it was last found to meet
 * itself or not. Failures would take most of the iterations, up to 80 each: what converges seldom
 * takes more than these. */
enum { CAREFUL_NEWTON_MOST = 5000, ROUND_MOST = 10, ROUND_MOST_MET = 30, CAREFUL_STEP_MOST = 30 };
static inline size_t load_steps_iterations(bool careful, size_t usual) {
    return careful && usual > CAREFUL_STEP_MOST ? CAREFUL_STEP_MOST : usual;
}

/* What a solution under drag came to. */
struct dragged {
    double change; /* largest of the area of a cell since the state held; a jump is refused */
    double force;  /* largest of the drag on a degree of freedom, over the mean force of a node */
};

/* A solver, which gets itself as the first argument. It has the state of the last load and, during
 * jumps, one that is held. */
struct load_solver {
    /* Brings a load to equilibrium and makes it the last one; where it fails, goes back to the
     * last. *change: as struct dragged, 0 where it failed. */
    int (*step)(void *solver, double load, double *change, struct error *err);
    /* ERROR_NUMERIC where a limit is used up. */
    int (*check)(void *solver, struct error *err);
    /* Solves from the state held, each displacement from which is dragged, to this residual over
     * the largest contact force, whatever the solver's own tolerance. */
    int (*drag)(void *solver, double load, double drag, double tolerance, struct dragged *out,
                struct error *err);
    void (*hold)(void *solver); /* the present state */
    void (*fall)(void *solver); /* back to the state held */
    /* Begin a jump by going back to the last load; and end it: the present state becomes the last
     * load where it came to rest, else it goes back. */
    void (*leave)(void *solver);
    void (*land)(void *solver, double load, bool rests);
};

struct load_steps {
    const struct load_solver *by;
    void *solver;      /* borrowed */
    double least_step; /* smallest step over the whole change; smaller ones fail */
    double tolerance;  /* the solver's */
    bool careful;      /* small steps from the first one on, and jumps */
    /* Results: */
    double reached;     /* the last load */
    double failed;      /* step that failed */
    size_t cuts, jumps; /* added to: steps that were halved, and loads that were jumped to */
};

/* Goes from the last load to a goal, in one step or in smaller ones, which grow again. A failure
 * other than ERROR_NUMERIC ends it. */
int load_steps_follow(struct load_steps *steps, double from, double goal, struct error *err);

#endif
