/* A curve as portable bytes with a checksum, in which the store keeps it; every number is exact. Of
 * theories that are made on demand (y NULL) only the name is kept. */
#ifndef RUGO_SCHEMA_RESULT_CURVE_BYTES_H
#define RUGO_SCHEMA_RESULT_CURVE_BYTES_H

#include "schema/result/result.h"

/* The caller frees *data. */
int curve_encode(const struct curve *curve, unsigned char **data, size_t *size, struct error *err);
/* Appends the curve to the result; ERROR_INPUT for bytes that curve_encode did not make. */
int curve_decode(struct case_result *result, const unsigned char *data, size_t size,
                 struct error *err);

#endif
