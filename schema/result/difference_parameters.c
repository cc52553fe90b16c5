#include "schema/result/difference_parameters.h"
#include <math.h>
#include <stdio.h>

const char *difference_text(struct case_result *out, const char *a, const char *b) {
    char text[160];
    if (same_text(a, b))
        return result_text(out, a);
    snprintf(text, sizeof text, "%.64s less %.64s", a != NULL ? a : "-", b != NULL ? b : "-");
    return result_text(out, text);
}

static void value_text(const struct result_parameter *value, char text[64]) {
    if (value == NULL)
        snprintf(text, 64, "-");
    else if (value->text != NULL)
        snprintf(text, 64, "%.63s", value->text);
    else
        snprintf(text, 64, "%.10g", value->number);
}

int difference_parameters(const struct case_result *a, const struct case_result *b,
                          struct case_result *out, struct error *err) {
    out->parameters = result_room(out, a->parameter_count + 1, sizeof *out->parameters);
    if (out->parameters == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for parameters");
    for (size_t p = 0; p < a->parameter_count; p++) {
        const struct result_parameter *one = &a->parameters[p];
        const struct result_parameter *other = result_parameter(b, one->pointer);
        struct result_parameter *to = &out->parameters[out->parameter_count++];
        char first[64], second[64];
        bool same = other != NULL && same_text(one->text, other->text) &&
                    same_number(one->number, other->number);
        value_text(one, first);
        value_text(other, second);
        *to = (struct result_parameter){.pointer = result_text(out, one->pointer),
                                        .number = same ? one->number : (double)NAN,
                                        .list = same && one->list};
        if (!same || one->text != NULL)
            to->text = same ? result_text(out, one->text) : difference_text(out, first, second);
        if (to->pointer == NULL || (to->text == NULL && isnan(to->number)))
            return error_set(err, ERROR_MEMORY, "no memory left for parameters");
    }
    return 0;
}
