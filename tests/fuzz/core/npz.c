/* NPZ files: a zip archive is a map, or is refused with words. */
#include "core/instrument/formats.h"
#include "tests/support/fuzz/instrument.h"

enum { SHARE = 5000 }; /* points a byte: deflated a thousand times, and a cloud on its grid */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    return fuzz_instrument(&INSTRUMENT_NPZ, data, size, SHARE);
}
