#pragma once
#include "bytes.h"
#include "hgmm/map.h"

/// Scans, poses and parameters that a fuzzer's bytes choose: few bytes, many kinds.
namespace hgmm::fuzz {

/// Up to some hundred points: of a room, a plane, a line, one point, the same point many
/// times, a cloud around the sensor, a planar laser, or whatever floats the bytes hold;
/// 1e-3 to 1e5 m large, with noise of 0 to 1 m, with and without channels and cleared rays.
/// The pose is the identity.
Scan scanFrom(Bytes& bytes);

/// Turned any way, up to 1e7 m from the origin; now and then farther than maps go, or not
/// rigid.
Pose poseFrom(Bytes& bytes);

/// All in range; loops that a user may make as long as he likes are short.
MapParams paramsFrom(Bytes& bytes);

}  // namespace hgmm::fuzz
