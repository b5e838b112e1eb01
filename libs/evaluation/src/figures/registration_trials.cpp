#include "hgmm/evaluation/registration_trials.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <deque>
#include <optional>
#include <utility>

#include "hgmm/evaluation/sensor_kind.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/registration.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {
namespace {

class MixtureAligner : public Aligner {
 public:
    explicit MixtureAligner(const MapParams& params) : params_(params) {}

    std::string name() const override { return "hgmm"; }

    void setTarget(const Scan& target) override {
        Map map(params_);
        map.insert(target);
        std::vector<const Mixture<3>*> levels;
        for (std::size_t level = map.levelCount(); level > 0; --level)
            levels.push_back(&map.mixture(level - 1));
        origin_ = map.origin();
        target_.emplace(levels);
    }

    void setSource(const Scan& source) override {
        source_ = filterScan(source, params_.filter);
    }

    Pose align(const Pose& guess) const override {
        const Registration found = target_->align(source_, {guess.R, guess.t - origin_});
        return {found.T_target_source.R, found.T_target_source.t + origin_};
    }

 private:
    MapParams params_;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // of the target, in the map
    std::optional<RegistrationTarget> target_;
    Mixture<3> source_;  // in the source's sensor frame
};

template <class Work>
double processorMilliseconds(const Work& work) {
    const std::clock_t start = std::clock();
    work();
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void alignPair(Aligner& aligner, const Scan& target, const Scan& source,
               const std::vector<Pose>& guesses, AlignerFigures& figures) {
    figures.prepare_ms.push_back(processorMilliseconds([&] {
        aligner.setTarget(target);
        aligner.setSource(source);
    }));
    for (const Pose& guess : guesses) {
        Pose found;
        figures.align_ms.push_back(
            processorMilliseconds([&] { found = aligner.align(guess); }));
        figures.errors.push_back(errorOf(found, source.T_map_sensor));
    }
}

std::vector<Pose> guessesFor(const Scan& source, std::size_t index,
                             const RegistrationTrials& trials) {
    auto stream = randomStream(trials.seed, index, Draw::startPose);
    std::vector<Pose> guesses;
    for (int k = 0; k < trials.guessesPerPair; ++k)
        guesses.push_back(
            displaced(source.T_map_sensor, trials.off_m, trials.off_deg, false, stream));
    return guesses;
}

}  // namespace

std::unique_ptr<Aligner> makeMixtureAligner(const MapParams& params) {
    return std::make_unique<MixtureAligner>(params);
}

RegistrationTrials trialsFor(const std::string& sensor, std::uint64_t seed) {
    RegistrationTrials trials;
    trials.seed = seed;
    if (sensorKindOf(sensor) != SensorKind::depthCamera) trials.success_m = 0.3;
    return trials;
}

std::vector<AlignerFigures> runTrials(Recording& recording,
                                      const std::vector<std::unique_ptr<Aligner>>& aligners,
                                      const RegistrationTrials& trials) {
    std::vector<AlignerFigures> figures;
    for (const auto& aligner : aligners) figures.push_back({aligner->name(), {}, {}, {}});
    const std::size_t stride = std::max<std::size_t>(1, recording.size() / trials.maxPairs);
    std::deque<Scan> last;  // the newest at the end
    for (std::size_t k = 0; const auto recorded = recording.next();) {
        auto scan =
            mrpt_bridge::observationToScan(*recorded->observation, recorded->T_map_robot);
        if (!scan || scan->size() == 0) continue;
        last.push_back(std::move(*scan));
        if (last.size() <= trials.gap) continue;
        if (k++ % stride == 0) {
            const auto guesses = guessesFor(last.back(), recorded->index, trials);
            for (std::size_t a = 0; a < aligners.size(); ++a)
                alignPair(*aligners[a], last.front(), last.back(), guesses, figures[a]);
        }
        last.pop_front();
    }
    return figures;
}

std::string trialsTable(const std::vector<AlignerFigures>& figures,
                        const RegistrationTrials& trials) {
    char line[200];
    std::snprintf(line, sizeof line,
                  "pairs i, i + %zu, guesses off by %g m, %g deg; success: within %g m, %g "
                  "deg\n",
                  trials.gap, trials.off_m, trials.off_deg, trials.success_m,
                  trials.success_deg);
    std::string text = line;
    std::snprintf(line, sizeof line, "  %-14s %7s %8s %10s %10s %12s %10s\n", "method",
                  "guesses", "success", "median m", "median deg", "ms prepare", "ms align");
    text += line;
    for (const AlignerFigures& f : figures) {
        std::vector<double> metres, degrees;
        std::size_t successes = 0;
        for (const PoseError& e : f.errors) {
            metres.push_back(e.position_m);
            degrees.push_back(e.rotation_deg);
            if (e.position_m <= trials.success_m && e.rotation_deg <= trials.success_deg)
                ++successes;
        }
        std::snprintf(line, sizeof line, "  %-14s %7zu %8.3f %10.3f %10.2f %12.1f %10.1f\n",
                      f.name.c_str(), f.errors.size(),
                      static_cast<double>(successes) /
                          static_cast<double>(std::max<std::size_t>(1, f.errors.size())),
                      median(metres), median(degrees), median(f.prepare_ms),
                      median(f.align_ms));
        text += line;
    }
    return text;
}

}  // namespace hgmm::evaluation
