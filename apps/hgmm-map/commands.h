#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hgmm/mrpt_bridge/render_params.h"

namespace maptool {

/// `hgmm-map info`: prints levels, size, extent, origin, modalities and options of a saved
/// map.
void info(const std::string& mapFile);

/// `hgmm-map check`: prints for each file whether a map in it may go to a robot. Returns
/// whether all may.
bool check(const std::vector<std::string>& mapFiles);

struct SampleOptions {
    std::string mapFile, output;
    std::size_t points = 0;
    std::uint64_t seed = 1;
    std::size_t level = 0;
    bool colour = false;  ///< as the map's modalities look like
    bool force = false;   ///< replace a file of another kind
};

/// `hgmm-map sample`: draws points from a level into a PLY file.
void sample(const SampleOptions& options);

struct QueryOptions {
    std::string mapFile;
    std::vector<std::string> points;      ///< each "x,y,z" [m]
    std::string pointsFile;               ///< CSV or lines of "x y z" [m], if not empty
    std::vector<std::string> modalities;  ///< names to be answered too; "rgb" is all three
    std::size_t level = 0;
    std::string output;          ///< CSV, or JSON lines; empty: standard output
    bool json = false;           ///< JSON lines
    bool distance = false;       ///< Euclidean distance to the nearest surface, too
    double maxDistance_m = 5.0;  ///< of that [m]
};

/// `hgmm-map query`: prints or writes, for each point, whether it is occupied, free or
/// unknown, how far from the surface, and the modalities asked for.
void query(const QueryOptions& options);

struct RayOptions {
    std::string mapFile;
    std::string from, direction;  ///< "x,y,z"
    double maxRange_m = 100.0;    ///< [m], > 0
    std::size_t level = 0;
};

/// `hgmm-map raycast`: prints the first occupied point along a ray.
void raycast(const RayOptions& options);

struct MergeOptions {
    std::string mapFile, otherFile, output;
    std::vector<double> pose;  ///< of the other map in the first: x, y, z [m], yaw, pitch,
                               ///< roll [deg]; empty: in the same frame
    bool refine = false;       ///< by registration, from that pose
    bool force = false;        ///< replace a file of another kind
};

/// `hgmm-map merge`: writes the first map with what the other knows, and prints where the
/// other was put. Throws std::runtime_error if a refined pose is not to be trusted.
void merge(const MergeOptions& options);

struct ForgetOptions {
    std::string mapFile, output;
    std::vector<double> box;  ///< x0, y0, z0, x1, y1, z1 [m], in the map frame
    bool force = false;       ///< replace a file of another kind
};

/// `hgmm-map forget`: writes the map without its surfaces in a box, and prints how many
/// components that were. Throws std::runtime_error for a box that is empty or not finite.
void forget(const ForgetOptions& options);

struct ExportOptions {
    std::string mapFile, output;
    std::string format;  ///< "ply", "glb", "3Dscene", "png", "bt", "ot", "yaml", "csv"...
    std::size_t level = 0;
    std::size_t pointsPerComponent = 0;  ///< ply: points instead of ellipsoids, if not 0
    std::uint64_t seed = 1;
    double yaw_deg = 30.0;    ///< png: viewing direction about z [deg]
    double pitch_deg = 30.0;  ///< png: how far it points down [deg]
    double cut = 0.0;         ///< png: share of the depth left out, in [0, 1)
    hgmm::mrpt_bridge::RenderParams render;  ///< 3Dscene only; level is taken from above
    double resolution_m = 0.0;               ///< of cells and voxels [m]; 0: derived
    /// bt, ot: the point of the map that becomes the tree's origin, x, y, z [m], rounded to
    /// whole cells; empty: the map's (0, 0, 0).
    std::vector<double> offset_map;
    bool local = false;  ///< bt, ot: that point is the map's own origin
    /// yaml, csv, pgm: of the slice [m], in the map frame.
    std::optional<double> height_m;
    std::vector<double> band_m;         ///< yaml: instead, lowest and highest height [m]
    std::string quantity = "distance";  ///< pgm: or "deviation", its standard deviation
    double maxDistance_m = 5.0;         ///< csv, pgm: how far surfaces are looked for [m]
    double maxDeviation_m = 0.2;        ///< pgm: shown brightest [m]
    bool force = false;                 ///< replace files of other kinds
};

/// `hgmm-map export`: one level in another program's format, in the map frame.
void exportMap(const ExportOptions& options);

struct ViewOptions {
    std::string mapFile;
    std::string output;      ///< empty: beside the map
    std::string posesFile;   ///< trajectory, TUM lines; empty: none
    std::string pointsFile;  ///< input points, PLY or lines of "x y z" [m]; empty: none
    std::string up = "z";    ///< axis of the map that points up: "z", "-y", ...
    bool force = false;      ///< replace a file of another kind
};

/// `hgmm-map view`: writes a page that shows the map in 3D, and prints its name.
void view(const ViewOptions& options);

struct OptionsOptions {
    bool all = false;       ///< advanced options, too
    bool markdown = false;  ///< all, as docs/options.md
};

/// `hgmm-map options`: prints the options of maps with default, range, unit and meaning.
void printOptions(const OptionsOptions& options);

}  // namespace maptool
