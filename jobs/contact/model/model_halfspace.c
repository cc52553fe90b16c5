/* The model "halfspace": an elastic half-space, or an exact layer of finite height. */
#include "jobs/contact/model/model_linear.h"
#include <math.h>

const struct contact_model HALFSPACE_MODEL = {
    .rank = 0,
    .yields = true,
    .coatings = true,
    .counter_faces = true,
    .free_space = true,
    .block = MODEL_HALFSPACE,
    .default_height = INFINITY,
    .bytes = linear_bytes,
    .seconds = linear_seconds,
    .create = linear_create,
    .destroy = linear_destroy,
    .set_team = linear_set_team,
    .begin = linear_begin,
    .press = linear_press,
    .full_pressure = linear_full_pressure,
};
