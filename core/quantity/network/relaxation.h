/* Relaxation of a network, Gauss and Seidel's by colours: nodes of a colour do not depend on each
 * other. Private to core/quantity/network. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_RELAXATION_H
#define RUGO_CORE_QUANTITY_NETWORK_RELAXATION_H

#include "core/quantity/network/level.h"

/* Fills level->inverse. */
void relaxation_prepare(struct level *level);
/* Relaxes u for r; the second is the transpose of the first. */
void relaxation_first(const struct level *level);
void relaxation_second(const struct level *level);
/* residual = r - A u. */
void relaxation_residual(const struct level *level);

/* The same of the finest level. Nodes of i + j odd come second at first, so that they have no
 * residual, and first afterwards, so that their u before does not count; the residual is made at
 * the other nodes alone. */
void relaxation_first_finest(const struct level *level);
void relaxation_second_finest(const struct level *level);

#endif
