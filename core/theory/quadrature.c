#include "core/theory/quadrature.h"

/* The positive half of the 16-point rule on [-1, 1]. */
static const double NODES[8] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863,
                                0.6178762444026437484, 0.7554044083550030339, 0.8656312023878317439,
                                0.9445750230732325761, 0.9894009349916499326};
static const double WEIGHTS[8] = {
    0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
    0.1246289712555338721, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};

const double GAUSS_4_NODES[GAUSS_4] = {-0.86113631159405258, -0.33998104358485626,
                                       0.33998104358485626, 0.86113631159405258};
const double GAUSS_4_WEIGHTS[GAUSS_4] = {0.34785484513745386, 0.65214515486254614,
                                         0.65214515486254614, 0.34785484513745386};

double quadrature(integrand *f, const void *context, double low, double high, size_t panels) {
    if (!(high > low))
        return 0;
    double half = (high - low) / (2 * (double)panels), total = 0;
    for (size_t panel = 0; panel < panels; panel++) {
        double centre = low + (2 * (double)panel + 1) * half, sum = 0;
        for (size_t node = 0; node < 8; node++) {
            double offset = half * NODES[node];
            sum += WEIGHTS[node] * (f(centre - offset, context) + f(centre + offset, context));
        }
        total += sum * half;
    }
    return total;
}

void quadrature_panel(double low, double high, double node[QUADRATURE_NODES],
                      double weight[QUADRATURE_NODES]) {
    double centre = (low + high) / 2, half = (high - low) / 2;
    for (size_t n = 0; n < 8; n++) {
        node[7 - n] = centre - half * NODES[n];
        node[8 + n] = centre + half * NODES[n];
        weight[7 - n] = weight[8 + n] = half * WEIGHTS[n];
    }
}
