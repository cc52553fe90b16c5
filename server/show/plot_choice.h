/* Which curves of a quantity one picture shows: as many as its legend can name. */
#ifndef RUGO_SERVER_SHOW_PLOT_CHOICE_H
#define RUGO_SERVER_SHOW_PLOT_CHOICE_H

#include "schema/result/result.h"

enum { PLOT_LINES = 12, PLOT_LABEL_SIZE = 200 };

struct plot_line { /* borrows */
    const struct case_result *one;
    const struct curve *curve;
    size_t colour;     /* shared by the levels of one series */
    size_t coarseness; /* levels of the series above this one: 0 for the finest */
};
struct plot_choice {
    const struct study_result *study; /* borrowed */
    size_t count;
    struct plot_line lines[PLOT_LINES];
    char left_out[PLOT_LABEL_SIZE]; /* what is shown of more: "finest level"; "" for everything */
};
/* Curves of a quantity with this label of their y axis (NULL: of the first one). Where they are
 * more than PLOT_LINES the choice narrows, as far as needed, to estimates without their brackets,
 * to the finest level, to the first series, to the first model, to the first curves. count is 0
 * where no case has the quantity. */
void plot_choose(struct plot_choice *choice, const struct study_result *study, const char *quantity,
                 const char *y_label);
/* Writes what tells a line from the others: "hurst 0.8, halfspace, edges, level 8". */
void plot_label(const struct plot_choice *choice, size_t line, char label[PLOT_LABEL_SIZE]);

#endif
