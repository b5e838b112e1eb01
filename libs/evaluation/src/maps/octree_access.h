#pragma once
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/baseline.h"

// What MRPT's octrees, plain and coloured, have in common without a common class.
namespace hgmm::evaluation {

template <class Octree>
std::vector<std::pair<std::string, double>> optionsOfOctree(const Octree& octree) {
    return {{"resolution", octree.getResolution()},
            {"probHit", octree.getProbHit()},
            {"probMiss", octree.getProbMiss()},
            {"clampingThresMin", octree.getClampingThresMin()},
            {"clampingThresMax", octree.getClampingThresMax()}};
}

template <class Octree>
Answer answerOfOctree(const Octree& octree, const Eigen::Vector3d& p_map) {
    const Eigen::Vector3f p = p_map.cast<float>();
    double probability = 0.5;
    const bool known = octree.getPointOccupancy(p.x(), p.y(), p.z(), probability);
    return known ? Answer{probability, false} : Answer{};
}

}  // namespace hgmm::evaluation
