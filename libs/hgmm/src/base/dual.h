#pragma once
#include <Eigen/Core>
#include <cmath>

namespace hgmm {

/// A number with its gradient in space, so that the gradient of a formula is the formula
/// itself, evaluated once.
struct Dual {
    double value = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();

    Dual() = default;
    Dual(double v) : value(v) {}  // NOLINT: constants mix with dual numbers
    Dual(double v, const Eigen::Vector3d& g) : value(v), gradient(g) {}
};

inline Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.gradient + b.gradient};
}
inline Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.gradient - b.gradient};
}
inline Dual operator-(const Dual& a) {
    return {-a.value, -a.gradient};
}
inline Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.gradient + b.value * a.gradient};
}
inline Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.value / b.value;
    return {q, (a.gradient - q * b.gradient) / b.value};
}
inline Dual& operator+=(Dual& a, const Dual& b) {
    return a = a + b;
}
inline Dual exp(const Dual& a) {
    const double e = std::exp(a.value);
    return {e, e * a.gradient};
}
inline Dual erfc(const Dual& a) {
    constexpr double twoOverSqrtPi = 1.1283791670955126;
    return {std::erfc(a.value), -twoOverSqrtPi * std::exp(-a.value * a.value) * a.gradient};
}

/// Of numbers and dual numbers.
template <typename T>
T square(const T& v) {
    return v * v;
}

inline double valueOf(double v) {
    return v;
}
inline double valueOf(const Dual& d) {
    return d.value;
}

}  // namespace hgmm
