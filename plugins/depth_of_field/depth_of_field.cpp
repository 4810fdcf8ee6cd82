// Depth of field of a thin lens, from colour and depth. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace {

constexpr double pinhole = 128; ///< the f-number that counts as infinite

constexpr const char* views[] = {"picture", "circle_of_confusion"};

constexpr postfx::Parameter parameters[] = {
    postfx::number("focus_distance", 0)
        .range(0, 100000)
        .in_unit("m")
        .about(
            "Distance of the plane that is sharp; 0: what the camera is focused on, 5 m if it does not say"),
    postfx::number("f_number", 1.4)
        .range(0.5, pinhole)
        .logarithmic()
        .identity_at(pinhole)
        .about("Focal length over aperture diameter; 128 is a pinhole, which blurs nothing"),
    postfx::number("focal_length", 50)
        .range(1, 1000)
        .in_unit("mm")
        .logarithmic()
        .about("With the f-number, gives the aperture; the field of view stays the camera's"),
    postfx::number("max_circle_of_confusion", 0.03)
        .range(0, 0.1)
        .in_unit("height")
        .identity_at(0)
        .about("Largest diameter of the blur of a point; beyond it blur grows no more"),
    postfx::choice("view", views)
        .constant()
        .about("picture, or the circle's diameter [px]: red in front of the focus, blue behind"),
};
constexpr const char* attachments[] = {"depth"};

/// Circles up to this diameter [px] count as sharp and stay untouched.
constexpr double sharp_diameter = 1;
/// Radius of the largest gather, in texels of the reduced layers; 6 is at most 137 taps. More means finer
/// layers for the same circle.
constexpr double largest_radius = 6;
/// Edge of a tile, texels. A tile and its eight neighbours must hold everything that reaches a texel of the
/// tile or one beside it: largest_radius + half a texel of edge + 1.
constexpr int tile_size = 8;

/// Signed diameter of the circle of confusion [px], affine in the raw depth sample d, negative in front:
///     clamp(d == sky depth ? sky : scale * d + offset, -limit, limit)
struct Lens {
    double scale, offset, sky, limit;
};

double focus_metres(const postfx::Request& in) {
    constexpr double unsaid = 5;
    if (in.number("focus_distance") > 0) return in.number("focus_distance");
    return in.camera().focus_distance > 0 ? in.camera().focus_distance : unsaid;
}

double aperture_metres(const postfx::Request& in) {
    return in.number("focal_length") / 1000 / in.number("f_number");
}

/// c = A H / (2 S tan(fov/2)) (1 - S/z): what a lens of diameter A gives in a camera of that field of view.
Lens perspective_lens(const postfx::Request& in) {
    const postfx_camera& camera = in.camera();
    const double focus = focus_metres(in);
    const double at_infinity = aperture_metres(in) * in.height() / (2 * focus * camera.tan_half_fov);
    const double at_near = at_infinity * (focus / camera.near_plane - 1);
    return {-at_infinity * focus * camera.depth_scale, at_infinity * (1 - focus * camera.depth_offset),
            at_infinity, std::max(at_infinity, at_near)};
}

/// c = A (z/S - 1) metres of the scene, at any place: the bundle of rays that meets in the focus plane.
Lens orthographic_lens(const postfx::Request& in) {
    const postfx_camera& camera = in.camera();
    const double focus = focus_metres(in);
    const double per_metre = aperture_metres(in) * in.height() / camera.vertical_extent / focus;
    constexpr double unbounded = std::numeric_limits<double>::infinity();
    return {per_metre * camera.depth_scale, per_metre * (camera.depth_offset - focus), unbounded, unbounded};
}

struct Reduction {
    int block; ///< a texel of the reduced layers is block x block pixels
    std::uint32_t width, height, tiles_x, tiles_y;
};

std::uint32_t divide_up(int size, int part) {
    return static_cast<std::uint32_t>((size + part - 1) / part);
}

/// Half resolution, or less when the largest circle would not fit the gather: the cost never grows with the
/// circle.
Reduction reduce(const postfx::Request& in, double largest_diameter) {
    const int block = std::max(2, static_cast<int>(std::ceil(largest_diameter / 2 / largest_radius)));
    return {block, divide_up(in.width(), block), divide_up(in.height(), block),
            divide_up(in.width(), block * tile_size), divide_up(in.height(), block * tile_size)};
}

