/* Surfaces that hold the measured patch and go on as its law says (FORMULAS.md, F18.50). The patch
 * is sent with the study, so that neither service nor workers need the file. */
#ifndef RUGO_JOBS_LIKE_LIKE_HOLD_H
#define RUGO_JOBS_LIKE_LIKE_HOLD_H

#include "core/map/height_map.h"
#include "jobs/like/like_case.h"

/* Writes heights over a length as the text of a study, for the caller to free. ERROR_INPUT for more
 * than LIKE_PATCH_POINTS; ERROR_MEMORY. */
int like_hold_text(char **out, const struct height_map *map, double length, struct error *err);

/* Reads the patch that the surfaces of a case hold, if they hold one; adds faults where it is not
 * that of the case, or does not suit its other parameters. Fails with ERROR_MEMORY alone. */
int like_hold_read(struct surface_case *surface, const struct like_case *like,
                   struct values *values, struct error *err);

/* The error of the mean over n draws, with this deviation, as a value of the one surface: no
 * correction, and the half width of the 95 % interval of one more draw. */
struct like_error like_hold_error(double deviation, size_t n);

#endif
