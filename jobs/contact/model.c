#include "jobs/contact/model.h"
#include <math.h>

double model_sum(size_t n, const double *values) {
    double sum = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        sum += values[k];
    return sum;
}

double model_largest(size_t n, const double *values) {
    double largest = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        largest = fmax(largest, values[k]);
    return largest;
}

const char *contact_model_name(const struct contact_model *model) {
    size_t m = 0;
    while (CONTACT_MODELS[m] != NULL && CONTACT_MODELS[m] != model)
        m++;
    return CONTACT_MODEL_CHOICES[m].name;
}
