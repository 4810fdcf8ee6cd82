// Depth of field of a thin lens, from colour and depth. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace {

constexpr double pinhole = 128; ///< the f-number that counts as infinite

constexpr const char* views[] = {"picture", "circle_of_confusion"};
enum View { picture, circle_of_confusion };

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
    postfx::number("axial_aberration", 0)
        .range(0, 0.05)
        .about(
            "How much longer the focal length is for red than for blue, as a share of it; 0.016 is one lens "
            "of crown glass"),
    postfx::choice("view", views)
        .constant()
        .about("picture, or the circle's diameter [px]: red in front of the focus, blue behind"),
};
constexpr const char* attachments[] = {"depth"};

/// Of a gathered disc, texels: the texel itself.
constexpr double smallest_radius = 0.5;

/// Of the levels that gather in layers.
struct Gather {
    int largest_radius; ///< texels; for larger circles the layers get coarser, so that the cost does not grow
    int finest_block;   ///< a texel of the layers is at least so many pixels wide
    int block_step; ///< and, if not one, a multiple of this: only even ones can be interpolated by the sampler
    /// Edge of a tile, texels; even. A tile and its eight neighbours must hold everything that reaches a texel of the
    /// tile or one beside it: largest_radius + half a disc's edge + 1.
    int tile;
    /// By how much a disc's edge is wider than a texel for each pixel that a block of two or three has beyond one.
    /// Interpolated, an edge of one texel would show the texels' corners, and the more the larger those are.
    double softening;

    /// Texels over which a disc's edge falls.
    double edge(int block) const { return 1 + softening * std::min(block - 1, 2); }
    /// Of a gathered disc: where a texel is a pixel it may be wider than the circle, see own_spread().
    double widest() const { return largest_radius + 0.1; }
};

enum LevelIndex { low, medium, ultra, reference, classic };
constexpr postfx_level levels[] = {
    postfx::level("low", "Discs in layers of a quarter of the size at 720 rows"),
    postfx::level("medium", "Discs in layers of half the size at 720 rows"),
    postfx::level("ultra", "Discs in layers of the full size at 720 rows"),
    postfx::level("reference", "Discs of every pixel, of any radius; slow"),
    postfx::level("classic", "Mean of a square; leaks, and near surfaces keep sharp edges"),
};
constexpr Gather gathers[] = {
    {4, 2, 2, 8, 0}, {7, 2, 1, 16, 0.25}, {14, 1, 1, 16, 0.25}, {40, 1, 1, 48, 0.25}};

/// Pictures with fewer rows than twice this have layers of the full size.
constexpr int rows_of_a_pixel = 360;

/// Circles up to this diameter [px] count as sharp and stay untouched.
constexpr double sharp_diameter = 1;
/// Difference of circles [px] over which sharp turns into blurred.
constexpr double shortest_transition = 0.5;
/// Edge of what is drawn or not as a whole, in tiles: these follow what reaches where, but are too small to draw
/// singly.
constexpr int tiles_of_a_mask = 4;
/// Entries of the table of the discs' weights. Between them the sum is off by at most 1.1 %, at 0.62 texels, where the
/// first neighbours come in.
constexpr int disc_entries = 1024;
/// Of the layers. Every texel is read over a hundred times, and software rasterisers pay for each conversion from half
/// floats as much as for the fetch.
constexpr const char* gathered = "rgba32f";

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
    if (in.number("f_number") == pinhole) return 0;
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
    const double far_away = per_metre > 0 ? std::numeric_limits<double>::infinity() : 0;
    return {per_metre * camera.depth_scale, per_metre * (camera.depth_offset - focus), far_away, far_away};
}

/// Shift of the signed circle [px] for red, green and blue. The sensor stays where green (549 nm) is sharp; a focal
/// length longer by the share e moves the focus from S to 1/S' = 1/S - e/f, and with it every circle by -K S e/f.
struct AxialShift {
    double red = 0, green = 0, blue = 0;
    bool any() const { return red != 0 || blue != 0; }
    double reach() const { return std::max(std::abs(red), std::abs(blue)); }
};

AxialShift axial_shift(const postfx::Request& in, double limit) {
    const postfx_camera& camera = in.camera();
    const double heights =
        camera.orthographic != 0 ? focus_metres(in) / camera.vertical_extent : 1 / (2 * camera.tan_half_fov);
    // Cauchy's n = A + B / wavelength^2 at 612, 549 and 464 nm: shares of the difference between red and blue.
    constexpr double red = 1 / (0.612 * 0.612), green = 1 / (0.549 * 0.549), blue = 1 / (0.464 * 0.464);
    const double whole =
        std::min(in.number("axial_aberration") * heights * in.height() / in.number("f_number"), limit);
    return {-whole * (green - red) / (blue - red), 0, whole * (blue - green) / (blue - red)};
}

