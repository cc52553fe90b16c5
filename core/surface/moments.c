#include "core/surface/moments.h"
#include <math.h>

void moments_derive(struct moments *m, bool profile) {
    m->m0 = m->m00;
    m->m2 = profile ? m->m20 : (m->m20 + m->m02) / 2;
    m->m4 = profile ? m->m40 : (m->m40 + m->m04) / 2;
    m->nayak_alpha = m->m0 / m->m2 * (m->m4 / m->m2);
    m->rms_height = sqrt(m->m00);
    m->rms_slope = sqrt(m->m20 + m->m02);
    m->rms_curvature = profile ? sqrt(m->m40) : sqrt((m->m40 + 2 * m->m22 + m->m04) / 4);
}

bool moments_isotropic(const struct moments *moments) {
    static const double MARGIN = 0.25;
    return fabs(3 * moments->m22 / moments->m4 - 1) <= MARGIN &&
           fabs(moments->m20 / moments->m02 - 1) <= MARGIN &&
           fabs(moments->m40 / moments->m04 - 1) <= MARGIN;
}
