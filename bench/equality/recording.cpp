#include "recording.h"

#include <mrpt/math/CQuaternion.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace equality {
namespace {

/// TUM lines: t x y z qx qy qz qw.
std::vector<mrpt::poses::CPose3D> readPoses(const std::string& file) {
    std::ifstream in(file);
    std::vector<mrpt::poses::CPose3D> poses;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream numbers(line);
        double stamp_s, x, y, z, qx, qy, qz, qw;
        if (!(numbers >> stamp_s >> x >> y >> z >> qx >> qy >> qz >> qw))
            throw std::runtime_error(file + ": is no line of a pose: " + line);
        mrpt::math::CQuaternionDouble q(qw, qx, qy, qz);
        q.normalize();
        poses.emplace_back(q, x, y, z);
    }
    if (poses.empty()) throw std::runtime_error(file + ": holds no poses");
    return poses;
}

}  // namespace

Recording::Recording(const std::string& rawlogFile, const std::string& posesFile)
    : T_map_robot_(readPoses(posesFile)) {
    if (!rawlog_.open(rawlogFile))
        throw std::runtime_error(rawlogFile + ": cannot be read");
}

std::optional<RecordedScan> Recording::next() {
    if (index_ == T_map_robot_.size()) return std::nullopt;
    auto archive = mrpt::serialization::archiveFrom(rawlog_);
    const auto object = archive.ReadObject();
    const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object);
    if (!observation) throw std::runtime_error("the rawlog holds more than observations");
    return RecordedScan{observation, T_map_robot_[index_++]};
}

}  // namespace equality
