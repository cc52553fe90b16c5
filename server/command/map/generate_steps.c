#include "server/command/map/generate_steps.h"
#include "core/nodal/step_folder.h"
#include "jobs/kind.h"
#include "server/command/exit_status.h"
#include "server/command/map/mesh_file.h"
#include "server/command/output_file.h"
#include "server/show/quantity.h"
#include <string.h>

enum { STEP_LOADS_MOST = 1000 };

bool step_words_ask(const struct step_words *words) {
    return words->mesh != NULL || words->steps != NULL || words->nodes != NULL;
}

/* Reads the loads; none where none are given. */
static bool read_loads(const struct step_words *words, double loads[STEP_LOADS_MOST],
                       size_t *count) {
    *count = 0;
    return words->pressure == NULL ||
           rising_numbers(words->pressure, STEP_LOADS_MOST, loads, count);
}

int step_words_check(const struct step_words *words) {
    double loads[STEP_LOADS_MOST];
    size_t count;
    if (!step_words_ask(words) && (words->pressure != NULL || words->model != NULL))
        return usage_error("generate", "--%s belongs to --mesh, --steps or --nodes",
                           words->pressure != NULL ? "pressure" : "model");
    if (!read_loads(words, loads, &count))
        return usage_error("generate", "--pressure %.40s: not up to %d rising numbers above 0",
                           words->pressure, STEP_LOADS_MOST);
    return 0;
}

/* The files that are written while loads are solved. */
struct step_files {
    const struct step_words *words;
    struct step_folder folder;
    struct mesh_file mesh;
};

static int put_step(void *context, const struct nodal_step *step, size_t number, size_t count,
                    struct error *err) {
    struct step_files *files = context;
    int status = step->load > 0 ? step_folder_put(&files->folder, step, err) : 0;
    if (status != 0 || files->words->mesh == NULL)
        return status;
    status = mesh_file_note(&files->mesh, step, count, err);
    return status == 0 && number + 1 == count ? mesh_file_write(&files->mesh, step, err) : status;
}

static const struct job_kind *kind_with_contact(void) {
    size_t k = 0;
    while (JOB_KINDS[k] != NULL && kind_of(JOB_KINDS[k])->press_steps == NULL)
        k++;
    return JOB_KINDS[k] != NULL ? kind_of(JOB_KINDS[k]) : NULL;
}

static int press(struct step_files *files, const struct job_kind *kind, const cJSON *parameters,
                 struct random_key key, const double *z, struct error *err) {
    static const double UNLOADED = 0;
    const struct step_words *words = files->words;
    double loads[STEP_LOADS_MOST];
    void *one_case = NULL;
    struct steps_order order = {
        .z = z, .key = key, .model = words->model, .meshed = words->mesh != NULL};
    const struct steps_sink sink = {put_step, files};
    (void)read_loads(words, loads, &order.load_count);
    order.loads = loads;
    if (order.load_count == 0 && words->steps == NULL && words->nodes == NULL) {
        order.load_count = 1;
        order.loads = &UNLOADED;
    }
    int status = kind_case_create(&one_case, kind, parameters, NULL, err);
    if (status == 0)
        status = kind->press_steps(one_case, &order, &sink, err);
    kind_case_destroy(kind, &one_case);
    return status;
}

int generate_steps(const struct step_words *words, const struct study *study, size_t case_number,
                   struct random_key key, const double *z, struct error *err) {
    const struct job_kind *kind = kind_of(study->kind), *contact = kind_with_contact();
    struct step_files files = {.words = words, .mesh = {.path = words->mesh}};
    if (kind->press_steps == NULL)
        return error_set(err, ERROR_INPUT, "--%s needs a study of kind %s, and this is %s",
                         words->mesh != NULL    ? "mesh"
                         : words->steps != NULL ? "steps"
                                                : "nodes",
                         contact != NULL ? contact->study.name : "with contact", study->kind->name);
    int status = words->mesh != NULL ? output_file_check(words->mesh, err) : 0;
    if (status == 0)
        status = step_folder_open(&files.folder, words->steps, words->nodes, err);
    if (status == 0)
        status = press(&files, kind, study->cases[case_number].parameters, key, z, err);
    status = step_folder_close(&files.folder, status, err);
    mesh_file_clear(&files.mesh);
    return status;
}
