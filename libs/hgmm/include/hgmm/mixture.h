#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "hgmm/export.h"

namespace hgmm {

/// Number of distinct entries of a symmetric D x D matrix.
constexpr int packedSize(int D) {
    return D * (D + 1) / 2;
}

/// Place of entry (row, col) of a symmetric matrix in packed form: row-major upper
/// triangle, (0,0) (0,1) .. (0,D-1) (1,1) .. (D-1,D-1).
constexpr int packedIndex(int D, int row, int col) {
    return row <= col ? row * D - row * (row - 1) / 2 + (col - row)
                      : packedIndex(D, col, row);
}

/// Bounds of what maps hold, far beyond what sensors see: within them nothing overflows,
/// and no loop over cells runs long.
constexpr double kMaxCoordinate_m = 1e9;   ///< of a mean, in the local frame, either sign
constexpr double kMinVariance_m2 = 1e-18;  ///< of a component along an axis
constexpr double kMaxVariance_m2 = 1e16;
constexpr double kMaxSupport = 1e12;  ///< a component that has more keeps this [count]

/// One Gaussian component, or one measured sample, with its support. This is the form in
/// which single components travel; sets of them are stored as Mixture.
template <int D>
struct Gaussian {
    // Unaligned, so that D = 2 and 4 cross library borders whatever the caller's CPU flags.
    using Vector = Eigen::Matrix<double, D, 1, Eigen::DontAlign>;
    using Matrix = Eigen::Matrix<double, D, D, Eigen::DontAlign>;

    double support = 0.0;                ///< S_pi, measurements explained [count], > 0
    Vector mean = Vector::Zero();        ///< mu
    Matrix covariance = Matrix::Zero();  ///< Sigma, symmetric positive semi-definite
};

/// A mixture of D-dimensional Gaussians (thesis 3.1.1), stored as a structure of arrays:
/// one contiguous array of floats per parameter, so that kernels stream through what they
/// need.
///
/// Weights are not stored. A component carries its support S_pi = N pi (thesis 3.3.3) and
/// its weight is support / totalSupport(), so that joining two mixtures by thesis eq.
/// (3.23) is concatenation.
///
/// The same type holds measured samples: there, support counts the raw points behind a
/// sample, mean is their centroid and covariance their scatter plus the sensor's noise.
template <int D>
class Mixture {
 public:
    static constexpr int dimension = D;
    static constexpr int packed = packedSize(D);

    std::vector<float> support;              ///< [count], > 0
    std::array<std::vector<float>, D> mean;  ///< [m] for spatial axes, local frame
    std::array<std::vector<float>, packed> covariance;  ///< packed (packedIndex), [m^2]

    std::size_t size() const { return support.size(); }
    bool empty() const { return support.empty(); }

    void clear();
    void reserve(std::size_t n);
    void pushBack(const Gaussian<D>& component);
    /// Overwrites component i; its support is kept to kMaxSupport. @throws
    /// std::out_of_range if i >= size().
    void set(std::size_t i, const Gaussian<D>& component);
    /// Removes component i; the last component takes its place.
    void removeSwap(std::size_t i);
    /// Gathers component i. @throws std::out_of_range if i >= size().
    Gaussian<D> operator[](std::size_t i) const;

    /// Mean of component i < size().
    typename Gaussian<D>::Vector meanAt(std::size_t i) const {
        typename Gaussian<D>::Vector m;
        for (int d = 0; d < D; ++d) m[d] = mean[d][i];
        return m;
    }

    /// Joins another mixture over disjoint data: thesis eq. (3.23).
    void append(const Mixture& other);

    /// Sum of all supports [count], accumulated in index order.
    double totalSupport() const;
    /// pi_i = support_i / total, in [0, 1], thesis eq. (3.20). Pass totalSupport() once per
    /// loop.
    double weight(std::size_t i, double total) const { return support[i] / total; }

    /// Throws std::logic_error if array lengths differ, a number is not finite, a support
    /// is not positive or above kMaxSupport, a mean or variance of the first three axes out
    /// of the bounds above, or a covariance not clearly positive definite, as regularized
    /// ones are. For loading, tests and debug builds.
    void check() const;

    bool operator==(const Mixture& o) const {
        return support == o.support && mean == o.mean && covariance == o.covariance;
    }
    bool operator!=(const Mixture& o) const { return !(*this == o); }
};

extern template class HGMM_EXPORT Mixture<2>;
extern template class HGMM_EXPORT Mixture<3>;
extern template class HGMM_EXPORT Mixture<4>;

/// The Gaussian with the support, mean and second moments of a and b together.
template <int D>
Gaussian<D> mergeMoments(const Gaussian<D>& a, const Gaussian<D>& b) {
    const double total = a.support + b.support;
    const double fa = a.support / total, fb = b.support / total;
    const typename Gaussian<D>::Vector between = b.mean - a.mean;
    Gaussian<D> merged;
    merged.support = total;
    merged.mean = a.mean + fb * between;
    merged.covariance =
        fa * a.covariance + fb * b.covariance + (fa * fb) * between * between.transpose();
    return merged;
}

}  // namespace hgmm
