#include "server/command/access/access_source.h"

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct access_origin *origin = context;
    return access_results(origin->access, origin->id, filter, out, err);
}

static int difference(const void *context, const struct comparison *comparison,
                      struct study_result *out, struct error *err) {
    const struct access_origin *origin = context;
    return access_difference(origin->access, origin->id, comparison, out, err);
}

struct picture_source access_source(const struct access_origin *origin) {
    return (struct picture_source){origin, results, difference};
}
