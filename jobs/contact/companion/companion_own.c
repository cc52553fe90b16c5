#include "jobs/contact/companion/companion_own.h"
#include <string.h>

int companion_press_own(const struct companion_own *own, const struct contact_surface *surface,
                        struct contact_tally *tally, double *series,
                        const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    if (subset_has(&one_case->companions[COMPANION_PROBE].due, surface->key.realisation)) {
        memcpy(series, contact_tally_series(tally, COMPANION_PROBE, 0, 0),
               measure_paired(one_case) * contact_case_slots(one_case) * sizeof *series);
        return 0;
    }
    const struct level_source source = {own->rms_height, surface->key};
    int status =
        contact_level_sample(own->level, &one_case->surface, &source, surface->z, own->z, err);
    return status != 0 ? status : coarse_solver_press(own->halfspace, own->z, series, stopper, err);
}
