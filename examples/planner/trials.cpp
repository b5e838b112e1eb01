#include "trials.h"

#include <ompl/util/RandomNumbers.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "smoothing.h"

namespace planner {

namespace {

constexpr int kMaxDraws = 1000000;  // of a free place

Eigen::Vector3d freePlace(const FreeSpace& space, ompl::RNG& random,
                          const Path& otherPlaces_map, double apart_m) {
    const Eigen::AlignedBox3d box = space.bounds_map();
    for (int draw = 0; draw < kMaxDraws; ++draw) {
        Eigen::Vector3d place;
        for (int d = 0; d < 3; ++d)
            place[d] = random.uniformReal(box.min()[d], box.max()[d]);
        bool apart = true;
        for (const Eigen::Vector3d& other : otherPlaces_map)
            apart = apart && (place - other).norm() >= apart_m;
        if (apart && space.isFree(place, place)) return place;
    }
    throw std::runtime_error("found no free places that are so far apart");
}

}  // namespace

Plan timedPlan(const FreeSpace& space, const Eigen::Vector3d& start_map,
               const Eigen::Vector3d& goal_map, const PlanningParams& params) {
    const auto begin = std::chrono::steady_clock::now();
    Plan result;
    result.start_map = start_map;
    result.goal_map = goal_map;
    result.path_map = plan(space, start_map, goal_map, params);
    if (!result.path_map.empty()) result.path_map = smoothed(space, result.path_map);
    const std::chrono::duration<double, std::milli> took =
        std::chrono::steady_clock::now() - begin;
    result.milliseconds = took.count();
    return result;
}

std::vector<Plan> randomPlans(const FreeSpace& space, unsigned count, double apart_m,
                              const PlanningParams& params) {
    ompl::RNG random;
    std::vector<Plan> plans;
    for (unsigned i = 0; i < count; ++i) {
        const Eigen::Vector3d start = freePlace(space, random, {}, apart_m);
        const Eigen::Vector3d goal = freePlace(space, random, {start}, apart_m);
        plans.push_back(timedPlan(space, start, goal, params));
    }
    return plans;
}

void printTable(const FreeSpace& space, const std::vector<Plan>& plans) {
    std::printf("plan  found  length_m  clearance_m        ms  from, to\n");
    std::size_t found = 0;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const Plan& plan = plans[i];
        if (plan.path_map.empty()) {
            std::printf("%4zu  no            -            -", i);
        } else {
            ++found;
            std::printf("%4zu  yes    %8.3f     %8.3f", i, length_m(plan.path_map),
                        space.clearance_m(plan.path_map));
        }
        std::printf("  %8.0f  %.3f,%.3f,%.3f %.3f,%.3f,%.3f\n", plan.milliseconds,
                    plan.start_map.x(), plan.start_map.y(), plan.start_map.z(),
                    plan.goal_map.x(), plan.goal_map.y(), plan.goal_map.z());
    }
    std::printf("%zu of %zu found\n", found, plans.size());
}

void writeCsv(const std::vector<Plan>& plans, const std::string& file) {
    std::ofstream out(file);
    out << "plan,x,y,z\n" << std::setprecision(17);
    for (std::size_t i = 0; i < plans.size(); ++i)
        for (const Eigen::Vector3d& place : plans[i].path_map)
            out << i << ',' << place.x() << ',' << place.y() << ',' << place.z() << '\n';
    if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace planner
