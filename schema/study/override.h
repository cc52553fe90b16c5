/* --set PATH=VALUE: changes to a study before it is checked. */
#ifndef RUGO_SCHEMA_STUDY_OVERRIDE_H
#define RUGO_SCHEMA_STUDY_OVERRIDE_H

#include "schema/json/json.h"

/* text: a pointer or dotted path, '=', JSON or a bare word. Makes objects that are missing on the
 * path. ERROR_INPUT when the path is empty or runs through something that is no object. */
int override_apply(cJSON *document, const char *text, struct error *err);

#endif
