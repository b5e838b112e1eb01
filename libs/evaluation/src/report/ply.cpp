#include "hgmm/evaluation/ply.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace hgmm::evaluation {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "PLY bodies are written as they lie");

template <typename T>
void append(std::string& bytes, const T& value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string header(const Ply& ply) {
    std::string text =
        "ply\nformat binary_little_endian 1.0\ncomment made by mrpt-hgmm, in m\n";
    text += "element vertex " + std::to_string(ply.vertices.size()) + "\n";
    for (const char* axis : {"x", "y", "z"})
        text += std::string("property double ") + axis + "\n";
    if (!ply.colours.empty())
        for (const char* c : {"red", "green", "blue"})
            text += std::string("property uchar ") + c + "\n";
    if (!ply.values.empty()) text += "property float value\n";
    if (!ply.components.empty()) text += "property uint component\n";
    if (!ply.faces.empty())
        text += "element face " + std::to_string(ply.faces.size()) +
                "\nproperty list uchar uint vertex_indices\n";
    return text + "end_header\n";
}

}  // namespace

void writePly(const std::string& file, const Ply& ply, mrpt_bridge::Replace replace) {
    std::string bytes = header(ply);
    for (std::size_t i = 0; i < ply.vertices.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) append(bytes, ply.vertices[i][axis]);
        if (!ply.colours.empty()) append(bytes, ply.colours[i]);
        if (!ply.values.empty()) append(bytes, ply.values[i]);
        if (!ply.components.empty()) append(bytes, ply.components[i]);
    }
    for (const auto& face : ply.faces) {
        append(bytes, std::uint8_t{3});
        append(bytes, face);
    }
    mrpt_bridge::writeFile(file, bytes, replace);
}

Colour colourOf(std::uint32_t component) {
    // Hues a golden ratio of the circle apart never come close to one another.
    const double hue = 6.0 * std::fmod(0.6180339887498949 * component, 1.0);
    Colour colour{};
    for (int channel = 0; channel < 3; ++channel) {
        const double k = std::fmod(hue + 5.0 - 2.0 * channel, 6.0);
        const double share = std::max(0.0, std::min({k, 4.0 - k, 1.0}));
        colour[channel] =
            static_cast<std::uint8_t>(std::lround(255 * (0.95 - 0.7 * share)));
    }
    return colour;
}

}  // namespace hgmm::evaluation
