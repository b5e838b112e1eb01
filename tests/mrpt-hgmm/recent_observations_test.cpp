#include "recent_observations.h"

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

TEST(RecentObservations, WholeDigestSeesAnyPoint) {
    for (const auto& [name, o] : observations::all()) {
        Numbers numbers(Digested::whole);
        EXPECT_EQ(numbers.of(*o), 0);
        if (auto* scan = dynamic_cast<mrpt::obs::CObservation2DRangeScan*>(o.get()))
            scan->setScanRange(77, scan->getScanRange(77) + 0.001F);
        else if (auto* image = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(o.get());
                 image && image->hasRangeImage)
            image->rangeImage(17, 33) += 1;
        else
            continue;
        EXPECT_EQ(numbers.of(*o), 1) << name;
    }
}

}  // namespace
