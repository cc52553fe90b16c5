/* The model "layered": linear finite elements in layers below a flat face. */
#include "jobs/contact/model/model_linear.h"

const struct contact_model LAYERED_MODEL = {
    .rank = 1,
    .yields = true,
    .block = MODEL_LAYERED,
    .elements = true,
    .coatings = true,
    .counter_faces = true,
    .default_height = 1.5,
    .bytes = linear_bytes,
    .seconds = linear_seconds,
    .create = linear_create,
    .destroy = linear_destroy,
    .set_team = linear_set_team,
    .begin = linear_begin,
    .press = linear_press,
    .full_pressure = linear_full_pressure,
};
