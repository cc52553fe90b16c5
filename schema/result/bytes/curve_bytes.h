/* Curves as portable bytes with a checksum, in which the store keeps them; every number is exact.
 * Of theories that are made on demand (y NULL) only the name is kept. */
#ifndef RUGO_SCHEMA_RESULT_BYTES_CURVE_BYTES_H
#define RUGO_SCHEMA_RESULT_BYTES_CURVE_BYTES_H

#include "schema/result/result.h"

/* Encodes curves, one or more, one after the other. The caller frees *data. */
int curves_encode(const struct curve *curves, size_t count, unsigned char **data, size_t *size,
                  struct error *err);
/* Appends the curves to the result; ERROR_INPUT, and none, for bytes that curves_encode did not
 * make. */
int curves_decode(struct case_result *result, const unsigned char *data, size_t size,
                  struct error *err);

#endif
