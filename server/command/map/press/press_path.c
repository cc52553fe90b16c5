#include "server/command/map/press/press_path.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/case/contact_loads.h"
#include <math.h>
#include <stdlib.h>

/* As in studies (quantity_sliding.c). */
enum { TURNS_MOST = 100, STEPS = 30 };
static const double SLIDE_MOST = 1e3, SLIPS = 4;

/* Reads numbers; false where they are no turning points. */
static bool read_turns(const char *text, double turns[TURNS_MOST], size_t *count) {
    for (*count = 0; *count < TURNS_MOST; text++) {
        char *end;
        double at = strtod(text, &end);
        if (end == text || !(fabs(at) <= SLIDE_MOST))
            return false;
        turns[(*count)++] = at;
        text = end;
        if (*text == '\0')
            return contact_loads_turns(turns, *count) == *count;
        if (*text != ',')
            return false;
    }
    return false;
}

int press_path_parse(struct press_path *out, const char *turns, unsigned steps, double friction,
                     struct error *err) {
    double at[TURNS_MOST] = {SLIPS * friction};
    size_t count = 1;
    if (turns != NULL && !read_turns(turns, at, &count))
        return error_set(err, ERROR_INPUT,
                         "--slide-to %.40s: not up to %d numbers, each up to %g to either side, at "
                         "which the flat turns: forth and back, the first not 0",
                         turns, TURNS_MOST, SLIDE_MOST);
    out->steps = steps > 0 ? steps : STEPS;
    out->count = count * out->steps + 1;
    if (out->count > CONTACT_LOADS_MOST)
        return error_set(err, ERROR_INPUT,
                         "--slide-steps %zu to each of %zu turning points; allowed: %d in all",
                         out->steps, count, CONTACT_LOADS_MOST - 1);
    out->at = array_create(out->count, sizeof *out->at);
    if (out->at == NULL)
        return error_memory(err, out->count * sizeof *out->at, "a path of the flat");
    contact_loads_path(at, count, out->steps, out->at);
    return 0;
}

void press_path_clear(struct press_path *path) {
    free(path->at);
    *path = (struct press_path){0};
}
