#include "hgmm/mrpt_bridge/modality_colours.h"

#include <mrpt/img/color_maps.h>

#include <algorithm>
#include <limits>

namespace hgmm::mrpt_bridge {

namespace {

using Answers = std::vector<ModalityEstimate>;

const mrpt::img::TColorf kUnknown(0.5F, 0.5F, 0.5F, 1.F);

Answers ask(const Map& map, const std::string& name,
            const std::vector<Eigen::Vector3d>& points_map) {
    Answers answers(points_map.size());
    map.modality(name, points_map.data(), points_map.size(), answers.data());
    return answers;
}

float inUnitRange(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1.0));
}

void paintScalar(const Answers& answers, std::vector<mrpt::img::TColorf>& colours) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ModalityEstimate& answer : answers) {
        if (!answer.known) continue;
        low = std::min(low, answer.mean);
        high = std::max(high, answer.mean);
    }
    for (std::size_t i = 0; i < answers.size(); ++i)
        if (answers[i].known)
            colours[i] = jetColour(static_cast<float>(answers[i].mean),
                                   static_cast<float>(low), static_cast<float>(high));
}

}  // namespace

mrpt::img::TColorf jetColour(float value, float low, float high) {
    const float place = high > low ? (value - low) / (high - low) : 0.5F;
    mrpt::img::TColorf colour(0, 0, 0, 1);
    mrpt::img::colormap(mrpt::img::cmJET, place, colour.R, colour.G, colour.B);
    return colour;
}

std::vector<std::string> shownModalities(const Map& map, const std::string& wanted) {
    const std::vector<std::string>& modelled = map.modalities();
    const auto isModelled = [&](const std::string& name) {
        return std::find(modelled.begin(), modelled.end(), name) != modelled.end();
    };
    const bool rgb = isModelled("r") && isModelled("g") && isModelled("b");
    if (rgb && (wanted.empty() || wanted == "rgb")) return {"r", "g", "b"};
    if (wanted.empty() && !modelled.empty()) return {modelled.front()};
    if (isModelled(wanted)) return {wanted};
    return {};
}

std::vector<mrpt::img::TColorf> modalityColours(
    const Map& map, const std::string& wanted,
    const std::vector<Eigen::Vector3d>& points_map) {
    std::vector<mrpt::img::TColorf> colours(points_map.size(), kUnknown);
    const std::vector<std::string> names = shownModalities(map, wanted);
    if (names.size() == 1) paintScalar(ask(map, names[0], points_map), colours);
    if (names.size() != 3) return colours;
    const Answers r = ask(map, "r", points_map), g = ask(map, "g", points_map),
                  b = ask(map, "b", points_map);
    for (std::size_t i = 0; i < colours.size(); ++i)
        if (r[i].known && g[i].known && b[i].known)
            colours[i] = {inUnitRange(r[i].mean), inUnitRange(g[i].mean),
                          inUnitRange(b[i].mean), 1.F};
    return colours;
}

}  // namespace hgmm::mrpt_bridge
