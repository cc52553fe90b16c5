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
        "load: p/(E* h'_rms); area: A/A0, +- one standard error; errors in percent of it, what is "
        "told less what is true: mesh, from the limit of the levels; cell, from a very long one; "
        "block, from an infinitely high one; model, from the limit of the most complete one; "
        "generation, from surfaces found in other ways",
    .scalars = SCALARS,
    .left_out = LEFT_OUT,
};
const struct result_view CONTACT_VIEW = {.table = &TABLE, .logarithmic = LOGARITHMIC};
