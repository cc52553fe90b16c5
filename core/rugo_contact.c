/* Implements the contact of rugo.h: one solver with the workspace of its areas. */
#include "core/contact/area.h"
#include "core/contact/patches.h"
#include "core/contact/stretch.h"
#include "core/full/full.h"
#include "core/rugo_shared.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

struct rugo_contact {
    struct compliance *compliance; /* of the full model: that of its flat block */
    struct contact *linear;        /* one of the two */
    struct full *full;
    struct area_workspace *areas;
    struct patch_finder *patches;
    bool begun;      /* a surface has been taken */
    double approach; /* under the last load; NaN before */
};

struct rugo_block rugo_block_defaults(enum rugo_model model, const struct rugo_grid *grid) {
    double longest = grid->ny == 1 ? grid->lx : fmax(grid->lx, grid->ly);
    return (struct rugo_block){.model = model,
                               .poisson = 0.3,
                               .height = model == RUGO_HALFSPACE ? INFINITY : 1.5 * longest,
                               .layer_growth = 1.1};
}

static int block_take(struct block *out, const struct rugo_block *from, struct error *err) {
#define MODEL(type, name, value) [RUGO_##type] = MODEL_##type,
    static const enum block_model MODELS[] = {RUGO_LINEAR_MODELS(MODEL)[RUGO_FULL] =
                                                  MODEL_LAYERED}; /* its flat block */
#undef MODEL
    if ((unsigned)from->model >= sizeof MODELS / sizeof *MODELS)
        return error_set(err, ERROR_INPUT, "there is no contact model %d", (int)from->model);
    *out = (struct block){.model = MODELS[from->model],
                          .poisson = from->poisson,
                          .height = from->height,
                          .layer_growth = from->layer_growth,
                          .weighting = GAP_STANDARD};
    return 0;
}

static int solver_create(struct rugo_contact *contact, const struct grid *grid, bool open,
                         enum rugo_model model, const struct block *block, struct error *err) {
    int status = open ? compliance_create_open(&contact->compliance, grid, block, err)
                      : compliance_create(&contact->compliance, grid, block, err);
    if (status == 0)
        status = model == RUGO_FULL ? full_create(&contact->full, grid, block, &FULL_DEFAULTS, err)
                                    : contact_create(&contact->linear, contact->compliance,
                                                     &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = area_workspace_create(&contact->areas, contact->compliance, err);
    if (status == 0)
        status = patch_finder_create(&contact->patches, grid, err);
    if (status == 0 && open)
        patch_finder_open(contact->patches, grid->nx, grid->ny);
    contact->approach = NAN;
    return status;
}

static int create(struct rugo_contact **out, const struct rugo_grid *grid, bool open,
                  const struct rugo_block *block, struct rugo_error *err) {
    struct error why = {0};
    struct grid cell;
    struct block what;
    struct rugo_contact *contact = array_create(1, sizeof *contact);
    int status = contact == NULL ? error_memory(&why, sizeof *contact, "a contact solver") : 0;
    if (status == 0)
        status = grid_take(&cell, grid, &why);
    if (status == 0)
        status = block_take(&what, block, &why);
    if (status == 0)
        status = solver_create(contact, &cell, open, block->model, &what, &why);
    if (status == 0)
        *out = contact;
    else
        rugo_contact_destroy(&contact);
    return error_give(status, &why, err);
}

int rugo_contact_create(struct rugo_contact **out, const struct rugo_grid *grid,
                        const struct rugo_block *block, struct rugo_error *err) {
    return create(out, grid, false, block, err);
}

int rugo_contact_create_open(struct rugo_contact **out, const struct rugo_grid *grid,
                             struct rugo_error *err) {
    struct rugo_block block = rugo_block_defaults(RUGO_HALFSPACE, grid);
    return create(out, grid, true, &block, err);
}

void rugo_contact_destroy(struct rugo_contact **contact) {
    struct rugo_contact *c = *contact;
    if (c == NULL)
        return;
    patch_finder_destroy(&c->patches);
    area_workspace_destroy(&c->areas);
    contact_destroy(&c->linear);
    full_destroy(&c->full);
    compliance_destroy(&c->compliance);
    free(c);
    *contact = NULL;
}

int rugo_contact_begin(struct rugo_contact *contact, const double *z, struct rugo_error *err) {
    struct error why = {0};
    int status = contact->full != NULL ? full_begin(contact->full, z, &why)
                                       : contact_begin(contact->linear, z, &why);
    contact->begun = status == 0;
    contact->approach = NAN;
    return error_give(status, &why, err);
}

/* Takes areas of the undeformed face to those under load. */
static void stretch_areas(struct contact_area *area, double stretch) {
    double now = stretch_touching(area->nodes, stretch);
    area->edges = stretch_fraction(area->edges, stretch_rest(area->nodes, now));
    area->nodes *= now;
    area->lower *= now;
    area->upper *= now;
}

int rugo_contact_press(struct rugo_contact *contact, double pressure,
                       struct rugo_contact_state *out, struct rugo_error *err) {
    struct error why = {0};
    struct contact_state state;
    struct full_report report = {0};
    int status = 0;
    if (!(pressure >= 0 && isfinite(pressure)))
        status =
            error_set(&why, ERROR_INPUT, "the mean pressure must be 0 or more, not %g", pressure);
    else if (!contact->begun)
        status = error_set(&why, ERROR_INPUT,
                           "no surface to press: rugo_contact_begin must have succeeded before");
    else if (contact->full != NULL)
        status = full_press(contact->full, pressure, &state, &report, &why);
    else
        status = contact_press(contact->linear, pressure, &state, &why);
    if (status != 0)
        return error_give(status, &why, err);
    struct contact_area area;
    struct patches patches;
    contact->approach = state.approach;
    contact_area(contact->areas, &state, &area);
    if (contact->full != NULL && state.nodes > 0)
        stretch_areas(&area, report.stretch);
    patches_find(contact->patches, state.p, &patches, NULL);
    *out = (struct rugo_contact_state){.pressure = state.pressure,
                                       .p = state.p,
                                       .gap = state.gap,
                                       .area = area.edges,
                                       .area_nodes = area.nodes,
                                       .area_lower = area.lower,
                                       .area_upper = area.upper,
                                       .mean_gap = area.mean_gap,
                                       .stiffness = state.stiffness,
                                       .patches = patches.count,
                                       .iterations =
                                           contact->full != NULL ? report.newton : state.iterations,
                                       .violation = state.violation};
    return 0;
}

double rugo_contact_approach(const struct rugo_contact *contact) {
    return contact->approach;
}

double rugo_contact_full_pressure(const struct rugo_contact *contact) {
    bool known = contact->linear != NULL && contact->begun && !contact->compliance->open;
    return known ? contact_full_pressure(contact->linear) : (double)NAN;
}
