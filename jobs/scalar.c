#include "jobs/scalar.h"
#include <math.h>

bool scalar_put(cJSON *scalars, const char *name, struct estimate estimate, double theory) {
    cJSON *scalar = cJSON_CreateObject();
    bool done = value_put(scalar, "value", value_number(estimate.value)) &&
                value_put(scalar, "standard_error", value_number(estimate.standard_error)) &&
                (isnan(theory) || value_put(scalar, "theory", value_number(theory)));
    if (done)
        return value_put(scalars, name, scalar);
    cJSON_Delete(scalar);
    return false;
}
