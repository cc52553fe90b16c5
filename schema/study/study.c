#include "schema/study/study.h"
#include <stdlib.h>

static void case_clear(struct study_case *one) {
    cJSON_Delete(one->parameters);
    for (size_t a = 0; a < one->component_count; a++)
        cJSON_Delete(one->components[a].parameters);
    free(one->components);
}

void study_destroy(struct study **study) {
    struct study *s = *study;
    if (s == NULL)
        return;
    for (size_t c = 0; s->cases != NULL && c < s->case_count; c++)
        case_clear(&s->cases[c]);
    for (size_t p = 0; s->swept != NULL && s->swept[p] != NULL; p++)
        free(s->swept[p]);
    free(s->swept);
    free(s->cases);
    free(s->name);
    free(s->owner);
    free(s->source);
    free(s);
    *study = NULL;
}
