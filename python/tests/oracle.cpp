#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/map.h"

/// Answers of the core in C++, for the tests of the Python package to compare with. Files
/// hold numbers as they are in memory; maps are buffers of Map::save.
///   python-oracle insert POINTS(f64) MAP        a map of one scan at the origin, exact
///   python-oracle occupancy MAP POINTS ANSWERS(f32)
///   python-oracle distance MAP POINTS ANSWERS(f64: distance, gradient, std, known) MAX
///   LEVEL python-oracle modality MAP POINTS ANSWERS(f64: mean, variance, known) NAME
///   python-oracle time MAP POINTS               seconds of the best of 20 batches of
///   queries
namespace {

using hgmm::Map;
using Bytes = std::vector<std::uint8_t>;

Bytes read(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file + ": cannot be read");
    return Bytes(std::istreambuf_iterator<char>(in), {});
}

template <typename Number>
void write(const std::string& file, const std::vector<Number>& numbers) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(numbers.data()),
              static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
    if (!out) throw std::runtime_error(file + ": cannot be written");
}

std::vector<Eigen::Vector3d> readPoints(const std::string& file) {
    const Bytes bytes = read(file);
    std::vector<Eigen::Vector3d> points(bytes.size() / (3 * sizeof(double)));
    for (std::size_t i = 0; i < points.size(); ++i)
        std::memcpy(points[i].data(), bytes.data() + 3 * sizeof(double) * i,
                    3 * sizeof(double));
    return points;
}

Map readMap(const std::string& file) {
    const Bytes bytes = read(file);
    return Map::load(bytes.data(), bytes.size());
}

void insert(const std::string& pointsFile, const std::string& mapFile) {
    hgmm::Scan scan;
    for (const Eigen::Vector3d& p : readPoints(pointsFile))
        scan.pushBack(float(p.x()), float(p.y()), float(p.z()));
    Map map;
    map.insert(scan);
    write(mapFile, map.save(hgmm::Encoding::exact));
}

void occupancy(const Map& map, const std::vector<Eigen::Vector3d>& points,
               const std::string& file) {
    std::vector<float> numbers;
    for (const Eigen::Vector3d& p : points) {
        const hgmm::Occupancy o = map.occupancy(p);
        numbers.insert(numbers.end(),
                       {o.occupied, o.free, o.unknown, o.alongRay_m, o.variance_m2});
    }
    write(file, numbers);
}

void distance(const Map& map, const std::vector<Eigen::Vector3d>& points,
              const std::string& file, double maxDistance_m, std::size_t level) {
    std::vector<double> numbers;
    for (const Eigen::Vector3d& p : points) {
        const hgmm::SurfaceDistance d = map.distance(p, {maxDistance_m}, level);
        numbers.insert(numbers.end(), {d.distance_m, d.gradient.x(), d.gradient.y(),
                                       d.gradient.z(), d.std_m, d.known ? 1.0 : 0.0});
    }
    write(file, numbers);
}

void modality(const Map& map, const std::vector<Eigen::Vector3d>& points,
              const std::string& file, const std::string& name) {
    std::vector<double> numbers;
    for (const Eigen::Vector3d& p : points) {
        const hgmm::ModalityEstimate e = map.modality(name, p);
        numbers.insert(numbers.end(), {e.mean, e.variance, e.known ? 1.0 : 0.0});
    }
    write(file, numbers);
}

void time(const Map& map, const std::vector<Eigen::Vector3d>& points) {
    std::clock_t best = std::numeric_limits<std::clock_t>::max();
    for (int i = 0; i < 20; ++i) {
        const std::clock_t start = std::clock();
        std::vector<hgmm::Occupancy> answers(points.size());
        map.occupancy(points.data(), points.size(), answers.data());
        best = std::min(best, std::clock() - start);
    }
    std::printf("%.9f\n", double(best) / CLOCKS_PER_SEC);
}

void run(const std::vector<std::string>& words) {
    const std::string& command = words.at(0);
    if (command == "insert") return insert(words.at(1), words.at(2));
    const Map map = readMap(words.at(1));
    const std::vector<Eigen::Vector3d> points = readPoints(words.at(2));
    if (command == "occupancy") return occupancy(map, points, words.at(3));
    if (command == "distance")
        return distance(map, points, words.at(3), std::stod(words.at(4)),
                        std::stoul(words.at(5)));
    if (command == "modality") return modality(map, points, words.at(3), words.at(4));
    if (command == "time") return time(map, points);
    throw std::runtime_error("no command " + command);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run({argv + 1, argv + argc});
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "python-oracle: %s\n", e.what());
        return 1;
    }
}
