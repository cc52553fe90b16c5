/* What is measured of each load: a value, or none (NaN), a realisation, model, level and load. */
#ifndef RUGO_JOBS_CONTACT_MEASURE_H
#define RUGO_JOBS_CONTACT_MEASURE_H

enum { MODEL_MEASURES_MOST = 5 };
enum contact_measure {
    MEASURE_NODES, /* share of the cell, as all areas */
    MEASURE_EDGES,
    MEASURE_EDGES_STRETCHED, /* edges as they are under load; surfaces with a scale alone */
    MEASURE_PERIMETER,       /* surfaces alone */
    MEASURE_GAP,             /* mean gap/sqrt(m0) */
    MEASURE_NODES_LOWER,
    MEASURE_NODES_UPPER,
    MEASURE_STIFFNESS, /* -d(p/(E* h'))/d(gap/sqrt(m0)); none in full contact */
    MEASURE_PATCHES,
    MEASURE_PATCH_MEAN, /* share of the cell; none without patches */
    MEASURE_PATCH_LARGEST,
    MEASURE_KAPPA, /* of the line area = kappa load through the loads up to this one, by edges */
    MEASURE_POWER_LAW_A, /* likewise of area = a load^b; none at the first load */
    MEASURE_POWER_LAW_B,
    MEASURE_PAIRED, /* measures above: differences are summed too */
    MEASURE_ITERATIONS = MEASURE_PAIRED,
    MEASURE_WORK, /* transforms of the level's grid */
    MEASURE_VIOLATION,
    MEASURE_PENETRATION, /* of the weighted gap */
    MEASURE_OWN,         /* from here on those of the model, each its own (model.h) */
    MEASURE_COUNT = MEASURE_OWN + MODEL_MEASURES_MOST
};

#endif
