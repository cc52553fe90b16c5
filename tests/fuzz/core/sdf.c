/* Surface data files, text and binary: any bytes make a map or a refusal. */
#include "core/instrument/formats.h"
#include "tests/support/fuzz/instrument.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    return fuzz_instrument(&INSTRUMENT_SDF, data, size, 1);
}
