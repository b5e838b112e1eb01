#include "cloud_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hgmm::importer {
namespace {

/// Bits that are a NaN as a float, as a text file has for a colour with an alpha of 255.
constexpr std::uint32_t kQuietNan = 0x7FC00000;

}  // namespace

CloudFields::CloudFields(const CloudLayout& layout) : layout_(layout) {
    const char* const places[] = {"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
        xyz_[i] = findSingle(places[i]);
        if (!xyz_[i])
            throw std::runtime_error(std::string("the header has no field ") + places[i]);
    }
    for (const char* name : {"rgb", "rgba"})
        if (!packed_) packed_ = findSingle(name);
    if (packed_ && packed_->size != 4)
        throw std::runtime_error("the field " + packed_->name + " must have SIZE 4");
    const char* const colors[][3] = {{"r", "g", "b"},
                                     {"red", "green", "blue"},
                                     {"diffuse_red", "diffuse_green", "diffuse_blue"}};
    for (const auto& names : colors) {
        if (packed_ || color_[0]) break;
        const CloudField* found[3];
        for (std::size_t i = 0; i < 3; ++i) found[i] = findSingle(names[i]);
        if (found[0] && found[1] && found[2]) std::copy(found, found + 3, color_);
    }
    for (const char* name :
         {"intensity", "i", "scalar_intensity", "reflectivity", "reflectance", "remission"})
        if (!intensity_) intensity_ = findSingle(name);
}

const CloudField* CloudFields::findSingle(const std::string& name) const {
    const CloudField* field = layout_.find(name);
    if (field && field->count != 1)
        throw std::runtime_error("the field " + field->name + " must have COUNT 1");
    return field;
}

RecordedCloud CloudFields::emptyCloud() const {
    RecordedCloud cloud;
    cloud.hasIntensity = intensity_ != nullptr;
    cloud.hasColor = packed_ || color_[0];
    const auto isBytes = [](const CloudField* field) {
        return field && field->size == 1 && field->type != 'F';
    };
    cloud.bytesOfIntensity = isBytes(intensity_);
    cloud.bytesOfColor = packed_ || isBytes(color_[0]);
    for (const auto& field : layout_.fields) {
        if (field.name == "_") continue;  // PCL's padding
        const bool isPlace = std::count(xyz_, xyz_ + 3, &field) > 0;
        const bool isColor =
            &field == packed_ || std::count(color_, color_ + 3, &field) > 0;
        const bool isIntensity = &field == intensity_;
        if (isColor) cloud.colorFields.push_back(field.name);
        if (isIntensity) cloud.intensityFields.push_back(field.name);
        (isPlace || isColor || isIntensity ? cloud.used : cloud.unused)
            .push_back(field.name);
    }
    return cloud;
}

void CloudFields::setPacked(std::uint32_t bits, RecordedPoint& point) {
    if (bits == kQuietNan) {
        point.color.fill(std::numeric_limits<float>::quiet_NaN());
        return;
    }
    for (std::size_t i = 0; i < 3; ++i)
        point.color[i] = static_cast<float>((bits >> (16 - 8 * i)) & 255U);
}

}  // namespace hgmm::importer
