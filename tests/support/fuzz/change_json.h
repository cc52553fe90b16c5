/* JSON documents that are right but for a few leaves. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_CHANGE_JSON_H
#define RUGO_TESTS_SUPPORT_FUZZ_CHANGE_JSON_H

#include "tests/support/fuzz/choices.h"
#include <cjson/cJSON.h>

/* Changes one value of the document, the whole included: to another one, of any type, to a number
 * beside it, or away, or it stands there twice. */
void change_json(struct choices *choices, cJSON **document);
/* Returns a value that programs stumble over. */
cJSON *odd_json(struct choices *choices);

#endif
