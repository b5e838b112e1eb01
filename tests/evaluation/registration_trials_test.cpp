#include "hgmm/evaluation/registration_trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "box_room.h"
#include "scratch_folder.h"

namespace hgmm::evaluation {
namespace {

/// Answers with the guess moved by so much, and takes down what it was given.
class Fake : public Aligner {
 public:
    explicit Fake(double shift_m) : shift_m_(shift_m) {}

    std::string name() const override { return "fake"; }
    void setTarget(const Scan& target) override { targets.push_back(target.T_map_sensor); }
    void setSource(const Scan& source) override {
        sources.push_back(source.T_map_sensor);
        truth_ = source.T_map_sensor;
    }
    Pose align(const Pose& guess) const override {
        guesses.push_back(guess);
        return {truth_.R, truth_.t + Eigen::Vector3d(shift_m_, 0, 0)};
    }

    std::vector<Pose> targets, sources;
    mutable std::vector<Pose> guesses;

 private:
    double shift_m_;
    Pose truth_;
};

class RegistrationTrialsTest : public ScratchFolder {
 protected:
    Recording record(std::size_t scans) const {
        box_room::writeRawlog(path("room.rawlog"), box_room::observations(scans, 2000));
        box_room::writePoses(path("room.tum"), scans);
        RecordingOptions options;
        options.posesFile = path("room.tum");
        return Recording(path("room.rawlog"), options);
    }
};

TEST_F(RegistrationTrialsTest, PairsAndGuessesAreAsStated) {
    Recording recording = record(12);
    std::vector<std::unique_ptr<Aligner>> aligners;
    aligners.push_back(std::make_unique<Fake>(0.05));
    aligners.push_back(std::make_unique<Fake>(0.2));
    RegistrationTrials trials;
    const auto figures = runTrials(recording, aligners, trials);
    const auto& first = dynamic_cast<const Fake&>(*aligners[0]);
    const auto& second = dynamic_cast<const Fake&>(*aligners[1]);
    ASSERT_EQ(first.sources.size(), 7U);
    ASSERT_EQ(first.guesses.size(), 21U);
    const auto sensorOf = [](std::size_t i) {
        return mrpt_bridge::toPose(box_room::robotPose(i) +
                                   mrpt::poses::CPose3D(0, 0, 0.2, 0, 0, 0));
    };
    for (std::size_t k = 0; k < first.sources.size(); ++k) {
        EXPECT_LT(errorOf(first.targets[k], sensorOf(k)).position_m, 1e-6);
        EXPECT_LT(errorOf(first.sources[k], sensorOf(k + 5)).position_m, 1e-6);
    }
    for (std::size_t k = 0; k < first.guesses.size(); ++k) {
        const PoseError off = errorOf(first.guesses[k], first.sources[k / 3]);
        EXPECT_NEAR(off.position_m, 0.5, 1e-9);
        EXPECT_NEAR(off.rotation_deg, 10, 1e-6);
        EXPECT_EQ(errorOf(first.guesses[k], second.guesses[k]).position_m, 0)
            << "all aligners have the same guesses";
    }
    const std::string table = trialsTable(figures, trials);
    EXPECT_NE(table.find(" 1.000      0.050 "), std::string::npos) << table;
    EXPECT_NE(table.find(" 0.000      0.200 "), std::string::npos) << table;
}

TEST_F(RegistrationTrialsTest, MixturesFindTheRoom) {
    Recording recording = record(7);
    std::vector<std::unique_ptr<Aligner>> aligners;
    aligners.push_back(makeMixtureAligner({}));
    const auto figures = runTrials(recording, aligners, {});
    ASSERT_EQ(figures.size(), 1U);
    ASSERT_EQ(figures[0].errors.size(), 6U);
    EXPECT_EQ(figures[0].prepare_ms.size(), 2U);
    EXPECT_EQ(figures[0].align_ms.size(), 6U);
    int good = 0;
    for (const PoseError& error : figures[0].errors)
        good += error.position_m < 0.02 && error.rotation_deg < 0.5;
    EXPECT_GE(good, 5);
}

TEST_F(RegistrationTrialsTest, FewScansGiveNoPairs) {
    Recording recording = record(5);
    std::vector<std::unique_ptr<Aligner>> aligners;
    aligners.push_back(std::make_unique<Fake>(0.0));
    const auto figures = runTrials(recording, aligners, {});
    EXPECT_TRUE(figures[0].errors.empty());
    EXPECT_EQ(trialsTable(figures, {}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace hgmm::evaluation
