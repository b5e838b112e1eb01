#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/mrpt_bridge/output_file.h"

namespace hgmm::evaluation {

using Colour = std::array<std::uint8_t, 3>;

/// Points or a mesh, as a PLY file holds them.
struct Ply {
    std::vector<Eigen::Vector3d> vertices;            ///< [m], map frame
    std::vector<Colour> colours;                      ///< one per vertex, or none at all
    std::vector<float> values;                        ///< one per vertex, or none at all
    std::vector<std::uint32_t> components;            ///< one per vertex, or none at all
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< vertex indices, counter-clockwise
};

/// Writes binary little-endian PLY, coordinates in double. The file appears whole or not at
/// all. Throws std::runtime_error naming the file.
void writePly(const std::string& file, const Ply& ply,
              mrpt_bridge::Replace replace = mrpt_bridge::Replace::sameKind);

/// A colour that differs well from those of neighbouring numbers.
Colour colourOf(std::uint32_t component);

}  // namespace hgmm::evaluation
