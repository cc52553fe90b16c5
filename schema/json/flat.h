/* A case's parameters as people filter by them. Private to worker/. */
#ifndef RUGO_SCHEMA_JSON_FLAT_H
#define RUGO_SCHEMA_JSON_FLAT_H

#include <cjson/cJSON.h>

/* {"/surface/hurst": 0.2, ...}: every number, string and boolean within the object by its RFC 6901
 * pointer, in the order of the object; lists (bins) are left out. Caller deletes; NULL when out of
 * memory. */
cJSON *flat_parameters(const cJSON *parameters);

#endif
