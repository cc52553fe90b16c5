#include "jobs/like/like_hold.h"
#include "jobs/like/like_draw.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES = sizeof(float) };
_Static_assert(sizeof(float) == 4, "heights are 32-bit floats");
static const char PATCH[] = "/surface/like/patch", HOLD[] = "/surface/like/hold";

/* --- the text --- */

static void float_put(unsigned char *out, double value) {
    const float number = (float)value;
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    for (int b = 0; b < BYTES; b++)
        out[b] = (unsigned char)(bits >> (8 * b));
}

static double float_get(const unsigned char *data) {
    float number;
    uint32_t bits = 0;
    for (int b = 0; b < BYTES; b++)
        bits |= (uint32_t)data[b] << (8 * b);
    memcpy(&number, &bits, sizeof number);
    return number;
}

int like_hold_text(char **out, const struct height_map *map, double length, struct error *err) {
    const size_t points = grid_points(&map->grid);
    if (points > LIKE_PATCH_POINTS)
        return error_set(err, ERROR_INPUT,
                         "\"hold\": a map of %zu by %zu points; allowed: %d points; crop or "
                         "resample it",
                         map->grid.nx, map->grid.ny, (int)LIKE_PATCH_POINTS);
    unsigned char *data = array_create(points, BYTES);
    if (data == NULL)
        return error_memory(err, points * BYTES, "a held patch");
    for (size_t p = 0; p < points; p++)
        float_put(data + p * BYTES, map->z[p] / length);
    int status = base64_encode(data, points * BYTES, out, err);
    free(data);
    return status;
}

/* --- the case --- */

/* The cell has exactly twice the sides of the map, and the spacing of its points. */
static bool cell_fits(const struct like_case *like, const struct grid *grid) {
    static const double ROUNDING = 1e-6;
    const bool profile = like->ny == 1;
    return grid->nx == 2 * like->nx && grid->ny == (profile ? 1 : 2 * like->ny) &&
           fabs(grid_dx(grid) - like->spacing) <= ROUNDING * like->spacing;
}

/* Adds the faults of what surfaces that hold a patch exclude. */
static void check(const struct surface_case *surface, const struct like_case *like,
                  struct values *values) {
    if (surface->options.heights.type != HEIGHTS_GAUSSIAN)
        values_fault(values, HOLD,
                     "surfaces have the heights of the patch; leave out /surface/heights");
    if (surface->counter != NULL)
        values_fault(values, HOLD, "one face holds the patch; leave out counter_surface");
    if (!cell_fits(like, &surface->grid))
        values_fault(values, HOLD,
                     "the cell has %zu by %zu points, %g apart; allowed: %zu by %zu, %g apart, "
                     "twice the sides of the patch",
                     surface->grid.nx, surface->grid.ny, grid_dx(&surface->grid), 2 * like->nx,
                     like->ny == 1 ? 1 : 2 * like->ny, like->spacing);
}

/* Fills heights of the text; adds a fault where they are others than those of the map. */
static int decode(double *z, const struct like_case *like, const char *text, struct values *values,
                  struct error *err) {
    const size_t points = like->nx * like->ny;
    unsigned char *data = NULL;
    struct error reason = {0};
    size_t size = 0, heights = 0;
    int status = base64_decode(text, &data, &size, &reason);
    if (status != 0 && status != ERROR_INPUT)
        return error_set(err, status, "%s", reason.text);
    if (status != 0)
        values_fault(values, PATCH, "%s", reason.text);
    else if (size != points * BYTES)
        values_fault(values, PATCH, "%zu bytes; allowed: 4 each of %zu by %zu heights", size,
                     like->nx, like->ny);
    else {
        for (size_t p = 0; p < points; p++) {
            z[p] = float_get(data + p * BYTES);
            heights += isfinite(z[p]) ? 1 : 0;
            if (isinf(z[p]))
                z[p] = (double)NAN;
        }
        if (heights == 0)
            values_fault(values, PATCH, "holes alone; a patch has heights");
    }
    free(data);
    return 0;
}

int like_hold_read(struct surface_case *surface, const struct like_case *like,
                   struct values *values, struct error *err) {
    const char *text = values_text(values, PATCH);
    if (!like->given || !like->hold) {
        if (like->given && text != NULL)
            values_fault(values, PATCH, "nothing holds it unless /surface/like/hold is true");
        return 0;
    }
    const size_t before = values_fault_count(values);
    check(surface, like, values);
    if (text == NULL)
        values_fault(values, HOLD, "the heights that are held are missing, /surface/like/patch");
    if (values_fault_count(values) != before)
        return 0;
    double *z = array_create(like->nx * like->ny, sizeof *z);
    if (z == NULL)
        return error_memory(err, like->nx * like->ny * sizeof *z, "a held patch");
    int status = decode(z, like, text, values, err);
    if (status == 0 && values_fault_count(values) == before)
        status = surface_case_hold(surface, like->nx, like->ny, z, like->detrend, err);
    free(z);
    return status;
}

struct like_error like_hold_error(double deviation, size_t n) {
    return like_draw_error(0, deviation, n);
}