/// Square of the radius [texels] of a disc that spreads as much as all but the gathered disc does (radius^2 = 4
/// variances), beyond what pixels do anyway: those are squares of light, seen by squares. edge: of a disc, texels.
double own_spread(int block, double edge) {
    const double pixel = 1.0 / (block * block); // texels^2
    const double averaging = (1 - pixel) / 12;
    const double soft_edge = edge * edge * 5 / 48;
    const double interpolation = block == 1 ? 0 : block % 2 == 0 ? 1.0 / 6 + pixel / 12 : (1 - pixel) / 6;
    return 4 * (averaging + soft_edge + interpolation - pixel / 6);
}

/// 1 / (the smallest circle [px] that the layers can blur by - the largest sharp one).
double share_slope(int block, double spread) {
    const double radius = block * std::sqrt(std::max(spread + smallest_radius * smallest_radius, 0.0));
    return 1 / (std::max(2 * radius, shortest_transition + sharp_diameter) - sharp_diameter);
}

std::uint32_t divide_up(int size, int part) {
    return static_cast<std::uint32_t>((size + part - 1) / part);
}

int up_to_multiple(int size, int unit) {
    return static_cast<int>(divide_up(size, unit)) * unit;
}

/// What the passes of one picture agree on.
struct Layout {
    Gather level;
    Lens lens;
    AxialShift shift;
    int block;                   ///< pixels
    std::uint32_t width, height; ///< of the layers, texels
    std::uint32_t across, along; ///< of the tiles
    std::uint32_t masked;        ///< edge of what is drawn or not as a whole, texels

    double texels() const { return 0.5 / block; } ///< of radius per pixel of diameter
    double edge() const { return level.edge(block); }
    double spread() const { return own_spread(block, edge()); }
    double axial_reach() const;
};

Layout layout_of(const postfx::Request& in, const Lens& lens, const Gather& level) {
    const AxialShift shift = axial_shift(in, lens.limit);
    // Small pictures have finer layers, or their look would be another.
    const int finest = std::min(level.finest_block, std::max(1, in.height() / rows_of_a_pixel));
    const double largest = (lens.limit + shift.reach()) / 2; // pixels
    const int fitting = std::max(finest, static_cast<int>(std::ceil(largest / level.largest_radius)));
    const int block = fitting == 1 ? 1 : up_to_multiple(fitting, level.block_step);
    return {.level = level,
            .lens = lens,
            .shift = shift,
            .block = block,
            .width = divide_up(in.width(), block),
            .height = divide_up(in.height(), block),
            .across = divide_up(in.width(), block * level.tile),
            .along = divide_up(in.height(), block * level.tile),
            .masked = static_cast<std::uint32_t>(level.tile * tiles_of_a_mask)};
}

/// By how much a gathered disc's radius [texels] grows at most by axial aberration: of the smallest the most is taken
/// off, which a larger circle gets back.
double Layout::axial_reach() const {
    const double shifted = shift.reach() * texels();
    const double circle = std::sqrt(std::max(spread() + smallest_radius * smallest_radius, 0.0)) + shifted;
    return std::max(shifted, std::sqrt(std::max(circle * circle - spread(), 0.0)) - smallest_radius);
}

/// The picture split in two.
struct Layers {
    postfx::PlanImage background, foreground, thickness;
};

Layers declare_layers(postfx::Builder& out, const Layout& layout) {
    const double widest = layout.level.widest();
    const postfx::PlanImage discs = out.pass("discs", "depth_of_field_discs.glsl")
                                        .value("largest_radius", widest)
                                        .constant("DEPTH_OF_FIELD_EDGE", layout.edge())
                                        .format("r32f")
                                        .sized(disc_entries, 1);
    const Lens& lens = layout.lens;
    const postfx::PlanImage layers =
        out.pass("layers", "depth_of_field_layers.glsl")
            .reads("source", out.color(), "nearest")
            .reads("depth", out.attachment("depth"), "nearest")
            .reads("discs", discs, "nearest")
            .value("lens", lens.scale, lens.offset, lens.sky, lens.limit)
            .value("entries_per_texel", (disc_entries - 1) / (widest - smallest_radius))
            .constant("DEPTH_OF_FIELD_BLOCK", layout.block)
            .constant("DEPTH_OF_FIELD_SLOPE", share_slope(layout.block, layout.spread()))
            .constant("DEPTH_OF_FIELD_SPREAD", layout.spread())
            .formats({gathered, gathered, "r32f"})
            .sized(layout.width, layout.height);
    return {layers, layers.output(1), layers.output(2)};
}

/// What can reach each tile, and which squares of tiles are to be drawn.
struct Reach {
    postfx::PlanImage radii, blurred, covered;
};

