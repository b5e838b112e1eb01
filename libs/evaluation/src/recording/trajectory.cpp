#include "hgmm/evaluation/trajectory.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "hgmm/evaluation/parse_numbers.h"
#include "hgmm/mrpt_bridge/output_file.h"

namespace hgmm::evaluation {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& what) {
    throw std::runtime_error(file + ":" + std::to_string(line) + ": " + what);
}

StampedPose fromTum(const std::vector<double>& v) {
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (q.norm() < 1e-6) throw std::runtime_error("the quaternion is null");
    StampedPose pose;
    pose.stamp = v[0];
    pose.T_world_frame.t = {v[1], v[2], v[3]};
    pose.T_world_frame.R = q.normalized().toRotationMatrix();
    return pose;
}

StampedPose fromKitti(const std::vector<double>& v, std::size_t index) {
    Eigen::Matrix3d rotation;
    rotation << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
    StampedPose pose;
    pose.stamp = static_cast<double>(index) * kDefaultPosePeriod;
    pose.T_world_frame.t = {v[3], v[7], v[11]};
    pose.T_world_frame.R = nearestRotation(rotation);
    return pose;
}

StampedPose parsePose(const std::string& text, std::size_t& columns, std::size_t index) {
    const auto numbers = parseNumbers(text);
    if (numbers.size() != kTumColumns && numbers.size() != kKittiColumns)
        throw std::runtime_error(
            "expected 8 numbers (TUM: t x y z qx qy qz qw) or 12 (KITTI), got " +
            std::to_string(numbers.size()));
    if (columns == 0) columns = numbers.size();
    if (numbers.size() != columns)
        throw std::runtime_error("expected " + std::to_string(columns) +
                                 " numbers as in the lines before, got " +
                                 std::to_string(numbers.size()));
    return columns == kTumColumns ? fromTum(numbers) : fromKitti(numbers, index);
}

std::string tumLine(const StampedPose& pose) {
    Eigen::Quaterniond q(pose.T_world_frame.R);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const auto& t = pose.T_world_frame.t;
    char text[320];
    std::snprintf(text, sizeof text, "%.6f %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                  pose.stamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    return text;
}

}  // namespace

Trajectory readTrajectory(const std::string& file) {
    std::ifstream in(file);
    if (!in || std::filesystem::is_directory(file))
        throw std::runtime_error(file + ": cannot be read; give the path of a pose file");
    Trajectory trajectory;
    std::size_t columns = 0;
    std::size_t line = 0;
    for (std::string text; std::getline(in, text);) {
        ++line;
        const auto first = text.find_first_not_of(" \t\r");
        if (first == std::string::npos || text[first] == '#') continue;
        try {
            trajectory.push_back(parsePose(text, columns, trajectory.size()));
        } catch (const std::runtime_error& e) {
            fail(file, line, e.what());
        }
        const auto n = trajectory.size();
        if (n > 1 && trajectory[n - 1].stamp < trajectory[n - 2].stamp)
            fail(file, line,
                 "the time stamp is earlier than that of the pose before; sort the file");
    }
    if (trajectory.empty()) throw std::runtime_error(file + ": holds no poses");
    return trajectory;
}

std::string tumText(const Trajectory& trajectory) {
    std::string text = "# timestamp tx ty tz qx qy qz qw\n";
    for (const auto& pose : trajectory) text += tumLine(pose);
    return text;
}

void writeTumTrajectory(const std::string& file, const Trajectory& trajectory) {
    mrpt_bridge::writeFile(file, tumText(trajectory));
}

void writeKittiTrajectory(const std::string& file, const Trajectory& trajectory) {
    std::ostringstream out;
    out.precision(12);
    for (const auto& pose : trajectory) {
        const auto& [R, t] = pose.T_world_frame;
        for (int row = 0; row < 3; ++row)
            out << R(row, 0) << ' ' << R(row, 1) << ' ' << R(row, 2) << ' ' << t(row)
                << (row < 2 ? ' ' : '\n');
    }
    mrpt_bridge::writeFile(file, out.str());
}

std::optional<Pose> poseAt(const Trajectory& trajectory, double stamp, double maxGap) {
    const auto after =
        std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                         [](const StampedPose& pose, double t) { return pose.stamp < t; });
    const bool hasAfter = after != trajectory.end();
    const bool hasBefore = after != trajectory.begin();
    const double gapAfter = hasAfter ? after->stamp - stamp : INFINITY;
    const double gapBefore = hasBefore ? stamp - (after - 1)->stamp : INFINITY;
    // Negated, so that a NaN stamp finds nothing.
    if (!(std::min(gapAfter, gapBefore) <= maxGap)) return std::nullopt;
    if (!hasBefore) return after->T_world_frame;
    if (!hasAfter) return (after - 1)->T_world_frame;

    const Pose& a = (after - 1)->T_world_frame;
    const Pose& b = after->T_world_frame;
    const double share = gapBefore / (gapBefore + gapAfter);
    const Eigen::Quaterniond qa(a.R);
    Pose pose;
    pose.R = qa.slerp(share, Eigen::Quaterniond(b.R)).toRotationMatrix();
    pose.t = a.t + share * (b.t - a.t);
    return pose;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix, double tolerance) {
    if (!matrix.allFinite()) throw std::runtime_error("the rotation matrix is not finite");
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
    const Eigen::Matrix3d R =
        svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    if ((R - matrix).cwiseAbs().maxCoeff() > tolerance)
        throw std::runtime_error("the 3x3 part is not a rotation matrix");
    return R;
}

}  // namespace hgmm::evaluation
