/* rugo generate STUDY.json: one surface of a study, or a block meshed on it, to look at or to use
 * elsewhere. */
#include "core/map/height_map_file.h"
#include "jobs/kind.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "server/command/command.h"
#include "server/command/output_file.h"
#include "server/show/map/map_report.h"
#include "server/show/plot/plot_map.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct generate_options {
    const char *output;     /* NULL: standard output */
    const char **overrides; /* of --set */
    int64_t case_number, realisation;
    const char *format;
    const char *picture; /* NULL: none */
    const char *mesh;    /* NULL: the surface alone */
    double pressure;     /* p/(E* h') on the mesh; 0: not pressed */
};
#define AT(member) offsetof(struct generate_options, member)
static const struct option_row OPTIONS[] = {
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", "0", "of this case"},
    {"realisation", 0, OPTION_INDEX, 0, 0, AT(realisation), "R", "0", "this realisation"},
    {"format", 0, OPTION_TEXT, 0, 0, AT(format), "npy|csv|xyz", NULL,
     "of the height map (that of the file's name, or npy)"},
    {"output", 'o', OPTION_TEXT, 0, 0, AT(output), "FILE", NULL, "write the height map there"},
    {"picture", 0, OPTION_TEXT, 0, 0, AT(picture), "FILE.svg|FILE.png", NULL,
     "draw the surface there: its summits marked, or a pixel a point"},
    {"mesh", 0, OPTION_TEXT, 0, 0, AT(mesh), "FILE.vtu", NULL,
     "write the block of the model full, meshed on the surface"},
    {"pressure", 0, OPTION_NUMBER, 0, 0, AT(pressure), "P", NULL,
     "the mesh pressed to p/(E* h'), with displacement, pressure, stress"},
    {"set", 0, OPTION_LIST, 0, 0, AT(overrides), "PATH=VALUE", NULL, SET_HELP},
    {0}};

/* The options ask for this. */
struct generate_order {
    const struct generate_options *options;
    const char *study, *output; /* output NULL: standard output */
    enum height_map_format format;
};

/* A mesh or a picture takes the place of a surface on standard output. */
static bool writes_surface(const struct generate_order *order) {
    return (order->options->mesh == NULL && order->options->picture == NULL) ||
           order->output != NULL;
}

/* Chooses the format asked for, or that of the output's name, or npy; returns 0 or EXIT_USAGE. */
static int choose_format(struct generate_order *order) {
    const char *name = order->options->format;
    order->format = HEIGHT_MAP_FORMATS;
    if (name != NULL) {
        for (order->format = HEIGHT_MAP_NPY; order->format < HEIGHT_MAP_FORMATS &&
                                             strcmp(name, HEIGHT_MAP_NAMES[order->format]) != 0;)
            order->format++;
        if (order->format == HEIGHT_MAP_FORMATS)
            return usage_error("generate", "--format %.40s is not npy, csv or xyz", name);
    } else if (order->output != NULL)
        order->format = height_map_format_of(order->output);
    if (order->format == HEIGHT_MAP_FORMATS)
        order->format = HEIGHT_MAP_NPY;
    if (writes_surface(order) && order->output == NULL && order->format == HEIGHT_MAP_NPY &&
        isatty(STDOUT_FILENO) != 0)
        return usage_error("generate", "npy is not for a terminal: give -o FILE or --format");
    return 0;
}

static int read_order(struct generate_order *order, const struct generate_options *options,
                      const char *study) {
    *order = (struct generate_order){.options = options, .study = study, .output = options->output};
    if (order->output != NULL && strcmp(order->output, "-") == 0)
        order->output = NULL;
    if (options->mesh == NULL && options->pressure > 0)
        return usage_error("generate", "--pressure belongs to --mesh FILE");
    return choose_format(order);
}

static int write_output(const struct generate_order *order, const struct grid *grid,
                        const double *z, struct error *err) {
    FILE *file;
    if (order->output == NULL)
        return height_map_write(stdout, order->format, grid, z, err);
    int status = output_file_open(&file, order->output, err);
    if (status != 0)
        return status;
    status = height_map_write(file, order->format, grid, z, err);
    return output_file_close(file, order->output, status, err);
}

static int write_picture(const struct generate_order *order, const struct study *study,
                         const struct grid *grid, const double *z, struct error *err) {
    char subject[80];
    snprintf(subject, sizeof subject, "case %lld, realisation %lld",
             (long long)order->options->case_number, (long long)order->options->realisation);
    const struct map_picture picture = {.name = study->name,
                                        .subject = subject,
                                        .x_label = "x/lambda_s",
                                        .y_label = "y/lambda_s",
                                        .z_label = "z",
                                        .grid = grid,
                                        .z = z};
    return output_file_picture(order->options->picture, &picture, err);
}

