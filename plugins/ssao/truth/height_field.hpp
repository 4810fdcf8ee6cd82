// Ambient occlusion of what a depth buffer tells, taken as a height field.
#pragma once

#include <postfx/camera.hpp>
#include <postfx/image.hpp>

#include <glm/glm.hpp>

#include <vector>

namespace postfx::host {

/// Each pixel is a place of a surface, and all is solid between there and the tangent plane of another pixel: within
/// a plane through that pixel's line of sight (a slice) light comes from over the horizon only, on either side of it.
/// Nothing is known beyond the border, so nothing there occludes.
class HeightField {
public:
    /// `depth`: raw samples, 1 channel; `normal`: in view space, 3 channels or more, 0 where nothing is. A surface at
    /// the distance t [m] counts as a whole up to radius * (1 - falloff), then less, and not at all from the radius
    /// on: it lifts the horizon by that share of 1 - cosine of its angle with the tangent plane, within the slice.
    HeightField(const Image& depth, const Image& normal, const Camera& camera, double radius, double falloff);

    /// Share of the ambient light, by the cosine, that a pixel's surface gets, if all were as in the plane through
    /// its line of sight that is turned from the picture's horizontal by `angle`: the mean over 0 to pi is the
    /// visibility. One plane's own may lie below 0. Several threads may ask.
    double visibility(int x, int y, double angle) const;

private:
    /// What a slice is taken from, and one half of it.
    struct Point;
    struct Side;
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }
    /// View space [m]; only where there is something.
    glm::dvec3 place(int x, int y) const;
    /// Steps of that many pixels, until lines of sight pass the point by at more than the radius.
    double reach(const Point& point, glm::dvec2 step) const;
    double lost(const Point& point, const Side& side) const;
    /// 1 - cosine of the elevation over the tangent plane that a pixel lifts the horizon to.
    double lift(const Point& point, const Side& side, int x, int y) const;

    int width_, height_;
    bool parallel_;
    double radius_, falloff_;
    double pixel_;                 ///< its side, in the plane 1 m before the eye (perspective), or in metres
    glm::dvec2 axis_;              ///< where the optical axis is in the picture, pixels
    std::vector<double> distance_; ///< along the view axis [m]; 0 where nothing is
    std::vector<glm::dvec3> normal_;
};

} // namespace postfx::host
