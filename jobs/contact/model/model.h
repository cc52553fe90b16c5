/* The interface of a model of contact, which presses a rough block on a rigid flat. A model is one
 * struct, filled in one file model_NAME.c, and one entry in the list of models.c. Nothing else
 * names a model.
 *
 * Life of a solver: create (of one level, for one thread) -> begin (a surface) -> press (rising
 * loads) -> begin ... -> destroy. */
#ifndef RUGO_JOBS_CONTACT_MODEL_MODEL_H
#define RUGO_JOBS_CONTACT_MODEL_MODEL_H

#include "core/contact/contact.h"
#include "core/cost.h"
#include "core/full/material.h"
#include "core/full/mesh.h"
#include "jobs/contact/measure.h"
#include "schema/study/values.h"
#include <math.h>

enum { CONTACT_MODELS_MOST = 8, MODEL_FACTS_MOST = 2 };

struct contact_case;
struct contact_solver; /* each model's own */

/* The solution of a load. */
struct contact_pressed {
    struct contact_state state; /* its work in points x transforms */
    double stretch; /* nodes in contact: area under load over that undeformed; 1 where areas are
                     * reported undeformed */
    double open_stretch; /* the same of the open face, also if not reported; NaN: not
                          * known */
    /* Areas of the face as it stands over the same on the flat, less 1 (core/full/face.h): of all
     * of it, and of the nodes in contact; 0 where areas are reported on the flat. */
    double face_tilt, contact_tilt;
    double own[MODEL_MEASURES_MOST]; /* the model's own measures; NaN: none */
    double reached;                  /* without a solution: the load reached; NaN: not known */
};

/* A curve of a measure that the model alone has. */
struct model_curve {
    const char *quantity, *y_label;
    size_t measure; /* number among its own */
};

/* Returns what there is before a load is solved: nothing is known of it. */
static inline struct contact_pressed contact_not_pressed(void) {
    struct contact_pressed out = {.stretch = 1, .open_stretch = NAN, .reached = NAN};
    for (size_t a = 0; a < MODEL_MEASURES_MOST; a++)
        out.own[a] = NAN;
    return out;
}

/* The meshed block of a solver, which is valid until its next call. */
struct contact_block {
    const struct mesh *mesh;
    const double *u; /* [node*dimension + k], the grid's unit */
    struct material material;
};

/* What scalars of the model's own are computed from: a realisation on the finest level. */
struct model_values {
    size_t load_count;
    const double *loads;
    const double *of[MEASURE_COUNT]; /* by load; NaN: none */
    const double *facts;             /* MODEL_FACTS_MOST, as begin filled them */
};

/* Sum, and largest value, over the loads that have values, which come first; 0 without any. */
static inline double model_sum(size_t n, const double *values) {
    double sum = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        sum += values[k];
    return sum;
}
static inline double model_largest(size_t n, const double *values) {
    double largest = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        largest = fmax(largest, values[k]);
    return largest;
}

struct contact_model {
    int rank; /* of completeness: the highest in a case is the reference for model errors */
    enum block_model block; /* its compliance locates edges of contact between nodes */
    bool elements;          /* finite elements: layers of them, and mortar functions for the gap */
    bool may_fail;  /* to find a solution: a note gives the reason, and loads from there on have no
                     * values */
    bool stretches; /* areas are reported as they are under load */
    bool yields;    /* presses under a hardness (contact_case.yield) */
    bool coatings;  /* its block may have a coating */
    bool counter_faces;  /* presses the sum of two rough faces */
    bool slides;         /* has friction of its own, at finite strain (quantity_sliding.c) */
    bool free_space;     /* presses maps that do not repeat, too: on the block's compliance there */
    double times_linear; /* least time over that of a linear model; 0: 1 */
    double default_height; /* of the block, in lengths of the cell; INFINITY */
    double tolerance;      /* of a solution for which none is prescribed; 0: that of core/contact */
    size_t curve_count;    /* of its own */
    const struct model_curve *curves;
    size_t scalar_count; /* of its own */
    const char *const *scalars;

