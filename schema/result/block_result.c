#include "schema/result/block_result.h"
#include <stdlib.h>

void block_result_clear(struct block_result *result) {
    free((void *)result->names);
    free((void *)result->scalars);
    free((void *)result->data);
    *result = (struct block_result){0};
}
