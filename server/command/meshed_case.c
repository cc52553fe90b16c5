#include "server/command/meshed_case.h"
#include "core/full/mesh_file.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_solver.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct meshed {
    struct contact_case study;
    size_t model;     /* full */
    double rms_slope; /* of the prescribed spectrum */
    struct full *full;
    double *z; /* on the finest level */
};

static void meshed_clear(struct meshed *meshed) {
    full_destroy(&meshed->full);
    contact_case_clear(&meshed->study);
    free(meshed->z);
}

static int read_slope(struct meshed *meshed, struct error *err) {
    const struct surface_case *surface = &meshed->study.surface;
    struct modes *modes;
    struct moments moments;
    int status = modes_create(&modes, &surface->spectrum, &surface->grid, err);
    if (status != 0)
        return status;
    modes_moments(modes, &moments);
    modes_destroy(&modes);
    meshed->rms_slope = moments.rms_slope;
    return 0;
}

/* Leaves what was made in *out, also on failure. */
static int meshed_open(struct meshed *out, const cJSON *parameters, const double *z,
                       struct error *err) {
    *out = (struct meshed){0};
    struct contact_case *study = &out->study;
    int status = contact_case_read(study, parameters, NULL, err);
    if (status != 0)
        return status;
    out->model = contact_case_full(study);
    if (out->model == study->model_count)
        return error_set(err, ERROR_INPUT, "--mesh needs \"full\" among /contact/model");
    const struct contact_level *finest = contact_case_finest(study);
    size_t points = grid_points(&finest->grid);
    out->z = array_create(points, sizeof *out->z);
    if (out->z == NULL)
        return error_memory(err, points * sizeof *out->z, "a surface");
    struct full_options options = contact_full_options(study);
    status = read_slope(out, err);
    if (status == 0)
        status = contact_level_sample(study, finest, z, out->z, err);
    if (status == 0)
        status = full_create(&out->full, &finest->grid, &study->blocks[out->model], &options, err);
    return status != 0 ? status : full_begin(out->full, out->z, err);
}

static int write_file(const char *path, const char *title, const struct mesh *mesh,
                      const struct mesh_step *step, struct error *err) {
    FILE *file = fopen(path, "wb");
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot open %s: %s", path, strerror(errno));
    int status = mesh_file_write(file, title, mesh, step, err);
    if (fclose(file) != 0 && status == 0)
        status = error_set(err, ERROR_SYSTEM, "cannot write %s: %s", path, strerror(errno));
    return status;
}

int meshed_case_write(const char *path, const cJSON *parameters, const double *z, double pressure,
                      struct error *err) {
    struct meshed meshed;
    struct mesh_step step = {0};
    char title[160] = "lengths in lambda_s";
    int status = meshed_open(&meshed, parameters, z, err);
    if (status == 0 && pressure > 0) {
        enum kinematics kinematics = meshed.study.kinematics;
        status = full_press(meshed.full, pressure * meshed.rms_slope, &step.face, NULL, err);
        step.material = material_of(meshed.study.blocks[meshed.model].poisson, kinematics);
        step.unit = meshed.rms_slope;
        snprintf(title, sizeof title,
                 "lengths in lambda_s; pressure and stress in E* h'; mean pressure %.9g; "
                 "kinematics %s",
                 pressure, kinematics_name(kinematics));
    }
    if (status == 0) {
        step.u = full_displacement(meshed.full);
        status = write_file(path, title, full_mesh(meshed.full), pressure > 0 ? &step : NULL, err);
    }
    meshed_clear(&meshed);
    return status;
}