Reach declare_reach(postfx::Builder& out, const Layout& layout, const Layers& layers) {
    const postfx::PlanImage tiles = out.pass("tiles", "depth_of_field_tiles.glsl")
                                        .reads("foreground", layers.foreground, "nearest")
                                        .reads("background", layers.background, "nearest")
                                        .constant("DEPTH_OF_FIELD_TILE", layout.level.tile)
                                        .format("rgba32f")
                                        .sized(layout.across, layout.along);
    const postfx::PlanImage reach = out.pass("reach", "depth_of_field_reach.glsl")
                                        .reads("tiles", tiles, "nearest")
                                        .formats({"rgba32f", "r8"})
                                        .sized(layout.across, layout.along);
    const postfx::PlanImage mask = out.pass("mask", "depth_of_field_mask.glsl")
                                       .reads("reach", reach, "nearest")
                                       .reads("blurred", reach.output(1), "nearest")
                                       .constant("DEPTH_OF_FIELD_MASK", tiles_of_a_mask)
                                       .formats({"r8", "r8"})
                                       .sized(divide_up(static_cast<int>(layout.across), tiles_of_a_mask),
                                              divide_up(static_cast<int>(layout.along), tiles_of_a_mask));
    return {reach, mask, mask.output(1)};
}

/// A pass that sums discs for squares of 2x2 texels. side: 1 behind the focus, -1 before it, where a circle grows by
/// what it shrinks by behind.
postfx::PlanImage gather(const Layout& layout, double side, postfx::PassDeclaration& pass,
                         postfx::PlanImage mask) {
    const double texels = side * layout.texels();
    return pass.value("axial_shift", layout.shift.red * texels, layout.shift.blue * texels)
        .value("axial_reach", layout.axial_reach())
        .constant("DEPTH_OF_FIELD_TILE", layout.level.tile)
        .constant("DEPTH_OF_FIELD_EDGE", layout.edge())
        .constant("DEPTH_OF_FIELD_SPREAD", layout.spread())
        .constant("DEPTH_OF_FIELD_AXIAL", layout.shift.any() ? 1 : 0)
        .formats({gathered, gathered, gathered, gathered})
        .sized((layout.width + 1) / 2, (layout.height + 1) / 2)
        .where(mask, layout.masked / 2);
}

/// Lets a pass read the texels of those squares.
postfx::PassDeclaration& reads_squares(postfx::PassDeclaration&& pass, postfx::PlanImage squares) {
    return pass.reads("first", squares, "nearest")
        .reads("second", squares.output(1), "nearest")
        .reads("third", squares.output(2), "nearest")
        .reads("fourth", squares.output(3), "nearest");
}

postfx::PlanImage blurred_foreground(postfx::Builder& out, const Layout& layout, const Layers& layers,
                                     const Reach& reach) {
    const postfx::PlanImage squares =
        gather(layout, -1,
               out.pass("gather_foreground", "depth_of_field_gather_foreground.glsl")
                   .reads("layer", layers.foreground, "nearest")
                   .reads("thickness", layers.thickness, "nearest")
                   .reads("reach", reach.radii, "nearest"),
               reach.covered);
    return reads_squares(out.pass("foreground", "depth_of_field_foreground.glsl"), squares)
        .format(gathered)
        .sized(layout.width, layout.height)
        .where(reach.covered, layout.masked);
}

postfx::PlanImage blurred_background(postfx::Builder& out, const Layout& layout, const Layers& layers,
                                     const Reach& reach, postfx::PlanImage foreground) {
    const postfx::PlanImage squares =
        gather(layout, 1,
               out.pass("gather_background", "depth_of_field_gather_background.glsl")
                   .reads("layer", layers.background, "nearest")
                   .reads("reach", reach.radii, "nearest"),
               reach.blurred);
    return reads_squares(out.pass("background", "depth_of_field_background.glsl"), squares)
        .reads("layer", layers.background, "nearest")
        .reads("before", layers.foreground, "nearest")
        .reads("covered", foreground, "nearest")
        .reads("reach", reach.radii, "nearest")
        .constant("DEPTH_OF_FIELD_TILE", layout.level.tile)
        .constant("DEPTH_OF_FIELD_EDGE", layout.edge())
        .format(gathered)
        .sized(layout.width, layout.height)
        .where(reach.blurred, layout.masked);
}

