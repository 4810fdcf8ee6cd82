// One layer of colour and depth seen from the points of a lens.
#pragma once

#include "thin_lens.hpp"

#include <postfx/image.hpp>

#include <array>
#include <vector>

namespace postfx::host {

/// Every pixel is a patch of a surface, tilted as its neighbours say. Seen from a point of the lens it moves and is
/// stretched; nearer patches hide farther ones by the area that they cover. Where no patch is seen, what the lens
/// looks at there was hidden in the layer: it is taken to be as the farther one of its two neighbours in the
/// direction of the movement. What lies outside of the picture counts for nothing: a pixel is the mean over those
/// points of the lens from which something is known of it.
class LayerLens {
public:
    /// `color` has 3 channels; `inverse_distance` [1/m] along the view axis, one per pixel, 0 for the sky.
    LayerLens(Image64 color, std::vector<double> inverse_distance, const ThinLens& lens);

    /// Of a sum: light of red, green, blue, then the area that it covers.
    static constexpr int channels = 6;

    /// Add what is seen from a point of the lens, in its unit disc.
    void add(glm::dvec2 point, Image64& sum);

    /// 3 channels. What was seen from nowhere keeps the layer's own colour.
    Image64 picture(const Image64& sum) const;

private:
    /// Of one pixel, from one point of the lens.
    struct Seen {
        glm::dvec3 light{0};      ///< times area
        double area = 0;          ///< that is covered, 0 to 1
        std::size_t farthest = 0; ///< of the patches that are seen in it
    };

    void add_channels(glm::dvec2 shift, double focus, int first, int last, Image64& sum);
    /// Make view_ what is seen. `shift`: pixels that 1/m of defocus moves a patch by.
    void look(glm::dvec2 shift, double focus);
    /// The view with its holes filled.
    Seen filled(std::size_t pixel, glm::dvec2 shift) const;
    /// The first pixel from there on that is covered whole; null when there is none.
    const Seen* next_known(std::size_t pixel, glm::dvec2 step) const;

    Image64 color_;
    std::vector<double> inverse_distance_;
    std::vector<glm::dvec2> slope_; ///< of the inverse distance, per pixel to the right and up
    std::vector<std::size_t> nearest_first_;
    std::vector<Seen> view_; ///< scratch
    std::array<double, 3> focus_;
    double pixels_; ///< that 1/m of defocus moves a pixel by, seen from the lens' rim
};

} // namespace postfx::host