void declare_passes(const postfx::Request& in, postfx::Builder& out, const Lens& lens) {
    const Reduction size = reduce(in, lens.limit);
    const double softening = 1 / (2 * size.block - sharp_diameter);
    const postfx::PlanImage depth = out.attachment("depth");
    const postfx::PlanImage background = out.pass("layers", "depth_of_field_layers.glsl")
                                             .reads("source", out.color(), "nearest")
                                             .reads("depth", depth, "nearest")
                                             .value("lens", lens.scale, lens.offset, lens.sky, lens.limit)
                                             .value("sharp_diameter", sharp_diameter)
                                             .value("softening", softening)
                                             .int_value("block", size.block)
                                             .formats({"", "", "rg32f"})
                                             .sized(size.width, size.height);
    const postfx::PlanImage foreground = background.output(1);
    const postfx::PlanImage foreground_shape = background.output(2);
    const postfx::PlanImage tiles = out.pass("tiles", "depth_of_field_tiles.glsl")
                                        .reads("shape", foreground_shape, "nearest")
                                        .reads("background", background, "nearest")
                                        .constant("DEPTH_OF_FIELD_TILE", tile_size)
                                        .format("rg32f")
                                        .sized(size.tiles_x, size.tiles_y);
    const postfx::PlanImage reach = out.pass("reach", "depth_of_field_reach.glsl")
                                        .reads("tiles", tiles, "nearest")
                                        .format("rg32f")
                                        .sized(size.tiles_x, size.tiles_y);
    const postfx::PlanImage blurred_background = out.pass("background", "depth_of_field_background.glsl")
                                                     .reads("layer", background, "nearest")
                                                     .reads("reach", reach, "nearest")
                                                     .constant("DEPTH_OF_FIELD_TILE", tile_size)
                                                     .sized(size.width, size.height);
    const postfx::PlanImage blurred_foreground = out.pass("foreground", "depth_of_field_foreground.glsl")
                                                     .reads("layer", foreground, "nearest")
                                                     .reads("shape", foreground_shape, "nearest")
                                                     .reads("reach", reach, "nearest")
                                                     .constant("DEPTH_OF_FIELD_TILE", tile_size)
                                                     .sized(size.width, size.height);
    out.compose("depth_of_field.glsl")
        .reads("depth", depth, "nearest")
        .reads("background", blurred_background, "nearest")
        .reads("foreground", blurred_foreground, "nearest")
        .reads("reach", reach, "nearest")
        .value("lens", lens.scale, lens.offset, lens.sky, lens.limit)
        .value("sharp_diameter", sharp_diameter)
        .value("softening", softening)
        .int_value("block", size.block)
        .constant("DEPTH_OF_FIELD_TILE", tile_size);
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    if (in.number("f_number") == pinhole) return out.identity("the f-number is that of a pinhole");
    const double largest_allowed = in.number("max_circle_of_confusion") * in.height();
    if (largest_allowed <= sharp_diameter) {
        return out.identity("max_circle_of_confusion is at most one pixel, which counts as sharp");
    }
    if (focus_metres(in) <= in.number("focal_length") / 1000) {
        const std::string text = "the focus distance is " + std::to_string(focus_metres(in))
                                 + " m, but a lens can only focus beyond its focal length of "
                                 + std::to_string(in.number("focal_length")) + " mm";
        return out.refuse(text.c_str());
    }
    if (!in.has("depth")) return out.not_called_for("visible", "there is no depth attachment to focus by");
    Lens lens = in.camera().orthographic ? orthographic_lens(in) : perspective_lens(in);
    if (lens.limit <= sharp_diameter) {
        return out.not_called_for(
            "exact", "from the near plane to the sky every circle of confusion is at most one pixel");
    }
    lens.limit = std::min(lens.limit, largest_allowed);
    lens.sky = std::min(lens.sky, lens.limit);
    declare_passes(in, out, lens);
}

constexpr auto depth_of_field = postfx::effect<plan>("depth_of_field")
                                    .about("Blur of what is not in focus, as by a lens")
                                    .with_parameters(parameters)
                                    .reading(attachments);

} // namespace

POSTFX_MODULE(&depth_of_field)