/// The picture split into background and foreground, each blurred at a reduced size.
void declare_gathers(const postfx::Request& in, postfx::Builder& out, const Lens& lens, const Gather& level) {
    const Layout layout = layout_of(in, lens, level);
    const Layers layers = declare_layers(out, layout);
    const Reach reach = declare_reach(out, layout, layers);
    const postfx::PlanImage foreground = blurred_foreground(out, layout, layers, reach);
    const postfx::PlanImage background = blurred_background(out, layout, layers, reach, foreground);
    const int block = layout.block;
    const char* filter = block == 1 ? "nearest" : "linear";
    out.compose("depth_of_field.glsl")
        .constant("DEPTH_OF_FIELD_BY_HAND", block > 1 && block % 2 == 1 ? 1 : 0)
        .reads("depth", out.attachment("depth"), "nearest")
        .reads("background", background, filter)
        .reads("foreground", foreground, filter)
        .value("lens", lens.scale, lens.offset, lens.sky, lens.limit)
        .value("layer_scale", 1 / (double(block) * layout.width), 1 / (double(block) * layout.height))
        .constant("DEPTH_OF_FIELD_SLOPE", share_slope(block, layout.spread()));
}

postfx::PlanImage declare_classic(postfx::Builder& out, const Lens& lens) {
    return out.pass("classic", "depth_of_field_classic.glsl")
        .reads("source", out.color(), "nearest")
        .reads("depth", out.attachment("depth"), "nearest")
        .value("lens", lens.scale, lens.offset, lens.sky, lens.limit);
}

void declare_passes(const postfx::Request& in, postfx::Builder& out, const Lens& lens) {
    if (in.choice("view") == circle_of_confusion) {
        out.compose("depth_of_field_view.glsl")
            .reads("depth", out.attachment("depth"), "nearest")
            .value("lens", lens.scale, lens.offset, lens.sky, lens.limit);
    } else if (in.level() == classic) {
        out.compose("depth_of_field_whole.glsl").reads("blurred", declare_classic(out, lens), "nearest");
    } else {
        declare_gathers(in, out, lens, gathers[in.level()]);
    }
}

/// Is it known that nothing is out of focus? The largest circle is that of the nearest surface, of the farthest, or
/// of the sky: it only grows with the distance in 1/z from the focus. Asks the frame where the scene's bounds don't
/// tell.
bool is_skipped_as_sharp(const postfx::Request& in, postfx::Builder& out, const Lens& lens) {
    const postfx_camera& camera = in.camera();
    const double focus = focus_metres(in), aperture = aperture_metres(in) * in.height();
    const bool parallel = camera.orthographic != 0;
    // c = scale * (1 - focus / z), or scale * (z / focus - 1)
    const double scale =
        parallel ? aperture / camera.vertical_extent : aperture / (2 * focus * camera.tan_half_fov);
    const double nearest = std::max(in.scene().nearest, camera.near_plane);
    const double at_nearest = parallel ? scale * (nearest / focus - 1) : scale * (1 - focus / nearest);
    const double shift = axial_shift(in, lens.limit).reach();
    // Rounding in float32 must not lift a circle over the limit that was below it in float64.
    constexpr double limit = sharp_diameter * 0.9999;
    const double largest = std::max(std::abs(at_nearest), std::abs(lens.sky)) + shift;
    if (largest <= limit) {
        return out.not_called_for("exact", "the largest circle of confusion is " + std::to_string(largest)
                                               + " pixels, up to 1 counts as sharp");
    }
    out.skip_when("exact", "depth_of_field_sharp.glsl", "largest circle of confusion [px]",
                  "what counts as sharp")
        .reads("depth", out.attachment("depth"), "nearest")
        .value("circle", scale, focus, lens.sky, shift)
        .value("limit", limit)
        .constant("DEPTH_OF_FIELD_PARALLEL", parallel ? 1 : 0);
    return false;
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    const bool shows_picture = in.choice("view") == picture;
    if (shows_picture && in.number("f_number") == pinhole
        && out.identity("the f-number is that of a pinhole"))
        return;
    const double largest_allowed = in.number("max_circle_of_confusion") * in.height();
    if (shows_picture && largest_allowed <= sharp_diameter
        && out.identity("max_circle_of_confusion is at most one pixel, which counts as sharp")) {
        return;
    }
    if (focus_metres(in) <= in.number("focal_length") / 1000) {
        const std::string text = "the focus distance is " + std::to_string(focus_metres(in))
                                 + " m, but a lens can only focus beyond its focal length of "
                                 + std::to_string(in.number("focal_length")) + " mm";
        return out.refuse(text.c_str());
    }
    if (!in.has("depth")) return out.lacks("there is no depth attachment to focus by");
    Lens lens = in.camera().orthographic ? orthographic_lens(in) : perspective_lens(in);
    if (shows_picture && is_skipped_as_sharp(in, out, lens)) return;
    lens.limit = std::min(lens.limit, largest_allowed);
    lens.sky = std::min(lens.sky, lens.limit);
    declare_passes(in, out, lens);
}

constexpr auto depth_of_field = postfx::effect<plan>("depth_of_field")
                                    .about("Blur of what is not in focus, as by a lens")
                                    .with_parameters(parameters)
                                    .reading(attachments)
                                    .with_levels(levels, medium)
                                    .without_amplifying();

} // namespace

POSTFX_MODULE(&depth_of_field)
