/* A way to press a rough block on a rigid flat: one struct, filled in one file model_NAME.c, and
 * one line in the table of models.c. Nothing else names a model.
 *
 * Life of a solver: create (of one level, for one thread) -> begin (a surface) -> press (rising
 * loads) -> begin ... -> destroy. */
#ifndef RUGO_JOBS_CONTACT_MODEL_H
#define RUGO_JOBS_CONTACT_MODEL_H

#include "core/contact/contact.h"
#include "jobs/contact/measure.h"
#include "schema/study/values.h"

enum { CONTACT_MODELS_MOST = 8, MODEL_FACTS_MOST = 2 };

struct contact_case;
struct contact_solver; /* each model's own */

/* A load gives this. */
struct contact_pressed {
    struct contact_state state; /* its work in points x transforms */
    double stretch; /* nodes in contact: area under load over that undeformed; 1 where areas are
                       told undeformed */
    double open_stretch;             /* the same of the open face, told or not; NaN: not known */
    double own[MODEL_MEASURES_MOST]; /* the model's own measures; NaN: none */
    double reached; /* where no answer was found: the load reached; NaN: not told */
};

/* A curve of a measure that the model alone has. */
struct model_curve {
    const char *quantity, *y_label;
    size_t measure; /* number among its own */
};

/* What scalars of the model's own are made of: a realisation on the finest level. */
struct model_values {
    size_t load_count;
    const double *loads;
    const double *of[MEASURE_COUNT]; /* by load; NaN: none */
    const double *facts;             /* MODEL_FACTS_MOST, as begin filled them */
};

/* Sums over the loads that have values, which come first; 0 without any. */
double model_sum(size_t n, const double *values);
double model_largest(size_t n, const double *values);

struct contact_model {
    int rank; /* of completeness: the errors of others are counted from the highest in a case */
    enum block_model block; /* whose compliance tells where edges of contact lie between nodes */
    bool elements;          /* finite elements: layers of them, and mortar functions for the gap */
    bool may_fail; /* to find an answer: a note tells why, and loads from there on have no values */
    bool stretches;        /* areas are told as they are under load */
    double times_linear;   /* it takes so many times as long as a linear model at least; 0: once */
    double default_height; /* of the block, in lengths of the cell; INFINITY */
    size_t curve_count;    /* of its own */
    const struct model_curve *curves;
    size_t scalar_count; /* of its own */
    const char *const *scalars;

    /* Names the kinematics of the strains; NULL where there is nothing to choose. */
    const char *(*kinematics)(const struct contact_case *one_case);
    /* Adds faults that only this model finds in a case; `model` is its position there. NULL: none.
     */
    int (*check)(struct contact_case *one_case, size_t model, struct values *values,
                 struct error *err);
    /* Returns what finer levels do not take off the error of the mesh: a bound, as a share of the
     * measure. NULL: nothing. */
    double (*mesh_floor)(int dimension, enum contact_measure measure, double transition_depth);
    /* These return the bytes of a solver on one grid, and the CPU seconds of all loads there on a 3
     * GHz core. */
    double (*bytes)(const struct contact_case *one_case, size_t model, const struct grid *grid);
    double (*seconds)(const struct contact_case *one_case, size_t model, const struct grid *grid);

    /* Borrows both, which must outlive it; the compliance is that of `block`. */
    int (*create)(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err);
    void (*destroy)(struct contact_solver **solver);
    /* Takes a surface of the grid and lifts it off: nothing is left of the last one. stop may be
     * asked within loads, until the next surface; non-zero ends them with ERROR_STOPPED. Fills what
     * it has of facts[MODEL_FACTS_MOST]. */
    int (*begin)(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err);
    /* To a mean pressure in E*. ERROR_NUMERIC where it finds no answer. Of *out, stretch is 1,
     * open_stretch, reached and own are NaN before the call. */
    int (*press)(struct contact_solver *solver, double pressure, struct contact_pressed *out,
                 struct error *err);
    /* Its own scalars of a realisation, NaN before the call. NULL where it has none. */
    void (*measure)(const struct model_values *values, double *scalars);
    /* Writes the block meshed on the surface z of the case's own grid, pressed to p/(E* h') where
     * that is above 0, as a VTU file. NULL where it has no mesh. */
    int (*write_mesh)(const char *path, const struct contact_case *one_case, size_t model,
                      const double *z, double pressure, struct error *err);
};

/* All models, NULL at the end, and the choices of /contact/model, which stand for their places.
 * models.c holds nothing but these: a program that defines them itself has the models that it names
 * there, at most CONTACT_MODELS_MOST. */
extern const struct contact_model *const CONTACT_MODELS[];
extern const struct choice CONTACT_MODEL_CHOICES[];
/* Returns the name in studies and curves; NULL for a model outside of the table. */
const char *contact_model_name(const struct contact_model *model);

/* Defines both from a list of structs with their names:
 * #define LIST(MODEL) MODEL(HALFSPACE_MODEL, "halfspace") MODEL(LAYERED_MODEL, "layered") */
#define CONTACT_MODEL_DECLARE(model, name) extern const struct contact_model model;
#define CONTACT_MODEL_ADDRESS(model, name) &(model),
#define CONTACT_MODEL_PLACE(model, name) model##_PLACE,
#define CONTACT_MODEL_CHOICE(model, name) {name, model##_PLACE},
#define CONTACT_MODEL_TABLES(LIST)                                                                 \
    LIST(CONTACT_MODEL_DECLARE)                                                                    \
    enum { LIST(CONTACT_MODEL_PLACE) CONTACT_MODEL_PLACES };                                       \
    _Static_assert((int)CONTACT_MODEL_PLACES <= (int)CONTACT_MODELS_MOST, "too many models");      \
    const struct contact_model *const CONTACT_MODELS[] = {LIST(CONTACT_MODEL_ADDRESS) NULL};       \
    const struct choice CONTACT_MODEL_CHOICES[] = {LIST(CONTACT_MODEL_CHOICE){0}};

#endif
