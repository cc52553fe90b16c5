#include "server/show/picture.h"
#include "server/show/plot.h"
#include "server/show/plot_sweep.h"
#include <stdlib.h>

enum { CASES_MOST = 64 }; /* whose curves are read for one picture */

static int draw_curves(const struct study_result *study, const char *quantity, FILE *file,
                       struct error *err) {
    const struct plot_request request = {.quantity = quantity};
    return plot_quantity(study, &request, file, err);
}

static int draw_difference(const struct picture_source *source,
                           const struct picture_request *request, FILE *file, struct error *err) {
    struct study_result study = {0};
    if (request->case_number >= 0 || request->x != NULL || request->colour != NULL)
        return error_set(err, ERROR_INPUT, "a difference takes no case, x or colour");
    int status = source->difference(source->context, request->difference, &study, err);
    if (status == 0)
        status = draw_curves(&study, request->quantity, file, err);
    study_result_clear(&study);
    return status;
}

static int draw_scalar(const struct study_result *study, const struct picture_request *request,
                       FILE *file, struct error *err) {
    const struct sweep_request sweep = {request->quantity, request->x, request->colour};
    if (request->case_number >= 0)
        return error_set(err, ERROR_INPUT, "%.60s is a scalar: its picture is of all cases",
                         request->quantity);
    return plot_sweep(study, &sweep, file, err);
}

/* cases: of the study */
static int draw_quantity(const struct picture_source *source, const struct picture_request *request,
                         size_t cases, FILE *file, struct error *err) {
    const struct result_filter filter = {.case_number = request->case_number,
                                         .part = {.quantity = request->quantity},
                                         .complete = true};
    struct study_result study = {0};
    if (request->x != NULL || request->colour != NULL)
        return error_set(err, ERROR_INPUT,
                         "x and colour belong to scalars, and no case has a "
                         "scalar \"%.60s\"",
                         request->quantity);
    if (request->case_number < 0 && cases > CASES_MOST)
        return error_set(err, ERROR_INPUT, "%zu cases are too many for one picture; name a case",
                         cases);
    int status = source->results(source->context, &filter, &study, err);
    if (status == 0)
        status = draw_curves(&study, request->quantity, file, err);
    study_result_clear(&study);
    return status;
}

int picture_draw(const struct picture_source *source, const struct picture_request *request,
                 FILE *file, struct error *err) {
    const struct result_filter scalars = {.case_number = -1, .part = {.scalars_only = true}};
    struct study_result study = {0};
    bool scalar = false;
    if (request->difference != NULL)
        return draw_difference(source, request, file, err);
    int status = source->results(source->context, &scalars, &study, err);
    for (size_t c = 0; c < study.case_count && status == 0; c++)
        scalar = scalar || result_scalar(&study.cases[c], request->quantity) != NULL;
    if (status == 0)
        status = scalar ? draw_scalar(&study, request, file, err)
                        : draw_quantity(source, request, study.case_count, file, err);
    study_result_clear(&study);
    return status;
}
