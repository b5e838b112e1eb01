#include "motion_action.h"

#include <algorithm>

#include "mrpt_pose.h"

namespace hgmm::importer {
namespace {

constexpr double kLeastSigmaMetres = 0.01;
constexpr double kLeastSigmaDegrees = 0.5;

}  // namespace

Pose withNoise(const Pose& T_from_to, const OdometryNoise& noise,
               std::mt19937_64& generator) {
    std::normal_distribution<double> normal;
    double error[6];
    for (int i = 0; i < 6; ++i)
        error[i] = normal(generator) *
                   (i < 3 ? noise.sigmaMetres : mrpt::DEG2RAD(noise.sigmaDegrees));
    return fromMrpt(toMrpt(T_from_to) + mrpt::poses::CPose3D(error[0], error[1], error[2],
                                                             error[3], error[4], error[5]));
}

mrpt::obs::CActionRobotMovement3D::Ptr makeMotionAction(const Pose& T_from_to,
                                                        const OdometryNoise& noise) {
    const mrpt::poses::CPose3D increment = toMrpt(T_from_to);
    auto action = mrpt::obs::CActionRobotMovement3D::Create();
    action->estimationMethod = mrpt::obs::CActionRobotMovement3D::emOdometry;
    action->rawOdometryIncrementReading = increment;
    action->poseChange.mean = increment;
    const double metres = std::max(noise.sigmaMetres, kLeastSigmaMetres);
    const double radians = mrpt::DEG2RAD(std::max(noise.sigmaDegrees, kLeastSigmaDegrees));
    action->poseChange.cov.setZero();
    for (int i = 0; i < 6; ++i)
        action->poseChange.cov(i, i) = i < 3 ? metres * metres : radians * radians;

    auto& model = action->motionModelConfiguration;
    model.modelSelection = mrpt::obs::CActionRobotMovement3D::mm6DOF;
    model.mm6DOFModel.additional_std_XYZ = static_cast<float>(metres);
    model.mm6DOFModel.additional_std_angle = static_cast<float>(radians);
    return action;
}

mrpt::obs::CActionRobotMovement2D::Ptr makePlanarMotionAction(
    const Pose& T_from_to, const OdometryNoise& noise, double turnErrorPerMetre_deg) {
    mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
    model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
    model.gaussianModel.a3 = static_cast<float>(mrpt::DEG2RAD(turnErrorPerMetre_deg));
    auto& least = model.gaussianModel;
    least.minStdXY = std::max<double>(least.minStdXY, noise.sigmaMetres);
    least.minStdPHI = std::max<double>(least.minStdPHI, mrpt::DEG2RAD(noise.sigmaDegrees));
    auto action = mrpt::obs::CActionRobotMovement2D::Create();
    action->computeFromOdometry(mrpt::poses::CPose2D(toMrpt(T_from_to)), model);
    return action;
}

}  // namespace hgmm::importer
