/* The conductance of the contact by its elastic stiffness (core/quantity/conductance.h). On a
 * half-space without end it is the stiffness of the solution itself, under a hardness that of
 * unloading, to which yielded nodes contribute. Under other blocks half-spaces conduct through the
 * same nodes, which takes a solution of its own. */
#include "core/cost.h"
#include "core/quantity/conductance.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

struct quantity_state {
    struct conductance *conductance; /* NULL: the stiffness of the solution serves */
};

static const struct parameter ROWS[] = {
    {.path = "/contact/conductance",
     .type = PARAMETER_FLAG,
     .later = true,
     .example_json = "true",
     .help = "the conductance of the contact for current and heat, that of half-spaces which touch "
             "in its nodes; of full an analogy, by the nodes in contact of the deformed face"},
    {.path = "/contact/resistivity",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = 1e30,
     .above_minimum = true,
     .items_low = 1,
     .items_high = 2,
     .later = true,
     .unit = "ohm m",
     .example_json = "[1e-7]",
     .help = "electric resistivity of both faces, or of the rough one and the flat: curves of "
             "conductance are then in S/m^2, too, by /surface/unit"},
    {.path = "/contact/conductivity",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = 1e30,
     .above_minimum = true,
     .items_low = 1,
     .items_high = 2,
     .later = true,
     .unit = "W/(m K)",
     .example_json = "[50]",
     .help = "in place of it: thermal conductivity of both faces, or of the rough one and the "
             "flat: curves are in W/(m^2 K)"},
};
const struct parameter_table CONDUCTANCE_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

/* The units need resistivities alone (jobs/units.h), so that cases do not hold them. */
static bool asked(struct contact_case *one_case, struct values *values) {
    static const char *const UNITS[] = {"/contact/resistivity", "/contact/conductivity"};
    bool conducts = values_flag(values, "/contact/conductance");
    (void)one_case;
    for (size_t u = 0; u < 2; u++)
        if (!conducts && values_is_given(values, UNITS[u]))
            values_fault(values, UNITS[u], "nothing conducts unless /contact/conductance is true");
    if (values_is_given(values, UNITS[0]) && values_is_given(values, UNITS[1]))
        values_fault(values, UNITS[1], "give it or /contact/resistivity, not both");
    if (conducts && values_is_given(values, "/contact/coating/thickness"))
        values_fault(values, ROWS[0].path,
                     "what passes a coating is not known from its contact; leave one of them out");
    return conducts;
}

/* Returns whether the stiffness of solutions is that of half-spaces without end. */
static bool is_halfspace(const struct quantity_scene *scene) {
    return scene->exact && isinf(scene->block.height) && !block_is_coated(&scene->block);
}

static double bytes_of(const struct quantity_scene *scene) {
    return is_halfspace(scene) ? 0 : conductance_bytes(&scene->grid, scene->open);
}

/* A held set takes about as long as a load at this tolerance. */
static double seconds_of(const struct quantity_scene *scene) {
    static const double TOLERANCE = 1e-3;
    return is_halfspace(scene)
               ? 0
               : cost_linear_contact(&scene->grid, TOLERANCE, scene->one_case->load_count);
}

static void destroy(struct quantity_state **state) {
    if (*state != NULL)
        conductance_destroy(&(*state)->conductance);
    free(*state);
    *state = NULL;
}

static int create(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err) {
    struct quantity_state *state = array_create(1, sizeof *state);
    if (state == NULL)
        return error_memory(err, sizeof *state, "a conductance");
    int status = 0;
    if (!is_halfspace(scene))
        status = conductance_create(&state->conductance, &scene->grid, scene->open, err);
    if (status != 0)
        destroy(&state);
    *out = state;
    return status;
}

/* None in full contact, as the stiffness there. */
static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    const struct contact_state *contact = &pressed->state;
    double own = isnan(contact->unload_stiffness) ? contact->stiffness : contact->unload_stiffness;
    double stiffness =
        state->conductance == NULL ? own : conductance_measure(state->conductance, contact->p);
    (void)err;
    (void)area;
    *values = measure_stiffness(context, stiffness);
    return 0;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[CONDUCTANCE_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

static const struct measure MEASURES[] = {{.quantity = "conductance",
                                           .series = "",
                                           .y_label = "G (rho1 + rho2) sqrt(m0)/(2 h'_rms)",
                                           .shown = is_shown,
                                           .kept = is_asked,
                                           .order = 2,
                                           .theories = THEORIES_NONE,
                                           .solver = SOLVER_STIFFNESS,
                                           .field = FIELD_GAP,
                                           .load = LOAD_FALLS,
                                           .cell = CELL_SAME,
                                           .values = VALUES_REPORTED,
                                           .over = OVER_STIFFNESS}};

const struct contact_quantity CONDUCTANCE_QUANTITY = {.measures = MEASURES,
                                                      .tangent = true,
                                                      .read = asked,
                                                      .bytes = bytes_of,
                                                      .seconds = seconds_of,
                                                      .create = create,
                                                      .destroy = destroy,
                                                      .measure = measure};
