/* The block of the model full on its true geometry, as a file for other programs. */
#include "core/full/mesh_file.h"
#include "jobs/contact/contact_sample.h"
#include "jobs/contact/model_full.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct meshed {
    struct full *full;
    double *z; /* on the finest level */
};

static void meshed_clear(struct meshed *meshed) {
    full_destroy(&meshed->full);
    free(meshed->z);
}

/* Leaves what was made in *out, also on failure. */
static int meshed_open(struct meshed *out, const struct contact_case *one_case, size_t model,
                       const double *z, struct error *err) {
    const struct contact_level *finest = contact_case_finest(one_case);
    struct full_options options = full_model_options(one_case);
    size_t points = grid_points(&finest->grid);
    *out = (struct meshed){.z = array_create(points, sizeof *out->z)};
    if (out->z == NULL)
        return error_memory(err, points * sizeof *out->z, "a surface");
    int status = contact_level_sample(one_case, finest, z, out->z, err);
    if (status == 0)
        status = full_create(&out->full, &finest->grid, &one_case->blocks[model], &options, err);
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

int full_write_mesh(const char *path, const struct contact_case *one_case, size_t model,
                    const double *z, double pressure, struct error *err) {
    struct meshed meshed;
    struct mesh_step step = {0};
    char title[160] = "lengths in lambda_s";
    int status = meshed_open(&meshed, one_case, model, z, err);
    if (status == 0 && pressure > 0) {
        status = full_press(meshed.full, pressure * one_case->rms_slope, &step.face, NULL, err);
        step.material = material_of(one_case->blocks[model].poisson, one_case->kinematics);
        step.unit = one_case->rms_slope;
        snprintf(title, sizeof title,
                 "lengths in lambda_s; pressure and stress in E* h'; mean pressure %.9g; "
                 "kinematics %s",
                 pressure, choice_name(KINEMATICS_CHOICES, (int)one_case->kinematics));
    }
    if (status == 0) {
        step.u = full_displacement(meshed.full);
        status = write_file(path, title, full_mesh(meshed.full), pressure > 0 ? &step : NULL, err);
    }
    meshed_clear(&meshed);
    return status;
}
