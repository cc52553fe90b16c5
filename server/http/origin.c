#include "server/http/origin.h"

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    struct store *reader;
    int status = exchange_reader(origin->exchange, &reader, err);
    if (status == 0)
        status = aggregate_study(reader, origin->id, filter, out, err);
    service_give_back(origin->exchange->service, reader);
    return status;
}

static int difference(const void *context, const struct comparison *comparison,
                      struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    struct store *reader;
    int status = exchange_reader(origin->exchange, &reader, err);
    if (status == 0)
        status = comparison_make(reader, origin->id, comparison, out, err);
    service_give_back(origin->exchange->service, reader);
    return status;
}

struct picture_source origin_source(const struct origin *origin) {
    return (struct picture_source){origin, results, difference};
}
