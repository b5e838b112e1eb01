#include "answers.h"

#include "components.h"

#include <Eigen/Geometry>
#include <optional>

#include "hgmm/registration.h"

namespace equality {
namespace {

const std::vector<std::string> kXyz = {"x", "y", "z"};

void append(std::vector<double>& values, const Eigen::Vector3d& v) {
    values.insert(values.end(), {v.x(), v.y(), v.z()});
}

void addOccupancies(Dump& dump, const std::string& name,
                    const std::vector<hgmm::Occupancy>& answers) {
    std::vector<float> values;
    for (const hgmm::Occupancy& o : answers)
        values.insert(values.end(),
                      {o.occupied, o.free, o.unknown, o.alongRay_m, o.variance_m2});
    dump.add(name, Kind::answers, "point",
             {"occupied", "free", "unknown", "distance", "variance"}, values);
}

void addOccupancy(Dump& dump, const std::string& of, const hgmm::Map& map,
                  const Questions& questions) {
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        const auto points_map = questions.everyPoint(level == 0 ? 1 : 4);
        std::vector<hgmm::Occupancy> answers(points_map.size());
        map.occupancy(points_map.data(), points_map.size(), answers.data(), level);
        addOccupancies(dump, of + "occupancy, level " + std::to_string(level), answers);
    }
    std::vector<hgmm::Occupancy> single;
    for (const auto& point_map : questions.everyPoint(10))
        single.push_back(map.occupancy(point_map));
    addOccupancies(dump, of + "occupancy of every 10th point by itself", single);
}

void addGradients(Dump& dump, const std::string& of, const hgmm::Map& map,
                  const Questions& questions) {
    const std::size_t top = map.levelCount() - 1;
    for (const std::size_t level : {std::size_t{0}, top}) {
        std::vector<double> values;
        for (const auto& point_map : questions.everyPoint(10))
            append(values, map.occupancyGradient(point_map, level));
        dump.add(of + "occupancy gradient, level " + std::to_string(level), Kind::answers,
                 "point", kXyz, values);
        if (top == 0) break;
    }
}

void addDensities(Dump& dump, const std::string& of, const hgmm::Map& map,
                  const Questions& questions) {
    std::vector<double> values;
    for (const auto& point_map : questions.points_map)
        values.push_back(map.logDensity(point_map));
    dump.add(of + "log density", Kind::answers, "point", {"log density"}, values);
}

void addHits(Dump& dump, const std::string& name, const hgmm::Map& map,
             const Questions& questions, bool stopAtUnknown, std::size_t level) {
    hgmm::RayCastParams params;
    params.stopAtUnknown = stopAtUnknown;
    std::vector<double> values;
    for (const Ray& ray : questions.rays_map) {
        const auto hit = map.castRay(ray.origin_map, ray.direction_map, params, level);
        values.insert(values.end(), {hit ? 1.0 : 0.0, hit ? hit->range_m : 0.0});
        append(values, hit ? hit->point_map : Eigen::Vector3d::Zero());
    }
    dump.add(name, Kind::answers, "ray", {"hit", "range", "x", "y", "z"}, values);
}

/// Infers each modality from the others' values at points, with and without the place.
void addInference(Dump& dump, const std::string& of, const hgmm::Map& map,
                  const Questions& questions) {
    std::vector<double> values;
    for (const auto& point_map : questions.everyPoint(200)) {
        for (const std::string& target : map.modalities()) {
            std::vector<hgmm::ModalityValue> priors;
            for (const std::string& name : map.modalities())
                if (name != target)
                    priors.push_back({name, map.modality(name, point_map).mean});
            for (const bool placed : {false, true}) {
                const auto place = placed ? std::optional(point_map) : std::nullopt;
                const hgmm::CrossModalEstimate e = map.infer(target, priors, place);
                values.insert(values.end(), {e.mean, e.variance, e.known ? 1.0 : 0.0});
                append(values, e.place_map);
                values.push_back(e.likelihood);
            }
        }
    }
    dump.add(of + "inferred modalities", Kind::answers, "inference",
             {"mean", "variance", "known", "x", "y", "z", "likelihood"}, values);
}

void addModalities(Dump& dump, const std::string& of, const hgmm::Map& map,
                   const Questions& questions) {
    for (const std::string& name : map.modalities()) {
        const auto& points_map = questions.points_map;
        std::vector<hgmm::ModalityEstimate> answers(points_map.size());
        map.modality(name, points_map.data(), points_map.size(), answers.data());
        std::vector<double> values;
        for (const hgmm::ModalityEstimate& e : answers)
            values.insert(values.end(), {e.mean, e.variance, e.known ? 1.0 : 0.0});
        dump.add(of + "modality " + name, Kind::answers, "point",
                 {"mean", "variance", "known"}, values);
        std::vector<double> densities;
        if (const auto* model = map.modality(name))
            for (const auto& point_map : questions.everyPoint(10))
                densities.push_back(model->density(0.5, point_map - map.origin()));
        dump.add(of + "density of 0.5 in " + name, Kind::answers, "point", {"density"},
                 densities);
    }
    if (map.modalities().size() > 1) addInference(dump, of, map, questions);
}

const std::vector<std::string>& registrationColumns() {
    static const std::vector<std::string> columns = [] {
        std::vector<std::string> names = {"converged", "iterations", "overlap", "cost"};
        for (const char* part : {"rotation ", "translation ", "covariance "}) {
            const int n = part[0] == 'r' ? 9 : part[0] == 't' ? 3 : 36;
            for (int i = 0; i < n; ++i) names.push_back(part + std::to_string(i));
        }
        return names;
    }();
    return columns;
}

void append(std::vector<double>& values, const hgmm::Registration& r) {
    values.insert(values.end(), {r.converged ? 1.0 : 0.0, double(r.iterations)});
    values.insert(values.end(), {r.overlap, r.cost});
    const hgmm::Pose& T = r.T_target_source;
    values.insert(values.end(), T.R.data(), T.R.data() + 9);
    append(values, T.t);
    values.insert(values.end(), r.covariance.data(), r.covariance.data() + 36);
}

/// Moves what begins at a place by up to 0.2 m and about 3 deg an axis.
hgmm::Pose offBy(const Eigen::Vector3d& place, Generator& generator) {
    const Eigen::Vector3d turn_rad = generator.inCube(0.05);
    const Eigen::AngleAxisd turn(turn_rad.norm(), turn_rad.normalized());
    return {turn.toRotationMatrix(), place + generator.inCube(0.2)};
}

}  // namespace

