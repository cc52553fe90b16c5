#include "core/nodal/node_table.h"
#include <errno.h>
#include <math.h>
#include <string.h>

double node_table_row_bytes(bool displacements) {
    return displacements ? 110 : 70; /* 9 digits a number at most, most of them written */
}

/* Puts a number, or an empty field where a unit is so odd that it is none. */
static void put_value(FILE *file, double value) {
    fputc(',', file);
    if (isfinite(value))
        fprintf(file, "%.9g", value);
}

static void put_node(FILE *file, const struct nodal_step *step, size_t node) {
    const struct grid *grid = &step->grid;
    size_t column = node % grid->nx, row = node / grid->nx;
    double x = (double)column * grid_dx(grid);
    double y = grid_is_profile(grid) ? 0 : (double)row * grid_dy(grid);
    const double values[] = {x, y, step->z[node], step->gap[node], step->p[node]};
    fprintf(file, "%.9g,%zu", step->load, node);
    for (size_t v = 0; v < sizeof values / sizeof *values; v++)
        put_value(file, values[v]);
    fputs(step->contact[node] > 0 ? ",contact" : ",open", file);
    for (size_t k = 0; step->u != NULL && k < 3; k++)
        put_value(file, step->u[3 * node + k]);
    fputc('\n', file);
}

int node_table_put(FILE *file, bool first, const struct nodal_step *step, struct error *err) {
    errno = 0;
    if (first)
        fprintf(file, "load,node,x,y,z,gap,pressure,status%s\n",
                step->u != NULL ? ",u_x,u_y,u_z" : "");
    for (size_t node = 0; node < grid_points(&step->grid); node++)
        put_node(file, step, node);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the nodes: %s", strerror(errno));
    return 0;
}
