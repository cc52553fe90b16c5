#include "worker/publish/publish.h"
#include "worker/log.h"
#include "worker/publish/aggregate.h"

struct caller {
    bool (*stop)(void *context);
    void *context;
};

static int publish_one(void *context, struct store *store, const struct due_case *due,
                       struct error *err) {
    (void)context;
    int status = aggregate_publish(store, due->study, due->case_number, err);
    if (status != 0) {
        struct log_about about = {.study = due->study};
        log_line(LEVEL_WARNING, &about, "case %llu is not published: %s",
                 (unsigned long long)due->case_number, err->text);
    }
    return status;
}

static bool is_stopped(void *context) {
    struct caller *caller = context;
    return caller->stop != NULL && caller->stop(caller->context);
}

int publish_due(struct store *store, bool (*stop)(void *context), void *context,
                struct publish_counts *counts, struct error *err) {
    struct caller caller = {stop, context};
    struct publication publication = {.publish = publish_one, .stop = is_stopped, &caller};
    struct publish_counts own;
    return store_publish_due(store, &publication, counts != NULL ? counts : &own, err);
}
