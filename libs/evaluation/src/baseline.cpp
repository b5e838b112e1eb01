#include "hgmm/evaluation/baseline.h"

#include <stdexcept>

#include "hgmm/evaluation/octomap_baseline.h"
#include "hgmm/evaluation/parse_numbers.h"

namespace hgmm::evaluation {

std::unique_ptr<Baseline> makeBaseline(const std::string& specification) {
    const std::size_t colon = specification.find(':');
    const std::string name = specification.substr(0, colon);
    std::vector<double> numbers;
    try {
        if (colon != std::string::npos)
            numbers = parseNumbers(specification.substr(colon + 1));
    } catch (const std::runtime_error&) {
        numbers.clear();
    }
    if (name != "octomap" || numbers.size() != 1 || numbers[0] <= 0.0)
        throw std::invalid_argument("'" + specification +
                                    "' is no baseline; give octomap:RESOLUTION, in "
                                    "metres, such as octomap:0.05");
    return std::make_unique<OctomapBaseline>(numbers[0]);
}

}  // namespace hgmm::evaluation
