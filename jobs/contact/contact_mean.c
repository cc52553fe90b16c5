#include "jobs/contact/contact_mean.h"

/* The most complete of the other models that has a value of every realisation at this load of the
 * level; model_count without one. */
static size_t whole_model(const struct contact_tally *tally, enum contact_measure measure,
                          size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t found = one_case->model_count;
    for (size_t m = 0; m < one_case->model_count; m++) {
        size_t cell = contact_case_cell(one_case, m, level, load);
        bool better = found == one_case->model_count ||
                      one_case->models[m]->rank > one_case->models[found]->rank;
        if (m != contact_case_complete(one_case) && better &&
            contact_tally_valueless(tally, measure, cell) == 0)
            found = m;
    }
    return found;
}

size_t contact_mean_control(const struct contact_tally *tally, enum contact_measure measure,
                            size_t model, size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t cell = contact_case_cell(one_case, model, level, load);
    uint64_t valueless = contact_tally_valueless(tally, measure, cell);
    bool controlled = measure < MEASURE_PAIRED && valueless > 0 &&
                      valueless < tally->realisations && model == contact_case_complete(one_case) &&
                      level + 1 == one_case->level_count;
    return controlled ? whole_model(tally, measure, level, load) : one_case->model_count;
}

struct estimate contact_mean(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model, size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t control = contact_mean_control(tally, measure, model, level, load);
    if (control == one_case->model_count)
        return contact_tally_mean(tally, measure, contact_case_cell(one_case, model, level, load));
    struct estimate all =
        contact_tally_mean(tally, measure, contact_case_cell(one_case, control, level, load));
    struct estimate less = contact_tally_model(tally, measure, control, load);
    /* The two errors may go together. */
    return (struct estimate){all.value - less.value, all.standard_error + less.standard_error};
}
