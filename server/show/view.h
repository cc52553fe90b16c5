/* How the results of a kind are shown, looked up by the kind's name. */
#ifndef RUGO_SERVER_SHOW_VIEW_H
#define RUGO_SERVER_SHOW_VIEW_H

#include "schema/result/view.h"

/* Returns the view of a kind; a plain one for a kind without a view, or of another program (NULL).
 */
const struct result_view *view_of(const char *kind);
/* Returns the picture of a quantity with logarithmic axes, or NULL. */
const struct logarithmic_picture *view_logarithmic(const struct result_view *view,
                                                   const char *quantity);
/* Returns what the series of a curve of this case shows, or NULL where its name says so. Static. */
const char *view_series_name(const struct result_view *view, const struct case_result *one,
                             const char *series);
/* Returns how people call a quantity, a series, a theory or a scalar in a title: its own name where
 * the view does not say. Borrowed from either. */
const char *view_words(const struct result_view *view, const char *name);
/* Returns what stands at an axis for a label of curves, or for a scalar, likewise. */
const char *view_label(const struct result_view *view, const char *label);

#endif
