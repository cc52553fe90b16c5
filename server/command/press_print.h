/* What `press` prints: a table for people, or JSON. */
#ifndef RUGO_SERVER_COMMAND_PRESS_PRINT_H
#define RUGO_SERVER_COMMAND_PRESS_PRINT_H

#include "core/map/preparation.h"
#include "server/command/press_solver.h"

/* The loads of one map. */
struct press_report {
    const struct press *press; /* borrowed, as all here */
    const struct preparation_record *record;
    const char *boundary;    /* "open", "mirrored", "periodic" */
    const char *boundary_by; /* "option", "seam", "holes", "window" */
    const char *model;
    double modulus;  /* E* in Pa; 0: not known */
    bool metres;     /* the map's lengths are */
    double map_area; /* of a profile its length */
    size_t loads;
    double (*values)[PRESS_VALUES];
    double (*errors)[PRESS_VALUES]; /* of them by the points (press_error.h); NULL: not asked for */
};

int press_print_table(const struct press_report *report, struct error *err);
int press_print_json(const struct press_report *report, struct error *err);

#endif
