/* What is reported of the contact of one map, which `press` prints. */
#ifndef RUGO_SERVER_SHOW_MAP_PRESS_REPORT_H
#define RUGO_SERVER_SHOW_MAP_PRESS_REPORT_H

#include "core/map/preparation/preparation.h"
#include "jobs/maps/press/map_press.h"

/* The loads of one map; borrows all. */
struct press_report {
    const struct map_press *press;
    const struct preparation_record *record;
    const char *boundary;    /* "open", "mirrored", "periodic" */
    const char *boundary_by; /* "option", "seam", "instrument", "holes", "window", "model" */
    size_t model_count;
    const struct press_series *series; /* one a model */
    double modulus;                    /* E* in Pa; 0: not known */
    double resistivity;                /* of both bodies, ohm m or m K/W; 0: not known */
    bool heat;                         /* to heat, else to current */
    bool metres;                       /* the map's lengths are */
    const char *unit_note;             /* that of height_map.h; NULL: there is none */
    double map_area;                   /* of a profile its length */
    size_t loads;
    bool with_errors;               /* they are estimated (map_press_error.h) */
    double cpu_seconds, peak_bytes; /* of the process so far */
    struct case_result *result; /* curves (map_press_curves.h), of which the columns are printed */
};

#endif
