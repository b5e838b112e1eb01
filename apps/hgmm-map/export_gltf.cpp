#include "export_gltf.h"

#include <Eigen/Geometry>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "ellipsoid_mesh.h"

namespace maptool {
namespace {

/// Components share so many colours, each a material with a mesh.
constexpr std::uint32_t kColours = 16;
/// The thinnest ellipsoid, relative to its longest axis: a scale of 0 has no inverse.
constexpr double kThinnest = 1e-4;

std::string formatted(const char* format, ...) {
    char text[600];
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

template <typename T>
void appendNumber(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

void pad(std::string& bytes, char with) {
    while (bytes.size() % 4 != 0) bytes += with;
}

/// Positions, then triangles, of the unit sphere.
std::string sphereBytes() {
    std::string bytes;
    for (const Eigen::Vector3d& v : unitSphere().vertices)
        for (int axis = 0; axis < 3; ++axis)
            appendNumber(bytes, static_cast<float>(v[axis]));
    for (const auto& face : unitSphere().faces)
        for (const std::uint32_t vertex : face)
            appendNumber(bytes, static_cast<std::uint16_t>(vertex));
    pad(bytes, 0);
    return bytes;
}

/// What refers to the bytes of the sphere. It is its own normal.
std::string meshesOf() {
    const std::size_t vertices = unitSphere().vertices.size(),
                      indices = 3 * unitSphere().faces.size(), positions = 12 * vertices;
    Eigen::Vector3d low = unitSphere().vertices[0], high = low;
    for (const Eigen::Vector3d& v : unitSphere().vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
    }
    std::string json = formatted(
        "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34963}],",
        sphereBytes().size(), positions, positions, 2 * indices);
    json += formatted(
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%zu,"
        "\"type\":\"VEC3\",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":%zu,\"type\":\"SCALAR\"}],",
        vertices, float(low.x()), float(low.y()), float(low.z()), float(high.x()),
        float(high.y()), float(high.z()), indices);
    std::string materials, meshes;
    for (std::uint32_t i = 0; i < kColours; ++i) {
        const hgmm::evaluation::Colour colour = hgmm::evaluation::colourOf(i);
        const char* comma = i == 0 ? "" : ",";
        materials += formatted(
            "%s{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.4g,%.4g,%.4g,1],"
            "\"metallicFactor\":0,\"roughnessFactor\":0.9}}",
            comma, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
        meshes += formatted(
            "%s{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0},"
            "\"indices\":1,\"material\":%u}]}",
            comma, i);
    }
    return json + "\"materials\":[" + materials + "],\"meshes\":[" + meshes + "],";
}

std::string nodeOf(const Ellipsoid& e, std::uint32_t id) {
    const Eigen::Quaterniond q(e.axes);
    const Eigen::Vector3d scale =
        e.lengths.cwiseMax(kThinnest * e.lengths.maxCoeff()).cwiseMax(1e-6);
    return formatted(
        ",{\"mesh\":%u,\"translation\":[%.7g,%.7g,%.7g],\"rotation\":[%.9g,%.9g,%.9g,"
        "%.9g],\"scale\":[%.7g,%.7g,%.7g]}",
        id % kColours, e.centre_local.x(), e.centre_local.y(), e.centre_local.z(), q.x(),
        q.y(), q.z(), q.w(), scale.x(), scale.y(), scale.z());
}

std::string sceneOf(const hgmm::Map& map, std::size_t level, double sigmas) {
    const hgmm::Mixture<3>& mixture = map.mixture(level);
    std::string children, nodes;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const auto id = static_cast<std::uint32_t>(i);
        children += (i == 0 ? "" : ",") + std::to_string(i + 1);
        nodes += nodeOf(ellipsoidOf(mixture[i], sigmas), id);
    }
    const Eigen::Vector3d& origin = map.origin();
    return formatted(
               "{\"asset\":{\"version\":\"2.0\",\"generator\":\"hgmm-map\"},\"scene\":0,"
               "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"map\","
               "\"rotation\":[-0.70710678118654757,0,0,0.70710678118654757],"
               "\"extras\":{\"origin_m\":[%.17g,%.17g,%.17g]},\"children\":[",
               origin.x(), origin.y(), origin.z()) +
           children + "]}" + nodes + "],";
}

}  // namespace

std::string gltfOf(const hgmm::Map& map, std::size_t level, double sigmas) {
    std::string json = sceneOf(map, level, sigmas) + meshesOf();
    json.back() = '}';
    pad(json, ' ');
    const std::string binary = sphereBytes();
    std::string file = "glTF";
    appendNumber(file, std::uint32_t{2});
    appendNumber(file,
                 static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + binary.size()));
    appendNumber(file, static_cast<std::uint32_t>(json.size()));
    file += "JSON" + json;
    appendNumber(file, static_cast<std::uint32_t>(binary.size()));
    file += std::string("BIN\0", 4) + binary;
    return file;
}

}  // namespace maptool
