#pragma once
#include <string>
#include <string_view>

namespace hgmm::mrpt_bridge {

/// What a file holds, as its first bytes tell.
enum class FileKind {
    empty,
    map,        ///< mrpt::maps::CHGMMOccupancyMap, compressed or not
    rawlog,     ///< an MRPT action, frame or observation
    simpleMap,  ///< MRPT's poses and scans
    scene,      ///< MRPT's 3D objects
    octree,     ///< OctoMap, .bt or .ot
    ply,
    png,
    pgm,
    gltf,   ///< binary, .glb
    slice,  ///< the .yaml of map_server
    json,
    html,
    svg,
    numbers,  ///< lines of numbers, as pose files have
    text,     ///< any other text
    other
};

/// How many bytes kindOf wants to see.
constexpr std::size_t kKindBytes = 4096;

/// Of content that is not compressed.
FileKind kindOf(std::string_view start);
/// Of a file, which may be gzip-compressed; `other` if it cannot be read.
FileKind kindOfFile(const std::string& file);
/// "a map", "a rawlog", ...
const char* nameOf(FileKind kind);

}  // namespace hgmm::mrpt_bridge
