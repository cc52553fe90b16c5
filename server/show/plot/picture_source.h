/* Where pictures and tables get results from: a store or a service, behind two functions. */
#ifndef RUGO_SERVER_SHOW_PLOT_PICTURE_SOURCE_H
#define RUGO_SERVER_SHOW_PLOT_PICTURE_SOURCE_H

#include "worker/publish/aggregate.h"
#include "worker/publish/comparison.h"

/* Who asks gives these; each fills an empty document, which the caller clears also after a failure.
 */
struct picture_source {
    const void *context;
    int (*results)(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err);
    int (*difference)(const void *context, const struct comparison *comparison,
                      struct study_result *out, struct error *err);
};

#endif
