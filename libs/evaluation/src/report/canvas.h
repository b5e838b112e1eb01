#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/evaluation/render.h"

namespace hgmm::evaluation {

/// Throws std::invalid_argument naming the field that is outside its range.
void requireValid(const View& view);

/// Rows: right, down, away from the viewer.
Eigen::Matrix3d viewAxes(const View& view);

/// A picture being drawn, of what a frame holds. Points are in view axes [m].
class Canvas {
 public:
    Canvas(const Frame& frame, const View& view);

    /// Pixels that a box of the given half size around a centre covers, clipped to the
    /// picture; empty (x1 < x0 or y1 < y0) outside of it.
    struct Patch {
        int x0, y0, x1, y1;  // both included
    };
    Patch patch(const Eigen::Vector3d& centre, double halfWidth_m,
                double halfHeight_m) const;

    /// Right and down from the centre to the middle of a pixel [m].
    Eigen::Vector2d offset(int x, int y, const Eigen::Vector3d& centre) const;

    /// The colour of a height, by the frame.
    Rgb colourOf(double height_m) const;

    /// Draws a pixel unless something nearer is there or the view cuts it away.
    void put(int x, int y, double depth_m, const Rgb& colour, double brightness);

    /// Darkens pixels that lie behind a neighbour: more, the larger the gap is.
    void shadeGaps(double gap_m);

    double metresPerPixel() const { return 1.0 / scale_; }

    /// The finished picture.
    Picture take();

 private:
    struct Pixel {
        double depth_m;
        Rgb colour;
        double brightness;
    };
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    Frame frame_;
    int width_, height_ = 1;
    double scale_ = 1.0, left_ = 0.0, top_ = 0.0;  // pixels per metre; of the corner
    double nearest_ = 0.0;                         // depth where the cut ends
    std::vector<Pixel> pixels_;
};

}  // namespace hgmm::evaluation
