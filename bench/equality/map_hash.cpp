// Puts a recording into a map and prints a hash of the map's exact bytes; writes down what
// the map answers at given points. For scripts/same_bytes.sh.
//   map_hash LOG.rawlog POSES.tum POINTS ANSWERS   POINTS are drawn from this map if there
//                                                  is no such file
//   map_hash --compare ANSWERS ANSWERS             prints the largest difference
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "questions.h"
#include "recording.h"

namespace {

using namespace equality;
using Text = std::string;

template <typename T>
std::vector<T> read(const Text& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file + ": cannot be read");
    const Text bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<T> values(bytes.size() / sizeof(T));
    std::copy_n(bytes.data(), values.size() * sizeof(T),
                reinterpret_cast<char*>(values.data()));
    return values;
}

template <typename T>
void write(const Text& file, const std::vector<T>& values) {
    std::ofstream out(file + ".part", std::ios::binary);
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
    out.close();
    if (!out) throw std::runtime_error(file + ": cannot be written");
    std::filesystem::rename(file + ".part", file);
}

/// FNV-1a, 64 bits.
std::uint64_t hashOf(const std::vector<std::uint8_t>& bytes) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001B3U;
    return hash;
}

int hashMap(const Text& rawlog, const Text& poses, const Text& pointsFile,
            const Text& answersFile) {
    mrpt::maps::CHGMMOccupancyMap changing;
    Recording recording(rawlog, poses);
    std::vector<Eigen::Vector3d> sensors_map;
    while (const auto scan = recording.next()) {
        const auto T_map_sensor =
            scan->T_map_robot + mrpt::poses::CPose3D(scan->observation->sensorPose());
        sensors_map.emplace_back(T_map_sensor.x(), T_map_sensor.y(), T_map_sensor.z());
        changing.insertObservation(*scan->observation, scan->T_map_robot);
    }
    const hgmm::Map& map = std::as_const(changing).model();
    if (!std::filesystem::exists(pointsFile)) {
        std::vector<double> drawn;
        for (const Eigen::Vector3d& p : questionsFor(map, sensors_map).points_map)
            drawn.insert(drawn.end(), p.data(), p.data() + 3);
        write(pointsFile, drawn);
    }
    const std::vector<double> points = read<double>(pointsFile);
    std::vector<float> answers;
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
        const hgmm::Occupancy o =
            map.occupancy(Eigen::Vector3d(points[i], points[i + 1], points[i + 2]));
        answers.insert(answers.end(), {o.occupied, o.free, o.unknown});
    }
    write(answersFile, answers);
    std::printf("%016llx %zu\n",
                static_cast<unsigned long long>(hashOf(map.save(hgmm::Encoding::exact))),
                map.mixture().size());
    return 0;
}

int compare(const Text& a, const Text& b) {
    constexpr float kSame = 1e-4F;
    const std::vector<float> x = read<float>(a), y = read<float>(b);
    if (x.size() != y.size()) throw std::runtime_error("answers to different questions");
    float largest = 0.F;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const float difference = std::abs(x[i] - y[i]);
        largest = std::max(largest, difference);
        differing += difference > kSame ? 1 : 0;
    }
    std::printf("%.2g, %zu of %zu beyond %g\n", double(largest), differing, x.size(),
                double(kSame));
    return differing == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<Text> a(argv + 1, argv + argc);
    try {
        if (a.size() == 3 && a[0] == "--compare") return compare(a[1], a[2]);
        if (a.size() == 4) return hashMap(a[0], a[1], a[2], a[3]);
        std::fprintf(stderr, "usage: see the head of bench/equality/map_hash.cpp\n");
    } catch (const std::exception& e) {
        std::fprintf(stderr, "map_hash: %s\n", e.what());
    }
    return 2;
}
