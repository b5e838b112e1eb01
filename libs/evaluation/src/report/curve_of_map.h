#pragma once
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/svg_plot.h"

namespace hgmm::evaluation {

/// The curve of one of `maps`, empty as yet: it looks the same in every plot, and the first
/// map's is drawn thick.
inline Curve curveOfMap(const MapFigures& map, const std::vector<MapFigures>& maps) {
    Curve curve;
    curve.label = map.name;
    curve.emphasised = &map == &maps.front();
    curve.style = static_cast<std::size_t>(&map - maps.data());
    return curve;
}

}  // namespace hgmm::evaluation
