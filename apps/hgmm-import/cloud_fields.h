#pragma once
#include <cstdint>

#include "cloud_layout.h"
#include "recorded_cloud.h"

namespace hgmm::importer {

/// Which fields of a file are read, by their names, and how they become a point.
///
/// | what | names, the first that is there |
/// | --- | --- |
/// | place | x, y, z |
/// | colour | rgb, rgba (packed in four bytes); r g b; red green blue; diffuse_red ... |
/// | intensity | intensity, i, scalar_intensity, reflectivity, reflectance, remission |
class CloudFields {
 public:
    /// Throws std::runtime_error if x, y or z is missing, or a field that is read has
    /// another COUNT than 1, or a packed colour another size than 4.
    explicit CloudFields(const CloudLayout& layout);

    /// What the file has, without points.
    RecordedCloud emptyCloud() const;

    /// number(field) gives a field's value, bits(field) its four bytes.
    template <typename Number, typename Bits>
    RecordedPoint build(Number number, Bits bits) const {
        RecordedPoint point;
        for (std::size_t i = 0; i < 3; ++i)
            point.position[static_cast<Eigen::Index>(i)] = number(*xyz_[i]);
        if (intensity_) point.intensity = static_cast<float>(number(*intensity_));
        if (packed_) {
            setPacked(bits(*packed_), point);
        } else if (color_[0]) {
            for (std::size_t i = 0; i < 3; ++i)
                point.color[i] = static_cast<float>(number(*color_[i]));
        }
        return point;
    }

 private:
    static void setPacked(std::uint32_t bits, RecordedPoint& point);
    const CloudField* findSingle(const std::string& name) const;

    const CloudLayout& layout_;
    const CloudField* xyz_[3] = {};
    const CloudField* color_[3] = {};
    const CloudField* packed_ = nullptr;
    const CloudField* intensity_ = nullptr;
};

}  // namespace hgmm::importer
