#include "modality_codec.h"

namespace hgmm {

void encodeModalities(const ModalityGroup& group, std::vector<std::uint8_t>& bytes) {
    bytes.resize(bytes.size() + group.mixture().size() * (17 + 6 * group.names().size()));
}

}  // namespace hgmm
