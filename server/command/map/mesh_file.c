#include "server/command/map/mesh_file.h"
#include "core/file/file.h"
#include "core/file/written_file.h"
#include "core/full/file/mesh_msh.h"
#include "core/nodal/step_folder.h"
#include "server/command/output_file.h"
#include <stdlib.h>

static int write_block(const struct mesh_file *mesh, FILE *file, const struct nodal_step *step,
                       struct error *err) {
    const struct inp_model model = {.mesh = step->mesh,
                                    .material = step->step->material,
                                    .step_count = step->load > 0 ? mesh->count : 0,
                                    .steps = mesh->history};
    if (file_ends_in(mesh->path, ".msh"))
        return mesh_msh(file, step->mesh, err);
    if (file_ends_in(mesh->path, ".inp"))
        return mesh_inp(file, step->lengths, &model, err);
    return step_vtu(file, step, err);
}

int mesh_file_check(const char *mesh, const char *nodes, struct error *err) {
    static const char *const MESHES[] = {".vtu", ".msh", ".inp", NULL}, *const CSV[] = {".csv",
                                                                                        NULL};
    int status = mesh != NULL ? output_file_check_ending(mesh, "--mesh", MESHES, err) : 0;
    return status == 0 && nodes != NULL ? output_file_check_ending(nodes, "--nodes", CSV, err)
                                        : status;
}

int mesh_file_write(const struct mesh_file *mesh, const struct nodal_step *step,
                    struct error *err) {
    struct written_file file;
    int status = file_ends_in(mesh->path, ".msh") ? mesh_msh_check(step->mesh, err) : 0;
    if (status == 0)
        status = written_file_open(&file, mesh->path, err);
    if (status != 0)
        return status;
    status = write_block(mesh, file.stream, step, err);
    return written_file_close(&file, status, err);
}

/* Notes how far the far side moved towards the flat. */
int mesh_file_note(struct mesh_file *mesh, const struct nodal_step *step, size_t most,
                   struct error *err) {
    if (mesh->path == NULL)
        return 0;
    if (mesh->history == NULL)
        mesh->history = array_create(most, sizeof *mesh->history);
    if (mesh->history == NULL)
        return error_memory(err, most * sizeof *mesh->history, "steps");
    size_t far_side = mesh_vertical(step->mesh, mesh_far_side(step->mesh));
    mesh->history[mesh->count++] =
        (struct inp_step){-step->step->u[far_side], step->step->face.pressure};
    return 0;
}

void mesh_file_clear(struct mesh_file *mesh) {
    free(mesh->history);
    *mesh = (struct mesh_file){.path = NULL};
}
