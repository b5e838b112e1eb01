#include "planning.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/StateCostIntegralObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace planner {

namespace {

namespace ob = ompl::base;
using StateSpace = ob::RealVectorStateSpace;

Eigen::Vector3d placeOf(const ob::State* state, const Robot& robot) {
    const double* x = state->as<StateSpace::StateType>()->values;
    return {x[0], x[1], robot.planar() ? *robot.plane_m : x[2]};
}

/// One swept sphere for a whole motion, instead of many places along it.
class SweptMotion : public ob::MotionValidator {
 public:
    SweptMotion(const ob::SpaceInformationPtr& si, const FreeSpace& space)
        : ob::MotionValidator(si), space_(space) {}

    bool checkMotion(const ob::State* from, const ob::State* to) const override {
        const bool free =
            space_.isFree(placeOf(from, space_.robot()), placeOf(to, space_.robot()));
        ++(free ? valid_ : invalid_);
        return free;
    }
    /// The last valid state is the first one: a swept sphere does not say where it met
    /// what.
    bool checkMotion(const ob::State* from, const ob::State* to,
                     std::pair<ob::State*, double>& lastValid) const override {
        const bool free = checkMotion(from, to);
        if (!free) {
            if (lastValid.first != nullptr) si_->copyState(lastValid.first, from);
            lastValid.second = 0;
        }
        return free;
    }

 private:
    const FreeSpace& space_;
};

/// Length of the way, and how near to surfaces it is.
class LengthAndNearness : public ob::StateCostIntegralObjective {
 public:
    LengthAndNearness(const ob::SpaceInformationPtr& si, const FreeSpace& space)
        : ob::StateCostIntegralObjective(si, true), space_(space) {}

    ob::Cost stateCost(const ob::State* state) const override {
        const auto surface = space_.nearDistance(placeOf(state, space_.robot()));
        return ob::Cost(1 + space_.nearness(surface.distance_m));
    }
    ob::Cost motionCostHeuristic(const ob::State* from,
                                 const ob::State* to) const override {
        return ob::Cost(si_->distance(from, to));
    }

 private:
    const FreeSpace& space_;
};

ob::SpaceInformationPtr spaceInformation(const FreeSpace& space) {
    const unsigned dimension = space.robot().planar() ? 2 : 3;
    const Eigen::AlignedBox3d box = space.bounds_map();
    ob::RealVectorBounds bounds(dimension);
    for (unsigned d = 0; d < dimension; ++d) {
        bounds.setLow(d, box.min()[d]);
        bounds.setHigh(d, box.max()[d]);
    }
    const auto states = std::make_shared<StateSpace>(dimension);
    states->setBounds(bounds);
    // So far apart are the places at which the cost of a motion is summed.
    states->setLongestValidSegmentFraction(space.robot().radius_m /
                                           states->getMaximumExtent());
    const auto si = std::make_shared<ob::SpaceInformation>(states);
    si->setStateValidityChecker([&space](const ob::State* state) {
        const Eigen::Vector3d place = placeOf(state, space.robot());
        return space.isFree(place, place);
    });
    si->setMotionValidator(std::make_shared<SweptMotion>(si, space));
    si->setup();
    return si;
}

ob::ScopedState<StateSpace> stateAt(const ob::SpaceInformationPtr& si,
                                    const Eigen::Vector3d& place_map) {
    ob::ScopedState<StateSpace> state(si);
    for (unsigned d = 0; d < si->getStateDimension(); ++d) state[d] = place_map[d];
    return state;
}

void requireFree(const FreeSpace& space, const Eigen::Vector3d& place_map,
                 const char* which) {
    if (!space.isFree(place_map, place_map))
        throw std::invalid_argument(std::string("the robot cannot be at the ") + which);
}

}  // namespace

void setSeed(std::uint_fast32_t seed) {
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(seed);
}

Path plan(const FreeSpace& space, const Eigen::Vector3d& start_map,
          const Eigen::Vector3d& goal_map, const PlanningParams& params) {
    requireFree(space, start_map, "start");
    requireFree(space, goal_map, "goal");
    const ob::SpaceInformationPtr si = spaceInformation(space);
    const auto problem = std::make_shared<ob::ProblemDefinition>(si);
    problem->setStartAndGoalStates(stateAt(si, start_map), stateAt(si, goal_map));
    problem->setOptimizationObjective(std::make_shared<LengthAndNearness>(si, space));

    ompl::geometric::RRTstar search(si);
    search.setRange(params.step_m);
    search.setProblemDefinition(problem);
    search.setup();
    // Iterations, not time: the same path on any machine.
    for (unsigned done = 0; done < params.maxIterations; done += params.improvements) {
        const bool before = problem->hasExactSolution();
        ob::IterationTerminationCondition enough(params.improvements);
        search.solve(enough);
        if (before) break;
    }
    Path path;
    if (!problem->hasExactSolution()) return path;
    auto* found = problem->getSolutionPath()->as<ompl::geometric::PathGeometric>();
    for (const ob::State* state : found->getStates())
        path.push_back(placeOf(state, space.robot()));
    return path;
}

}  // namespace planner
