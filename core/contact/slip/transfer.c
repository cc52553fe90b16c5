#include "core/contact/slip/transfer.h"
#include <math.h>

int transfer_create(struct transfer *out, const struct grid *grid, double poisson,
                    struct error *err) {
    *out = (struct transfer){.grid = *grid, .poisson = poisson};
    if (!(poisson >= 0 && poisson <= 0.5))
        return error_set(err, ERROR_INPUT, "Poisson's ratio of the block = %g; allowed: 0 to 0.5",
                         poisson);
    int status = grid_check(grid, err);
    out->fields = grid_is_profile(grid) ? ALONG_Y : FIELDS;
    for (size_t f = 0; status == 0 && f < out->fields; f++)
        status = transform_create(&out->plans[f], grid, grid->nx / 2, grid->ny / 2, err);
    if (status != 0)
        transfer_clear(out);
    return status;
}

void transfer_clear(struct transfer *transfer) {
    for (size_t f = 0; f < FIELDS; f++)
        transform_destroy(&transfer->plans[f]);
}

double transfer_bytes(const struct grid *grid) {
    return (grid_is_profile(grid) ? ALONG_Y : FIELDS) * transform_bytes(grid, grid->nx / 2);
}

/* A wave of the half spectrum. Where a direction has the highest wave of an even grid, which is its
 * own mirror image, odd symbols have no value of their own but 0. */
struct wave {
    double k;    /* its number, above 0 */
    double x, y; /* its direction, of length 1 */
    double odd_x, odd_y;
};

static struct wave wave_at(const struct grid *grid, size_t mx, size_t row) {
    double my = row <= grid->ny / 2 ? (double)row : (double)row - (double)grid->ny;
    double kx = 2 * M_PI * (double)mx / grid->lx;
    double ky = row == 0 ? 0 : 2 * M_PI * my / grid->ly, k = hypot(kx, ky);
    struct wave wave = {.k = k, .x = kx / k, .y = ky / k};
    wave.odd_x = 2 * mx == grid->nx ? 0 : wave.x;
    wave.odd_y = 2 * row == grid->ny ? 0 : wave.y;
    return wave;
}

/* Multiplies the fields t of one wave, in place. */
typedef void wave_product(double poisson, const struct wave *wave, double complex t[FIELDS]);

/* F24.1 */
static void yield_wave(double poisson, const struct wave *wave, double complex t[FIELDS]) {
    const double complex p = t[NORMAL], qx = t[ALONG_X], qy = t[ALONG_Y];
    const double length = 2 / wave->k, beta = (1 - 2 * poisson) / (2 * (1 - poisson));
    const double shear = length / (1 - poisson),
                 cross = -shear * poisson * wave->odd_x * wave->odd_y;
    const double complex couple = I * beta * length;
    t[NORMAL] = length * p - couple * (wave->odd_x * qx + wave->odd_y * qy);
    t[ALONG_X] =
        couple * wave->odd_x * p + shear * (1 - poisson * wave->x * wave->x) * qx + cross * qy;
    t[ALONG_Y] =
        couple * wave->odd_y * p + shear * (1 - poisson * wave->y * wave->y) * qy + cross * qx;
}

static void resist_wave(double poisson, const struct wave *wave, double complex t[FIELDS]) {
    const double complex qx = t[ALONG_X], qy = t[ALONG_Y];
    const double stiffness = wave->k / 2;
    const double cross = stiffness * poisson * wave->odd_x * wave->odd_y;
    t[NORMAL] *= stiffness;
    t[ALONG_X] = stiffness * (1 - poisson * wave->y * wave->y) * qx + cross * qy;
    t[ALONG_Y] = stiffness * (1 - poisson * wave->x * wave->x) * qy + cross * qx;
}

/* Multiplies all waves; fields that are not given are 0. */
static void multiply_waves(struct transfer *transfer, wave_product *product,
                           double *const in[FIELDS]) {
    const struct grid *grid = &transfer->grid;
    double complex *spectra[FIELDS] = {0};
    for (size_t f = 0; f < transfer->fields; f++)
        spectra[f] = transform_spectrum(transfer->plans[f]);
    for (size_t at = 0; at < (grid->nx / 2 + 1) * grid->ny; at++) {
        double complex t[FIELDS] = {0};
        const struct wave wave = wave_at(grid, at / grid->ny, at % grid->ny);
        for (size_t f = 0; at > 0 && f < transfer->fields; f++)
            t[f] = in[f] != NULL ? spectra[f][at] : 0;
        if (at > 0)
            product(transfer->poisson, &wave, t);
        for (size_t f = 0; f < transfer->fields; f++)
            spectra[f][at] = t[f];
    }
}

static void multiply(struct transfer *transfer, wave_product *product, double *const in[FIELDS],
                     double *const out[FIELDS]) {
    for (size_t f = 0; f < transfer->fields; f++)
        if (in[f] != NULL) {
            transform_forward(transfer->plans[f], in[f]);
            transfer->transforms++;
        }
    multiply_waves(transfer, product, in);
    for (size_t f = 0; f < transfer->fields; f++)
        if (out[f] != NULL) {
            transform_inverse(transfer->plans[f], out[f]);
            transfer->transforms++;
        }
}

void transfer_apply(struct transfer *transfer, double *const in[FIELDS],
                    double *const out[FIELDS]) {
    multiply(transfer, yield_wave, in, out);
}

void transfer_precondition(struct transfer *transfer, double *const in[FIELDS],
                           double *const out[FIELDS]) {
    multiply(transfer, resist_wave, in, out);
}
