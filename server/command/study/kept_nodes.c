#include "server/command/study/kept_nodes.h"
#include "jobs/kept_steps.h"
#include "server/command/command.h"
#include <stdio.h>

static int is_stopped(void *context) {
    (void)context;
    return atomic_load(&stop_requested);
}

static void warn(const struct error *err) {
    fprintf(stderr, "rugo run: warning: no nodes: %s\n", err->text);
}

static int write_case(struct store *store, const char *id, const struct study_status *study,
                      struct kept_order *order, struct error *err) {
    struct case_info info = {0};
    int status = store_case(store, id, order->case_number, &info, err);
    if (status == 0) {
        order->parameters = info.parameters;
        order->key =
            (struct random_key){study->seed, study_sequence(study->random, order->case_number), 0};
        status = kept_steps_write(order, err);
    }
    case_info_clear(&info);
    return status;
}

int kept_nodes_write(struct store *store, const char *id, const char *folder, struct error *err) {
    struct study_status study = {0};
    int status = store_status(store, id, &study, err);
    if (status != 0)
        return status;
    struct kept_order order = {
        .kind = kind_find(study.kind), .folder = folder, .stop = is_stopped, .unsolved = warn};
    bool may_keep = order.kind != NULL && order.kind->kept != NULL && study.realisations > 0;
    for (uint64_t c = 0; c < study.cases && may_keep && status == 0; c++) {
        order.case_number = c;
        status = write_case(store, id, &study, &order, err);
    }
    study_status_clear(&study);
    return status;
}
