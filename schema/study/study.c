#include "schema/study/study.h"
#include <stdlib.h>

void study_destroy(struct study **study) {
    struct study *s = *study;
    if (s == NULL)
        return;
    for (size_t c = 0; s->cases != NULL && c < s->case_count; c++)
        cJSON_Delete(s->cases[c].parameters);
    for (size_t p = 0; s->swept != NULL && s->swept[p] != NULL; p++)
        free(s->swept[p]);
    free(s->swept);
    free(s->cases);
    free(s->name);
    free(s->source);
    free(s);
    *study = NULL;
}
