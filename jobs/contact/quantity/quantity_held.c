/* The contact area within the measured patch that surfaces hold (jobs/like/like_hold.h), a share of
 * the patch: the points of the patch in contact, times the area of the cell by edges over that by
 * nodes. */
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>

/* A study asks by /surface/like/hold, which is no parameter of contact. */
const struct parameter_table HELD_PARAMETERS = {"contact", NULL, 0};

static bool asked(struct contact_case *one_case, struct values *values) {
    (void)values;
    return one_case->like.given && one_case->like.hold;
}

/* The patch has half of each side of the cell. */
static int measure(struct quantity_state *state, const struct measure_context *context,
                   const struct contact_pressed *pressed, const struct contact_area *area,
                   double *values, struct error *err) {
    const struct grid *grid = area_workspace_grid(context->area);
    const size_t nx = grid->nx / 2, ny = grid_is_profile(grid) ? 1 : grid->ny / 2;
    const double *p = pressed->state.p;
    size_t count = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            count += p[j * grid->nx + i] > 0 ? 1 : 0;
    (void)state;
    (void)err;
    const double share = (double)count / ((double)nx * (double)ny);
    *values = area->nodes > 0 ? fmin(1, share * (area->edges / area->nodes)) : 0;
    return 0;
}

static bool is_asked(const struct contact_case *one_case) {
    return one_case->asked.of[HELD_AT];
}

static bool is_shown(const struct contact_case *one_case, size_t model) {
    (void)model;
    return is_asked(one_case);
}

static const struct measure MEASURES[] = {{.quantity = "held_contact_area",
                                           .series = "",
                                           .y_label = "A/A0 of the patch",
                                           .shown = is_shown,
                                           .kept = is_asked,
                                           .order = 2,
                                           .theories = THEORIES_NONE,
                                           .solver = SOLVER_COUNTED,
                                           .field = FIELD_PRESSURE,
                                           .load = LOAD_FALLS,
                                           .cell = CELL_SAME,
                                           .values = VALUES_SOME,
                                           .over = OVER_ONE}};

const struct contact_quantity HELD_QUANTITY = {
    .measures = MEASURES, .read = asked, .measure = measure};
