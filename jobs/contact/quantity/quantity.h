/* The interface of a quantity that stands on a solved contact, such as its conductance. A quantity
 * is one struct, filled in one file quantity_NAME.c, and one entry in the list below. It is made of
 * the pressures, the gap and the stiffness of a load (struct contact_pressed), whatever the model,
 * and costs nothing in studies that do not ask for it.
 *
 * It has measures of its own (measure.h), so that its curves have every error that others have. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_QUANTITY_H
#define RUGO_JOBS_CONTACT_QUANTITY_QUANTITY_H

#include "core/cost.h"
#include "jobs/contact/case/contact_case.h"

/* All quantities: NAME and how many measures it has. NAME_QUANTITY is its struct, NAME_PARAMETERS
 * its table of parameters. Partial results hold measures in this order, so that an entry comes
 * behind all others. */
#define CONTACT_QUANTITY_LIST(ENTRY)                                                               \
    ENTRY(CONDUCTANCE, 1)                                                                          \
    ENTRY(LEAK, 7)                                                                                 \
    ENTRY(HARDNESS, 5)                                                                             \
    ENTRY(UNLOAD, 3)                                                                               \
    ENTRY(FRICTION, 8) ENTRY(COUPLING, 3) ENTRY(SLIDING, 6) ENTRY(HELD, 1) ENTRY(SLIDING_EDGES, 3)

/* NAME_AT: its position, as in quantities_asked. NAME_MEASURE: the number of its first measure. */
#define CONTACT_QUANTITY_POSITION(name, count) name##_AT,
enum { CONTACT_QUANTITY_LIST(CONTACT_QUANTITY_POSITION) CONTACT_QUANTITIES };
_Static_assert((int)CONTACT_QUANTITIES <= (int)CONTACT_QUANTITIES_MOST, "too many quantities");
#define CONTACT_QUANTITY_NUMBER(name, count)                                                       \
    name##_MEASURE, name##_MEASURE_LAST = name##_MEASURE + (count)-1,
enum {
    CONTACT_QUANTITY_BEFORE = MEASURE_QUANTITIES - 1,
    CONTACT_QUANTITY_LIST(CONTACT_QUANTITY_NUMBER) CONTACT_QUANTITY_BEHIND
};
_Static_assert((int)CONTACT_QUANTITY_BEHIND <= (int)MEASURE_PAIRED, "too many measures");

/* Why targets refuse what slips, of all quantities that do. */
#define FRICTION_NO_TARGET "a target answers contact without friction"

struct measure_context; /* contact_measure.h */
struct contact_area;    /* core/contact/area.h */

/* Measures that others name: columns of tables of one map, a bound of areas by edges, and what
 * slips after yielding. */
enum {
    LEAK_ALONG_X = LEAK_MEASURE + 4,
    LEAK_ALONG_Y,
    PLASTIC_AREA = HARDNESS_MEASURE,
    PLASTIC_LOAD,
    PLASTIC_VOLUME,
    EDGES_YIELDED = HARDNESS_MEASURE + 4,
    UNLOAD_AREA = UNLOAD_MEASURE,
    UNLOAD_GAP,
    UNLOAD_APPROACH,
    SLIP_STICK_EDGES = FRICTION_MEASURE + 1,
    SLIP_DISPLACEMENT = FRICTION_MEASURE + 3,
    SLIP_WORK,
    FRICTION_NORMAL,
    FRICTION_APPROACH,
    FRICTION_RATIO,
    COUPLED_STICK = COUPLING_MEASURE,
    COUPLED_DISPLACEMENT,
    COUPLED_AREA,
    SLIDING_FORCE = SLIDING_MEASURE,
    SLIDING_STICK_AREA,
    SLIDING_STICK_LOAD,
    SLIDING_AREA,
    SLIDING_GAP,
    SLIDING_DISSIPATION,
    SLIDING_STICK_BY_EDGES = SLIDING_EDGES_MEASURE,
    SLIDING_AREA_BY_EDGES,
    SLIDING_STICK_UNKNOWN
};

/* What a quantity is measured on: one grid under one model. */
struct quantity_scene {
    const struct contact_case *one_case; /* borrowed, for as long as the state lives */
    struct grid grid;
    struct block block;
    bool exact;   /* by core/contact on the block itself, without a mesh */
    bool open;    /* in free space */
    bool slides;  /* by the model full, with friction at finite strain */
    bool planned; /* seconds are those that companions are planned by: they stay, as draws follow */
};

struct quantity_state; /* each quantity's own */

/* What scalars of a quantity are made of: one realisation of the first model on the finest level.
 */
