#pragma once
#include <hgmm/scan.h>
#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/poses/CPose3D.h>

namespace hgmm::importer {

/// The same pose as MRPT's type.
inline mrpt::poses::CPose3D toMrpt(const Pose& pose) {
    const mrpt::math::CMatrixDouble33 rotation(pose.R);
    mrpt::math::CMatrixDouble31 translation;
    for (int i = 0; i < 3; ++i) translation[i] = pose.t[i];
    return mrpt::poses::CPose3D(rotation, translation);
}

/// The same pose as the core's type.
inline Pose fromMrpt(const mrpt::poses::CPose3D& pose) {
    Pose result;
    result.R = pose.getRotationMatrix().asEigen();
    result.t = {pose.x(), pose.y(), pose.z()};
    return result;
}

}  // namespace hgmm::importer
