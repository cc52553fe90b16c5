#include "jobs/contact/quantity/sliding_edges.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int sliding_edges_create(struct sliding_edges *out, const struct grid *grid, double poisson,
                         double friction, struct error *err) {
    const size_t n = grid_points(grid);
    *out = (struct sliding_edges){.n = n, .friction = friction, .ratio = 1, .legs = 1};
    /* Of surfaces the mean over the directions of an edge: across it both compliances are alike,
     * along it that of tractions is 1/(1 - poisson) of the other. */
    if (!grid_is_profile(grid))
        out->ratio = (1 - poisson / 2) / (1 - poisson);
    out->turned = array_create(n, sizeof *out->turned);
    out->lighter_p = array_create(n, sizeof *out->lighter_p);
    out->lighter_gap = array_create(n, sizeof *out->lighter_gap);
    if (out->turned != NULL && out->lighter_p != NULL && out->lighter_gap != NULL)
        return 0;
    sliding_edges_clear(out);
    return error_memory(err, 3 * n * sizeof(double), "areas that slide");
}

void sliding_edges_clear(struct sliding_edges *edges) {
    free(edges->turned);
    free(edges->lighter_p);
    free(edges->lighter_gap);
    *edges = (struct sliding_edges){0};
}

double sliding_edges_bytes(const struct grid *grid) {
    return 3 * sizeof(double) * (double)grid_points(grid);
}

void sliding_edges_begin(struct sliding_edges *edges, double forward) {
    memset(edges->turned, 0, edges->n * sizeof *edges->turned);
    edges->forward = forward;
    edges->legs = 1;
}

void sliding_edges_turn(struct sliding_edges *edges, const struct sliding_nodes *nodes) {
    memcpy(edges->turned, nodes->over, edges->n * sizeof *edges->turned);
    edges->forward = -edges->forward;
    edges->legs = 2;
}

static struct contact_area area_of(struct area_workspace *areas, const double *p,
                                   const double *opening) {
    const size_t points = grid_points(area_workspace_grid(areas));
    const struct contact_state state = {.p = p, .gap = opening, .opening = opening};
    struct contact_area area = {.nodes = 0};
    bool touches = false;
    for (size_t i = 0; i < points && !touches; i++)
        touches = p[i] > 0;
    if (touches)
        contact_area(areas, &state, &area);
    return area;
}

double sliding_edges_area(struct area_workspace *areas, const double *p, const double *opening) {
    return area_of(areas, p, opening).edges;
}

/* What bears less than friction allows is, over friction, the pressure of the lighter load; what
 * the face has slid behind, over friction, its gap. After a turn both are twice that. */
struct sliding_area sliding_edges_measure(struct sliding_edges *edges, struct area_workspace *areas,
                                          const struct sliding_nodes *nodes) {
    const double forward = edges->forward / edges->friction;
    for (size_t i = 0; i < edges->n; i++) {
        bool touches = nodes->p[i] > 0, sticks = nodes->sticks[i];
        double left = nodes->p[i] - forward * nodes->q[i];
        double slid = forward * (edges->turned[i] - nodes->over[i]) / edges->ratio;
        double open = touches ? 0 : edges->legs * nodes->opening[i];
        edges->lighter_p[i] = sticks ? fmax(left, 0) : 0;
        edges->lighter_gap[i] = sticks ? 0 : fmax(open + slid, 0);
    }
    const struct contact_area stick = area_of(areas, edges->lighter_p, edges->lighter_gap);
    return (struct sliding_area){.contact = sliding_edges_area(areas, nodes->p, nodes->opening),
                                 .stick = stick.edges,
                                 .crossed = stick.upper - stick.lower};
}