void addAnswers(Dump& dump, const std::string& of, const hgmm::Map& map,
                const Questions& questions) {
    addOccupancy(dump, of, map, questions);
    addGradients(dump, of, map, questions);
    // Of a copy: in d48da0d the last bits of these sums depended on the order in which the
    // map had changed, unlike those of a map that was copied or loaded.
    const hgmm::Map copy = map;
    addDensities(dump, of, copy, questions);
    addHits(dump, of + "rays, level 0", map, questions, false, 0);
    addHits(dump, of + "rays to unknown space, level 0", map, questions, true, 0);
    addHits(dump, of + "rays, top level", map, questions, false, map.levelCount() - 1);
    addModalities(dump, of, copy, questions);
}

void addSaved(Dump& dump, const hgmm::Map& map, const Questions& questions) {
    const Questions some = questions.every(4);
    for (const bool exact : {true, false}) {
        const std::string encoding = exact ? "saved exact" : "saved compact";
        const std::vector<std::uint8_t> bytes =
            map.save(exact ? hgmm::Encoding::exact : hgmm::Encoding::compact);
        // Not the bytes: they hold the options, whose names may change.
        const hgmm::Map loaded = hgmm::Map::load(bytes.data(), bytes.size());
        addComponents(dump, encoding + " and loaded: ", loaded);
        addAnswers(dump, encoding + " and loaded: ", loaded, some);
    }
}

void addPairs(Dump& dump, const hgmm::Map& map, const std::vector<hgmm::Map>& others) {
    Generator generator(2);
    std::vector<const hgmm::Mixture<3>*> levels;
    for (std::size_t level = map.levelCount(); level-- > 0;)
        levels.push_back(&map.mixture(level));
    std::vector<double> found;
    hgmm::Map merged = map;
    for (const hgmm::Map& other : others) {
        const Eigen::Vector3d between = other.origin() - map.origin();
        const hgmm::Pose T_map_other = offBy(between, generator);
        append(found, hgmm::registerMixtures(levels, other.mixture(), T_map_other));
        merged.merge(other, offBy(Eigen::Vector3d::Zero(), generator));
    }
    dump.add("registrations", Kind::answers, "scan", registrationColumns(), found);
    addComponents(dump, "merged with scans' maps: ", merged);
}

void addInsertions(Dump& dump, const hgmm::MapParams& params,
                   const std::vector<hgmm::Scan>& scans) {
    hgmm::Map map(params);
    std::vector<std::uint64_t> values;
    for (const hgmm::Scan& scan : scans) {
        // By place, for their names are not the same in both trees.
        const auto [points, samples, novel, updated, added, seenThrough, outgrown,
                    removed] = map.insert(scan);
        values.insert(values.end(), {points.used, points.notFinite, samples, novel, updated,
                                     added, seenThrough, outgrown, removed});
    }
    dump.add("reports of insertion", Kind::answers, "scan",
             {"used", "not finite", "samples", "novel", "updated", "added", "seen through",
              "outgrown", "removed"},
             values);
    addComponents(dump, "map of inserted scans: ", map);
}

}  // namespace equality
