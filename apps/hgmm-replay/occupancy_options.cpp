#include "occupancy_options.h"

#include <stdexcept>
#include <vector>

#include "hgmm/evaluation/baseline.h"

namespace replay {

using namespace hgmm::evaluation;

namespace {

std::string namesOfBaselines() {
    std::string names;
    for (const auto& [name, text] : baselineNames())
        names += (names.empty() ? "" : ", ") + name + " (" + text + ")";
    return names;
}

}  // namespace

void defineOccupancyOptions(CLI::App& app, Options& o) {
    using Numbers = std::vector<double>;
    app.add_option_function<Numbers>(
           "--near",
           [&o](const Numbers& v) {
               o.near = NearBand{v[0], v[1]};
           },
           "Near free points lie MIN,MAX metres before their hit (0.05,0.30 for depth "
           "cameras, 0.10,0.60 for lidars)")
        ->delimiter(',')
        ->expected(2);
    app.add_option_function<Numbers>(
           "--free-band",
           [&o](const Numbers& v) {
               o.free = FreeBand{v[0], v[1]};
           },
           "Uniform free points lie between START metres after the sensor and END metres "
           "before their hit (0.1,0.15)")
        ->delimiter(',')
        ->expected(2);
    app.add_option(
           "--baselines", o.baselines,
           "Other maps to evaluate beside ours, NAME or NAME:RESOLUTION in metres: " +
               namesOfBaselines())
        ->delimiter(',');
}

void checkOccupancyUsage(const Options& o) {
    try {
        if (o.near) o.near->validate();
        o.free.validate();
    } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(e.what());
    }
}

void checkBaselines(const Options& o) {
    for (const std::string& baseline : o.baselines) makeBaseline(baseline);
}

}  // namespace replay
