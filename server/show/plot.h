/* An SVG of one quantity: curves of the cases with their error bars, and the theories. */
#ifndef RUGO_SERVER_SHOW_PLOT_H
#define RUGO_SERVER_SHOW_PLOT_H

#include "schema/result/result.h"
#include <stdio.h>

struct plot_request {
    const char *quantity;
    const char *y_label; /* of curves in one unit; NULL: that of the first */
    bool logarithmic;    /* both axes, whatever the kind's view says, and theories as a whole */
};
/* What is drawn of many curves is said in the legend (plot_choice.h). Write errors are left to the
 * file's own flag. ERROR_ABSENT when no case has the quantity. */
int plot_quantity(const struct study_result *study, const struct plot_request *request, FILE *file,
                  struct error *err);

#endif
