#include "jobs/contact/coated_theory.h"
#include "core/contact/compliance.h"
#include <math.h>

double coated_theory_factor(const struct contact_case *one_case, const struct modes *modes) {
    const struct grid *grid = &modes->grid;
    double bare = 0, coated = 0;
    if (!contact_case_is_coated(one_case))
        return 1;
    struct block block = one_case->blocks[0];
    block.height = INFINITY;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            double qy = my == 0 ? 0 : (double)my / grid->ly;
            double k = 2 * M_PI * hypot((double)mx / grid->lx, qy);
            double power = modes_weight(grid, mx) * modes_power(modes, mx, my);
            if (!(k > 0 && power > 0))
                continue;
            double pressure = 1 / block_compliance_exact(k, &block);
            bare += power * k * k / 4;
            coated += power * pressure * pressure;
        }
    return coated > 0 ? sqrt(bare / coated) : 1;
}
