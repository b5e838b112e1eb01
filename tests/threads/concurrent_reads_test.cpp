// Const member functions of a map, called from several threads at once. The thread
// sanitizer looks for races; without it, the tests compare answers with those of a lone
// reader.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coloured_scenes.h"
#include "hgmm/likelihood.h"
#include "hgmm/map.h"
#include "hgmm/registration.h"

namespace hgmm {
namespace {

using Numbers = std::vector<double>;
using Reader = std::function<Numbers(const Map&)>;

constexpr std::size_t kThreads = 6;
constexpr int kRounds = 5;

/// A painted wall that two scans saw, saved: what is loaded from it has nothing prepared.
const std::vector<std::uint8_t>& saved() {
    static const std::vector<std::uint8_t> buffer = [] {
        const std::vector<std::pair<std::string, testing::Painting>> channels = {
            {"heat", testing::patches({10, 20, 30})}, {"gloss", testing::patches({1, 3})}};
        Map map(testing::modelling({"heat", "gloss"}));
        for (const std::uint64_t seed : {1, 2})
            map.insert(testing::paintedWall(channels, seed, 60, 40));
        return map.save(Encoding::exact);
    }();
    return buffer;
}

Map fresh() {
    return Map::load(saved().data(), saved().size());
}

std::vector<Eigen::Vector3d> points() {
    std::vector<Eigen::Vector3d> result;
    for (int i = 0; i < 40; ++i)
        result.emplace_back(1.0 + 0.03 * i, -0.5 + 0.025 * i, 0.3 - 0.015 * i);
    return result;
}

void append(Numbers& to, const Occupancy& o) {
    to.insert(to.end(), {o.occupied, o.free, o.unknown, o.alongRay_m, o.variance_m2});
}

Numbers occupancies(const Map& map) {
    Numbers answers;
    for (std::size_t level = 0; level < map.levelCount(); ++level)
        for (const Eigen::Vector3d& p : points()) append(answers, map.occupancy(p, level));
    return answers;
}

Numbers occupancyBatch(const Map& map) {
    Numbers answers;
    const std::vector<Eigen::Vector3d> all = points();
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        std::vector<Occupancy> batch(all.size());
        map.occupancy(all.data(), all.size(), batch.data(), level);
        for (const Occupancy& o : batch) append(answers, o);
    }
    return answers;
}

Numbers levels(const Map& map) {
    Numbers answers;
    for (std::size_t level = map.levelCount(); level-- > 0;) {
        answers.push_back(double(map.mixture(level).size()));
        answers.push_back(map.mixture(level).totalSupport());
        answers.push_back(double(map.freeMixture(level).size()));
        answers.push_back(map.freeMixture(level).totalSupport());
        answers.push_back(double(map.viewDirections(level).size()));
    }
    return answers;
}

Numbers rays(const Map& map) {
    Numbers answers;
    for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d direction(1, 0.02 * (i - 10), 0.01 * (i - 10));
        for (const std::size_t level : {0, 1}) {
            const auto hit = map.castRay(Eigen::Vector3d::Zero(), direction, {}, level);
            answers.push_back(hit ? hit->range_m : -1);
        }
    }
    return answers;
}

Numbers modalities(const Map& map) {
    Numbers answers;
    for (const std::string name : {"heat", "gloss"}) {
        for (int i = 0; i < 20; ++i) {
            const ModalityEstimate e = map.modality(name, {2.0, 0.05 * (i - 10), 0.1});
            answers.insert(answers.end(), {e.mean, e.variance, double(e.known)});
        }
        answers.push_back(double(map.modality(name)->mixture(1).size()));
    }
    const CrossModalEstimate inferred = map.infer("heat", {{"gloss", 1.0}});
    answers.insert(answers.end(), {inferred.mean, inferred.variance, inferred.likelihood});
    return answers;
}

Numbers densities(const Map& map) {
    Numbers answers;
    for (const Eigen::Vector3d& p : points()) answers.push_back(map.logDensity(p));
    return answers;
}

Numbers copies(const Map& map) {
    const Map copy(map);
    Numbers answers = occupancies(copy);
    answers.push_back(copy == map);
    return answers;
}

