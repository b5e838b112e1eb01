#include "hgmm/registration.h"

#include <cmath>

#include "arrays.h"

namespace hgmm::python {

namespace {

constexpr const char* kRegisterDoc =
    R"(Finds where another map lies in this one, from its surfaces (RegistrationTarget in
hgmm/registration.h: distribution to distribution, after Stoyanov et al. 2012).

T_this_other_guess: shape (4, 4), a pose of the other map's frame in this one's [m]; None for
    the identity. Its rotation is taken to be off about the origin of the other map's first
    sensor, to a metre.
coarse_width_m, coarse_angle_rad: error of the guess, one standard deviation.
fine_width_m, fine_angle_rad: to what the pose is resolved; at most the coarse ones.
max_stage_iterations: of each stage [count].
min_overlap: share of the other map that must be found, in [0, 1].

Returns a Registration. Where too little is found, it is not converged. The other map is left as
it is: merge() takes the pose. Raises ValueError if a map is empty, for a pose that is not
finite or not rigid, and for numbers out of range. Releases the GIL.)";

/// The guess in the local frames of both maps, in which registration works.
Pose toLocal(const Pose& T_a_b, const Map& a, const Map& b) {
    return {T_a_b.R, T_a_b.t + T_a_b.R * b.origin() - a.origin()};
}

/// The error (w, v) of a local pose as that of the pose between the map frames: there, the
/// error w of the rotation moves the origin by (R origin_b) x w.
Eigen::Matrix<double, 6, 6> toMapFrame(const Registration& local, const Map& b) {
    const Eigen::Vector3d lever = local.T_target_source.R * b.origin();
    Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
    J.bottomLeftCorner<3, 3>() << 0, -lever.z(), lever.y(), lever.z(), 0, -lever.x(),
        -lever.y(), lever.x(), 0;
    return J * local.covariance * J.transpose();
}

Registration align(const Map& a, const Map& b, const Pose& T_a_b,
                   const RegistrationParams& params) {
    if (a.empty() || b.empty())
        throw std::invalid_argument("register: an empty map cannot be aligned");
    std::vector<const Mixture<3>*> levels;
    for (std::size_t level = a.levelCount(); level-- > 0;)
        levels.push_back(&a.mixture(level));
    Registration found =
        registerMixtures(levels, b.mixture(), toLocal(T_a_b, a, b), params);
    found.covariance = toMapFrame(found, b);
    Pose& T = found.T_target_source;
    T.t += a.origin() - T.R * b.origin();
    return found;
}

py::object registerMap(const SharedMap& map, const SharedMap& other,
                       const py::object& T_this_other_guess, double coarseWidth_m,
                       double coarseAngle_rad, double fineWidth_m, double fineAngle_rad,
                       int maxStageIterations, double minOverlap) {
    const RegistrationParams params{coarseWidth_m, coarseAngle_rad,    fineWidth_m,
                                    fineAngle_rad, maxStageIterations, minOverlap};
    const Pose guess = poseFrom(T_this_other_guess, "T_this_other_guess");
    const Registration r = map.readWith(
        other, [&](const Map& a, const Map& b) { return align(a, b, guess, params); });
    return answer("Registration", arrayOf(r.T_target_source),
                  arrayOf(Eigen::MatrixXd(r.covariance)), r.converged, r.iterations,
                  r.overlap, r.cost);
}

}  // namespace

void bindRegistration(MapClass& map) {
    using namespace py::literals;
    const RegistrationParams params;
    map.def("register", &registerMap, "other"_a, "T_this_other_guess"_a = py::none(),
            py::kw_only(), "coarse_width_m"_a = params.coarseWidth_m,
            "coarse_angle_rad"_a = params.coarseAngle_rad,
            "fine_width_m"_a = params.fineWidth_m,
            "fine_angle_rad"_a = params.fineAngle_rad,
            "max_stage_iterations"_a = params.maxStageIterations,
            "min_overlap"_a = params.minOverlap, kRegisterDoc);
}

}  // namespace hgmm::python
