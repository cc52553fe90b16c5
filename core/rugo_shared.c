#include "core/rugo_shared.h"
#include <stdio.h>

_Static_assert((int)RUGO_ERROR_INPUT == (int)ERROR_INPUT, "codes of rugo.h are those of error.h");
_Static_assert((int)RUGO_ERROR_MEMORY == (int)ERROR_MEMORY, "likewise");
_Static_assert((int)RUGO_ERROR_SYSTEM == (int)ERROR_SYSTEM, "likewise");
_Static_assert((int)RUGO_ERROR_NUMERIC == (int)ERROR_NUMERIC, "likewise");

const char *rugo_version(void) {
    return RUGO_VERSION;
}

int error_give(int status, const struct error *from, struct rugo_error *to) {
    if (status != 0 && to != NULL) {
        to->code = status;
        snprintf(to->text, sizeof to->text, "%s", from->text);
    }
    return status;
}

struct grid grid_of_rugo(const struct rugo_grid *grid) {
    return (struct grid){.nx = grid->nx, .ny = grid->ny, .lx = grid->lx, .ly = grid->ly};
}

int grid_take(struct grid *out, const struct rugo_grid *grid, struct error *err) {
    *out = grid_of_rugo(grid);
    return grid_check(out, err);
}

void moments_give(const struct moments *from, struct rugo_moments *to) {
    *to = (struct rugo_moments){.m00 = from->m00,
                                .m20 = from->m20,
                                .m02 = from->m02,
                                .m11 = from->m11,
                                .m22 = from->m22,
                                .m40 = from->m40,
                                .m04 = from->m04,
                                .m31 = from->m31,
                                .m13 = from->m13,
                                .m0 = from->m0,
                                .m2 = from->m2,
                                .m4 = from->m4,
                                .nayak_alpha = from->nayak_alpha,
                                .rms_height = from->rms_height,
                                .rms_slope = from->rms_slope,
                                .rms_curvature = from->rms_curvature};
}

void roughness_give(const struct roughness *from, struct rugo_roughness *to) {
    *to = (struct rugo_roughness){.mean = from->mean,
                                  .rms_height = from->rms_height,
                                  .rms_slope = from->rms_slope,
                                  .rms_curvature = from->rms_curvature,
                                  .skewness = from->skewness,
                                  .kurtosis = from->kurtosis,
                                  .lowest = from->lowest,
                                  .highest = from->highest};
}

int stencil_take(enum summit_stencil *out, enum rugo_summit_rule rule, struct error *err) {
#define STENCIL(type, name, value) [RUGO_##type] = SUMMITS_##type,
    static const enum summit_stencil STENCILS[] = {RUGO_SUMMIT_RULES(STENCIL)};
#undef STENCIL
    if ((unsigned)rule >= sizeof STENCILS / sizeof *STENCILS)
        return error_set(err, ERROR_INPUT, "there is no rule %d for summits", (int)rule);
    *out = STENCILS[rule];
    return 0;
}

int summits_give(const struct summit_list *list, struct rugo_summits *out, struct error *err) {
    struct rugo_summit *summits = array_create(list->count, sizeof *summits);
    if (summits == NULL)
        return error_memory(err, list->count * sizeof *summits, "summits");
    for (size_t s = 0; s < list->count; s++) {
        const struct summit *from = &list->summits[s];
        summits[s] = (struct rugo_summit){from->x, from->y, from->height, from->curvature};
    }
    *out = (struct rugo_summits){summits, list->count};
    return 0;
}
