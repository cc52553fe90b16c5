/* Partial slip under a tangential load Q at a constant normal load P, by Ciavarella (1998) and
 * Jaeger (1998): what slips bears mu (p(P) - p(P*)), and what sticks is the contact of the lighter
 * load P* = P - Q/mu. So that loads of the study serve, at Q/(mu P) = 1 - P_k/P each (F26). After
 * yielding p(P*) is the contact of falling loads (quantity_unload.c). */
#include "core/contact/area.h"
#include "core/contact/slip/held.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

struct quantity_state {
    struct held *held; /* of surfaces with lay */
};

/* Its measures, in this order. Hidden are the stiffness across the face and the approach, up to a
 * constant, on the path that slips, and of isotropic surfaces the ratio of both stiffnesses. */
enum {
    STIFFNESS,
    STICK_EDGES,
    STICK_NODES,
    DISPLACEMENT,
    WORK,
    NORMAL,
    APPROACH,
    RATIO,
    FRICTION_MEASURES
};

_Static_assert((int)FRICTION_MEASURE + WORK == (int)SLIP_WORK &&
                   (int)FRICTION_MEASURE + RATIO == (int)FRICTION_RATIO,
               "what tests name");

#define FRICTION "/contact/friction"
static const char PRESSURE[] = "/contact/slip/pressure", DIRECTION[] = "/contact/slip/direction";
static const struct choice DIRECTIONS[] = {{"x", 0}, {"y", 1}, {0}};

static const struct parameter ROWS[] = {
    {.path = FRICTION,
     .symbol = "mu",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 10,
     .above_minimum = true,
     .sweep = true,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .example_json = "0.2",
     .help =
         "coefficient of friction: the block is pressed, and a tangential load then rises to "
         "full slip; what sticks, how far it gives, and what a cycle takes, by the loads "
         "below, to which some are added where they are far apart. With the model full, up to 1, "
         "at finite strain by how far the flat slides"},
    {.path = "/contact/slip/pressure",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = CONTACT_LOAD_NUMBER_MOST,
     .above_minimum = true,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .unit = "that of the loads",
     .example_json = "0.1",
     .help = "with friction: the load that is held while the tangential one rises; unless given "
             "the highest, with a hardness no other"},
    {.path = "/contact/slip/direction",
     .type = PARAMETER_CHOICE,
     .choices = DIRECTIONS,
     .later = true,
     .target_refusal = FRICTION_NO_TARGET,
     .example_json = "\"y\"",
     .help = "with friction: direction of the tangential load (x unless given), which matters on "
             "surfaces with lay"},
};
const struct parameter_table FRICTION_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};

static bool has_lay(const struct surface_case *surface) {
    return surface->spectrum.anisotropy > 1 ||
           (surface->plateau != NULL && surface->plateau->spectrum.anisotropy > 1) ||
           (surface->counter != NULL && surface->counter->spectrum.anisotropy > 1);
}

/* The load that is held is found among the loads, which are read behind (contact_case_read.c). */
static bool asked(struct contact_case *one_case, struct values *values) {
    bool slips = one_case->friction > 0;
    if (!slips && values_is_given(values, PRESSURE))
        values_fault(values, PRESSURE, "nothing slips unless " FRICTION " is given");
    if (!slips && values_is_given(values, DIRECTION))
        values_fault(values, DIRECTION, "nothing slips unless " FRICTION " is given");
    if (values_is_given(values, DIRECTION) && values_choice(values, DIRECTION) == 1) {
        one_case->slip_angle = M_PI / 2;
        if (surface_case_dimension(values) == 1)
            values_fault(values, DIRECTION, "\"y\": profiles have one direction, x");
    }
    slips = slips && !contact_case_slides(one_case); /* that is quantity_sliding.c */
    one_case->slip_measured = slips && has_lay(&one_case->surface);
    if (slips && contact_case_is_coated(one_case))
        values_fault(values, FRICTION,
                     "how a coating gives tangentially is not known from its contact; leave one of "
                     "them out");
    return slips;
}

static double bytes_of(const struct quantity_scene *scene) {
    return scene->one_case->slip_measured ? held_bytes(&scene->grid) : 0;
}

/* A held set takes about as long along the face as a load at this tolerance. */
static double seconds_of(const struct quantity_scene *scene) {
    static const double TOLERANCE = 1e-4;
    return scene->one_case->slip_measured
               ? cost_linear_contact(&scene->grid, TOLERANCE, scene->one_case->load_count)
               : 0;
}

static void destroy(struct quantity_state **state) {
    if (*state != NULL)
        held_destroy(&(*state)->held);
    free(*state);
    *state = NULL;
}

