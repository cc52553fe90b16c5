/* A kind of study with one parameter of every sort, for tests of the schema. */
#ifndef RUGO_TESTS_SUPPORT_FAKE_KIND_H
#define RUGO_TESTS_SUPPORT_FAKE_KIND_H

#include "schema/study/fault.h"
#include "schema/study/study.h"
#include <math.h>

static const struct choice FAKE_COLOURS[] = {{"red", 3}, {"green", 1}, {0}};
static const struct choice FAKE_SHAPES[] = {{"round", 0}, {"square", 1}, {"oval", 2}, {0}};
static const struct choice FAKE_DEPTHS[] = {{"endless", 0}, {0}};
static const struct choice FAKE_UNITS[] = {{"metres", 0}, {"feet", 1}, {0}};
static const struct parameter FAKE_ROWS[] = {
    {.path = "/box/width",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1,
     .above_minimum = true,
     .required = true,
     .sweep = true,
     .help = "in metres"},
    {.path = "/box/count",
     .type = PARAMETER_INTEGER,
     .minimum = 1,
     .maximum = INFINITY,
     .sweep = true,
     .default_json = "2",
     .help = "of boxes"},
    {.path = "/box/colour",
     .type = PARAMETER_CHOICE,
     .choices = FAKE_COLOURS,
     .sweep = true,
     .default_json = "\"red\"",
     .help = "of the box"},
    {.path = "/bins",
     .type = PARAMETER_NUMBERS,
     .minimum = -9,
     .maximum = 9,
     .items_low = 2,
     .items_high = 3,
     .sweep = true,
     .default_json = "[0,1]",
     .help = "low, high, middle"},
    {.path = "/shapes",
     .type = PARAMETER_CHOICES,
     .choices = FAKE_SHAPES,
     .default_json = "\"round\"",
     .help = "of the lids"},
    {.path = "/depth",
     .type = PARAMETER_MEASURE,
     .choices = FAKE_DEPTHS,
     .units = FAKE_UNITS,
     .minimum = 0,
     .maximum = 10,
     .above_minimum = true,
     .sweep = true,
     .help = "of a box"},
    {.path = "/seconds",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = INFINITY,
     .default_json = "1",
     .help = "a realisation takes"},
};

static const struct parameter_table FAKE_PARAMETERS = {"boxes", FAKE_ROWS,
                                                       sizeof FAKE_ROWS / sizeof *FAKE_ROWS};
static const struct parameter_table *const FAKE_TABLES[] = {&FAKE_PARAMETERS, NULL};

/* Refuses width 0.5 together with 7 boxes; a worker needs a byte a box; costs /seconds. */
static inline int fake_check(const struct study_kind *kind, const cJSON *parameters,
                             double memory_limit, struct fault_list *faults,
                             struct study_cost *cost, struct error *err) {
    (void)kind;
    (void)memory_limit;
    (void)err;
    double count = json_at(parameters, "/box/count")->valuedouble;
    if (json_at(parameters, "/box/width")->valuedouble == 0.5 && count == 7)
        fault_add(faults, "/box/count", "seven boxes are too many for half a metre");
    *cost = (struct study_cost){.nx = 1,
                                .ny = 1,
                                .memory_bytes = count,
                                .seconds = json_at(parameters, "/seconds")->valuedouble};
    return 0;
}

static const struct study_kind FAKE_KIND = {
    .name = "boxes", .tables = FAKE_TABLES, .default_realisations = 100, .check = fake_check};
static const struct study_kind *const FAKE_KINDS[] = {&FAKE_KIND, NULL};

#endif
