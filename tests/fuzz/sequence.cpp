// The whole interface of Map, in any order.
#include <algorithm>

#include "harness.h"
#include "oracle.h"
#include "random_input.h"

namespace hgmm::fuzz {

namespace {

/// Calls that may refuse their input must leave the map as it was.
template <typename Call>
void refusesOrDoes(Map& map, Call&& call) {
    const Map before(map);
    try {
        call();
    } catch (const std::invalid_argument&) {
        require(map == before, "what refuses its input leaves the map as it was");
    }
}

void insertScan(Map& map, Bytes& bytes, bool asSamples) {
    Scan scan = scanFrom(bytes);
    scan.T_map_sensor = poseFrom(bytes);
    refusesOrDoes(map, [&] {
        const InsertReport report =
            asSamples ? map.insert(samplesOf(scan, map.params()), scan.T_map_sensor)
                      : map.insert(scan);
        const FilterCounts& points = report.points;
        require(points.used + points.notFinite + points.tooNear + points.cut == scan.size(),
                "the filter accounts for every point");
    });
}

void forgetBox(Map& map, Bytes& bytes) {
    const Eigen::Vector3d a = map.origin() + 5 * poseFrom(bytes).R.col(0),
                          b = map.origin() + 5 * poseFrom(bytes).R.col(1);
    const Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
    const std::size_t before = map.mixture().size();
    const std::size_t forgotten = map.forget(box);
    require(map.mixture().size() + forgotten == before, "forget counts what it removes");
}

void reload(Map& map, Encoding encoding) {
    const std::vector<std::uint8_t> saved = map.save(encoding);
    map = Map::load(saved.data(), saved.size());
}

void doOne(Map& map, Map& other, Bytes& bytes) {
    switch (bytes.below(16)) {
        default:
            insertScan(map, bytes, false);
            break;
        case 6:
            insertScan(map, bytes, true);
            break;
        case 7: {
            const Pose pose = poseFrom(bytes);
            refusesOrDoes(map, [&] { map.merge(other, pose); });
            break;
        }
        case 8: {
            const unsigned times = 1 + bytes.below(8) * bytes.below(16);
            for (unsigned k = 0; k < times; ++k) map.merge(map);
            break;
        }
        case 9:
            forgetBox(map, bytes);
            break;
        case 10:
            map.clear();
            break;
        case 11:
            map.setParams(paramsFrom(bytes));
            break;
        case 12:
            reload(map, Encoding::exact);
            break;
        case 13:
            reload(map, Encoding::compact);
            break;
        case 14:
            std::swap(map, other);
            break;
        case 15:
            requireSoundAnswers(map, bytes.raw<std::uint16_t>());
            break;
    }
}

}  // namespace

void runOne(const std::uint8_t* data, std::size_t size) {
    constexpr int kMostCalls = 12;
    Bytes bytes(data, size);
    Map map(paramsFrom(bytes)), other(map.params());
    const auto seed = bytes.raw<std::uint16_t>();
    for (int call = 0; call < kMostCalls && !bytes.empty(); ++call)
        doOne(map, other, bytes);
    requireSoundAnswers(map, seed);
    requireStableSaving(map);
}

}  // namespace hgmm::fuzz
