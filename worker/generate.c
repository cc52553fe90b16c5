/* rugo generate STUDY.json: one surface of a study, to look at or to use elsewhere. */
#include "jobs/surface_case.h"
#include "server/command.h"
#include "worker/characterisation.h"
#include "worker/height_map.h"
#include "worker/kinds.h"
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char NAME[] = "generate";

struct options {
    const char *study, *output; /* output NULL or "-": standard output */
    uint64_t case_number, realisation;
    enum height_map_format format;
};

static int read_count(const char *option, const char *text, uint64_t *out, struct error *err) {
    char *stop;
    errno = 0;
    unsigned long long value = strtoull(text, &stop, 10);
    if (*text < '0' || *text > '9' || *stop != '\0' || errno != 0)
        return error_set(err, ERROR_INPUT, "%s: '%s' is not a number from 0 on", option, text);
    *out = value;
    return 0;
}

static int read_format(const char *text, enum height_map_format *out, struct error *err) {
    for (*out = HEIGHT_MAP_NPY; *out < HEIGHT_MAP_FORMATS; (*out)++)
        if (strcmp(text, HEIGHT_MAP_NAMES[*out]) == 0)
            return 0;
    return error_set(err, ERROR_INPUT, "--format: '%s' is not npy, csv or xyz", text);
}

/* The format asked for, or that of the output's name, or npy. */
static int choose_format(struct options *options, struct error *err) {
    bool to_file = options->output != NULL && strcmp(options->output, "-") != 0;
    if (!to_file)
        options->output = NULL;
    if (options->format == HEIGHT_MAP_FORMATS && to_file)
        options->format = height_map_format_of(options->output);
    if (options->format == HEIGHT_MAP_FORMATS)
        options->format = HEIGHT_MAP_NPY;
    if (!to_file && options->format == HEIGHT_MAP_NPY && isatty(STDOUT_FILENO))
        return error_set(err, ERROR_INPUT, "npy is not for a terminal: give -o FILE, or --format");
    return 0;
}

static int read_options(int argc, char **argv, struct options *out, struct error *err) {
    static const struct option LONG[] = {{"case", required_argument, NULL, 'c'},
                                         {"realisation", required_argument, NULL, 'r'},
                                         {"format", required_argument, NULL, 'f'},
                                         {"output", required_argument, NULL, 'o'},
                                         {NULL, 0, NULL, 0}};
    int status = 0;
    *out = (struct options){.format = HEIGHT_MAP_FORMATS};
    optind = 1;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, ":c:r:f:o:", LONG, NULL)) != -1;) {
        if (option == 'c')
            status = read_count("--case", optarg, &out->case_number, err);
        else if (option == 'r')
            status = read_count("--realisation", optarg, &out->realisation, err);
        else if (option == 'f')
            status = read_format(optarg, &out->format, err);
        else if (option == 'o')
            out->output = optarg;
        else
            status =
                error_set(err, ERROR_INPUT, "unknown or incomplete option '%s'", argv[optind - 1]);
        if (status != 0)
            return status;
    }
    if (optind != argc - 1)
        return error_set(err, ERROR_INPUT, "wants one STUDY.json");
    out->study = argv[optind];
    return choose_format(out, err);
}

static int write_output(const struct options *options, const struct grid *grid, const double *z,
                        struct error *err) {
    if (options->output == NULL)
        return height_map_write(stdout, options->format, grid, z, err);
    FILE *file = fopen(options->output, "wb");
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot open %s: %s", options->output, strerror(errno));
    int status = height_map_write(file, options->format, grid, z, err);
    if (fclose(file) != 0 && status == 0)
        status =
            error_set(err, ERROR_SYSTEM, "cannot write %s: %s", options->output, strerror(errno));
    return status;
}

static const char *end_name(enum surface_end end) {
    static const char *const names[] = {"direct", "converged", "stalled", "at the limit"};
    return names[end];
}

/* Beside the surface on standard output, the characterisation goes to standard error. */
static int characterise(const struct options *options, const struct surface_case *surface,
                        const struct surface_report *report, const double *z, struct error *err) {
    FILE *file = options->output == NULL ? stderr : stdout;
    size_t mode_x = surface_case_band(surface);
    size_t mode_y = surface->dimension == 1 ? 0 : mode_x;
    if (!surface_case_exact(surface)) {
        mode_x = surface->grid.nx / 2;
        mode_y = surface->grid.ny / 2;
    }
    cJSON *values;
    int status = characterisation_create(&values, &surface->grid, z, mode_x, mode_y, err);
    if (status != 0)
        return status;
    characterisation_print(file, values);
    cJSON_Delete(values);
    if (report->end != END_DIRECT)
        fprintf(file,
                "generation\n  %-18s %zu\n  %-18s %s\n  %-18s %.4g\n  %-18s %.4g\n  %-18s %.4g\n",
                "iterations", report->iterations, "end", end_name(report->end), "eps_h",
                report->eps_h, "eps_s", report->eps_s, "eps_s0", report->eps_s0);
    if (fflush(file) != 0 || ferror(file))
        return error_set(err, ERROR_SYSTEM, "cannot write the characterisation");
    return 0;
}

static int generate(const struct options *options, const struct study *study, struct error *err) {
    struct surface_case surface;
    struct surface_report report = {0};
    struct generator *generator = NULL;
    if (options->case_number >= study->case_count)
        return error_set(err, ERROR_INPUT, "there is no case %llu: the study has %zu",
                         (unsigned long long)options->case_number, study->case_count);
    int status =
        surface_case_read(&surface, study->cases[options->case_number].parameters, NULL, err);
    if (status != 0)
        return status;
    double *z = array_create(grid_points(&surface.grid), sizeof *z);
    if (z == NULL)
        status = error_memory(err, grid_points(&surface.grid) * sizeof *z, "a surface");
    if (status == 0)
        status =
            generator_create(&generator, &surface.spectrum, &surface.grid, &surface.options, err);
    if (status == 0)
        status = generator_run(
            generator, (struct random_key){study->seed, options->case_number, options->realisation},
            z, &report, err);
    generator_destroy(&generator);
    if (status == 0)
        status = write_output(options, &surface.grid, z, err);
    if (status == 0)
        status = characterise(options, &surface, &report, z, err);
    free(z);
    surface_case_clear(&surface);
    return status;
}

int command_generate(int argc, char **argv) {
    struct options options;
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    char *text = NULL;
    size_t size;
    int status = read_options(argc, argv, &options, &err);
    if (status == 0)
        status = file_read(options.study, JSON_LIMITS.bytes, &text, &size, &err);
    if (status == 0)
        status = kinds_read_study(&study, text, size, NULL, &faults, &err);
    if (status == 0)
        status = generate(&options, study, &err);
    int ended = EXIT_DONE;
    if (status != 0)
        ended = faults.count > 0 ? command_fail_faults(NAME, &faults) : command_fail(NAME, &err);
    free(text);
    study_destroy(&study);
    fault_list_clear(&faults);
    return ended;
}
