/* The model "layered": linear finite elements in layers below a flat face. */
#include "jobs/contact/model/model_linear.h"

const struct contact_model LAYERED_MODEL = {
    .rank = 1,
    LINEAR_MODEL,
    .block = MODEL_LAYERED,
    .elements = true,
    .default_height = 1.5,
};
