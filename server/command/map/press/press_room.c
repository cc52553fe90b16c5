#include "server/command/map/press/press_room.h"
#include "jobs/kind.h"
#include "server/show/summary/summary_cells.h"

enum { DURATION = 40 };
static const double MIB = 1 << 20;

static struct press_cost cost_of(const struct press_room_order *order, size_t m) {
    const struct grid *map = &order->press->map;
    return press_cost_of(order->press, &order->blocks[m], &order->goals, map->nx, map->ny);
}

static struct press_room room_of(const struct press_room_order *order) {
    return (struct press_room){.bytes = kind_memory_limit(),
                               .seconds = order->seconds_most,
                               .with_errors = order->with_errors};
}

static double all_seconds(const struct press_room_order *order, const struct press_cost *cost) {
    return cost->seconds + (order->with_errors ? cost->error_seconds : 0);
}

/* Says which smaller maps fit: all of it with fewer points, or a part. */
static void advise(const struct press_room_order *order, size_t m, char *text, size_t size) {
    const struct press_room room = room_of(order);
    size_t nx, ny;
    if (!press_cost_largest(order->press, &order->blocks[m], &order->goals, &room, &nx, &ny))
        snprintf(text, size, "no map of this shape with %d points along a side is small enough",
                 PRESS_SIDE_LEAST);
    else if (grid_is_profile(&order->press->map))
        snprintf(text, size,
                 "--resample %zu takes all of it with fewer points, --crop 0,0,%zu,1 a part", nx,
                 nx);
    else
        snprintf(text, size,
                 "--resample %zu,%zu takes all of it with fewer points, --crop 0,0,%zu,%zu a part",
                 nx, ny, nx, ny);
}

static int refuse(const struct press_room_order *order, size_t m, const struct press_cost *cost,
                  struct error *err) {
    const struct press_room room = room_of(order);
    const char *name = contact_model_name(order->blocks[m].model);
    char advice[160], takes[DURATION], most[DURATION];
    advise(order, m, advice, sizeof advice);
    if (!(cost->nodes > 0))
        return error_set(err, ERROR_INPUT, "%zu by %zu points are too many for a mesh of %s; %s",
                         cost->pressed.nx, cost->pressed.ny, name, advice);
    if (room.bytes > 0 && cost->bytes > room.bytes)
        return error_set(err, ERROR_INPUT,
                         "the model %s needs about %.3g MiB for %zu by %zu points (%.3g nodes), "
                         "and may use %.3g; %s",
                         name, cost->bytes / MIB, cost->pressed.nx, cost->pressed.ny, cost->nodes,
                         room.bytes / MIB, advice);
    duration_text(all_seconds(order, cost), takes, sizeof takes);
    duration_text(room.seconds, most, sizeof most);
    return error_set(err, ERROR_INPUT,
                     "the model %s takes about %s of CPU time for %zu by %zu points (%.3g nodes), "
                     "and may take %s (--limit); %s",
                     name, takes, cost->pressed.nx, cost->pressed.ny, cost->nodes, most, advice);
}

int press_room_check(const struct press_room_order *order, struct error *err) {
    const struct press_room room = room_of(order);
    for (size_t m = 0; m < order->model_count; m++) {
        if (!press_cost_is_known(order->blocks[m].model))
            continue;
        const struct press_cost cost = cost_of(order, m);
        if (!press_cost_fits(&cost, &room))
            return refuse(order, m, &cost, err);
    }
    return 0;
}

double press_room_seconds(const struct press_room_order *order, size_t m) {
    return press_cost_is_known(order->blocks[m].model) ? cost_of(order, m).seconds : 0;
}

void press_room_print(FILE *file, const struct press_room_order *order) {
    for (size_t m = 0; m < order->model_count; m++) {
        const char *name = contact_model_name(order->blocks[m].model);
        char takes[DURATION], beside[DURATION];
        if (!press_cost_is_known(order->blocks[m].model)) {
            fprintf(file, "model %s: no mesh; nothing is estimated\n", name);
            continue;
        }
        const struct press_cost cost = cost_of(order, m);
        duration_text(cost.seconds, takes, sizeof takes);
        duration_text(cost.error_seconds, beside, sizeof beside);
        fprintf(file,
                "model %s: %zu by %zu points, %.3g nodes\n"
                "memory: %.0f MiB\n"
                "CPU time: %s",
                name, cost.pressed.nx, cost.pressed.ny, cost.nodes, cost.bytes / MIB, takes);
        fprintf(file, order->with_errors ? ", and %s for errors by the points\n" : "\n", beside);
    }
}
