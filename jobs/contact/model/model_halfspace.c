/* The model "halfspace": an elastic half-space, or an exact layer of finite height. */
#include "jobs/contact/model/model_linear.h"
#include <math.h>

const struct contact_model HALFSPACE_MODEL = {
    .rank = 0,
    LINEAR_MODEL,
    .free_space = true,
    .block = MODEL_HALFSPACE,
    .default_height = INFINITY,
};
