/* Text exports, grids and lists of points: any bytes make a map or a refusal, by the reader that
 * the first byte says. */
#include "core/instrument/formats.h"
#include "tests/support/fuzz/instrument.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const struct instrument_format *const formats[] = {&INSTRUMENT_TEXT, &INSTRUMENT_POINTS,
                                                       &INSTRUMENT_SURFER, &INSTRUMENT_ESRI,
                                                       &INSTRUMENT_ZYGO};
    return size > 0 ? fuzz_instrument(formats[*data / 4 % 5], data, size, 64) : 0;
}
