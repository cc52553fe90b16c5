#include "core/nodal/step_folder.h"
#include "core/file/file.h"
#include "core/file/written_file.h"
#include "core/nodal/map_vtu.h"
#include "core/nodal/node_table.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Writes the path of a file of the folder into folder->name. */
static void name_step(struct step_folder *folder, size_t number) {
    snprintf(folder->name, folder->name_size, "%s/step-%zu.vtu", folder->path, number);
}

static void name_collection(struct step_folder *folder) {
    snprintf(folder->name, folder->name_size, "%s/steps.pvd", folder->path);
}

/* Opens a file to go on at its end: what an earlier run left stays until begin(). */
static int open_kept(FILE **file, const char *path, struct error *err) {
    *file = fopen(path, "ab");
    return *file != NULL
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot open %s: %s", path, strerror(errno));
}

/* Closes it, and returns the status of what was written, or that of the file, which may be full. */
static int close_kept(FILE *file, const char *path, int status, struct error *err) {
    bool failed = ferror(file) != 0;
    if ((fclose(file) != 0 || failed) && status == 0)
        status = error_set(err, ERROR_SYSTEM, "cannot write %s: %s", path, strerror(errno));
    return status;
}

static int collection_open(struct step_folder *folder, struct error *err) {
    int status = folder_make(folder->path, err);
    if (status != 0)
        return status;
    folder->name_size = strlen(folder->path) + 40; /* "/step-", 20 digits, ".vtu" */
    folder->name = array_create(folder->name_size, 1);
    if (folder->name == NULL)
        return error_memory(err, folder->name_size, "a path");
    name_collection(folder);
    return open_kept(&folder->collection, folder->name, err);
}

int step_folder_open(struct step_folder *out, const char *path, const char *nodes,
                     struct error *err) {
    *out = (struct step_folder){.path = path, .nodes = nodes};
    int status = path != NULL ? collection_open(out, err) : 0;
    if (status == 0 && nodes != NULL)
        status = open_kept(&out->table, nodes, err);
    return status == 0 ? 0 : step_folder_close(out, status, err);
}

int step_vtu(FILE *file, const struct nodal_step *step, struct error *err) {
    const struct map_field fields[] = {
        {"pressure", step->p}, {"gap", step->gap}, {"contact", step->contact}};
    if (step->mesh != NULL)
        return mesh_vtu(file, step->title, step->mesh, step->load > 0 ? step->step : NULL, err);
    return map_vtu(file, step->title, &step->grid, step->z, sizeof fields / sizeof *fields, fields,
                   err);
}

static int put_vtu(struct step_folder *folder, const struct nodal_step *step, struct error *err) {
    struct written_file file;
    name_step(folder, folder->count);
    int status = written_file_open(&file, folder->name, err);
    if (status != 0)
        return status;
    status = step_vtu(file.stream, step, err);
    status = written_file_close(&file, status, err);
    if (status == 0)
        fprintf(folder->collection,
                "    <DataSet timestep=\"%.9g\" group=\"\" part=\"0\" file=\"step-%zu.vtu\"/>\n",
                step->load, folder->count);
    return status;
}

/* Takes away what an earlier run left in a file; pipes and devices hold nothing. */
static int empty(FILE *file, const char *path, struct error *err) {
    if (ftruncate(fileno(file), 0) == 0 || errno == EINVAL)
        return 0;
    return error_set(err, ERROR_SYSTEM, "cannot empty %s: %s", path, strerror(errno));
}

static int begin(struct step_folder *folder, struct error *err) {
    int status = 0;
    if (folder->collection != NULL) {
        name_collection(folder);
        status = empty(folder->collection, folder->name, err);
        fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
              "byte_order=\"LittleEndian\">\n  <Collection>\n",
              folder->collection);
    }
    return status == 0 && folder->table != NULL ? empty(folder->table, folder->nodes, err) : status;
}

int step_folder_put(struct step_folder *folder, const struct nodal_step *step, struct error *err) {
    int status = folder->count++ == 0 ? begin(folder, err) : 0;
    if (status == 0 && folder->path != NULL)
        status = put_vtu(folder, step, err);
    if (status == 0 && folder->table != NULL)
        status = node_table_put(folder->table, folder->count == 1, step, err);
    return status;
}

/* Removes the steps that a longer earlier run left: it numbered its files in a row. */
static int remove_left(struct step_folder *folder, struct error *err) {
    for (size_t number = folder->count + 1;; number++) {
        name_step(folder, number);
        if (unlink(folder->name) != 0)
            return errno == ENOENT ? 0
                                   : error_set(err, ERROR_SYSTEM, "cannot remove %s: %s",
                                               folder->name, strerror(errno));
    }
}

/* Removes a file that was made for this run, and has nothing in it. */
static void remove_empty(const char *path) {
    struct stat file;
    if (stat(path, &file) == 0 && S_ISREG(file.st_mode) && file.st_size == 0)
        (void)unlink(path);
}

int step_folder_close(struct step_folder *folder, int status, struct error *err) {
    const bool kept = status != 0 && folder->count == 0;
    if (status == 0 && folder->count == 0)
        status = begin(folder, err);
    if (folder->collection != NULL) {
        int removed = kept ? 0 : remove_left(folder, status == 0 ? err : NULL);
        status = status != 0 ? status : removed;
        if (!kept)
            fputs("  </Collection>\n</VTKFile>\n", folder->collection);
        name_collection(folder);
        status = close_kept(folder->collection, folder->name, status, err);
        if (kept)
            remove_empty(folder->name);
    }
    if (folder->table != NULL) {
        status = close_kept(folder->table, folder->nodes, status, err);
        if (kept)
            remove_empty(folder->nodes);
    }
    free(folder->name);
    *folder = (struct step_folder){0};
    return status;
}
