/* How the results of contact studies are shown: the contact area over the load. */
#include "jobs/contact/contact_view.h"
#include "schema/result/view.h"

static const char *const SCALARS[] = {"kappa", "erf_kappa", NULL};
static const char *const LEFT_OUT[] = {"persson_light_load", "bgt_light_load", NULL};
static const struct logarithmic_picture LOGARITHMIC[] = {{"contact_area", "light"}, {NULL, NULL}};
static const struct quantity_table TABLE = {
    .quantity = "contact_area",
    .title = "contact area",
    .value = "area",
    .x = "load",
    .error_words = {[ERROR_DISCRETISATION] = "mesh"},
    .legend =
        "load: p/(E* h'_rms); area: A/A0, +- one standard error; mesh %: error from the limit "
        "of the levels, model %: of the limit from that of the most complete model",
    .scalars = SCALARS,
    .left_out = LEFT_OUT,
};
const struct result_view CONTACT_VIEW = {.table = &TABLE, .logarithmic = LOGARITHMIC};
