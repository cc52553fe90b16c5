#include "server/show/output.h"
#include "core/file/file.h"
#include "core/file/written_file.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/show/plot/plot.h"
#include "server/show/plot/plot_density.h"
#include "server/show/view.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 4096 };

/* Opens a file of the folder. */
static int open_file(struct written_file *file, const char *folder, const char *name,
                     struct error *err) {
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder);
    return written_file_open(file, path, err);
}

static bool print_json(FILE *file, const struct study_result *study) {
    return study_print(file, study) && fputc('\n', file) != EOF;
}

/* Writes a file of all curves; print is false when out of memory. */
static int write_curves(const struct study_result *study, const char *folder, const char *name,
                        bool (*print)(FILE *file, const struct study_result *study),
                        struct error *err) {
    struct written_file file;
    int status = open_file(&file, folder, name, err);
    if (status != 0)
        return status;
    if (!print(file.stream, study) && ferror(file.stream) == 0)
        status = error_memory(err, 0, "a document of curves");
    return written_file_close(&file, status, err);
}

/* --- pictures --- */

/* Writes a name such as "case-3-summit_joint_pdf.svg". */
static void picture_name(const struct case_result *one, const struct curve *curve, char *name,
                         size_t size) {
    const char *const parts[] = {curve->series, curve->model, curve->kinematics};
    size_t used = (size_t)snprintf(name, size, "case-%llu", (unsigned long long)one->case_number);
    if (one->difference)
        used +=
            (size_t)snprintf(name + used, size - used, "-less-%llu", (unsigned long long)one->less);
    used += (size_t)snprintf(name + used, size - used, "-%.60s", curve->quantity);
    for (size_t p = 0; p < sizeof parts / sizeof *parts; p++)
        if (parts[p] != NULL && *parts[p] != '\0')
            used += (size_t)snprintf(name + used, size - used, "-%.40s", parts[p]);
    if (!isnan(curve->level))
        used += (size_t)snprintf(name + used, size - used, "-%g", curve->level);
    if (!isnan(curve->pressure))
        used += (size_t)snprintf(name + used, size - used, "-at-%g", curve->pressure);
    snprintf(name + used, size - used, ".svg");
}

/* A matrix has a picture of its own, where it has values. */
static int write_density(const struct study_result *study, const struct case_result *one,
                         const struct curve *curve, const char *folder, struct error *err) {
    char name[256];
    struct written_file file;
    if (curve->columns == 0 || curve->cell_count == 0)
        return 0;
    picture_name(one, curve, name, sizeof name);
    int status = open_file(&file, folder, name, err);
    if (status != 0)
        return status;
    status = plot_density(study, one, curve, 0, file.stream, err);
    return written_file_close(&file, status, err);
}

static int write_densities(const struct study_result *study, const char *folder,
                           struct error *err) {
    int status = 0;
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count && status == 0; a++)
            status =
                write_density(study, &study->cases[c], &study->cases[c].curves[a], folder, err);
    return status;
}

/* Writes no picture where there is no point to draw: all values are missing, or those of
 * logarithmic axes are not above 0. */
static int write_plot(const struct study_result *study, const struct plot_request *request,
                      const char *folder, const char *name, struct error *err) {
    struct written_file file;
    int status = open_file(&file, folder, name, err);
    if (status != 0)
        return status;
    status = plot_quantity(study, request, file.stream, err);
    if (status == ERROR_ABSENT)
        (void)unlink(file.path); /* of an earlier run, which had points */
    status = written_file_close(&file, status, err);
    return status == ERROR_ABSENT ? 0 : status;
}

/* A quantity in several units (patches in the cell, patches per wave) takes a picture each, the
 * first one under the quantity's own name. The view may ask for one more with logarithmic axes. */
static int write_plots_of(const struct study_result *study, const struct curve *curve,
                          bool first_unit, const char *folder, struct error *err) {
    const struct logarithmic_picture *more =
        view_logarithmic(view_of(study->kind), curve->quantity);
    struct plot_request request = {
        .lines = {.quantity = curve->quantity, .y_label = curve->y_label}};
    const char *series = curve->series != NULL ? curve->series : "";
    char name[192];
    snprintf(name, sizeof name, "%.100s%s%.60s.svg", curve->quantity, first_unit ? "" : "-",
             first_unit ? "" : series);
    int status = write_plot(study, &request, folder, name, err);
    if (status == 0 && first_unit && more != NULL && more->suffix != NULL) {
        request.axes = AXES_XY;
        request.theories_whole = true;
        snprintf(name, sizeof name, "%.100s-%.60s.svg", curve->quantity, more->suffix);
        status = write_plot(study, &request, folder, name, err);
    }
    return status;
}

/* Draws the quantities of the first case that has begun, but no matrices. */
static int write_plots(const struct study_result *study, const char *folder, struct error *err) {
    size_t c = 0;
    while (c < study->case_count && study->cases[c].curve_count == 0)
        c++;
    size_t count = c < study->case_count ? study->cases[c].curve_count : 0;
    for (size_t a = 0; a < count; a++) {
        const struct curve *curve = &study->cases[c].curves[a];
        bool first_unit = true, drawn = curve->columns > 0;
        for (size_t b = 0; b < a; b++) {
            const struct curve *other = &study->cases[c].curves[b];
            if (strcmp(other->quantity, curve->quantity) == 0) {
                first_unit = false;
                drawn = drawn || strcmp(other->y_label, curve->y_label) == 0;
            }
        }
        int status = drawn ? 0 : write_plots_of(study, curve, first_unit, folder, err);
        if (status != 0)
            return status;
    }
    return 0;
}

int output_check(const char *folder, struct error *err) {
    char path[PATH_SIZE];
    int status = 0;
    if (snprintf(path, sizeof path, "%s/.rugo-XXXXXX", folder) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder);
    bool made = mkdir(folder, 0777) == 0;
    if (!made && errno != EEXIST)
        return error_set(err, ERROR_SYSTEM, "cannot make folder %s: %s", folder, strerror(errno));
    int file = mkstemp(path);
    if (file < 0)
        status = error_set(err, ERROR_SYSTEM, "folder %s: no file can be made in it: %s", folder,
                           strerror(errno));
    else {
        close(file);
        (void)unlink(path);
    }
    if (made)
        (void)rmdir(folder);
    return status;
}

int output_write(const struct study_result *study, const char *folder, struct error *err) {
    int status = folder_make(folder, err);
    if (status == 0)
        status = write_curves(study, folder, "curves.json", print_json, err);
    if (status == 0)
        status = write_curves(study, folder, "curves.csv", csv_print, err);
    if (status == 0)
        status = write_densities(study, folder, err);
    return status != 0 ? status : write_plots(study, folder, err);
}
