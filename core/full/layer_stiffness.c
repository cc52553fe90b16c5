#include "core/full/layer_stiffness.h"
#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

void layer_stiffness_make(const struct mesh *mesh, const struct material *material, size_t layer,
                          struct layer_stiffness *out, struct element_volumetric *volumetric) {
    int d = mesh->dimension;
    const struct level *level = &mesh->level[layer];
    double width = (double)level->width;
    double position[8][3], u[8][3] = {{0}},
                           stiffness[ELEMENT_DEGREES_OF_FREEDOM][ELEMENT_DEGREES_OF_FREEDOM];
    struct element_shape shape;
    memset(out, 0, sizeof *out);
    for (int a = 0; a < 1 << d; a++) {
        position[a][0] = (a & 1) * width;
        position[a][1] = (a >> 1 & 1) * width * mesh->across;
        position[a][d - 1] = (a >> (d - 1) & 1) * (level[1].depth - level->depth);
    }
    /* A brick without displacements is never inverted. */
    (void)element_shape_make(d, position, &shape);
    (void)element_evaluate(d, material, &shape, u, NULL, NULL, NULL, stiffness, volumetric);
    for (int a = 0; a < 1 << d; a++)
        for (int b = 0; b < 1 << d; b++) {
            int along = (b & 1) - (a & 1) + 1;
            int across = d == 2 ? 1 : (b >> 1 & 1) - (a >> 1 & 1) + 1;
            double(*block)[3] = out->block[a >> (d - 1) & 1][b >> (d - 1) & 1][across * 3 + along];
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    block[i][j] += stiffness[a * d + i][b * d + j];
        }
}

struct wave_phases wave_phases_of(const struct level *level, size_t mx, size_t row) {
    struct wave_phases phases;
    double x = 2 * PI * (double)mx / (double)level->nx;
    double y = 2 * PI * (double)row / (double)level->ny;
    for (int slot = 0; slot < 9; slot++) {
        int along = slot % 3 - 1, across = slot / 3 - 1;
        double phase = x * along + y * across;
        phases.cosine[slot] = cos(phase);
        phases.sine[slot] = sin(phase);
    }
    return phases;
}

double wave_phases_hanging(int dimension, const struct wave_phases *phases) {
    double along = (1 + phases->cosine[5]) / 2, across = (1 + phases->cosine[7]) / 2;
    return dimension == 2 ? along : along * across;
}

void layer_stiffness_add_symbol(int dimension, double block[9][3][3],
                                const struct wave_phases *phases, double factor, double out[3][3]) {
    for (int i = 0; i < dimension; i++)
        for (int j = 0; j < dimension; j++) {
            bool up = i == dimension - 1, right = j == dimension - 1;
            double sum = 0;
            for (int slot = 0; slot < 9; slot++)
                sum += block[slot][i][j] * (up == right ? phases->cosine[slot]
                                            : up        ? -phases->sine[slot]
                                                        : phases->sine[slot]);
            out[i][j] += factor * sum;
        }
}
