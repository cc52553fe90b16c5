#include "core/contact/coating.h"
#include <math.h>

/* Below this height over a wavelength, over 2 pi, the block is thin: both layers strain evenly. */
static const double THIN = 1e-5;

/* What lies below the layer opposes to tractions at the interface (F22.2): over k/(2 G), with the
 * normal traction N and the tangential one T, the displacements are W = -normal N + mixed T and
 * U = mixed N - tangential T. */
struct base {
    double normal, mixed, tangential;
};

/* y: its height times k, or INFINITY. */
static struct base base_of(double y, double poisson) {
    double q = isinf(y) ? 0 : exp(-2 * y), e = isinf(y) ? 1 : -expm1(-2 * y);
    double yq = q > 0 ? y * q : 0, sum = e * (1 + q) + 4 * yq, twice = 2 * (1 - poisson);
    return (struct base){.normal = twice * e * e / sum,
                         .mixed = ((1 - 2 * poisson) * e * (1 + q) - 4 * yq) / sum,
                         .tangential = twice * (1 + q) * (1 + q) / sum};
}

/* The matrix that makes the stresses that rise with depth, at the interface, of those that fall:
 * (C, D) of (a, b), in the notation of F22.2. */
struct reflection {
    double ca, cb, da, db;
};

static struct reflection reflection_of(const struct base *base, double ratio, double poisson) {
    double normal = ratio * base->normal, mixed = ratio * base->mixed;
    double tangential = ratio * base->tangential, c = 1 - 2 * poisson, d = 2 * (1 - poisson);
    double m11 = -1 - normal - mixed, m12 = mixed - c;
    double m21 = 1 + mixed + tangential, m22 = -d - tangential;
    double r11 = -1 + normal - mixed, r12 = mixed - c;
    double r21 = -1 - mixed + tangential, r22 = d - tangential;
    double all = m11 * m22 - m12 * m21;
    return (struct reflection){.ca = (r11 * m22 - m12 * r21) / all,
                               .cb = (r12 * m22 - m12 * r22) / all,
                               .da = (m11 * r21 - r11 * m21) / all,
                               .db = (m11 * r22 - r12 * m21) / all};
}

/* S E* of a block that is thin to the wave: no stress sideways in the mean, and one strain. */
static double thin(const struct block *block) {
    const struct coating *coating = &block->coating;
    double t = coating->thickness, h = block->height - t, r = block_coating_stiffness(block);
    double a = coating->poisson / (1 - coating->poisson);
    double b = block->poisson / (1 - block->poisson), shared = t * a + h * b;
    return t * (1 - a * a) / r + h * (1 - b * b) + shared * shared / (t * r + h);
}

double coating_compliance(double k, const struct block *block) {
    const struct coating *coating = &block->coating;
    double x = k * coating->thickness, nu = coating->poisson;
    if (k * block->height < THIN)
        return thin(block);
    double ratio = coating->modulus * (1 + block->poisson) / (1 + nu);
    const struct base base = base_of(k * (block->height - coating->thickness), block->poisson);
    const struct reflection r = reflection_of(&base, ratio, nu);
    /* The stress (A + B kz) exp(-kz) + (C + D (x - kz)) exp(kz - x) is 1 at the face, free of
     * shear; ca and others make C exp(-x) and D exp(-x) of A and B. */
    double q = exp(-2 * x), ca = q * r.ca, cb = q * (r.ca * x + r.cb);
    double da = q * r.da, db = q * (r.da * x + r.db);
    double p11 = 1 + ca + x * da, p12 = cb + x * db;
    double p21 = -1 + ca + (x - 1) * da, p22 = 1 + cb + (x - 1) * db;
    double all = p11 * p22 - p12 * p21, a = p22 / all, b = -p21 / all, c = 1 - 2 * nu;
    double displacement = a + c * b - (ca * a + cb * b) - (x + c) * (da * a + db * b);
    return displacement / (ratio * (1 - block->poisson)) / k;
}

/* For a long wave the excess is the thickness times the derivative of k S by kt (F22.1). */
double coating_excess(double k, const struct block *block) {
    static const double LONG = 1e-6;
    double least = LONG / block->coating.thickness;
    double at = fmax(k, least);
    return coating_compliance(at, block) - 2 / at;
}
