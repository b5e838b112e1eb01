#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "maps/import_map.h"
#include "match_poses.h"
#include "recording_writer.h"
#include "rgbd_observation.h"
#include "sources/cloud_source.h"

namespace hgmm::importer {

/// What the command line says.
struct Arguments {
    std::string input, poses;
    std::vector<double> intrinsics, sensorPose, noise;
    bool worldFrame = false;
    bool force = false;
    std::optional<double> aperture_deg;
    std::size_t step = 1;
    MatchOptions match;
    std::optional<double> unitsPerMetre;
    CloudOptions cloud;
    RecordingOutputs outputs;

    RgbdOptions rgbd() const;
    CloudOptions clouds() const;
};

/// Makes the source of a format that was asked for.
using MakeSource = std::function<std::unique_ptr<Source>()>;

/// Adds a format's command.
MakeSource addTum(CLI::App& app, Arguments& arguments);
MakeSource addSevenScenes(CLI::App& app, Arguments& arguments);
MakeSource addKitti(CLI::App& app, Arguments& arguments);
MakeSource addPcd(CLI::App& app, Arguments& arguments);
MakeSource addPly(CLI::App& app, Arguments& arguments);
MakeSource addSimpleMap(CLI::App& app, Arguments& arguments);
MakeSource addRawlog(CLI::App& app, Arguments& arguments);

/// Adds the command that imports maps.
void addMap(CLI::App& app, MapImport& import);

/// The check of an option: every number finite, and more than above.
CLI::Validator numbersAbove(double above);
/// The recording, where it goes to, and in which form.
void addOutputs(CLI::App& command, Arguments& arguments);

}  // namespace hgmm::importer
