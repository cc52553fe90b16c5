#include "core/random.h"
#include <Random123/philox.h>

void random_words(struct random_key key, enum random_stream stream, uint64_t first, size_t n,
                  uint64_t *words) {
    philox4x64_key_t philox_key = {{key.seed, key.sequence}};
    size_t done = 0;
    while (done < n) {
        uint64_t word = first + done;
        philox4x64_ctr_t counter = {{word / 4 + 1, (uint64_t)stream, key.realisation, 0}};
        philox4x64_ctr_t block = philox4x64(counter, philox_key);
        for (size_t lane = word % 4; lane < 4 && done < n; lane++)
            words[done++] = block.v[lane];
    }
}

void random_uniform(struct random_key key, enum random_stream stream, uint64_t first, size_t n,
                    double *u) {
    uint64_t words[256];
    for (size_t done = 0; done < n;) {
        size_t count = n - done < 256 ? n - done : 256;
        random_words(key, stream, first + done, count, words);
        for (size_t i = 0; i < count; i++)
            u[done + i] = (double)(words[i] >> 11) * 0x1p-53;
        done += count;
    }
}