    /* Returns the name of the kinematics of strains; NULL where there is nothing to choose. */
    const char *(*kinematics)(const struct contact_case *one_case);
    /* Adds faults that only this model finds in a case; `model` is its position there. NULL:
     * none. */
    int (*check)(struct contact_case *one_case, size_t model, struct values *values,
                 struct error *err);
    /* Returns ERROR_INPUT for a face that is too steep or too high for the block of one map, by its
     * RMS slope and height. NULL: the model takes all. */
    int (*face_fits)(const struct block *block, double rms_slope, double rms_height,
                     struct error *err);
    /* Returns a bound of the mesh error that finer levels do not reduce, as a share of a measure
     * that is read from this field. NULL: none. */
    double (*mesh_floor)(int dimension, enum measure_field field, double transition_depth);
    /* Return the bytes of a solver on one grid, and the CPU seconds of all loads there on a 3 GHz
     * core. */
    double (*bytes)(const struct contact_case *one_case, size_t model, const struct grid *grid);
    double (*seconds)(const struct contact_case *one_case, size_t model, const struct grid *grid);
    /* Returns what only some realisations take of these seconds. NULL: all take the same. */
    struct cost_jumps (*jumps)(const struct contact_case *one_case, size_t model,
                               const struct grid *grid);

    /* Borrows both, which must outlive it; the compliance is that of `block`. */
    int (*create)(struct contact_solver **out, const struct contact_case *one_case, size_t model,
                  const struct compliance *compliance, struct error *err);
    void (*destroy)(struct contact_solver **solver);
    /* Lets a team of threads work along, with the same digits; borrowed until the next call.
     * ERROR_MEMORY. NULL: the model works on one. */
    int (*set_team)(struct contact_solver *solver, struct team *team, struct error *err);
    /* Takes a surface of the grid, out of contact: nothing of the last one is kept. stop may be
     * called within loads, until the next surface; non-zero ends them with ERROR_STOPPED. Fills
     * what the model has of facts[MODEL_FACTS_MOST]. */
    int (*begin)(struct contact_solver *solver, const double *z, int (*stop)(void *context),
                 void *context, double *facts, struct error *err);
    /* Presses to a mean pressure in E*. ERROR_NUMERIC without a solution. Of *out, stretch is 1,
     * tilts are 0, and open_stretch, reached and own NaN before the call. */
    int (*press)(struct contact_solver *solver, double pressure, struct contact_pressed *out,
                 struct error *err);
    /* Returns the least mean pressure of full contact of the surface begun, in E*. NULL: not
     * known. */
    double (*full_pressure)(const struct contact_solver *solver);
    /* Measures the model's own scalars of a realisation, NaN before the call. NULL if it has
     * none. */
    void (*measure)(const struct model_values *values, double *scalars);
    /* Returns the nodes of the mesh on a grid, about, 0 where it cannot be meshed. NULL as the
     * next. */
    double (*nodes)(const struct contact_case *one_case, size_t model, const struct grid *grid);
    /* Returns the block as it is after begin and under the last load. NULL if the model has no
     * mesh. */
    struct contact_block (*block_of)(struct contact_solver *solver);
};

/* All models, NULL at the end, and the choices of /contact/model, whose values are their positions.
 * models.c holds nothing but these: a program that defines them itself has the models that it names
 * there, at most CONTACT_MODELS_MOST. */
extern const struct contact_model *const CONTACT_MODELS[];
extern const struct choice CONTACT_MODEL_CHOICES[];
/* Returns the name in studies and curves; NULL for a model outside of the table. */
const char *contact_model_name(const struct contact_model *model);

/* Defines both from a list as in rugo_lists.h, whose entry NAME has the struct NAME_MODEL. The
 * value is that of librugo; a model that it lacks has any:
 * #define LIST(ENTRY) RUGO_MODELS(ENTRY) ENTRY(SPRINGS, "springs", -1) */
#define CONTACT_MODEL_DECLARE(model, name, value) extern const struct contact_model model##_MODEL;
#define CONTACT_MODEL_ADDRESS(model, name, value) &model##_MODEL,
#define CONTACT_MODEL_PLACE(model, name, value) model##_PLACE,
#define CONTACT_MODEL_CHOICE(model, name, value) {name, model##_PLACE},
#define CONTACT_MODEL_TABLES(LIST)                                                                 \
    LIST(CONTACT_MODEL_DECLARE)                                                                    \
    enum { LIST(CONTACT_MODEL_PLACE) CONTACT_MODEL_PLACES };                                       \
    _Static_assert((int)CONTACT_MODEL_PLACES <= (int)CONTACT_MODELS_MOST, "too many models");      \
    const struct contact_model *const CONTACT_MODELS[] = {LIST(CONTACT_MODEL_ADDRESS) NULL};       \
    const struct choice CONTACT_MODEL_CHOICES[] = {LIST(CONTACT_MODEL_CHOICE){0}};

#endif
