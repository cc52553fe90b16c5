/* The block of a contact case on its true geometry, as `rugo generate --mesh` writes it. */
#ifndef RUGO_SERVER_COMMAND_MESHED_CASE_H
#define RUGO_SERVER_COMMAND_MESHED_CASE_H

#include "core/error.h"
#include <cjson/cJSON.h>

/* Meshes the finest level of a case, whose models must have full, for the surface z of its own
 * grid; pressed to pressure p/(E* h') where that is above 0. Lengths in lambda_s, pressures and
 * stresses in E* h'. ERROR_INPUT, ERROR_NUMERIC of core/full; nothing is written then. */
int meshed_case_write(const char *path, const cJSON *parameters, const double *z, double pressure,
                      struct error *err);

#endif
