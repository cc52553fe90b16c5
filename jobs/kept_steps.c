#include "jobs/kept_steps.h"
#include "core/nodal/step_folder.h"
#include "jobs/surface/realisation_map.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Room for "/nodes/case-K/realisation-R/MODEL/nodes.csv" behind the folder. */
enum { NAMES_SIZE = 160 };

struct kept_writer {
    const struct kept_order *order;
    const void *one_case;
    struct kept_steps kept;
    char *path, *table; /* owned: folder of a model, and its table of nodes */
    size_t size;
};

/* Writes the path of a model's folder, and makes the folders that lead to it. */
static int make_folders(struct kept_writer *writer, uint64_t realisation, const char *model,
                        struct error *err) {
    const struct kept_order *order = writer->order;
    snprintf(writer->path, writer->size, "%s/nodes/case-%llu/realisation-%llu/%s", order->folder,
             (unsigned long long)order->case_number, (unsigned long long)realisation, model);
    snprintf(writer->table, writer->size, "%s/nodes.csv", writer->path);
    for (char *slash = writer->path + strlen(order->folder) + 1;
         (slash = strchr(slash, '/')) != NULL; *slash++ = '/') {
        *slash = '\0';
        if (mkdir(writer->path, 0777) != 0 && errno != EEXIST)
            return error_set(err, ERROR_SYSTEM, "cannot make %s: %s", writer->path,
                             strerror(errno));
    }
    return 0;
}

static int put(void *context, const struct nodal_step *step, size_t number, size_t count,
               struct error *err) {
    (void)number;
    (void)count;
    return step_folder_put(context, step, err);
}

/* Presses a surface by one model. Where it finds no solution, the other models go on. */
static int press(struct kept_writer *writer, uint64_t realisation, const double *z,
                 const char *model, struct error *err) {
    const struct kept_order *order = writer->order;
    const struct steps_order steps = {.z = z,
                                      .model = model,
                                      .load_count = writer->kept.load_count,
                                      .loads = writer->kept.loads,
                                      .stop = order->stop,
                                      .stop_context = order->stop_context};
    struct step_folder folder = {0};
    const struct steps_sink sink = {put, &folder};
    int status = make_folders(writer, realisation, model, err);
    if (status == 0)
        status = step_folder_open(&folder, writer->path, writer->table, err);
    if (status != 0)
        return status;
    status = order->kind->press_steps(writer->one_case, &steps, &sink, err);
    status = step_folder_close(&folder, status, err);
    if (status == 0)
        return 0;
    error_context(err, "case %llu, realisation %llu", (unsigned long long)order->case_number,
                  (unsigned long long)realisation);
    if (status != ERROR_NUMERIC && status != ERROR_INPUT)
        return status;
    order->unsolved(err);
    *err = (struct error){0};
    return 0;
}

static int write_realisation(struct kept_writer *writer, uint64_t realisation, struct error *err) {
    const struct kept_order *order = writer->order;
    struct surface_report report;
    struct random_key key = order->key;
    double *z = NULL;
    key.realisation = realisation;
    int status = realisation_surface(order->kind->surface(writer->one_case), key, &z, &report, err);
    for (size_t m = 0; m < writer->kept.model_count && status == 0; m++)
        status = press(writer, realisation, z, writer->kept.models[m], err);
    free(z);
    return status;
}

static int write_all(struct kept_writer *writer, struct error *err) {
    writer->size = strlen(writer->order->folder) + NAMES_SIZE;
    writer->path = array_create(writer->size, 1);
    writer->table = array_create(writer->size, 1);
    int status = writer->path != NULL && writer->table != NULL
                     ? 0
                     : error_memory(err, 2 * writer->size, "a path");
    for (size_t r = 0; r < writer->kept.count && status == 0; r++)
        status = write_realisation(writer, (uint64_t)writer->kept.realisations[r], err);
    free(writer->path);
    free(writer->table);
    return status;
}

int kept_steps_write(const struct kept_order *order, struct error *err) {
    struct kept_writer writer = {.order = order};
    void *one_case = NULL;
    if (order->kind->kept == NULL)
        return 0;
    int status = kind_case_create(&one_case, order->kind, order->parameters, NULL, err);
    if (status != 0)
        return status;
    writer.one_case = one_case;
    writer.kept = order->kind->kept(one_case);
    if (writer.kept.count > 0)
        status = write_all(&writer, err);
    kind_case_destroy(order->kind, &one_case);
    return status;
}
