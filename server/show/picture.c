#include "server/show/picture.h"
#include "server/show/plot.h"
#include "server/show/plot_density.h"
#include "server/show/plot_sweep.h"
#include <stdlib.h>

enum { CASES_MOST = 64 }; /* whose curves are read for one picture */

int picture_of_results(const struct study_result *study, const char *quantity, FILE *file,
                       struct error *err) {
    for (size_t c = 0; c < study->case_count; c++) {
        const struct curve *density = density_curve(&study->cases[c], quantity);
        if (density != NULL)
            return plot_density(study, &study->cases[c], density, file, err);
    }
    return plot_quantity(study, &(struct plot_request){.quantity = quantity}, file, err);
}

static int draw_difference(const struct picture_source *source,
                           const struct picture_request *request, FILE *file, struct error *err) {
    struct study_result study = {0};
    if (request->case_number >= 0 || request->x != NULL || request->colour != NULL)
        return error_set(err, ERROR_INPUT, "a difference takes no case, x or colour");
    int status = source->difference(source->context, request->difference, &study, err);
    if (status == 0)
        status = picture_of_results(&study, request->quantity, file, err);
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

/* Returns the case whose curves tell what is drawn: the one asked for, or the first that has begun.
 */
static int64_t first_case(const struct study_result *scalars, int64_t asked) {
    for (size_t c = 0; c < scalars->case_count && asked < 0; c++)
        if (scalars->cases[c].realisations > 0 && scalars->cases[c].error == NULL)
            return (int64_t)scalars->cases[c].case_number;
    return asked >= 0 ? asked : 0;
}

/* Draws a density, which is of one case, or of one case what was asked for; *done: it is drawn. */
static int draw_case(const struct picture_source *source, const struct picture_request *request,
                     const struct study_result *scalars, FILE *file, bool *done,
                     struct error *err) {
    const struct result_filter filter = {.case_number = first_case(scalars, request->case_number),
                                         .part = {.quantity = request->quantity},
                                         .complete = true};
    struct study_result study = {0};
    int status = source->results(source->context, &filter, &study, err);
    const struct case_result *one = study.case_count > 0 ? &study.cases[0] : NULL;
    const struct curve *density =
        status == 0 && one != NULL ? density_curve(one, request->quantity) : NULL;
    *done = density != NULL || request->case_number >= 0;
    if (density != NULL)
        status = plot_density(scalars, one, density, file, err);
    else if (status == 0 && *done)
        status = picture_of_results(&study, request->quantity, file, err);
    study_result_clear(&study);
    return status;
}

/* scalars: of all cases, without curves */
static int draw_quantity(const struct picture_source *source, const struct picture_request *request,
                         const struct study_result *scalars, FILE *file, struct error *err) {
    const struct result_filter all = {
        .case_number = -1, .part = {.quantity = request->quantity}, .complete = true};
    struct study_result study = {0};
    bool done = false;
    if (request->x != NULL || request->colour != NULL)
        return error_set(err, ERROR_INPUT,
                         "x and colour belong to scalars, and no case has a "
                         "scalar \"%.60s\"",
                         request->quantity);
    int status = draw_case(source, request, scalars, file, &done, err);
    if (status != 0 || done)
        return status;
    if (scalars->case_count > CASES_MOST)
        return error_set(err, ERROR_INPUT, "%zu cases are too many for one picture; name a case",
                         scalars->case_count);
    status = source->results(source->context, &all, &study, err);
    if (status == 0)
        status = picture_of_results(&study, request->quantity, file, err);
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
                        : draw_quantity(source, request, &study, file, err);
    study_result_clear(&study);
    return status;
}
