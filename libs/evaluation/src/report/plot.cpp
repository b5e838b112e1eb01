#include "hgmm/evaluation/plot.h"

#include <cmath>
#include <stdexcept>

namespace hgmm::evaluation {

nlohmann::ordered_json plotJson(const Plot& plot) {
    nlohmann::ordered_json json{
        {"title", plot.title}, {"x_label", plot.xLabel}, {"y_label", plot.yLabel}};
    json["curves"] = nlohmann::ordered_json::array();
    std::size_t points = 0;
    for (const Curve& curve : plot.curves) {
        for (const auto& [x, y] : curve.points)
            if (!std::isfinite(x) || !std::isfinite(y))
                throw std::invalid_argument("plot '" + plot.title +
                                            "' has a point that is not finite");
        points += curve.points.size();
        json["curves"].push_back({{"label", curve.label},
                                  {"emphasised", curve.emphasised},
                                  {"points", curve.points}});
    }
    if (points == 0) throw std::invalid_argument("plot '" + plot.title + "' has no points");
    return json;
}

}  // namespace hgmm::evaluation
