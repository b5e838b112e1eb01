#include "observation/recent_observations.h"

#include <gtest/gtest.h>

#include "observations.h"

using hgmm::mrpt_bridge::Digested;

namespace {

/// Values are numbered in the order in which they were made.
class Numbers {
 public:
    explicit Numbers(Digested digested) : recent_(digested) {}
    int of(const mrpt::obs::CObservation& o, double params = 0) {
        return *recent_.get(o, params, [this] { return std::make_shared<int>(made_++); });
    }
    void forget() { recent_.forget(); }

 private:
    hgmm::mrpt_bridge::RecentObservations<double, int> recent_;
    int made_ = 0;
};

TEST(RecentObservations, RemembersByObservationAndParams) {
    for (const Digested digested : {Digested::sample, Digested::whole}) {
        Numbers numbers(digested);
        const auto a = observations::laser(), b = observations::laser();
        EXPECT_EQ(numbers.of(*a), 0);
        EXPECT_EQ(numbers.of(*a), 0);
        EXPECT_EQ(numbers.of(*b), 1) << "at another address";
        EXPECT_EQ(numbers.of(*a, 0.5), 2) << "with other parameters";
        EXPECT_EQ(numbers.of(*a), 0);
        a->timestamp += std::chrono::seconds(1);
        EXPECT_EQ(numbers.of(*a), 3);
        numbers.forget();
        EXPECT_EQ(numbers.of(*a), 4);
    }
}

TEST(RecentObservations, KeepsTheLastFourOnly) {
    Numbers numbers(Digested::whole);
    const auto scan = observations::laser();
    for (int i = 0; i < 5; ++i) EXPECT_EQ(numbers.of(*scan, i), i);
    for (int i = 4; i > 0; --i) EXPECT_EQ(numbers.of(*scan, i), i);
    EXPECT_EQ(numbers.of(*scan, 0), 5) << "the oldest went";
}

/// Moves one point, or one byte of a packet, in the midst of the data.
void moveOnePoint(mrpt::obs::CObservation& o) {
    using namespace mrpt::obs;
    if (auto* scan = dynamic_cast<CObservation2DRangeScan*>(&o)) {
        scan->setScanRange(77, scan->getScanRange(77) + 0.001F);
    } else if (auto* image = dynamic_cast<CObservation3DRangeScan*>(&o)) {
        if (image->hasRangeImage)
            image->rangeImage(17, 33) += 1;
        else
            image->points3D_y.at(image->points3D_y.size() / 2) += 0.001F;
    } else if (auto* cloud = dynamic_cast<CObservationPointCloud*>(&o)) {
        float x = 0, y = 0, z = 0;
        cloud->pointcloud->getPoint(57, x, y, z);
        cloud->pointcloud->setPoint(57, x, y, z + 0.001F);
    } else if (auto* velodyne = dynamic_cast<CObservationVelodyneScan*>(&o)) {
        if (velodyne->point_cloud.size() > 0)
            velodyne->point_cloud.z.at(velodyne->point_cloud.size() / 2) += 0.001F;
        else
            reinterpret_cast<std::uint8_t*>(velodyne->scan_packets.data())[501] ^= 1U;
    } else if (auto* rotating = dynamic_cast<CObservationRotatingScan*>(&o)) {
        rotating->rangeImage(0, rotating->columnCount / 2) += 1;
    } else {
        FAIL() << o.GetRuntimeClass()->className;
    }
}

TEST(RecentObservations, WholeDigestSeesAnyPoint) {
    for (const auto& [name, o] : observations::all()) {
        Numbers numbers(Digested::whole);
        EXPECT_EQ(numbers.of(*o), 0);
        moveOnePoint(*o);
        EXPECT_EQ(numbers.of(*o), 1) << name;
    }
}

TEST(RecentObservations, FieldsThatPlacePointsCount) {
    Numbers numbers(Digested::sample);
    const auto image = observations::depthImage();
    EXPECT_EQ(numbers.of(*image), 0);
    image->cameraParams.dist[0] = 0.1;
    EXPECT_EQ(numbers.of(*image), 1);
    mrpt::obs::CObservationVelodyneScan velodyne;
    EXPECT_EQ(numbers.of(velodyne), 2);
    velodyne.maxRange = 7;
    EXPECT_EQ(numbers.of(velodyne), 3);
    mrpt::obs::CObservationRotatingScan rotating;
    EXPECT_EQ(numbers.of(rotating), 4);
    rotating.lidarModel = "VLP-16";
    EXPECT_EQ(numbers.of(rotating), 5);
}

}  // namespace
