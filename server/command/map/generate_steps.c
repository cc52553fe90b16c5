#include "server/command/map/generate_steps.h"
#include "core/file.h"
#include "core/full/file/mesh_inp.h"
#include "core/full/file/mesh_msh.h"
#include "core/nodal/step_folder.h"
#include "jobs/kind.h"
#include "server/command/exit_status.h"
#include "server/command/output_file.h"
#include "server/show/quantity.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    struct inp_step *history; /* owned: of the loads so far */
    size_t count;
};

static int write_mesh(const struct step_files *files, FILE *file, const struct nodal_step *step,
                      struct error *err) {
    const char *path = files->words->mesh;
    const struct inp_model model = {.mesh = step->mesh,
                                    .material = step->step->material,
                                    .step_count = step->load > 0 ? files->count : 0,
                                    .steps = files->history};
    if (file_ends_in(path, ".msh"))
        return mesh_msh(file, step->mesh, err);
    if (file_ends_in(path, ".inp"))
        return mesh_inp(file, step->title, &model, err);
    return step_vtu(file, step, err);
}

static int put_mesh(const struct step_files *files, const struct nodal_step *step,
                    struct error *err) {
    FILE *file;
    int status = file_open(&file, files->words->mesh, err);
    if (status != 0)
        return status;
    status = write_mesh(files, file, step, err);
    status = file_close(file, files->words->mesh, status, err);
    if (status != 0)
        (void)unlink(files->words->mesh);
    return status;
}

/* Notes how far the far side moved towards the flat. */
static int note_step(struct step_files *files, const struct nodal_step *step, size_t count,
                     struct error *err) {
    if (files->history == NULL)
        files->history = array_create(count, sizeof *files->history);
    if (files->history == NULL)
        return error_memory(err, count * sizeof *files->history, "steps");
    size_t far_side = mesh_vertical(step->mesh, mesh_far_side(step->mesh));
    files->history[files->count++] =
        (struct inp_step){-step->step->u[far_side], step->step->face.pressure};
    return 0;
}

static int put_step(void *context, const struct nodal_step *step, size_t number, size_t count,
                    struct error *err) {
    struct step_files *files = context;
    int status = step->load > 0 ? step_folder_put(&files->folder, step, err) : 0;
    if (status != 0 || files->words->mesh == NULL)
        return status;
    status = note_step(files, step, count, err);
    return status == 0 && number + 1 == count ? put_mesh(files, step, err) : status;
}

static const struct job_kind *kind_with_contact(void) {
    size_t k = 0;
    while (JOB_KINDS[k] != NULL && kind_of(JOB_KINDS[k])->press_steps == NULL)
        k++;
    return JOB_KINDS[k] != NULL ? kind_of(JOB_KINDS[k]) : NULL;
}

static int press(struct step_files *files, const struct job_kind *kind, const cJSON *parameters,
                 const double *z, struct error *err) {
    static const double UNLOADED = 0;
    const struct step_words *words = files->words;
    double loads[STEP_LOADS_MOST];
    void *one_case = NULL;
    struct steps_order order = {.z = z, .model = words->model, .meshed = words->mesh != NULL};
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
                   const double *z, struct error *err) {
    const struct job_kind *kind = kind_of(study->kind), *contact = kind_with_contact();
    struct step_files files = {.words = words};
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
        status = press(&files, kind, study->cases[case_number].parameters, z, err);
    status = step_folder_close(&files.folder, status, err);
    free(files.history);
    return status;
}
