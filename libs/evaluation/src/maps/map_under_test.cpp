#include "hgmm/evaluation/map_under_test.h"

#include <chrono>

#include "hgmm/evaluation/unseen_points.h"

namespace hgmm::evaluation {
namespace {

class Ours : public MapUnderTest {
 public:
    explicit Ours(const MapParams& params) : map_(params) {}

    const std::string& name() const override { return name_; }
    std::vector<Occupancy> occupancy(const Points& points_map) const override {
        std::vector<Occupancy> answers(points_map.size());
        map_.occupancy(points_map.data(), points_map.size(), answers.data());
        return answers;
    }
    ComponentCount components() const override {
        return {map_.mixture().size(), map_.freeMixture().size()};
    }
    std::size_t savedBytes() const override { return map_.save().size(); }

 private:
    void insertScan(const Scan& scan) override { map_.insert(scan); }

    std::string name_ = "hgmm";
    Map map_;
};

class Other : public MapUnderTest {
 public:
    Other(const std::string& specification, SensorKind sensor)
        : name_(specification), map_(makeBaseline(specification, sensor)) {}

    const std::string& name() const override { return name_; }
    std::vector<Occupancy> occupancy(const Points& points_map) const override {
        std::vector<Answer> answers(points_map.size());
        map_->query(points_map.data(), points_map.size(), answers.data());
        std::vector<Occupancy> occupancies;
        occupancies.reserve(answers.size());
        for (const Answer& answer : answers)
            occupancies.push_back(occupancyOfAnswer(answer));
        return occupancies;
    }

 private:
    void insertScan(const Scan& scan) override { map_->insert(scan); }

    std::string name_;
    std::unique_ptr<Baseline> map_;
};

}  // namespace

void MapUnderTest::insert(const Scan& scan) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    insertScan(scan);
    insert_ms_.push_back(
        std::chrono::duration<double, std::milli>(Clock::now() - start).count());
}

std::unique_ptr<MapUnderTest> oursUnderTest(const MapParams& params) {
    return std::make_unique<Ours>(params);
}

std::unique_ptr<MapUnderTest> baselineUnderTest(const std::string& specification,
                                                SensorKind sensor) {
    return std::make_unique<Other>(specification, sensor);
}

}  // namespace hgmm::evaluation
