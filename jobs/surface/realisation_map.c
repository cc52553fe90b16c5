#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include <math.h>
#include <stdlib.h>

const char *const MAP_FIELD_NAMES[MAP_FIELDS] = {"height", "gap", "pressure"};

static int draw_held(const struct surface_case *surface, struct random_key key, double *heights,
                     struct surface_report *report, struct error *err) {
    struct extension *extension = NULL;
    struct extend_result done;
    int status = extension_create(&extension, &surface->held->map, surface->held->trend, err);
    if (status == 0)
        status = extension_draw(extension, key, heights, &done, err);
    extension_destroy(&extension);
    *report = (struct surface_report){.end = END_DIRECT};
    return status;
}

static int generate(const struct surface_case *surface, struct random_key key, double *heights,
                    struct surface_report *report, struct error *err) {
    struct generator *generator = NULL;
    int status =
        generator_create(&generator, &surface->spectrum, &surface->grid, &surface->options, err);
    if (status == 0)
        status = generator_run(generator, key, heights, report, err);
    generator_destroy(&generator);
    return status;
}

int realisation_surface(const struct surface_case *surface, struct random_key key, double **z,
                        struct surface_report *report, struct error *err) {
    const size_t points = grid_points(&surface->grid);
    double *heights = array_create(points, sizeof *heights);
    if (heights == NULL)
        return error_memory(err, points * sizeof *heights, "a surface");
    int status = (surface->held != NULL ? draw_held : generate)(surface, key, heights, report, err);
    if (status != 0)
        free(heights);
    else
        *z = heights;
    return status;
}

/* Replaces the heights by the gap or the pressures. */
static int press(const struct map_order *order, const void *one_case, size_t points, double **z,
                 struct error *err) {
    double *gap = array_create(points, sizeof *gap);
    double *pressure = array_create(points, sizeof *pressure);
    const struct realisation realisation = {
        .study = one_case, .z = *z, .stop = order->stop, .stop_context = order->stop_context};
    int status = gap != NULL && pressure != NULL
                     ? order->kind->press(&realisation, order->load, gap, pressure, err)
                     : error_memory(err, 2 * points * sizeof *gap, "a contact map");
    if (status == 0) {
        double **chosen = order->field == MAP_GAP ? &gap : &pressure;
        double *heights = *z;
        *z = *chosen;
        *chosen = heights;
    }
    free(gap);
    free(pressure);
    return status;
}

static int check(const struct map_order *order, const struct surface_case *surface,
                 struct error *err) {
    if (surface == NULL || (order->field != MAP_HEIGHT && order->kind->press == NULL))
        return error_set(err, ERROR_INPUT, "a study of kind %s has no field %s; allowed: height",
                         order->kind->study.name, MAP_FIELD_NAMES[order->field]);
    if (order->field != MAP_HEIGHT && !(order->load > 0 && isfinite(order->load)))
        return error_set(err, ERROR_INPUT, "load = %g; allowed: above 0, finite", order->load);
    double points = (double)grid_points(&surface->grid);
    if (points > order->points_most)
        return error_set(err, ERROR_INPUT, "the surface has %.0f points; allowed here: %.0f",
                         points, order->points_most);
    return 0;
}

int realisation_map(const struct map_order *order, struct grid *grid, double **out,
                    struct error *err) {
    void *one_case = NULL;
    double *z = NULL;
    struct surface_report report;
    int status = kind_case_create(&one_case, order->kind, order->parameters, NULL, err);
    if (status != 0)
        return status;
    const struct surface_case *surface =
        order->kind->surface != NULL ? order->kind->surface(one_case) : NULL;
    status = check(order, surface, err);
    if (status == 0) {
        struct surface_case stopped = *surface; /* borrows what that one owns */
        stopped.options.stop = order->stop;
        stopped.options.stop_context = order->stop_context;
        status = realisation_surface(&stopped, order->key, &z, &report, err);
    }
    if (status == 0 && order->field != MAP_HEIGHT)
        status = press(order, one_case, grid_points(&surface->grid), &z, err);
    if (status == 0) {
        *grid = surface->grid;
        *out = z;
    } else
        free(z);
    kind_case_destroy(order->kind, &one_case);
    return status;
}
