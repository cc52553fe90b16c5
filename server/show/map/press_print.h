/* What `press` prints of the contact of a map: a table for people, or JSON. */
#ifndef RUGO_SERVER_SHOW_MAP_PRESS_PRINT_H
#define RUGO_SERVER_SHOW_MAP_PRESS_PRINT_H

#include "core/map/preparation.h"
#include "jobs/maps/map_press.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* The loads of one map; borrows all. */
struct press_report {
    const struct map_press *press;
    const struct preparation_record *record;
    const char *boundary;    /* "open", "mirrored", "periodic" */
    const char *boundary_by; /* "option", "seam", "holes", "window" */
    size_t model_count;
    const struct press_series *series; /* one a model */
    double modulus;                    /* E* in Pa; 0: not known */
    double resistivity;                /* of both bodies, ohm m or m K/W; 0: not known */
    bool heat;                         /* to heat, else to current */
    bool metres;                       /* the map's lengths are */
    double map_area;                   /* of a profile its length */
    size_t loads;
    bool with_errors;               /* they are estimated (map_press_error.h) */
    double cpu_seconds, peak_bytes; /* of the process so far */
    struct case_result *result; /* curves (map_press_curves.h), of which the columns are printed */
};

/* Prints how the map was prepared and what the command took; for each model heading, values, those
 * in physical units where these are known, and errors by source. */
void press_print_table(FILE *file, const struct press_report *report);
/* Returns the same as a document, for the caller to delete; NULL when out of memory. What several
 * models have of their own is an element of "models" for each. */
cJSON *press_document(const struct press_report *report);

#endif
