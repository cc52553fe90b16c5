/* What is sent as JSON, as the other end sees it. */
#ifndef RUGO_TESTS_UNIT_WORKER_CROSSING_H
#define RUGO_TESTS_UNIT_WORKER_CROSSING_H

#include "schema/json/json.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const char TOKEN[] = "0123456789abcdef0123456789abcdef";

/* Takes the value, prints it, and reads it through the strict gate; the caller deletes it. */
static inline cJSON *cross(cJSON *value) {
    struct error err = {0};
    cJSON *read = NULL;
    assert_non_null(value);
    char *text = json_print(value);
    assert_non_null(text);
    cJSON_Delete(value);
    if (json_parse(text, strlen(text), NULL, &read, &err) != 0)
        fail_msg("%s", err.text);
    free(text);
    return read;
}

#endif