static int create(struct quantity_state **out, const struct quantity_scene *scene,
                  struct error *err) {
    struct quantity_state *state = NULL;
    int status = 0;
    if (scene->one_case->slip_measured) {
        state = array_create(1, sizeof *state);
        status = state != NULL ? held_create(&state->held, &scene->grid, scene->block.poisson, err)
                               : error_memory(err, sizeof *state, "a stiffness along the face");
        if (status != 0)
            destroy(&state);
    }
    *out = state;
    return status;
}

/* Returns the tangential stiffness over the normal one of isotropic contact (F26.2). */
static double isotropic_ratio(const struct contact_case *one_case) {
    double poisson = one_case->blocks[0].poisson;
    return one_case->surface.dimension == 1 ? 1 : (1 - poisson) / (1 - poisson / 2);
}

/* Returns the approach up to a constant, over the RMS height. In a cell it is what the mean gap
 * closes by, in free space that of far points. area: NULL on the path of falling loads. */
static double approach_of(const struct measure_context *context, const struct contact_state *state,
                          const struct contact_area *area) {
    bool corrected = area != NULL && !(context->one_case->hardness > 0);
    double gap = corrected ? area->mean_gap : state->mean_gap;
    return (context->free_space ? state->approach : -gap) / context->rms_height;
}

static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    const struct contact_state *contact = &pressed->state;
    const struct contact_case *one_case = context->one_case;
    double normal = one_case->hardness > 0 ? contact->unload_stiffness : contact->stiffness;
    values[RATIO] = isotropic_ratio(one_case);
    if (state != NULL && state->held != NULL) {
        static const double RESIDUAL = 1e-3; /* its square is the error */
        struct held_stiffness held;
        held_set_stop(state->held, context->stop, context->stop_context);
        int status =
            held_measure(state->held, contact->p, one_case->slip_angle, RESIDUAL, &held, err);
        if (status != 0)
            return status;
        values[RATIO] = held.ratio;
    }
    values[NORMAL] = measure_stiffness(context, normal);
    values[APPROACH] = approach_of(context, contact, area);
    values[STIFFNESS] = values[RATIO] * values[NORMAL];
    return 0;
}

static void measure_falling(const struct measure_context *context,
                            const struct contact_state *state, double *values) {
    values[NORMAL] = measure_stiffness(context, state->stiffness);
    values[APPROACH] = approach_of(context, state, NULL);
}

/* Returns the integral of the displacement over the tangential load between two loads, from the
 * values and slopes at both ends, exact for cubics. */
static double integral(double width, const double of[2], const double slope[2]) {
    return width * (of[0] + of[1]) / 2 + width * width * (slope[0] - slope[1]) / 12;
}

static int complete(struct quantity_state *state, const struct measure_context *context,
                    const double *z, size_t stride, double *values, struct error *err) {
    const struct contact_case *one_case = context->one_case;
    const bool yields = one_case->hardness > 0;
    const double *nodes = values + (yields ? (size_t)UNLOAD_AREA : MEASURE_NODES) * stride;
    const double *edges = values + MEASURE_EDGES * stride;
    double *own = values + FRICTION_MEASURE * stride;
    const double *approach = own + APPROACH * stride;
    const size_t top = one_case->slip_load;
    const double ratio = own[RATIO * stride + top], mu = one_case->friction;
    double under = 0; /* the curve of displacement */
    (void)state, (void)z, (void)err;
    for (size_t k = top; k-- > 0;) {
        double load = mu * (one_case->loads[top] - one_case->loads[k]);
        double ends[2], slopes[2];
        for (size_t e = 0; e < 2; e++) {
            ends[e] = mu / ratio * (approach[top] - approach[k + 1 - e]);
            slopes[e] = 1 / (ratio * own[NORMAL * stride + k + 1 - e]);
        }
        under += integral(mu * (one_case->loads[k + 1] - one_case->loads[k]), ends, slopes);
        own[STICK_EDGES * stride + k] = edges[k] / edges[top];
        own[STICK_NODES * stride + k] = nodes[k] / nodes[top];
        own[DISPLACEMENT * stride + k] = ends[1];
        own[WORK * stride + k] = 4 * load * ends[1] - 8 * under;
    }
    return 0;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[FRICTION_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

static bool is_edges_kept(const struct contact_case *one_case) {
    return is_asked(one_case) && one_case->edges && !(one_case->hardness > 0);
}

static bool is_edges_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_edges_kept(one_case);
}

static bool is_nodes_kept(const struct contact_case *one_case) {
    return is_asked(one_case) && (one_case->nodes || one_case->hardness > 0);
}

static bool is_nodes_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_nodes_kept(one_case);
}

static bool is_ratio_kept(const struct contact_case *one_case) {
    return is_asked(one_case) && one_case->slip_measured;
}

static bool is_ratio_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_ratio_kept(one_case);
}

