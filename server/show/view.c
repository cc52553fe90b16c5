#include "server/show/view.h"
#include "jobs/kind.h"
#include <string.h>

static const struct result_view PLAIN = {0};

const struct result_view *view_of(const char *kind) {
    const struct job_kind *found = kind != NULL ? kind_find(kind) : NULL;
    return found != NULL && found->view != NULL ? found->view : &PLAIN;
}

const struct logarithmic_picture *view_logarithmic(const struct result_view *view,
                                                   const char *quantity) {
    const struct logarithmic_picture *picture = view->logarithmic;
    for (; picture != NULL && picture->quantity != NULL; picture++)
        if (strcmp(picture->quantity, quantity) == 0)
            return picture;
    return NULL;
}
