// A long life: a robot wanders through a building of rooms, and the map must not grow for
// ever. Prints memory, saved size, time a scan and components for each tenth.
//   bench-soak 2d|rings [--scans N] [--state FILE]
// With a state file it goes on where it was stopped, and ends at once where it was done.
// Exit code 1 if the memory of the last tenth is more than 1.02 times that of the fifth.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "hgmm/evaluation/scene.h"
#include "hgmm/evaluation/simulated_sensor.h"
#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/output_file.h"

namespace {

using namespace hgmm;
using namespace hgmm::evaluation;

constexpr int kColumns = 5, kRows = 4, kTenths = 10;
constexpr double kRoom_m = 6.0, kHeight_m = 2.8, kDoor_m = 1.2, kWall_m = 0.1;
constexpr int kScansPerRoom = 60;  ///< from the middle of one to that of the next
constexpr double kMostGrowth = 1.02;

/// A wall of a room's length from (x, y) on, with a door in its middle unless it is an
/// outer one.
void addWall(Scene& scene, double x, double y, bool isAlongX, bool isOuter) {
    const auto piece = [&](double from, double to) {
        const double half = kWall_m / 2;
        Eigen::Vector3d low(x - half, y - half, 0.0), high(x + half, y + half, kHeight_m);
        low[isAlongX ? 0 : 1] = (isAlongX ? x : y) + from;
        high[isAlongX ? 0 : 1] = (isAlongX ? x : y) + to;
        scene.add(Box{low, high}, Part::wall);
    };
    if (isOuter) return piece(0.0, kRoom_m);
    piece(0.0, (kRoom_m - kDoor_m) / 2);
    piece((kRoom_m + kDoor_m) / 2, kRoom_m);
}

/// Rooms in a grid, doors between neighbours, a shelf and a pillar in each.
Scene building() {
    Scene scene;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) {
            const double x = column * kRoom_m, y = row * kRoom_m;
            if (column < kColumns) addWall(scene, x, y, true, row == 0 || row == kRows);
            if (row < kRows) addWall(scene, x, y, false, column == 0 || column == kColumns);
            if (column == kColumns || row == kRows) continue;
            const double shelf_m = 0.8 + 0.3 * ((3 * row + column) % 4);
            scene.add(Box{{x + 0.2, y + 0.2, 0.0}, {x + 0.2 + shelf_m, y + 0.6, 1.8}},
                      Part::solid);
            scene.add(Pillar{{x + 4.6, y + 4.8}, 0.2, 0.0, kHeight_m}, Part::pole);
        }
    const double length = kColumns * kRoom_m, width = kRows * kRoom_m;
    scene.add(Box{{0.0, 0.0, -kWall_m}, {length, width, 0.0}}, Part::floor);
    scene.add(Box{{0.0, 0.0, kHeight_m}, {length, width, kHeight_m + kWall_m}},
              Part::ceiling);
    return scene;
}

/// The rooms that the robot comes through: each time to any neighbour.
std::vector<Eigen::Vector2d> middlesOfRooms(std::size_t scans) {
    std::mt19937 random(1);
    int column = 0, row = 0;
    std::vector<Eigen::Vector2d> middles;
    while (middles.size() < scans / kScansPerRoom + 2) {
        middles.emplace_back((column + 0.5) * kRoom_m, (row + 0.5) * kRoom_m);
        for (bool moved = false; !moved;) {
            const unsigned way = random() % 4;
            const int c = column + (way == 0) - (way == 1),
                      r = row + (way == 2) - (way == 3);
            moved = c >= 0 && c < kColumns && r >= 0 && r < kRows;
            if (moved) column = c, row = r;
        }
    }
    return middles;
}

Pose poseAt(const std::vector<Eigen::Vector2d>& middles, std::size_t scan) {
    const std::size_t leg = scan / kScansPerRoom;
    const double share = double(scan % kScansPerRoom) / kScansPerRoom;
    const Eigen::Vector2d way = middles[leg + 1] - middles[leg],
                          p = middles[leg] + share * way;
    Pose pose;
    pose.t = {p.x(), p.y(), 0.6};
    pose.R = Eigen::AngleAxisd(std::atan2(way.y(), way.x()) + 0.3 * std::sin(0.05 * scan),
                               Eigen::Vector3d::UnitZ())
                 .toRotationMatrix();
    return pose;
}

/// What is saved to go on later: the run, the scans done, the figures of the tenths done,
/// and behind them the map.
struct State {
    std::size_t rings = 0, scans = 0, done = 0;
    double heap_MB[kTenths] = {}, program_MB[kTenths] = {}, saved_KB[kTenths] = {},
           time_ms[kTenths] = {};
    std::size_t surfaces[kTenths] = {}, free[kTenths] = {};  ///< components
};

