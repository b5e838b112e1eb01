#include "hgmm/mixture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "mixture/mixture_arrays.h"

namespace hgmm {

namespace {

/// A pivot of the covariance must be more than this share of the trace: regularized()
/// leaves hundreds of times as much.
constexpr double kLeastPivot = 1e-9;

template <int D>
bool isPositiveDefinite(const typename Gaussian<D>::Matrix& covariance) {
    Eigen::Matrix<double, D, D> L = covariance;
    const double least = kLeastPivot * L.trace();
    for (int i = 0; i < D; ++i) {
        for (int k = 0; k < i; ++k) L(i, i) -= L(i, k) * L(i, k);
        if (!(L(i, i) > least)) return false;
        L(i, i) = std::sqrt(L(i, i));
        for (int row = i + 1; row < D; ++row) {
            for (int k = 0; k < i; ++k) L(row, i) -= L(row, k) * L(i, k);
            L(row, i) /= L(i, i);
        }
    }
    return true;
}

}  // namespace

template <int D>
void Mixture<D>::clear() {
    forEachArray(*this, [](auto& array) { array.clear(); });
}

template <int D>
void Mixture<D>::reserve(std::size_t n) {
    forEachArray(*this, [n](auto& array) { array.reserve(n); });
}

template <int D>
void Mixture<D>::pushBack(const Gaussian<D>& component) {
    forEachArray(*this, [](auto& array) { array.push_back(0.F); });
    set(size() - 1, component);
}

template <int D>
void Mixture<D>::set(std::size_t i, const Gaussian<D>& component) {
    support.at(i) = static_cast<float>(std::min(component.support, kMaxSupport));
    for (int d = 0; d < D; ++d) mean[d][i] = static_cast<float>(component.mean[d]);
    for (int row = 0, k = 0; row < D; ++row)
        for (int col = row; col < D; ++col, ++k)
            covariance[k][i] = static_cast<float>(component.covariance(row, col));
}

template <int D>
void Mixture<D>::removeSwap(std::size_t i) {
    if (i >= size())
        throw std::out_of_range("Mixture::removeSwap: no component " + std::to_string(i));
    forEachArray(*this, [i](auto& array) {
        array[i] = array.back();
        array.pop_back();
    });
}

template <int D>
Gaussian<D> Mixture<D>::operator[](std::size_t i) const {
    Gaussian<D> g;
    g.support = support.at(i);
    for (int d = 0; d < D; ++d) g.mean[d] = mean[d][i];
    for (int row = 0, k = 0; row < D; ++row)
        for (int col = row; col < D; ++col, ++k)
            g.covariance(row, col) = g.covariance(col, row) = covariance[k][i];
    return g;
}

template <int D>
void Mixture<D>::append(const Mixture& other) {  // thesis eq. (3.23)
    const auto join = [](std::vector<float>& to, const std::vector<float>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    join(support, other.support);
    for (int d = 0; d < D; ++d) join(mean[d], other.mean[d]);
    for (int k = 0; k < packed; ++k) join(covariance[k], other.covariance[k]);
}

template <int D>
double Mixture<D>::totalSupport() const {
    return std::accumulate(support.begin(), support.end(), 0.0);
}

template <int D>
void Mixture<D>::check() const {
    forEachArray(*this, [this](const auto& array) {
        if (array.size() != size())
            throw std::logic_error("Mixture: arrays differ in length");
        for (const float v : array)
            if (!std::isfinite(v))
                throw std::logic_error("Mixture: a parameter is not finite");
    });
    const auto fail = [](std::size_t i, const char* why) {
        throw std::logic_error("Mixture: component " + std::to_string(i) + why);
    };
    for (std::size_t i = 0; i < size(); ++i) {
        if (!(support[i] > 0)) fail(i, " has no support");
        if (support[i] > float(kMaxSupport)) fail(i, " has a support beyond 1e12");
        for (int d = 0; d < std::min(D, 3); ++d) {
            const float variance = covariance[packedIndex(D, d, d)][i];
            if (std::abs(mean[d][i]) > float(kMaxCoordinate_m))
                fail(i, " lies farther than 1e9 m from the map's origin");
            if (variance < float(kMinVariance_m2) || variance > float(kMaxVariance_m2))
                fail(i, " has a standard deviation out of [1e-9, 1e8] m");
        }
        if (!isPositiveDefinite<D>((*this)[i].covariance))
            fail(i, " has a covariance that is not positive definite");
    }
}

template class Mixture<2>;
template class Mixture<3>;
template class Mixture<4>;

}  // namespace hgmm
