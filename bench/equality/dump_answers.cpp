// Writes down, bit by bit, what a map of a recording consists of and what it answers, and
// compares two such dumps. scripts/equality.sh compiles it with two trees of this project.
//   dump_answers --dump LOG.rawlog POSES.tum OUT.dump [OPTION=VALUE ...]   of _insertOpts
//   dump_answers --compare NAME BASE.dump PRESENT.dump
//   dump_answers --plant IN.dump OUT.dump SECTION COLUMN ROW               moves one ulp
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "answers.h"
#include "compare.h"
#include "components.h"
#include "plugin_answers.h"
#include "questions.h"
#include "recording.h"

namespace {

using namespace equality;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;
using Arguments = std::vector<std::string>;

constexpr std::size_t kKeptScans = 12;  // that the map is asked about
constexpr std::size_t kScanMaps = 3;    // of one scan each

/// Sets options by their names in configuration files, which stay as they are.
void setOptions(CHGMMOccupancyMap& map, const Arguments& options) {
    mrpt::config::CConfigFileMemory config;
    for (const std::string& option : options) {
        const std::size_t at = option.find('=');
        if (at == std::string::npos) throw std::runtime_error(option + ": has no value");
        config.write("options", option.substr(0, at), option.substr(at + 1));
    }
    map.insertionOptions.loadFromConfigFile(config, "options");
}

/// What is kept of a recording while its scans go by.
struct Insertion {
    std::vector<RecordedScan> kept;
    std::vector<Eigen::Vector3d> sensors_map;  // where each scan was taken [m]
    std::size_t inserted = 0;                  // [scans]
};

Insertion insertAll(CHGMMOccupancyMap& map, Recording& recording) {
    Insertion insertion;
    const std::size_t step = 1 + (recording.size() - 1) / kKeptScans;
    for (std::size_t i = 0; const auto scan = recording.next(); ++i) {
        const CPose3D T_map_sensor =
            scan->T_map_robot + CPose3D(scan->observation->sensorPose());
        insertion.sensors_map.emplace_back(T_map_sensor.x(), T_map_sensor.y(),
                                           T_map_sensor.z());
        insertion.inserted += map.insertObservation(*scan->observation, scan->T_map_robot);
        if (i % step == 0) insertion.kept.push_back(*scan);
    }
    return insertion;
}

void addScanMaps(Dump& dump, const CHGMMOccupancyMap& map, const Arguments& options,
                 const std::vector<RecordedScan>& kept) {
    std::vector<hgmm::Map> others;
    for (std::size_t i = 0; i < kept.size(); i += 1 + kept.size() / kScanMaps) {
        CHGMMOccupancyMap single;
        setOptions(single, options);
        single.insertObservation(*kept[i].observation, kept[i].T_map_robot);
        others.push_back(std::as_const(single).model());
    }
    std::vector<hgmm::Scan> scans;
    for (const RecordedScan& scan : kept) scans.push_back(pointsOf(scan));
    addPairs(dump, map.model(), others);
    addInsertions(dump, map.insertionOptions.params, scans);
}

int dumpAnswers(const Arguments& a) {
    const Arguments options(a.begin() + 4, a.end());
    CHGMMOccupancyMap changing;
    setOptions(changing, options);
    Recording recording(a[1], a[2]);
    const Insertion insertion = insertAll(changing, recording);
    const CHGMMOccupancyMap& map = changing;
    const Questions questions = questionsFor(map.model(), insertion.sensors_map);

    Dump dump;
    dump.add("scans", Kind::answers, "recording", {"read", "inserted"},
             std::vector<std::uint64_t>{recording.size(), insertion.inserted});
    addComponents(dump, "", map.model());
    addAnswers(dump, "", map.model(), questions);
    addPluginAnswers(dump, map, insertion.kept, questions);
    addSaved(dump, map.model(), questions);
    addScanMaps(dump, map, options, insertion.kept);
    dump.write(a[3]);
    return 0;
}

int run(const Arguments& a) {
    if (a.size() >= 4 && a[0] == "--dump") return dumpAnswers(a);
    if (a.size() == 4 && a[0] == "--compare")
        return compare(a[1], Dump::read(a[2]), Dump::read(a[3])) ? 0 : 1;
    if (a.size() == 6 && a[0] == "--plant") {
        Dump dump = Dump::read(a[1]);
        plant(dump, a[3], a[4], std::stoul(a[5]));
        dump.write(a[2]);
        return 0;
    }
    std::fprintf(stderr, "usage: see the head of bench/equality/dump_answers.cpp\n");
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run({argv + 1, argv + argc});
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dump_answers: %s\n", e.what());
        return 2;
    }
}