std::string asText(const State& state, const Map& map) {
    const std::vector<std::uint8_t> saved = map.save(Encoding::exact);
    std::string text(reinterpret_cast<const char*>(&state), sizeof(state));
    return text.append(reinterpret_cast<const char*>(saved.data()), saved.size());
}

void load(const std::string& file, State& state, Map& map) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t rings = state.rings, scans = state.scans;
    if (text.size() < sizeof(state)) throw std::runtime_error(file + ": is no state");
    std::memcpy(&state, text.data(), sizeof(state));
    if (state.rings != rings || state.scans != scans || state.done > scans)
        throw std::runtime_error(file + ": is of a run of another kind or length");
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    map = Map::load(bytes + sizeof(state), text.size() - sizeof(state));
}

void print(const State& state, int tenth) {
    std::printf("%5d %10zu %10.2f %10.2f %10.1f %10.2f %10zu %10zu\n", tenth + 1,
                (tenth + 1) * state.scans / kTenths, state.heap_MB[tenth],
                state.program_MB[tenth], state.saved_KB[tenth], state.time_ms[tenth],
                state.surfaces[tenth], state.free[tenth]);
    std::fflush(stdout);
}

/// Inserts the scans of the next tenth.
void wander(const Scene& scene, const SimulatedSensor& sensor, State& state, Map& map) {
    const auto tenth = state.done * kTenths / state.scans;
    const std::size_t end = (tenth + 1) * state.scans / kTenths, begin = state.done;
    const std::vector<Eigen::Vector2d> middles = middlesOfRooms(state.scans);
    double time_ms = 0.0;
    for (; state.done < end; ++state.done) {
        const Pose pose = poseAt(middles, state.done);
        const Scan scan =
            scanOf(simulateReturns(scene, sensor, pose, {0.01}, 1, state.done), sensor,
                   pose, WithoutReturn::leftOut);
        const auto start = std::chrono::steady_clock::now();
        map.insert(scan);
        time_ms += std::chrono::duration<double, std::milli>(
                       std::chrono::steady_clock::now() - start)
                       .count();
    }
    state.time_ms[tenth] = time_ms / double(end - begin);
    state.heap_MB[tenth] = double(map.liveBytes()) / 1e6;
    state.program_MB[tenth] = double(mallinfo2().uordblks) / 1e6;
    state.saved_KB[tenth] = double(map.save().size()) / 1e3;
    state.surfaces[tenth] = map.mixture().size();
    state.free[tenth] = map.freeMixture().size();
}

int soak(const std::string& kind, std::size_t scans, const std::string& file) {
    const SimulatedSensor sensor =
        kind == "2d" ? planarLaser(361, 270.0) : ringLidar(16, -15.0, 15.0, 900);
    State state;
    state.rings = kind == "2d" ? 1 : 16;
    state.scans = scans > 0 ? scans : kind == "2d" ? 100000 : 20000;
    Map map;
    if (!file.empty() && std::filesystem::exists(file)) load(file, state, map);
    std::printf(
        "tenth      scans    heap MB program MB   saved KB    ms/scan   surfaces       "
        "free\n");
    for (std::size_t t = 0; t < state.done * kTenths / state.scans; ++t)
        print(state, static_cast<int>(t));
    const Scene scene = building();
    while (state.done < state.scans) {
        const auto tenth = static_cast<int>(state.done * kTenths / state.scans);
        wander(scene, sensor, state, map);
        print(state, tenth);
        if (!file.empty()) mrpt_bridge::writeFile(file, asText(state, map));
    }
    const double growth = state.heap_MB[kTenths - 1] / state.heap_MB[kTenths / 2 - 1];
    std::printf("heap, last tenth over fifth: %.3f\n", growth);
    return growth <= kMostGrowth ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Wanders through a simulated building, and watches the map's memory."};
    std::string kind, file;
    std::size_t scans = 0;
    app.add_option("SENSOR", kind, "2d (100000 scans) or rings (20000)")
        ->required()
        ->check(CLI::IsMember({"2d", "rings"}));
    app.add_option("--scans", scans, "How many, in tens")->check(CLI::Range(10, 10000000));
    app.add_option("--state", file, "File to go on from later");
    CLI11_PARSE(app, argc, argv);
    if (scans % kTenths != 0) {
        std::fprintf(stderr, "bench-soak: --scans must be a multiple of %d\n",
                     int(kTenths));
        return 1;
    }
    try {
        return soak(kind, scans, file);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-soak: %s\n", e.what());
        return 1;
    }
}