struct quantity_values {
    const struct contact_case *one_case;
    size_t load_count;   /* contact_case_slots: room for so many values of a measure */
    const double *loads; /* p/(E* h'); of sliding there may be more points than loads */
    const double *areas; /* by edges, a load each */
    const double *of;    /* of its measures, by measure and load, or point of sliding */
};

struct contact_quantity {
    const struct measure *measures;
    const char *const *scalars; /* of a realisation; ends with NULL; NULL: none */
    bool tangent;               /* needs that of linear solutions */
    /* Returns whether a study asks for the quantity, whose models are known; fills what it has in
     * the case, and adds its faults. */
    bool (*read)(struct contact_case *one_case, struct values *values);
    /* Return the bytes of a state, and the CPU seconds of all loads on a 3 GHz core. */
    double (*bytes)(const struct quantity_scene *scene);
    double (*seconds)(const struct quantity_scene *scene);
    /* As of a model (model.h). */
    struct cost_jumps (*jumps)(const struct quantity_scene *scene);
    /* NULL where it keeps nothing, as the two above and the next. */
    int (*create)(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err);
    void (*destroy)(struct quantity_state **state);
    /* Measures a solved load into as many values as the quantity has, which are NaN: none. NULL
     * where no load by itself has a value. */
    int (*measure)(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err);
    /* Measures a load below the highest, on the path of falling loads, in place of what it had
     * there on that of rising ones. NULL where that is all the same to it. */
    void (*measure_falling)(const struct measure_context *context,
                            const struct contact_state *state, double *values);
    /* Fills measures that are made of all loads together, or of heights z on the grid, of one
     * realisation, model and level: values[measure * stride + load], of all measures. NULL where
     * there are none. */
    int (*complete)(struct quantity_state *state, const struct measure_context *context,
                    const double *z, size_t stride, double *values, struct error *err);
    /* Fills the scalars of a realisation; NaN: none. NULL where it has none. */
    void (*summarise)(const struct quantity_values *values, double *scalars);
};
/* Returns a quantity by its position, and the number of its first measure; NULL behind the last. */
const struct contact_quantity *contact_quantity_at(size_t at, size_t *measure);

/* The parameters of all, for the tables of the kind. */
#define CONTACT_QUANTITY_DECLARE(name, count)                                                      \
    extern const struct contact_quantity name##_QUANTITY;                                          \
    extern const struct parameter_table name##_PARAMETERS;
CONTACT_QUANTITY_LIST(CONTACT_QUANTITY_DECLARE)
#define CONTACT_QUANTITY_TABLE(name, count) &name##_PARAMETERS,
#define CONTACT_QUANTITY_TABLES CONTACT_QUANTITY_LIST(CONTACT_QUANTITY_TABLE)

/* Fills which quantities the study asks for, with their faults, and whether solutions need their
 * tangent. */
void contact_quantities_read(struct contact_case *one_case, struct values *values);
/* Asks for the quantity with this measure, in a case that no study describes. */
void contact_quantities_ask(struct contact_case *one_case, size_t measure);
/* Returns the row of a measure by its number from MEASURE_QUANTITIES on; NULL: no quantity has it.
 */
const struct measure *quantity_measure(size_t number);
/* Returns whether the case asks for the quantity with this measure. */
bool quantity_is_asked(const struct contact_case *one_case, size_t number);

/* The states of all quantities that a case asks for, of one grid and one thread. */
struct contact_quantities {
    const struct contact_case *one_case;                /* borrowed; NULL: nothing is asked for */
    struct quantity_state *of[CONTACT_QUANTITIES_MOST]; /* owned; NULL: nothing is kept */
};
int contact_quantities_create(struct contact_quantities *out, const struct quantity_scene *scene,
                              struct error *err);
void contact_quantities_clear(struct contact_quantities *quantities);
double contact_quantities_bytes(const struct quantity_scene *scene);
double contact_quantities_seconds(const struct quantity_scene *scene);
struct cost_jumps contact_quantities_jumps(const struct quantity_scene *scene);
/* Fills values[QUANTITY_MEASURES_MOST]; NaN where not asked for. quantities may be NULL. */
int contact_quantities_measure(const struct contact_quantities *quantities,
                               const struct measure_context *context,
                               const struct contact_pressed *pressed,
                               const struct contact_area *area, double *values, struct error *err);
/* Puts the values of a load on the path of falling ones into values[measure * stride], of all
 * measures. */
void contact_quantities_measure_falling(const struct contact_case *one_case,
                                        const struct measure_context *context,
                                        const struct contact_state *state, size_t stride,
                                        double *values);
/* Fills the measures that are made of all loads together: contact_quantity.complete, with the case
 * of the context, whose loads may be others than those of the quantities. */
int contact_quantities_complete(const struct contact_quantities *quantities,
                                const struct measure_context *context, const double *z,
                                size_t stride, double *values, struct error *err);

#endif
