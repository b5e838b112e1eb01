#include "parse_point.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "hgmm/evaluation/parse_numbers.h"

namespace maptool {

Eigen::Vector3d parsePoint(const std::string& text, const std::string& where) {
    std::string blanks = text;
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    std::vector<double> numbers;
    try {
        numbers = hgmm::evaluation::parseNumbers(blanks);
    } catch (const std::runtime_error& e) {
        throw std::runtime_error(where + ": " + e.what());
    }
    if (numbers.size() != 3)
        throw std::runtime_error(where + ": must be three numbers x,y,z, not " +
                                 std::to_string(numbers.size()));
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace maptool
