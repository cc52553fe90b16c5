/* The measures of a solved load: a value, or none (NaN), for each realisation, model, level and
 * load. A measure is a name in the enum and a row of the list in contact_measure.c; nothing else
 * lists them. Those of quantities that a study may ask for (quantity/quantity.h) are rows there.
 * Partial results hold measures in the order of the enum. */
#ifndef RUGO_JOBS_CONTACT_MEASURE_H
#define RUGO_JOBS_CONTACT_MEASURE_H

#include <stdbool.h>
#include <stddef.h>

enum { MODEL_MEASURES_MOST = 5, QUANTITY_MEASURES_MOST = 40 };
enum contact_measure {
    MEASURE_NODES, /* share of the cell, as all areas */
    MEASURE_EDGES,
    MEASURE_EDGES_STRETCHED, /* edges as they are under load; surfaces with a scale alone */
    MEASURE_PERIMETER,       /* surfaces alone */
    MEASURE_GAP,             /* mean gap/sqrt(m0) */
    MEASURE_NODES_LOWER,
    MEASURE_NODES_UPPER,
    MEASURE_EDGES_UNKNOWN, /* by how much edges and perimeter may be off where the law of edges does
                              not hold: beside yielded nodes, and where the face ends in a side */
    MEASURE_STIFFNESS,     /* -d(p/(E* h'))/d(gap/sqrt(m0)); none in full contact */
    MEASURE_PATCHES,
    MEASURE_PATCH_MEAN, /* share of the cell; none without patches */
    MEASURE_PATCH_LARGEST,
    MEASURE_KAPPA, /* of the line area = kappa load through the loads up to this one, by edges */
    MEASURE_POWER_LAW_A, /* likewise of area = a load^b; none at the first load */
    MEASURE_POWER_LAW_B,
    MEASURE_ERF_KAPPA,  /* likewise of area = erf(sqrt(pi)/2 kappa load) */
    MEASURE_QUANTITIES, /* from here on those of quantities, in the order of their table */
    MEASURE_FITS = MEASURE_QUANTITIES - MEASURE_KAPPA,            /* the last of those above */
    MEASURE_PAIRED = MEASURE_QUANTITIES + QUANTITY_MEASURES_MOST, /* measures above: differences
                                                                     are summed too */
    MEASURE_ITERATIONS = MEASURE_PAIRED,
    MEASURE_WORK, /* transforms of the level's grid */
    MEASURE_VIOLATION,
    MEASURE_PENETRATION, /* of the weighted gap */
    MEASURE_OWN,         /* from here on those of the model, each its own (model/model.h) */
    MEASURE_COUNT = MEASURE_OWN + MODEL_MEASURES_MOST
};

/* The theories of its curve (contact_curves.c). */
enum measure_theories {
    THEORIES_NONE,
    THEORIES_AREA,
    THEORIES_GAP,
    THEORIES_PLASTIC,
    THEORIES_KINDS
};
/* How the solver's tolerance changes it: smoothly with the forces; as a gap, which is closed within
 * a length; by counted points, one of which may fall on either side; as a stiffness, to which few
 * open points matter as much as few in contact; as a flow, which narrow passages decide, or a work,
 * which is left of large ones; by patches, which a counted point may join or divide; or by points
 * in bins of pressure. */
enum measure_solver {
    SOLVER_SMOOTH,
    SOLVER_GAP,
    SOLVER_COUNTED,
    SOLVER_STIFFNESS,
    SOLVER_FLOW,
    SOLVER_PATCHES,
    SOLVER_BINNED
};
/* The field of a solution that it is measured on. */
enum measure_field { FIELD_NONE, FIELD_PRESSURE, FIELD_GAP };
/* Whether it falls with the load where that is light. */
enum measure_load { LOAD_STAYS, LOAD_FALLS };
/* What it is in a cell n times as large: the same; n times it; an nth of it; without a limit in
 * large cells; or the same for each point of the grid, and its curve is for all points. */
enum measure_cell { CELL_SAME, CELL_GROWS, CELL_SHRINKS, CELL_UNLIMITED, CELL_POINT, CELL_KINDS };
/* What its value is over: 1, the area of the cell, E* h', the RMS height, the stiffness
 * E* h'/RMS height, or the work E* h' times the RMS height. By it a value is taken from one map to
 * another under the same force. */
enum measure_over {
    OVER_ONE,
    OVER_AREA,
    OVER_PRESSURE,
    OVER_HEIGHT,
    OVER_STIFFNESS,
    OVER_WORK,
    OVER_KINDS
};
/* What its curve runs over: the loads; the share of full slip at the load that friction is asked
 * at, from the load below it down (contact_case_point); or how far the flat has gone under that
 * load, with values of its own (contact_case_values). */
enum measure_by { BY_LOAD, BY_SLIP, BY_SLIDING };
/* Which solved realisations have a value: some; all, or a partial result is refused; some, and its
 * curve reports how many have none. */
enum measure_values { VALUES_SOME, VALUES_ALL, VALUES_REPORTED };

struct contact_case;
struct measure {
    const char *quantity, *series,
        *y_label; /* of its curve; NULL: it has none. CELL_GROWS, CELL_SHRINKS:
                     the label is without its unit, which is the cell
                     or, in the series "wave", a longest wave */
    bool (*shown)(const struct contact_case *one_case, size_t model); /* whether its curve is
                                                                       * shown */
    bool (*kept)(const struct contact_case *one_case); /* by realisation (contact_rows.h) */
    double order;                                      /* of its error in the mesh */
    enum measure_theories theories;
    enum measure_solver solver;
    enum measure_field field;
    enum measure_load load;
    enum measure_cell cell;
    enum measure_values values;
    enum measure_over over;
    enum measure_by by;
};
/* Returns the row of a measure; those of the models, and numbers that no quantity takes, have one
 * of zeros, which is not shown. measure: below MEASURE_COUNT. */
const struct measure *measure_row(size_t measure);
/* Returns whether a case may have values of a measure: all but those of quantities that it does not
 * ask for. */
bool measure_is_of(const struct contact_case *one_case, size_t measure);
/* Returns how many measures below MEASURE_PAIRED have sums of differences: less than that in a case
 * that asks for no quantity behind. */
size_t measure_paired(const struct contact_case *one_case);
/* In the order of their curves in a result. */
extern const enum contact_measure MEASURE_CURVES[MEASURE_OWN];

#endif
