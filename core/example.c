/* Presses a self-affine surface on a rigid flat by librugo and prints the contact area by load,
 * with Persson's theory beside it: cc example.c $(pkg-config --cflags --libs rugo) -o example &&
 * ./example */
#include <rugo.h>
#include <stdio.h>
#include <stdlib.h>

/* Presses the surface at rising loads p/(E* h') and prints the contact area of each. */
static int print_areas(struct rugo_contact *contact, double rms_slope, double alpha,
                       struct rugo_error *err) {
    static const double LOADS[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5};
    printf("p/(E* h')    area  Persson      BGT\n");
    for (size_t k = 0; k < sizeof LOADS / sizeof *LOADS; k++) {
        struct rugo_contact_state state;
        if (rugo_contact_press(contact, LOADS[k] * rms_slope, &state, err) != 0)
            return 1;
        printf("%9.3f %7.4f  %7.4f  %7.4f\n", LOADS[k], state.area, rugo_persson_area(LOADS[k]),
               rugo_bgt_area(LOADS[k], alpha));
    }
    return 0;
}

int main(void) {
    /* The cell has 256 x 256 points and waves from a quarter to a 32nd of it: 8 points a shortest
     * wave. */
    const struct rugo_grid grid = {256, 256, 1, 1};
    const double rms_slope = 0.1;
    const struct rugo_spectrum spectrum =
        rugo_spectrum_self_affine(0.8, 1.0 / 4, 1.0 / 32, rms_slope);
    const struct rugo_block block = rugo_block_defaults(RUGO_HALFSPACE, &grid);
    struct rugo_generator *generator = NULL;
    struct rugo_contact *contact = NULL;
    struct rugo_moments moments;
    struct rugo_error err;
    double *z = malloc(grid.nx * grid.ny * sizeof *z);
    if (z == NULL)
        return 1;
    int failed = rugo_spectrum_moments(&spectrum, &grid, &moments, &err) != 0 ||
                 rugo_generator_create(&generator, &spectrum, &grid, NULL, &err) != 0 ||
                 rugo_generator_run(generator, 1, 0, 0, z, NULL, &err) != 0 ||
                 rugo_contact_create(&contact, &grid, &block, &err) != 0 ||
                 rugo_contact_begin(contact, z, &err) != 0;
    if (failed == 0) {
        printf("RMS height %.4g, slope %.4g, Nayak's alpha %.4g\n", moments.rms_height,
               moments.rms_slope, moments.nayak_alpha);
        failed = print_areas(contact, rms_slope, moments.nayak_alpha, &err);
    }
    if (failed != 0)
        fprintf(stderr, "example: %s\n", err.text);
    rugo_contact_destroy(&contact);
    rugo_generator_destroy(&generator);
    free(z);
    return failed;
}
