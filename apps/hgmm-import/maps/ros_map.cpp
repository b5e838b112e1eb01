#include "maps/ros_map.h"

#include <mrpt/containers/yaml.h>
#include <mrpt/img/CImage.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "files.h"

namespace hgmm::importer {
namespace {

enum class Mode { trinary, scale, raw };

struct Description {
    std::string image;
    Mode mode = Mode::trinary;
    bool negate = false;
    double resolution_m = 0, occupiedThreshold = 0.65, freeThreshold = 0.196;
    std::array<double, 3> origin = {0, 0, 0};  ///< x, y [m], yaw [rad]
};

/// A number of the file; `otherwise` says what is taken if there is none.
double number(const mrpt::containers::yaml& yaml, const std::string& key,
              const double* otherwise, std::vector<std::string>& notes) {
    if (!yaml.has(key)) {
        if (otherwise == nullptr) throw std::runtime_error("has no '" + key + "'");
        char text[80];
        std::snprintf(text, sizeof text, "no '%s': %g is taken, as is usual", key.c_str(),
                      *otherwise);
        notes.emplace_back(text);
        return *otherwise;
    }
    const auto value = yaml[key].as<double>();
    if (!std::isfinite(value)) throw std::runtime_error("'" + key + "' is not finite");
    return value;
}

Mode modeOf(const std::string& word) {
    if (word == "trinary") return Mode::trinary;
    if (word == "scale") return Mode::scale;
    if (word == "raw") return Mode::raw;
    throw std::runtime_error("'mode' is '" + word + "', and must be trinary, scale or raw");
}

Description describe(const mrpt::containers::yaml& yaml, std::vector<std::string>& notes) {
    Description d;
    if (!yaml.isMap() || !yaml.has("image"))
        throw std::runtime_error("has no 'image': is it the .yaml of a map?");
    d.image = yaml["image"].as<std::string>();
    if (yaml.has("mode")) d.mode = modeOf(yaml["mode"].as<std::string>());
    d.resolution_m = number(yaml, "resolution", nullptr, notes);
    if (!(d.resolution_m >= 1e-3 && d.resolution_m <= 100))
        throw std::runtime_error("'resolution' must be in [0.001, 100] m");
    const double positive = 0;
    if (yaml.has("negate")) {
        const auto word = yaml["negate"].as<std::string>();
        d.negate = word == "true" || word == "True" ||
                   (word != "false" && word != "False" &&
                    number(yaml, "negate", &positive, notes) != 0);
    }
    d.occupiedThreshold = number(yaml, "occupied_thresh", &d.occupiedThreshold, notes);
    d.freeThreshold = number(yaml, "free_thresh", &d.freeThreshold, notes);
    if (!(d.freeThreshold < d.occupiedThreshold))
        throw std::runtime_error("'free_thresh' must be below 'occupied_thresh'");
    if (!yaml.has("origin") || !yaml["origin"].isSequence() ||
        yaml["origin"].asSequence().size() != 3)
        throw std::runtime_error("has no 'origin: [x, y, yaw]'");
    for (int i = 0; i < 3; ++i) {
        d.origin[i] = yaml["origin"](i).as<double>();
        if (!std::isfinite(d.origin[i])) throw std::runtime_error("'origin' is not finite");
    }
    return d;
}

mrpt::img::CImage loadPicture(const std::filesystem::path& file) {
    mrpt::img::CImage image;
    if (!std::filesystem::is_regular_file(file) || !image.loadFromFile(file.string()) ||
        image.isEmpty())
        failFile(file, "is no readable picture");
    if (image.getPixelDepth() != mrpt::img::PixelDepth::D8U)
        failFile(file, "has not 8 bits a channel, as pictures of maps have");
    return image;
}

enum class Pixel { unknown, free, occupied };

/// @param shade mean of the channels, 0 (black) to 255
Pixel meaningOf(double shade, const Description& d) {
    if (d.negate) shade = 255 - shade;
    if (d.mode == Mode::raw && shade > 100) return Pixel::unknown;
    const double occupied = d.mode == Mode::raw ? shade / 100 : (255 - shade) / 255;
    if (occupied > d.occupiedThreshold) return Pixel::occupied;
    return occupied < d.freeThreshold ? Pixel::free : Pixel::unknown;
}

/// Of the pixels, row by row from the north.
std::vector<Pixel> meaningsOf(const mrpt::img::CImage& image, const Description& d,
                              std::vector<std::string>& notes) {
    const std::size_t channels = image.channelCount(), columns = image.getWidth();
    const std::size_t colours = channels == 4 ? 3 : channels;
    std::vector<Pixel> meanings;
    std::size_t transparent = 0;
    for (std::size_t row = 0; row < image.getHeight(); ++row) {
        const auto* pixel = image.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
        for (std::size_t column = 0; column < columns; ++column, pixel += channels) {
            double sum = 0;
            for (std::size_t c = 0; c < colours; ++c) sum += pixel[c];
            const bool isOpaque = channels != 4 || pixel[3] == 255;
            meanings.push_back(isOpaque ? meaningOf(sum / double(colours), d)
                                        : Pixel::unknown);
            transparent += isOpaque ? 0 : 1;
        }
    }
    if (transparent > 0)
        notes.push_back(std::to_string(transparent) + " transparent pixels are unknown");
    return meanings;
}

mrpt::containers::yaml parsed(const std::string& text) {
    try {
        return mrpt::containers::yaml::FromText(text);
    } catch (const std::exception&) {
        throw std::runtime_error("is no YAML");
    }
}

Description readDescription(const std::string& file, std::vector<std::string>& notes) {
    const std::string text = readBytes(file);
    try {
        return describe(parsed(text), notes);
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    } catch (const std::exception&) {
        failFile(file, "has a field that is no number where one must be");
    }
}

}  // namespace

RosMap readRosMap(const std::string& yamlFile, double height_m) {
    RosMap map;
    const Description d = readDescription(yamlFile, map.notes);
    const auto picture = std::filesystem::path(yamlFile).parent_path() / d.image;
    const mrpt::img::CImage image = loadPicture(picture);
    const std::vector<Pixel> meanings = meaningsOf(image, d, map.notes);
    map.cells.edge_m = d.resolution_m;
    map.cells.T_map_cells = {
        Eigen::AngleAxisd(d.origin[2], Eigen::Vector3d::UnitZ()).toRotationMatrix(),
        {d.origin[0], d.origin[1], height_m - d.resolution_m / 2}};
    const auto columns = static_cast<std::int32_t>(image.getWidth()),
               rows = static_cast<std::int32_t>(image.getHeight());
    for (std::int32_t row = 0; row < rows; ++row)
        for (std::int32_t column = 0; column < columns; ++column) {
            const Pixel meaning = meanings[std::size_t(row) * columns + column];
            const CellCube cube{{column, rows - 1 - row, 0}, 1};
            if (meaning == Pixel::occupied) map.cells.occupied.push_back(cube);
            if (meaning == Pixel::free) map.cells.free.push_back(cube);
        }
    return map;
}

}  // namespace hgmm::importer
