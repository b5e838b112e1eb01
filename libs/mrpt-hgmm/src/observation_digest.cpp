#include "observation_digest.h"

#include <cstring>
#include <type_traits>

#include "scan_readers.h"

using namespace mrpt::obs;

namespace hgmm::mrpt_bridge {

namespace {

class Digest {
 public:
    template <typename T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        std::uint64_t word = 0;
        std::memcpy(&word, &value, sizeof(T));
        hash_ = (hash_ ^ word) * 0x9E3779B97F4A7C15ULL;
        hash_ ^= hash_ >> 32U;
    }
    /// Adds at most `most` of value(0) .. value(n - 1), and n.
    template <typename Value>
    void addSpread(std::size_t n, Value&& value, std::size_t most = 1024) {
        add(n);
        const std::size_t step = n / most + 1;
        for (std::size_t i = 0; i < n; i += step) add(value(i));
    }
    void add(const mrpt::poses::CPose3D& pose) {
        for (int i = 0; i < 6; ++i) add(pose[i]);
    }
    std::uint64_t value() const { return hash_; }

 private:
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

template <typename Matrix>
void addMatrix(Digest& digest, const Matrix& m) {
    const std::size_t cols = m.cols();
    digest.add(cols);
    digest.addSpread(m.rows() * cols, [&](std::size_t i) { return m(i / cols, i % cols); });
}

void addData(Digest& digest, const CObservation2DRangeScan& o) {
    digest.add(o.aperture);
    digest.add(o.rightToLeft);
    digest.add(o.deltaPitch);
    // Asked for by every particle: a digest of all rays would cost as much as the rest.
    digest.addSpread(
        o.getScanSize(),
        [&](std::size_t i) { return o.getScanRangeValidity(i) ? o.getScanRange(i) : -1.F; },
        128);
}

void addData(Digest& digest, const CObservation3DRangeScan& o) {
    for (const double v : {o.cameraParams.fx(), o.cameraParams.fy(), o.cameraParams.cx(),
                           o.cameraParams.cy(), double(o.rangeUnits)})
        digest.add(v);
    digest.add(o.range_is_depth);
    digest.add(o.hasPoints3D);
    digest.add(o.hasRangeImage);
    digest.addSpread(o.points3D_x.size(), [&](std::size_t i) {
        return o.points3D_x[i] + 3 * o.points3D_y[i] + 7 * o.points3D_z[i];
    });
    addMatrix(digest, o.rangeImage);
}

void addData(Digest& digest, const CObservationPointCloud& o) {
    if (!o.pointcloud) return;
    const auto& x = o.pointcloud->getPointsBufferRef_x();
    const auto& y = o.pointcloud->getPointsBufferRef_y();
    const auto& z = o.pointcloud->getPointsBufferRef_z();
    digest.addSpread(x.size(), [&](std::size_t i) { return x[i] + 3 * y[i] + 7 * z[i]; });
}

void addData(Digest& digest, const CObservationVelodyneScan& o) {
    const auto& cloud = o.point_cloud;
    digest.addSpread(cloud.size(), [&](std::size_t i) {
        return cloud.x[i] + 3 * cloud.y[i] + 7 * cloud.z[i];
    });
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(o.scan_packets.data());
    digest.addSpread(
        o.scan_packets.size() * sizeof(CObservationVelodyneScan::TVelodyneRawPacket),
        [&](std::size_t i) { return bytes[i]; });
}

void addData(Digest& digest, const CObservationRotatingScan& o) {
    for (const double v : {o.startAzimuth, o.azimuthSpan, o.rangeResolution}) digest.add(v);
    addMatrix(digest, o.rangeImage);
}

}  // namespace

std::uint64_t digestOf(const CObservation& observation) {
    Digest digest;
    digest.add(observation.timestamp.time_since_epoch().count());
    mrpt::poses::CPose3D sensorPose;
    observation.getSensorPose(sensorPose);
    digest.add(sensorPose);
    visitSupported(observation, [&](const auto& o) {
        digest.add(typeid(o).hash_code());
        addData(digest, o);
        return true;
    });
    return digest.value();
}

}  // namespace hgmm::mrpt_bridge
