#include "pose_file.h"

#include <hgmm/evaluation/parse_numbers.h>
#include <hgmm/evaluation/trajectory.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "files.h"

namespace hgmm::importer {
namespace {

using Row = std::vector<double>;

Pose fromQuaternion(const double* v) {
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (q.norm() < 1e-6) throw std::runtime_error("the quaternion is null");
    Pose pose;
    pose.t = {v[0], v[1], v[2]};
    pose.R = q.normalized().toRotationMatrix();
    return pose;
}

Pose fromRows(const double* v) {
    Pose pose;
    pose.R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
    pose.R = evaluation::nearestRotation(pose.R);
    pose.t = {v[3], v[7], v[11]};
    return pose;
}

void requireLastRow(const double* v) {
    if (v[0] != 0 || v[1] != 0 || v[2] != 0 || v[3] != 1)
        throw std::runtime_error(
            "its last four numbers are not 0 0 0 1, as the last row of a 4x4 pose is");
}

/// Adds the pose of a line's numbers; all lines of a file have the same count of them.
void addLine(const Row& v, PoseFile& file) {
    RecordedPose pose;
    const auto line = static_cast<double>(file.poses.size());
    pose.key = v[0];
    switch (v.size()) {
        case 4:
            file.format = "lines `t x y z` (rotations are taken as the identity)";
            file.key = PoseKey::stamp;
            pose.T_world_frame.t = {v[1], v[2], v[3]};
            break;
        case 7: {
            file.format = "lines `x y z qx qy qz qw`";
            const double norm = Eigen::Vector4d(v[3], v[4], v[5], v[6]).norm();
            if (std::abs(norm - 1) > 1e-2)
                throw std::runtime_error(
                    "7 numbers are read as x y z qx qy qz qw, and these are no unit "
                    "quaternion; convert the file to TUM lines");
            pose.key = line;
            pose.T_world_frame = fromQuaternion(&v[0]);
            break;
        }
        case 8:
            file.format = "TUM lines";
            file.key = PoseKey::stamp;
            pose.T_world_frame = fromQuaternion(&v[1]);
            break;
        case 9:
        case 10: {
            file.format = "lines `seconds nanoseconds x y z qx qy qz qw`";
            file.key = PoseKey::stamp;
            const std::size_t at = v.size() - 9;
            pose.key = v[at] + 1e-9 * v[at + 1];
            pose.T_world_frame = fromQuaternion(&v[at + 2]);
            break;
        }
        case 12:
        case 16:
            file.format = "KITTI lines";
            if (v.size() == 16) requireLastRow(&v[12]);
            pose.key = line;
            pose.T_world_frame = fromRows(&v[0]);
            break;
        case 13:
        case 17:
            file.format = "numbered KITTI lines";
            file.key = PoseKey::number;
            if (v.size() == 17) requireLastRow(&v[13]);
            pose.T_world_frame = fromRows(&v[1]);
            break;
        default:
            throw std::runtime_error(
                "expected 8 numbers (TUM: t x y z qx qy qz qw) or 12 (KITTI), or one of "
                "the "
                "other kinds of docs/hgmm-import.md; got " +
                std::to_string(v.size()));
    }
    file.poses.push_back(pose);
}

/// The id of a vertex. GTSAM's symbols hold a letter in the highest byte.
double vertexNumber(const std::string& word, char& letter) {
    std::size_t used = 0;
    std::uint64_t id = 0;
    try {
        id = std::stoull(word, &used);
    } catch (const std::logic_error&) {
        used = 0;
    }
    if (used == 0 || used != word.size())
        throw std::runtime_error("'" + word + "' is no number of a vertex");
    constexpr unsigned letterShift = 56;
    const char found = static_cast<char>(id >> letterShift);
    if (letter != '\0' && found != letter)
        throw std::runtime_error(
            "vertices have symbols of different letters; keep those of one robot");
    letter = found;
    if (found == '\0') return static_cast<double>(id);
    return static_cast<double>(id & ((std::uint64_t{1} << letterShift) - 1));
}

/// Adds a line of a g2o file if it is a vertex with a pose. MRPT's graphs and TORO's call
/// planar ones VERTEX2.
void addVertex(const std::string& text, char& letter, PoseFile& file) {
    std::istringstream words(text);
    std::string tag, id, rest;
    words >> tag >> id;
    const bool planar = tag == "VERTEX_SE2" || tag == "VERTEX2";
    if (!planar && tag != "VERTEX_SE3:QUAT") return;
    std::getline(words, rest);
    const auto v = evaluation::parseNumbers(rest);
    const std::size_t expected = planar ? 3 : 7;
    if (v.size() != expected)
        throw std::runtime_error(tag + " needs " + std::to_string(expected) +
                                 " numbers after its id, got " + std::to_string(v.size()));
    RecordedPose pose;
    pose.key = vertexNumber(id, letter);
    if (planar) {
        pose.T_world_frame.t = {v[0], v[1], 0};
        pose.T_world_frame.R =
            Eigen::AngleAxisd(v[2], Eigen::Vector3d::UnitZ()).toRotationMatrix();
    } else {
        pose.T_world_frame = fromQuaternion(&v[0]);
    }
    file.poses.push_back(pose);
}

/// Throws std::runtime_error if a comment names a quaternion's numbers in another order
/// than the files that are read have it.
void requireOrderOfQuaternion(std::string comment) {
    comment.erase(std::remove(comment.begin(), comment.end(), '_'), comment.end());
    std::transform(comment.begin(), comment.end(), comment.begin(), [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    const auto w = comment.find("qw"), x = comment.find("qx");
    if (w != std::string::npos && x != std::string::npos && w < x)
        throw std::runtime_error(
            "says that qw comes before qx; write the file with qx qy qz qw");
}

bool startsG2o(const std::string& text) {
    for (const char* tag : {"VERTEX", "EDGE", "FIX", "PARAMS_"})
        if (text.rfind(tag, 0) == 0) return true;
    return false;
}

/// The seconds of one unit of stamps: 1, or, if they are whole and too far apart for that,
/// the unit in which they are most nearly a tenth of a second apart.
double secondsPerUnit(const PoseFile& file) {
    if (!file.wholeKeys || file.key != PoseKey::stamp) return 1;
    std::vector<double> gaps;
    for (std::size_t i = 1; i < file.poses.size(); ++i)
        gaps.push_back(std::abs(file.poses[i].key - file.poses[i - 1].key));
    constexpr double epochOfSeconds = 1e11;
    const double largest = std::abs(file.poses.back().key);
    if (gaps.empty()) {
        double unit = 1;
        while (largest * unit > epochOfSeconds && unit > 1e-9) unit *= 1e-3;
        return unit;
    }
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<long>(gaps.size() / 2),
                     gaps.end());
    const double gap = gaps[gaps.size() / 2];
    constexpr double mostSeconds = 1000;
    if (gap < mostSeconds && largest < epochOfSeconds) return 1;
    double best = 1e-3;
    for (const double unit : {1e-6, 1e-9})
        if (std::abs(std::log10(gap * unit) + 1) < std::abs(std::log10(gap * best) + 1))
            best = unit;
    return best;
}

void setStamps(PoseFile& file) {
    auto& poses = file.poses;
    file.wholeKeys = std::all_of(poses.begin(), poses.end(), [](const auto& pose) {
        return pose.key == std::floor(pose.key);
    });
    file.sorted =
        std::is_sorted(poses.begin(), poses.end(),
                       [](const auto& a, const auto& b) { return a.key < b.key; });
    constexpr double mostScans = 1e9;
    if (file.key == PoseKey::number &&
        (!file.wholeKeys || std::abs(poses.back().key) >= mostScans))
        file.key = PoseKey::stamp;
    const double unit = secondsPerUnit(file);
    if (unit != 1)
        file.notes.push_back(file.path + ": its stamps are read as " +
                             (unit == 1e-3   ? "milliseconds"
                              : unit == 1e-6 ? "microseconds"
                                             : "nanoseconds"));
    if (unit != 1) file.wholeKeys = false;
    for (auto& pose : poses) {
        if (file.key == PoseKey::stamp) pose.key *= unit;
        pose.stamp = file.key == PoseKey::stamp ? pose.key
                                                : pose.key * evaluation::kDefaultPosePeriod;
    }
}

}  // namespace

PoseFile readPoseFile(const std::string& path) {
    PoseFile file;
    file.path = path;
    std::istringstream in(readBytes(path));
    std::size_t number = 0, columns = 0;
    bool g2o = false;
    char letter = '\0';
    for (std::string text; std::getline(in, text);) {
        ++number;
        std::replace(text.begin(), text.end(), ',', ' ');
        const auto first = text.find_first_not_of(" \t\r\v\f");  // what parseNumbers skips
        if (first == std::string::npos) continue;
        text.erase(0, first);
        try {
            if (text[0] == '#') {
                requireOrderOfQuaternion(text);
                continue;
            }
            if (columns == 0) g2o = g2o || startsG2o(text);
            if (g2o) {
                addVertex(text, letter, file);
                continue;
            }
            const auto numbers = evaluation::parseNumbers(text);
            if (columns != 0 && numbers.size() != columns)
                throw std::runtime_error("expected " + std::to_string(columns) +
                                         " numbers as in the lines before, got " +
                                         std::to_string(numbers.size()));
            columns = numbers.size();
            addLine(numbers, file);
        } catch (const std::runtime_error& e) {
            throw std::runtime_error(path + ":" + std::to_string(number) + ": " + e.what());
        }
    }
    if (g2o) {
        file.format = "g2o vertices";
        file.key = PoseKey::number;
    }
    if (file.poses.empty()) failFile(path, "holds no poses");
    setStamps(file);
    return file;
}

void stampLines(const std::vector<double>& times_s, PoseFile& file) {
    for (std::size_t i = 0; i < file.poses.size() && i < times_s.size(); ++i)
        file.poses[i].stamp = times_s[i];
}

}  // namespace hgmm::importer
