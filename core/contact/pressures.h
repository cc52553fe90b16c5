/* The distribution of the pressure over the cell: nodes in contact bear their pressures on their
 * cells, and near an edge of contact the law of edges gives the pressure (F12.8). */
#ifndef RUGO_CORE_CONTACT_PRESSURES_H
#define RUGO_CORE_CONTACT_PRESSURES_H

#include "core/contact/area.h"
#include "core/statistics/heights/histogram.h"

struct pressures;
/* Borrows the workspace, of a periodic grid, which must outlive it. */
int pressures_create(struct pressures **out, const struct area_workspace *areas, struct error *err);
void pressures_destroy(struct pressures **pressures);
/* Of faces with waves of up to these numbers. */
double pressures_bytes(const struct grid *grid, size_t mode_x, size_t mode_y);

/* Fills shares[bins->count + 2] of a state on the workspace's grid: fractions of the cell where
 * p/unit lies in each of the bins, which begin at 0 or above; the first is underflow, the last
 * overflow. They add up to `area`, and the mean of p over them to the mean pressure. ERROR_MEMORY;
 * ERROR_INPUT where nodes have yielded: shares of the load there are known without (contact_state).
 */
int pressures_share(struct pressures *pressures, const struct contact_state *state, double area,
                    const struct bins *bins, double unit, double *shares, struct error *err);

#endif
