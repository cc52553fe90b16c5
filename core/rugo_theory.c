/* Implements the theories of rugo.h. */
#include "core/rugo.h"
#include "core/theory/contact.h"
#include "core/theory/nayak.h"

double rugo_nayak_summit_pdf(double z, double alpha) {
    return nayak_summit_pdf(z, alpha);
}
double rugo_nayak_summit_cdf(double z, double alpha) {
    return nayak_summit_cdf(z, alpha);
}
double rugo_nayak_joint_pdf(double z, double t1, double alpha) {
    return nayak_joint_pdf(z, t1, alpha);
}
double rugo_nayak_mean_curvature(double z, double alpha) {
    return nayak_mean_curvature(z, alpha);
}
double rugo_nayak_summit_density(double m2, double m4) {
    return nayak_summit_density(m2, m4);
}
double rugo_persson_area(double load) {
    return persson_area(load);
}
double rugo_persson_pressure_pdf(double pressure, double load) {
    return persson_pressure_pdf(pressure, load);
}
double rugo_bgt_area(double load, double alpha) {
    return bgt_area(load, alpha);
}
double rugo_gw_mccool_area(double load, double alpha) {
    return gw_mccool_area(load, alpha);
}
double rugo_westergaard_area(double ratio) {
    return westergaard_area(ratio);
}
double rugo_westergaard_pressure(double x, double ratio) {
    return westergaard_pressure(x, ratio);
}
double rugo_westergaard_gap(double ratio) {
    return westergaard_gap(ratio);
}