Numbers saves(const Map& map) {
    Numbers answers;
    for (const Encoding encoding : {Encoding::exact, Encoding::compact}) {
        const std::vector<std::uint8_t> buffer = map.save(encoding);
        answers.insert(answers.end(), buffer.begin(), buffer.end());
    }
    return answers;
}

Numbers registrations(const Map& map) {
    Pose guess;
    guess.t = {0.05, 0.02, -0.01};
    const Mixture<3>& base = map.mixture();
    const Registration found = registerMixtures({&base}, base, guess);
    return {found.T_target_source.t.x(), found.T_target_source.t.y(), found.cost};
}

Numbers likelihoods(const Map& map) {
    const SurfaceLikelihood likelihood(map.mixture(), 0.1, 0.1);
    Numbers answers;
    for (int i = 0; i < 20; ++i)
        answers.push_back(likelihood(2.F, 0.05F * float(i - 10), 0.1F));
    return answers;
}

/// Thread t begins with reader t, so that different ones meet on a map that has nothing
/// prepared; then it calls the others. Each answer must be that of a lone reader.
void readTogether(const std::vector<Reader>& readers) {
    std::vector<Numbers> alone;
    for (const Reader& reader : readers) alone.push_back(reader(fresh()));
    for (int round = 0; round < kRounds; ++round) {
        const Map map = fresh();
        std::vector<int> wrong(kThreads, 0);
        std::atomic<std::size_t> waiting{kThreads};
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < kThreads; ++t)
            threads.emplace_back([&, t] {
                --waiting;
                while (waiting > 0) std::this_thread::yield();
                for (std::size_t i = 0; i < readers.size(); ++i) {
                    const std::size_t r = (t + i) % readers.size();
                    wrong[t] += readers[r](map) != alone[r];
                }
            });
        for (std::thread& thread : threads) thread.join();
        EXPECT_EQ(std::count(wrong.begin(), wrong.end(), 0), std::ptrdiff_t(kThreads))
            << "round " << round;
    }
}

}  // namespace

TEST(ConcurrentReads, AllFirstAskTheSame) {
    for (const Reader& reader : {Reader(occupancies), Reader(occupancyBatch),
                                 Reader(levels), Reader(rays), Reader(modalities)})
        readTogether({reader});
}

TEST(ConcurrentReads, AllFirstAskSomethingElse) {
    readTogether({occupancies, levels, rays, modalities, densities, occupancyBatch});
}

TEST(ConcurrentReads, CopiesAreTakenWhileOthersRead) {
    readTogether({copies, occupancies, copies, levels, modalities, rays});
}

TEST(ConcurrentReads, SavingGoesOnWhileOthersRead) {
    readTogether({saves, levels, occupancies, saves, modalities, copies});
}

TEST(ConcurrentReads, MixturesServeAlignmentAndLikelihoodOfSeveral) {
    readTogether({registrations, likelihoods, levels});
}

/// Readers of snapshots, while a writer inserts.
TEST(Snapshots, AreReadWhileTheMapGrows) {
    Map map = fresh();
    std::shared_ptr<const Map> published = map.snapshot();
    std::mutex publishing;
    std::atomic<bool> isDone{false};
    std::vector<std::thread> readers;
    std::atomic<int> wrong{0};
    for (int r = 0; r < 2; ++r)
        readers.emplace_back([&] {
            while (!isDone) {
                std::shared_ptr<const Map> mine;
                {
                    const std::lock_guard<std::mutex> lock(publishing);
                    mine = published;
                }
                const Numbers first = occupancies(*mine);
                if (first != occupancies(*mine)) ++wrong;
            }
        });
    const std::vector<std::pair<std::string, testing::Painting>> channels = {
        {"heat", testing::patches({10, 20, 30})}, {"gloss", testing::patches({1, 3})}};
    for (const std::uint64_t seed : {3, 4, 5}) {
        map.insert(testing::paintedWall(channels, seed, 60, 40));
        const std::lock_guard<std::mutex> lock(publishing);
        published = map.snapshot();
    }
    isDone = true;
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(occupancies(*published), occupancies(Map(map)));
}

}  // namespace hgmm
