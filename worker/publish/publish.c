#include "worker/publish/publish.h"
#include "worker/log.h"
#include "worker/publish/aggregate.h"
#include <stdlib.h>

struct caller {
    bool (*stop)(void *context);
    void *context;
    struct merged_case *merged; /* PUBLICATION_GROUP of them */
};

/* Logs why a case is not published; returns status. */
static int log_failure(const struct due_case *due, int status, const struct error *err) {
    struct log_about about = {.study = due->study};
    if (status != 0)
        log_line(LEVEL_WARNING, &about, "case %llu is not published: %s",
                 (unsigned long long)due->case_number, err->text);
    return status;
}

static int prepare_one(void *context, struct store *store, const struct due_case *due,
                       size_t number, struct error *err) {
    struct caller *caller = context;
    int status =
        aggregate_prepare(store, due->study, due->case_number, &caller->merged[number], err);
    return log_failure(due, status, err);
}

static int publish_one(void *context, struct store *store, const struct due_case *due,
                       size_t number, struct error *err) {
    struct caller *caller = context;
    return log_failure(due, aggregate_write(store, &caller->merged[number], err), err);
}

static void clear_all(void *context) {
    struct caller *caller = context;
    for (size_t n = 0; n < PUBLICATION_GROUP; n++)
        merged_case_clear(&caller->merged[n]);
}

static bool is_stopped(void *context) {
    struct caller *caller = context;
    return caller->stop != NULL && caller->stop(caller->context);
}

int publish_due(struct store *store, bool (*stop)(void *context), void *context,
                struct publish_counts *counts, struct error *err) {
    struct caller caller = {stop, context, array_create(PUBLICATION_GROUP, sizeof *caller.merged)};
    struct publication publication = {.prepare = prepare_one,
                                      .publish = publish_one,
                                      .clear = clear_all,
                                      .stop = is_stopped,
                                      .context = &caller};
    struct publish_counts own;
    if (caller.merged == NULL)
        return error_memory(err, PUBLICATION_GROUP * sizeof *caller.merged, "merged cases");
    int status = store_publish_due(store, &publication, counts != NULL ? counts : &own, err);
    free(caller.merged);
    return status;
}
