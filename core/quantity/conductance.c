#include "core/quantity/conductance.h"
#include "core/contact/contact.h"
#include "core/contact/free_space.h"
#include <math.h>
#include <stdlib.h>

static const struct block HALFSPACE = {
    .model = MODEL_HALFSPACE, .height = INFINITY, .layer_growth = 1};
static const double RESIDUAL = 1e-3; /* over the potential */

struct conductance {
    struct compliance *compliance; /* owned, as the next */
    struct contact *contact;
};

int conductance_create(struct conductance **out, const struct grid *grid, bool open,
                       struct error *err) {
    struct conductance *made = array_create(1, sizeof *made);
    if (made == NULL)
        return error_memory(err, sizeof *made, "a conductance");
    int status = open ? compliance_create_open(&made->compliance, grid, &HALFSPACE, err)
                      : compliance_create(&made->compliance, grid, &HALFSPACE, err);
    if (status == 0)
        status = contact_create(&made->contact, made->compliance, &CONTACT_DEFAULTS, err);
    if (status != 0)
        conductance_destroy(&made);
    *out = made;
    return status;
}

void conductance_destroy(struct conductance **conductance) {
    struct conductance *gone = *conductance;
    if (gone == NULL)
        return;
    contact_destroy(&gone->contact);
    compliance_destroy(&gone->compliance);
    free(gone);
    *conductance = NULL;
}

double conductance_bytes(const struct grid *grid, bool open) {
    return contact_bytes(grid, &HALFSPACE, &CONTACT_DEFAULTS) + compliance_bytes(grid, &HALFSPACE) +
           (open ? free_space_bytes(grid) : 0);
}

double conductance_measure(struct conductance *conductance, const double *p) {
    return contact_held_stiffness(conductance->contact, p, RESIDUAL);
}
