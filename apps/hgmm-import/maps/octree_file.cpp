#include "maps/octree_file.h"

#include <cstring>
#include <sstream>
#include <stdexcept>

#include "files.h"

namespace hgmm::importer {
namespace {

/// Levels below the root: OctoMap's keys have 16 bits, and 2^15 is the cell at the origin.
constexpr int kDepth = 16;
constexpr std::int32_t kMiddle = 1 << (kDepth - 1);

/// What the text before the nodes says.
struct Header {
    bool isBinary = false;  ///< .bt: two bits for each child, no probabilities
    std::string type;
    double resolution_m = 0;
    std::size_t nodes = 0;
    std::size_t end = 0;  ///< where the nodes begin [bytes]
};

Header headerOf(const std::string& bytes) {
    Header header;
    const std::string binary = "# Octomap OcTree binary file",
                      full = "# Octomap OcTree file";
    header.isBinary = bytes.compare(0, binary.size(), binary) == 0;
    if (!header.isBinary && bytes.compare(0, full.size(), full) != 0)
        throw std::runtime_error("is no octree of OctoMap (.bt or .ot)");
    std::istringstream lines(bytes.substr(0, 4096));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "id") words >> header.type;
        if (key == "res") words >> header.resolution_m;
        if (key == "size") words >> header.nodes;
        if (key != "data") continue;
        if (!lines.eof()) header.end = static_cast<std::size_t>(lines.tellg());
        break;
    }
    if (header.end == 0) throw std::runtime_error("its header has no end");
    if (!(header.resolution_m >= 1e-3 && header.resolution_m <= 100))
        throw std::runtime_error("its header has no resolution between 0.001 and 100 m");
    if (header.type != "OcTree" && header.type != "ColorOcTree")
        throw std::runtime_error("is a tree of type '" + header.type +
                                 "'; OcTree and ColorOcTree can be read");
    return header;
}

/// A node's place: its level and the lowest cell in it.
struct Place {
    int depth = 0;
    std::array<std::int32_t, 3> low = {-kMiddle, -kMiddle, -kMiddle};

    std::int32_t size() const { return 1 << (kDepth - depth); }
    Place child(int i) const {
        Place child{depth + 1, low};
        for (int axis = 0; axis < 3; ++axis)
            if ((i >> axis & 1) != 0) child.low[axis] += child.size();
        return child;
    }
};

/// Reads nodes from the root down, a child after the other.
class Nodes {
 public:
    Nodes(const std::string& bytes, const Header& header, KnownCells& cells)
        : bytes_(bytes), at_(header.end), cells_(cells) {
        if (header.nodes == 0) return;
        if (header.isBinary)
            readBinary({});
        else
            readFull({}, header.type == "ColorOcTree" ? 3 : 0);
    }

 private:
    const char* take(std::size_t size) {
        if (bytes_.size() - at_ < size) throw std::runtime_error("the file is cut off");
        at_ += size;
        return bytes_.data() + at_ - size;
    }
    void addLeaf(const Place& place, bool isOccupied) {
        (isOccupied ? cells_.occupied : cells_.free).push_back({place.low, place.size()});
    }
    static void requireRoomBelow(const Place& place) {
        if (place.depth == kDepth)
            throw std::runtime_error("is damaged: its nodes are deeper than 16 levels");
    }

    void readBinary(const Place& place) {
        requireRoomBelow(place);
        std::uint16_t children = 0;
        std::memcpy(&children, take(2), 2);
        for (int i = 0; i < 8; ++i) {
            const int what = children >> (2 * i) & 3;
            if (what == 1 || what == 2) addLeaf(place.child(i), what == 2);
            if (what == 3) readBinary(place.child(i));
        }
    }
    void readFull(const Place& place, std::size_t bytesOfColour) {
        float logOdds = 0;
        std::memcpy(&logOdds, take(sizeof logOdds), sizeof logOdds);
        take(bytesOfColour);
        const auto children = static_cast<unsigned char>(*take(1));
        if (children == 0) return addLeaf(place, logOdds >= 0);
        requireRoomBelow(place);
        for (int i = 0; i < 8; ++i)
            if ((children >> i & 1) != 0) readFull(place.child(i), bytesOfColour);
    }

    const std::string& bytes_;
    std::size_t at_;
    KnownCells& cells_;
};

}  // namespace

KnownCells readOctree(const std::string& file) {
    const std::string bytes = readBytes(file);
    try {
        const Header header = headerOf(bytes);
        KnownCells cells;
        cells.edge_m = header.resolution_m;
        Nodes(bytes, header, cells);
        return cells;
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
}

}  // namespace hgmm::importer
