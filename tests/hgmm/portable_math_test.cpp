#include "base/portable_math.h"

#include <gtest/gtest.h>

#include <random>

namespace hgmm {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Distance in units of the last place of what is right.
double ulps(double v, double right) {
    return std::abs(v - right) /
           (std::nextafter(std::abs(right), kInfinite) - std::abs(right));
}

TEST(PortableMath, IsAsExactAsTheCLibrary) {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> exponent(-700, 700), nearOne(-1e-3, 1e-3);
    for (int i = 0; i < 200000; ++i) {
        const double x = i % 2 == 0 ? exponent(engine) : exponent(engine) / 100;
        EXPECT_LE(ulps(portable::exp(x), std::exp(x)), 2.0) << x;
        const double y = std::exp(x);
        EXPECT_LE(ulps(portable::log(y), std::log(y)), 2.0) << y;
        const double z = 1 + nearOne(engine);
        EXPECT_LE(ulps(portable::log(z), std::log(z)), 2.0) << z;
    }
}

TEST(PortableMath, KnowsItsLimits) {
    EXPECT_EQ(portable::exp(0.0), 1.0);
    EXPECT_EQ(portable::exp(-kInfinite), 0.0);
    EXPECT_EQ(portable::exp(-800.0), 0.0);
    EXPECT_EQ(portable::exp(kInfinite), kInfinite);
    EXPECT_EQ(portable::exp(800.0), kInfinite);
    EXPECT_TRUE(std::isnan(portable::exp(std::nan(""))));
    EXPECT_EQ(portable::log(1.0), 0.0);
    EXPECT_EQ(portable::log(0.0), -kInfinite);
    EXPECT_EQ(portable::log(kInfinite), kInfinite);
    EXPECT_TRUE(std::isnan(portable::log(-1.0)));
    EXPECT_TRUE(std::isnan(portable::log(std::nan(""))));
    EXPECT_NEAR(portable::log(4.9e-324), std::log(4.9e-324), 1e-12);
}

// The golden bits: another processor or compiler must give the same.
TEST(PortableMath, GivesTheseBits) {
    EXPECT_EQ(portable::exp(1.0), 0x1.5bf0a8b14576ap+1);
    EXPECT_EQ(portable::log(10.0), 0x1.26bb1bbb55516p+1);
}

}  // namespace
}  // namespace hgmm
