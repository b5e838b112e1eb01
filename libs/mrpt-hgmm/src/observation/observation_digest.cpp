#include "observation/observation_digest.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <type_traits>

#include "observation/scan_readers.h"

using namespace mrpt::obs;

namespace hgmm::mrpt_bridge {

namespace {

class Digest {
 public:
    explicit Digest(Digested digested) : digested_(digested) {}

    template <typename T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        std::uint64_t word = 0;
        std::memcpy(&word, &value, sizeof(T));
        hash_ = mixed(hash_, word);
    }
    /// Adds n and value(0) .. value(n - 1); at most `most` of them, spread, if a sample
    /// will do.
    template <typename Value>
    void addAll(std::size_t n, Value&& value, std::size_t most = 1024) {
        addRows(
            1, n, [&](std::size_t, std::size_t i) { return value(i); }, most);
    }
    /// The same of value(row, column).
    template <typename Value>
    void addRows(std::size_t rows, std::size_t cols, Value&& value,
                 std::size_t most = 1024) {
        add(rows * cols);
        const std::size_t step =
            digested_ == Digested::whole
                ? 1
                : std::max<std::size_t>(1, (rows * cols + most - 1) / most);
        // Several chains, for each waits for its own last step only.
        std::array<std::uint64_t, 4> lanes{1, 2, 3, 4};
        std::size_t lane = 0, first = 0;
        for (std::size_t row = 0; row < rows; ++row) {
            std::size_t col = first;
            for (; col < cols; col += step) {
                const float v = static_cast<float>(value(row, col));
                std::uint32_t word = 0;
                std::memcpy(&word, &v, sizeof(v));
                lanes[lane] = mixed(lanes[lane], word);
                lane = (lane + 1) % lanes.size();
            }
            first = col - cols;
        }
        for (const std::uint64_t l : lanes) add(l);
    }
    void add(const mrpt::poses::CPose3D& pose) {
        for (int i = 0; i < 6; ++i) add(pose[i]);
    }
    void add(const std::string& text) {
        addAll(text.size(), [&](std::size_t i) { return text[i]; });
    }
    std::uint64_t value() const { return hash_; }

 private:
    static std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
        hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
        return hash ^ hash >> 32U;
    }

    Digested digested_;
    std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

template <typename Matrix>
void addMatrix(Digest& digest, const Matrix& m) {
    digest.add(m.cols());
    // Rows are spread first: a division for each element would take longer than its hash.
    digest.addRows(m.rows(), m.cols(), [&](auto row, auto col) { return m(row, col); });
}

template <typename Buffer>
void addPoints(Digest& digest, const Buffer& x, const Buffer& y, const Buffer& z) {
    for (const Buffer* buffer : {&x, &y, &z})
        digest.addAll(buffer->size(), [&](std::size_t i) { return (*buffer)[i]; });
}

void addData(Digest& digest, const CObservation2DRangeScan& o) {
    digest.add(o.aperture);
    digest.add(o.rightToLeft);
    digest.add(o.deltaPitch);
    digest.add(o.maxRange);
    const std::size_t n = o.getScanSize();
    if (n == 0) return;
    const float* ranges = &o.getScanRange(0);
    digest.addAll(
        n, [&](std::size_t i) { return ranges[i]; }, n);
    // Asked for by every particle, and slow to ask for.
    digest.addAll(
        n, [&](std::size_t i) { return o.getScanRangeValidity(i); }, 64);
}

// What is stored in files is told by their names: it may be loaded or not, and another
// thread may be at it.

void addData(Digest& digest, const CObservation3DRangeScan& o) {
    const auto& camera = o.cameraParams;
    for (const double v :
         {camera.fx(), camera.fy(), camera.cx(), camera.cy(), double(o.rangeUnits)})
        digest.add(v);
    for (const double k : camera.dist) digest.add(k);
    digest.add(camera.distortion);
    digest.add(o.range_is_depth);
    digest.add(o.maxRange);
    digest.add(o.hasPoints3D);
    digest.add(o.hasRangeImage);
    if (o.points3D_isExternallyStored())
        digest.add(o.points3D_getExternalStorageFile());
    else
        addPoints(digest, o.points3D_x, o.points3D_y, o.points3D_z);
    if (o.rangeImage_isExternallyStored())
        digest.add(o.rangeImage_getExternalStorageFile(""));
    else
        addMatrix(digest, o.rangeImage);
}

void addData(Digest& digest, const CObservationPointCloud& o) {
    if (o.isExternallyStored())
        digest.add(o.getExternalStorageFile());
    else if (o.pointcloud)
        addPoints(digest, o.pointcloud->getPointsBufferRef_x(),
                  o.pointcloud->getPointsBufferRef_y(),
                  o.pointcloud->getPointsBufferRef_z());
}

void addData(Digest& digest, const CObservationVelodyneScan& o) {
    addPoints(digest, o.point_cloud.x, o.point_cloud.y, o.point_cloud.z);
    digest.add(o.minRange);
    digest.add(o.maxRange);
    for (const auto& laser : o.calibration.laser_corrections)
        for (const double v :
             {laser.azimuthCorrection, laser.verticalCorrection, laser.distanceCorrection})
            digest.add(v);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(o.scan_packets.data());
    digest.addAll(
        o.scan_packets.size() * sizeof(CObservationVelodyneScan::TVelodyneRawPacket),
        [&](std::size_t i) { return bytes[i]; });
}

void addData(Digest& digest, const CObservationRotatingScan& o) {
    for (const double v : {o.startAzimuth, o.azimuthSpan, o.rangeResolution, o.maxRange})
        digest.add(v);
    digest.add(o.lidarModel);
    digest.add(o.rowCount);
    digest.add(o.columnCount);
    addMatrix(digest, o.rangeImage);
}

}  // namespace

std::uint64_t digestOf(const CObservation& observation, Digested digested) {
    Digest digest(digested);
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
