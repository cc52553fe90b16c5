/* Files of the steps that a case keeps of its realisations. A realisation is made and pressed again
 * for them: study and seed give the same bits as when it was measured. */
#ifndef RUGO_JOBS_KEPT_STEPS_H
#define RUGO_JOBS_KEPT_STEPS_H

#include "jobs/kind.h"

struct kept_order {
    const struct job_kind *kind;
    const cJSON *parameters; /* of the case */
    struct random_key key;   /* of its first realisation */
    uint64_t case_number;
    const char *folder; /* gets nodes/case-K/realisation-R/MODEL/ with step_folder.h's files */
    int (*stop)(void *context); /* as of steps; may be NULL */
    void *stop_context;
    /* Is called for a model without a solution, whose files hold the loads before; err->text has
     * the case, the realisation and the reason. */
    void (*unsolved)(const struct error *err);
};
/* Writes nothing for a case that keeps nothing. Files of an earlier run are replaced. */
int kept_steps_write(const struct kept_order *order, struct error *err);

#endif
