/* A picture of curves as text. */
#ifndef RUGO_TESTS_SUPPORT_PICTURE_TEXT_H
#define RUGO_TESTS_SUPPORT_PICTURE_TEXT_H

#include "server/show/plot/plot.h"
#include "tests/support/check.h"
#include <stdio.h>

/* Returns the status of plot_quantity(); the caller frees *text. */
static inline int picture_text(const struct study_result *study, const struct plot_request *request,
                               char **text, struct error *err) {
    size_t size = 0;
    *text = NULL;
    FILE *file = open_memstream(text, &size);
    assert_non_null(file);
    int status = plot_quantity(study, request, file, err);
    fclose(file);
    return status;
}

#endif
