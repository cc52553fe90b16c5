/* Steps as a table in CSV, one row a node and load: load, node, x, y, z, gap, pressure, status
 * (contact or open), and of models with displacements u_x, u_y, u_z. z is the height towards the
 * flat before the load, and u_z has its sign. Numbers have 9 digits. */
#ifndef RUGO_CORE_NODAL_NODE_TABLE_H
#define RUGO_CORE_NODAL_NODE_TABLE_H

#include "core/nodal/nodal_step.h"

/* Appends the rows of a step; before the first one the line of headings. ERROR_SYSTEM when they
 * cannot be written. */
int node_table_put(FILE *file, bool first, const struct nodal_step *step, struct error *err);
/* Returns the bytes of a row, about. */
double node_table_row_bytes(bool displacements);

#endif
