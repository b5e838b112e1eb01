// A harness as libFuzzer calls it.
#include "harness.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hgmm::fuzz::runOne(data, size);
    return 0;
}
