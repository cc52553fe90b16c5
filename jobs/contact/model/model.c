#include "jobs/contact/model/model.h"

const char *contact_model_name(const struct contact_model *model) {
    size_t m = 0;
    while (CONTACT_MODELS[m] != NULL && CONTACT_MODELS[m] != model)
        m++;
    return CONTACT_MODEL_CHOICES[m].name;
}
