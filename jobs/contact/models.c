#include "jobs/contact/model.h"

#define MODELS(MODEL)                                                                              \
    MODEL(HALFSPACE_MODEL, "halfspace")                                                            \
    MODEL(LAYERED_MODEL, "layered")                                                                \
    MODEL(FULL_MODEL, "full")
CONTACT_MODEL_TABLES(MODELS)
