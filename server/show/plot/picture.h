/* The picture of whatever a name stands for in a study: curves of a quantity, the density of one
 * case, a scalar over a parameter. Results are asked for as the picture needs them, from a store or
 * a service. */
#ifndef RUGO_SERVER_SHOW_PLOT_PICTURE_H
#define RUGO_SERVER_SHOW_PLOT_PICTURE_H

#include "server/show/plot/picture_source.h"
#include "server/show/plot/plot.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/comparison.h"
#include <stdio.h>

struct picture_request {
    const char *quantity;     /* of curves, a scalar's name, or QUANTITY@X */
    const char *x;            /* a parameter, for a scalar or a value of curves; NULL: chosen */
    const char *const *where; /* cases to draw, as of a table (case_table.h); NULL: all */
    const char *colour, *dash, *panel; /* what differs between lines (plot_lines.h); NULL: chosen */
    const char *model, *series, *level; /* of curves: these alone; NULL: all */
    const char *width;                  /* on paper (plot_layout.h); NULL: for screens */
    int axes;                           /* enum plot_axes */
    bool without_total;                 /* standard errors alone */
    int64_t case_number; /* of curves, without where; -1: all, of a density the first begun */
    const struct comparison *difference; /* of curves, in place of cases; NULL: none */
};
/* Draws the picture. ERROR_ABSENT for a name that no case has, ERROR_INPUT for a part of the
 * request that does not belong to what is drawn. Write errors are left to the file's own flag. */
int picture_draw(const struct picture_source *source, const struct picture_request *request,
                 FILE *file, struct error *err);

/* Draws curves of results that are at hand, or the density of the first case that has it. */
int picture_of_results(const struct study_result *study, const char *quantity, FILE *file,
                       struct error *err);

#endif
