#include "hgmm/view_directions.h"

namespace hgmm {

ViewDirection merged(const ViewDirection& a, double supportA, const ViewDirection& b,
                     double supportB) {
    if (!a.known() || !b.known()) return a.known() ? a : b;
    const double fa = supportA / (supportA + supportB);
    ViewDirection view;
    view.direction = fa * a.direction + (1 - fa) * b.direction;
    const double length = view.direction.norm();
    // Opposite directions have no mean: the first stays.
    view.direction = length > 1e-6 ? Eigen::Vector3d(view.direction / length) : a.direction;
    view.range_m = fa * a.range_m + (1 - fa) * b.range_m;
    return view;
}

ViewDirection viewFrom(const Eigen::Vector3d& sensorOrigin, const Eigen::Vector3d& mean) {
    const Eigen::Vector3d towards = sensorOrigin - mean;
    const double range = towards.norm();
    ViewDirection view;
    if (!(range > 0)) return view;
    view.direction = towards / range;
    view.range_m = range;
    return view;
}

void ViewDirections::reserve(std::size_t n) {
    forEachArray([n](std::vector<float>& array) { array.reserve(n); });
}

void ViewDirections::pushBack(const ViewDirection& view) {
    for (auto& axis : direction_) axis.push_back(0.F);
    range_.push_back(0.F);
    set(size() - 1, view);
}

void ViewDirections::set(std::size_t i, const ViewDirection& view) {
    for (int d = 0; d < 3; ++d) direction_[d].at(i) = static_cast<float>(view.direction[d]);
    range_[i] = static_cast<float>(view.range_m);
}

void ViewDirections::removeSwap(std::size_t i) {
    forEachArray([i](std::vector<float>& array) {
        array.at(i) = array.back();
        array.pop_back();
    });
}

}  // namespace hgmm
