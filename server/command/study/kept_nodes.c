#include "server/command/study/kept_nodes.h"
#include "core/file/file.h"
#include "core/nodal/step_folder.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "server/command/command.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- the realisations of a case --- */

struct kept_order {
    const struct job_kind *kind;
    const cJSON *parameters; /* of the case */
    struct random_key key;   /* of its first realisation */
    uint64_t case_number;
    const char *folder;
};

static int is_stopped(void *context) {
    (void)context;
    return atomic_load(&stop_requested);
}

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
        int status = folder_make(writer->path, err);
        if (status != 0)
            return status;
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
static int press(struct kept_writer *writer, struct random_key key, const double *z,
                 const char *model, struct error *err) {
    const uint64_t realisation = key.realisation;
    const struct kept_order *order = writer->order;
    const struct steps_order steps = {
        .z = z, .key = key, .model = model, .kept = true, .stop = is_stopped};
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
    fprintf(stderr, "rugo run: warning: no nodes: %s\n", err->text);
    *err = (struct error){0};
    return 0;
}

static int write_realisation(struct kept_writer *writer, uint64_t realisation, struct error *err) {
    const struct kept_order *order = writer->order;
    struct surface_report report;
    struct random_key key = order->key;
    double *z = NULL;
    /* borrows what that one owns */
    struct surface_case stopped = *order->kind->surface(writer->one_case);
    stopped.options.stop = is_stopped;
    key.realisation = realisation;
    int status = realisation_surface(&stopped, key, &z, &report, err);
    for (size_t m = 0; m < writer->kept.model_count && status == 0; m++)
        status = press(writer, key, z, writer->kept.models[m], err);
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

/* Writes what a case keeps. */
static int write_kept(const struct kept_order *order, struct error *err) {
    struct kept_writer writer = {.order = order};
    void *one_case = NULL;
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

/* --- the cases of a study --- */

static int write_case(struct store *store, const char *id, const struct study_status *study,
                      struct kept_order *order, struct error *err) {
    struct case_info info = {0};
    int status = store_case(store, id, order->case_number, &info, err);
    if (status == 0) {
        order->parameters = info.parameters;
        order->key =
            (struct random_key){study->seed, study_sequence(study->random, order->case_number), 0};
        status = write_kept(order, err);
    }
    case_info_clear(&info);
    return status;
}

int kept_nodes_write(struct store *store, const char *id, const char *folder, struct error *err) {
    struct study_status study = {0};
    int status = store_status_counted(store, id, &study, err);
    if (status != 0)
        return status;
    struct kept_order order = {.kind = kind_find(study.kind), .folder = folder};
    bool may_keep = order.kind != NULL && order.kind->kept != NULL && study.realisations > 0;
    for (uint64_t c = 0; c < study.cases && may_keep && status == 0; c++) {
        order.case_number = c;
        status = write_case(store, id, &study, &order, err);
    }
    study_status_clear(&study);
    return status;
}

/* --- what an earlier study left --- */

/* What a folder holds: nodes/, in it folders of cases, in these of realisations, and so on. */
enum depth { DEPTH_NODES, DEPTH_CASES, DEPTH_REALISATIONS, DEPTH_MODELS, DEPTH_FILES };
enum { PATH_SIZE = 4096 };

/* Returns whether a name is these words around a number, as "case-3" is. */
static bool is_numbered(const char *name, const char *before, const char *behind) {
    size_t length = strlen(before);
    if (strncmp(name, before, length) != 0)
        return false;
    size_t digits = strspn(name + length, "0123456789");
    return digits > 0 && strcmp(name + length + digits, behind) == 0;
}

/* Returns whether kept_nodes_write gives this name to what lies in a folder of this depth. */
static bool is_own_name(enum depth depth, const char *name) {
    if (depth == DEPTH_CASES)
        return is_numbered(name, "case-", "");
    if (depth == DEPTH_REALISATIONS)
        return is_numbered(name, "realisation-", "");
    if (depth == DEPTH_MODELS)
        return name[0] != '.';
    return strcmp(name, "nodes.csv") == 0 || strcmp(name, "steps.pvd") == 0 ||
           is_numbered(name, "step-", ".vtu");
}

static int remove_own(enum depth depth, const char *folder, struct error *err);

static int remove_one(enum depth depth, const char *folder, const char *name, struct error *err) {
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder);
    if (depth != DEPTH_FILES)
        return remove_own(depth + 1, path, err);
    return unlink(path) == 0 || errno == EISDIR /* somebody's own */
               ? 0
               : error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
}

/* Removes what has a name of this depth, and the folder where that was all. */
static int remove_own(enum depth depth, const char *folder, struct error *err) {
    int status = 0;
    DIR *list = opendir(folder);
    if (list == NULL)
        return errno == ENOENT || errno == ENOTDIR
                   ? 0
                   : error_set(err, ERROR_SYSTEM, "folder %s: %s", folder, strerror(errno));
    for (const struct dirent *one; status == 0 && (one = readdir(list)) != NULL;)
        if (is_own_name(depth, one->d_name))
            status = remove_one(depth, folder, one->d_name, err);
    (void)closedir(list);
    if (status == 0)
        (void)rmdir(folder); /* it stays where it holds something else */
    return status;
}

int kept_nodes_remove(const char *folder, struct error *err) {
    return remove_one(DEPTH_NODES, folder, "nodes", err);
}
