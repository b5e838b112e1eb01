#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace hgmm {

/// Rigid transform; p_a = R p_b + t for a pose named T_a_b.
struct Pose {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< rotation, orthonormal
    Eigen::Vector3d t = Eigen::Vector3d::Zero();      ///< translation [m]

    Pose operator*(const Pose& o) const { return {R * o.R, R * o.t + t}; }
    Pose inverse() const { return {R.transpose(), -(R.transpose() * t)}; }
};

/// One further quantity measured at each point of a scan.
struct Channel {
    std::string name;           ///< "r", "g", "b" or "intensity", or a user's own name
    std::vector<float> values;  ///< one per point; colours and intensity in [0, 1]
};

/// What one sensor saw from one place. Rays start at the origin of the sensor frame.
struct Scan {
    std::vector<float> x, y, z;     ///< points in the sensor frame [m]
    std::vector<Channel> channels;  ///< may be empty
    Pose T_map_sensor;              ///< pose of the sensor in the map frame

    std::size_t size() const { return x.size(); }
    void reserve(std::size_t n);
    void pushBack(float px, float py, float pz);
    /// Throws std::invalid_argument if x, y, z or a channel differ in length, or the pose
    /// is not finite or its rotation not orthonormal to 1e-4. Points need not be finite:
    /// the filter counts and drops those that are not.
    void validate() const;
};

}  // namespace hgmm