static const char *end_name(enum surface_end end) {
    static const char *const names[] = {"direct", "converged", "stalled", "schedule"};
    return names[end];
}

/* Beside the surface on standard output, the characterisation goes to standard error. */
static int characterise(const struct generate_order *order, const struct surface_case *surface,
                        const struct surface_report *report, const double *z, struct error *err) {
    bool beside = writes_surface(order) && order->output == NULL;
    FILE *file = beside ? stderr : stdout;
    const struct surface_band band = surface_case_own_band(surface);
    const struct measured_map map = {&surface->grid, z, BOUNDARY_PERIODIC};
    struct map_parameters parameters;
    struct named_values values = {0};
    int status = map_parameters_measure(&parameters, &map, band.x, band.y, NULL, err);
    if (status != 0)
        return status;
    map_report_parameters(&values, &parameters);
    named_values_print(file, &values);
    if (report->end != END_DIRECT)
        fprintf(file,
                "generation\n  %-18s %zu\n  %-18s %s\n  %-18s %.4g\n  %-18s %.4g\n  %-18s %.4g\n",
                "iterations", report->iterations, "end", end_name(report->end), "eps_h",
                report->eps_h, "eps_s", report->eps_s, "eps_s0", report->eps_s0);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the characterisation");
    return 0;
}

static int write_case_mesh(const struct generate_order *order, const struct job_kind *kind,
                           const cJSON *parameters, const double *z, struct error *err) {
    void *study = NULL;
    int status = kind_case_create(&study, kind, parameters, NULL, err);
    if (status == 0)
        status = kind->write_mesh(order->options->mesh, study, z, order->options->pressure, err);
    kind_case_destroy(kind, &study);
    return status;
}

static int write_mesh(const struct generate_order *order, const struct study *study,
                      const double *z, struct error *err) {
    const struct job_kind *kind = kind_of(study->kind);
    size_t other = 0;
    if (kind->write_mesh != NULL)
        return write_case_mesh(order, kind, study->cases[order->options->case_number].parameters, z,
                               err);
    while (JOB_KINDS[other] != NULL && kind_of(JOB_KINDS[other])->write_mesh == NULL)
        other++;
    return error_set(err, ERROR_INPUT, "--mesh needs a study of kind %s, and this is %s",
                     JOB_KINDS[other] != NULL ? JOB_KINDS[other]->name : "with meshes",
                     study->kind->name);
}

static int generate(const struct generate_order *order, const struct study *study,
                    struct error *err) {
    struct surface_case surface;
    struct surface_report report = {0};
    const uint64_t case_number = (uint64_t)order->options->case_number;
    const struct random_key key = {study->seed, study_sequence(study->random, case_number),
                                   (uint64_t)order->options->realisation};
    if (case_number >= study->case_count)
        return error_set(err, ERROR_INPUT, "there is no case %lld: the study has %zu",
                         (long long)order->options->case_number, study->case_count);
    int status = surface_case_read(&surface, study->cases[case_number].parameters, NULL, err);
    if (status != 0)
        return status;
    double *z = NULL;
    status = realisation_surface(&surface, key, &z, &report, err);
    if (status == 0 && order->options->mesh != NULL)
        status = write_mesh(order, study, z, err);
    if (status == 0 && order->options->picture != NULL)
        status = write_picture(order, study, &surface.grid, z, err);
    if (status == 0 && writes_surface(order))
        status = write_output(order, &surface.grid, z, err);
    if (status == 0)
        status = characterise(order, &surface, &report, z, err);
    free(z);
    surface_case_clear(&surface);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    struct generate_order order;
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    const struct generate_options *options = values;
    if (read_order(&order, options, arguments[0]) != 0)
        return EXIT_USAGE;
    int status = study_file_read(&study, order.study, options->overrides, &faults, &err);
    if (status == 0)
        status = generate(&order, study, &err);
    int result = command_end("generate", status, order.study, &faults, &err);
    study_destroy(&study);
    fault_list_clear(&faults);
    return result;
}

const struct command COMMAND_GENERATE = {
    .name = "generate",
    .arguments = "STUDY.json",
    .summary = "one surface of a study, and its characterisation",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct generate_options),
    .run = run,
};