static bool never_shown(const struct contact_case *one_case, size_t model) {
    (void)one_case, (void)model;
    return false;
}

static bool never_kept(const struct contact_case *one_case) {
    (void)one_case;
    return false;
}

#define STICK_LABEL "area that sticks/contact area"
static const struct measure MEASURES[FRICTION_MEASURES] = {
    [STIFFNESS] = {.quantity = "tangential_stiffness",
                   .series = "",
                   .y_label = "Kt sqrt(m0)/(E* h'_rms)",
                   .shown = is_shown,
                   .kept = is_asked,
                   .order = 1,
                   .theories = THEORIES_NONE,
                   .solver = SOLVER_STIFFNESS,
                   .field = FIELD_GAP,
                   .load = LOAD_FALLS,
                   .cell = CELL_SAME,
                   .values = VALUES_REPORTED,
                   .over = OVER_STIFFNESS},
    [STICK_EDGES] = {.quantity = "stick_area",
                     .series = "edges",
                     .y_label = STICK_LABEL,
                     .shown = is_edges_shown,
                     .kept = is_edges_kept,
                     .order = 2,
                     .theories = THEORIES_NONE,
                     .solver = SOLVER_SMOOTH,
                     .field = FIELD_PRESSURE,
                     .load = LOAD_STAYS,
                     .cell = CELL_SAME,
                     .values = VALUES_SOME,
                     .over = OVER_ONE,
                     .by = BY_SLIP},
    [STICK_NODES] = {.quantity = "stick_area",
                     .series = "nodes",
                     .y_label = STICK_LABEL,
                     .shown = is_nodes_shown,
                     .kept = is_nodes_kept,
                     .order = 1,
                     .theories = THEORIES_NONE,
                     .solver = SOLVER_COUNTED,
                     .field = FIELD_PRESSURE,
                     .load = LOAD_STAYS,
                     .cell = CELL_SAME,
                     .values = VALUES_SOME,
                     .over = OVER_ONE,
                     .by = BY_SLIP},
    [DISPLACEMENT] = {.quantity = "tangential_displacement",
                      .series = "",
                      .y_label = "tangential displacement/sqrt(m0)",
                      .shown = is_shown,
                      .kept = is_asked,
                      .order = 1,
                      .theories = THEORIES_NONE,
                      .solver = SOLVER_COUNTED,
                      .field = FIELD_GAP,
                      .load = LOAD_STAYS,
                      .cell = CELL_SAME,
                      .values = VALUES_SOME,
                      .over = OVER_HEIGHT,
                      .by = BY_SLIP},
    [WORK] = {.quantity = "slip_work",
              .series = "",
              .y_label = "work of a cycle/(E* h'_rms sqrt(m0))",
              .shown = is_shown,
              .kept = is_asked,
              .order = 1,
              .theories = THEORIES_NONE,
              .solver = SOLVER_FLOW,
              .field = FIELD_GAP,
              .load = LOAD_STAYS,
              .cell = CELL_SAME,
              .values = VALUES_SOME,
              .over = OVER_WORK,
              .by = BY_SLIP},
    [NORMAL] = {.series = "",
                .shown = never_shown,
                .kept = never_kept,
                .order = 1,
                .theories = THEORIES_NONE,
                .solver = SOLVER_STIFFNESS,
                .field = FIELD_GAP,
                .load = LOAD_FALLS,
                .cell = CELL_SAME,
                .values = VALUES_SOME,
                .over = OVER_STIFFNESS},
    [APPROACH] = {.series = "",
                  .shown = never_shown,
                  .kept = never_kept,
                  .order = 1,
                  .theories = THEORIES_NONE,
                  .solver = SOLVER_SMOOTH,
                  .field = FIELD_GAP,
                  .load = LOAD_STAYS,
                  .cell = CELL_SAME,
                  .values = VALUES_SOME,
                  .over = OVER_HEIGHT},
    [RATIO] = {.quantity = "stiffness_ratio",
               .series = "",
               .y_label = "Kt/Kn",
               .shown = is_ratio_shown,
               .kept = is_ratio_kept,
               .order = 1,
               .theories = THEORIES_NONE,
               .solver = SOLVER_COUNTED,
               .field = FIELD_GAP,
               .load = LOAD_STAYS,
               .cell = CELL_SAME,
               .values = VALUES_SOME,
               .over = OVER_ONE}};
const struct contact_quantity FRICTION_QUANTITY = {.measures = MEASURES,
                                                   .tangent = true,
                                                   .read = asked,
                                                   .bytes = bytes_of,
                                                   .seconds = seconds_of,
                                                   .create = create,
                                                   .destroy = destroy,
                                                   .measure = measure,
                                                   .measure_falling = measure_falling,
                                                   .complete = complete};
