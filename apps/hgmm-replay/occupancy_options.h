#pragma once
#include <CLI/CLI.hpp>

#include "options.h"

namespace replay {

/// Defines what belongs to the evaluation of occupancy: bands of free points and baselines.
void defineOccupancyOptions(CLI::App& app, Options& options);

/// Throws CLI::ValidationError naming the option.
void checkOccupancyUsage(const Options& options);

/// Throws std::invalid_argument, naming those there are, for a baseline that is not known.
void checkBaselines(const Options& options);

}  // namespace replay
