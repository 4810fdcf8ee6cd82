// Ambient occlusion from depth and normals, by slices of the horizon. README.md has the model and its limits.
#include <postfx/plugin.hpp>

#include <algorithm>
#include <cstdint>

namespace {

constexpr const char* choices_without_ambient[] = {"skip", "multiply"};
enum WithoutAmbient { skip, multiply };
constexpr const char* views[] = {"picture", "visibility"};
enum View { picture, visibility };

constexpr postfx::Parameter parameters[] = {
    postfx::number("radius", 1)
        .range(0, 1000)
        .in_unit("m")
        .identity_at(0)
        .about("Surfaces farther away than this do not occlude"),
    postfx::number("strength", 1).range(0, 1).identity_at(0).about("Share of the occlusion that is applied"),
    postfx::number("falloff", 0.6)
        .range(0, 1)
        .about("Last part of the radius over which occlusion fades out; 0: all or nothing"),
    postfx::choice("without_ambient", choices_without_ambient)
        .about("If the ambient share of the light is not known: skip, or multiply all light"),
    postfx::choice("view", views).about("picture, or the ambient visibility alone"),
};
constexpr const char* attachments[] = {"depth", "normal", "ambient"};

/// Of one pixel's estimate, and of the images that it is made in.
struct Gather {
    int block;        ///< one texel for every block x block pixels
    int slices;       ///< planes through the line of sight
    int steps;        ///< samples on either side of it, per slice
    int closing;      ///< more of them where a surface leaves the radius
    bool interleaved; ///< 3x3 texels look along different slices, and are averaged by the denoiser
};

enum LevelIndex { low, medium, high, ultra, reference, classic };
constexpr postfx_level levels[] = {
    postfx::level("low", "1 slice of 2 x 4 samples for every 3x3 pixels, denoised"),
    postfx::level("medium", "1 slice of 2 x 5 samples for every 2x2 pixels, denoised"),
    postfx::level("high", "2 slices of 2 x 6 samples for every pixel, denoised"),
    postfx::level("ultra", "4 slices of 2 x 12 samples for every pixel, denoised"),
    postfx::level("reference", "24 slices of 2 x 64 samples for every pixel; slow"),
    postfx::level("classic", "share of 80 pixels around that are nearer; darkens slopes"),
};
constexpr Gather gathers[] = {
    {3, 1, 4, 2, true}, {2, 1, 5, 3, true}, {1, 2, 6, 3, true}, {1, 4, 12, 4, true}, {1, 24, 64, 4, false}};

/// Below this the sphere of influence [pixels] lies within a pixel's nearest neighbours.
constexpr double smallest_radius = 1.3;

/// Texels of the gathered image that are drawn, or not, together. Small tiles follow the skyline better, large ones
/// are fewer.
constexpr int tile_side = 32;

std::uint32_t divide_up(int size, int part) {
    return static_cast<std::uint32_t>((size + part - 1) / part);
}

/// Projected radius [pixels] at the nearest place where there may be a surface.
double largest_radius(const postfx::Request& in) {
    const postfx_camera& camera = in.camera();
    const double nearest = std::max(camera.near_plane, in.scene().nearest);
    const double metres_high =
        camera.orthographic != 0 ? camera.vertical_extent : 2 * camera.tan_half_fov * nearest;
    return in.number("radius") * in.height() / metres_high;
}

/// An image of (occlusion, metres along the view axis), one texel per block of pixels.
postfx::PlanImage declare_gather(const postfx::Request& in, postfx::Builder& out, const Gather& gather) {
    const std::uint32_t width = divide_up(in.width(), gather.block);
    const std::uint32_t height = divide_up(in.height(), gather.block);
    const postfx::PlanImage depth = out.attachment("depth");
    postfx::PlanImage distances;
    if (in.has("normal")) {
        distances = out.pass("geometry", "ssao_geometry.glsl")
                        .reads("depth", depth, "nearest")
                        .reads("normal", out.attachment("normal"), "nearest")
                        .constant("SSAO_BLOCK", gather.block)
                        .formats({"r32f", "rgba16f"})
                        .sized(width, height);
    } else {
        distances = out.pass("geometry", "ssao_geometry_rebuilt.glsl")
                        .reads("depth", depth, "nearest")
                        .constant("SSAO_BLOCK", gather.block)
                        .formats({"r32f", "rgba16f"})
                        .sized(width, height);
    }
    const postfx::PlanImage normals = distances.output(1);
    const postfx::PlanImage tiles = out.pass("tiles", "ssao_tiles.glsl")
                                        .reads("distances", distances, "nearest")
                                        .constant("SSAO_TILE", tile_side)
                                        .format("r8")
                                        .sized(divide_up(static_cast<int>(width), tile_side),
                                               divide_up(static_cast<int>(height), tile_side));
    const postfx::PlanImage gathered = out.pass("gather", "ssao_gather.glsl")
                                           .reads("distances", distances, "nearest")
                                           .reads("normals", normals, "nearest")
                                           .constant("SSAO_BLOCK", gather.block)
                                           .constant("SSAO_SLICES", gather.slices)
                                           .constant("SSAO_STEPS", gather.steps)
                                           .constant("SSAO_CLOSING", gather.closing)
                                           .constant("SSAO_INTERLEAVED", gather.interleaved ? 1 : 0)
                                           .format("rg32f")
                                           .sized(width, height)
                                           .where(tiles, tile_side);
    if (!gather.interleaved) return gathered;
    return out.pass("denoise", "ssao_denoise.glsl")
        .reads("occlusion", gathered, "nearest")
        .reads("normals", normals, "nearest")
        .constant("SSAO_BLOCK", gather.block)
        .format("rg32f")
        .sized(width, height)
        .where(tiles, tile_side);
}

/// The seed of this effect: its stride is what makes its radius some per cent of the height.
postfx::PlanImage declare_classic(const postfx::Request& in, postfx::Builder& out) {
    return out.pass("classic", "ssao_classic.glsl")
        .reads("depth", out.attachment("depth"), "nearest")
        .int_value("stride", 1 + in.height() / 240)
        .format("rg32f");
}

void declare_passes(const postfx::Request& in, postfx::Builder& out) {
    const bool is_classic = in.level() == classic;
    const int block = is_classic ? 1 : gathers[in.level()].block;
    const postfx::PlanImage depth = out.attachment("depth");
    const postfx::PlanImage occlusion =
        is_classic ? declare_classic(in, out) : declare_gather(in, out, gathers[in.level()]);
    const bool shows_picture = in.choice("view") == picture, has_ambient = in.has("ambient");
    const bool checks_normal = in.has("normal") && (is_classic || block > 1);
    const char* source = !shows_picture ? "ssao_view.glsl" : has_ambient ? "ssao.glsl" : "ssao_multiply.glsl";
    postfx::PassDeclaration pass = out.compose(source);
    pass.reads("depth", depth, "nearest")
        .reads("occlusion", occlusion, "nearest")
        .reads("normal", checks_normal ? out.attachment("normal") : depth, "nearest")
        .constant("SSAO_BLOCK", block)
        .constant("SSAO_CHECKS_NORMAL", checks_normal ? 1 : 0);
    if (shows_picture && has_ambient) pass.reads("ambient", out.attachment("ambient"), "nearest");
}

void plan(const postfx::Request& in, postfx::Builder& out) {
    const bool shows_picture = in.choice("view") == picture;
    if (shows_picture && in.number("strength") == 0 && out.identity("strength is 0")) return;
    if (shows_picture && in.number("radius") == 0 && out.identity("radius is 0")) return;
    if (!in.has("depth")) return out.lacks("there is no depth attachment");
    const bool needs_ambient = shows_picture && in.choice("without_ambient") == skip;
    if (needs_ambient && !in.has("ambient")) {
        return out.lacks("there is no ambient attachment, and only ambient light is occluded "
                         "(without_ambient: multiply would darken all light)");
    }
    if (shows_picture) {
        if (in.is_empty("depth") && out.not_called_for("exact", "there is only sky in view")) return;
        if (needs_ambient && in.is_empty("ambient")
            && out.not_called_for("exact", "there is no ambient light"))
            return;
        if (largest_radius(in) < smallest_radius
            && out.not_called_for("visible",
                                  "even at the nearest surface the radius is less than 1.3 pixels")) {
            return;
        }
    }
    declare_passes(in, out);
}

constexpr auto ssao = postfx::effect<plan>("ssao")
                          .about("Ambient occlusion: less ambient light in corners and under things")
                          .with_parameters(parameters)
                          .reading(attachments)
                          .with_levels(levels, medium);

} // namespace

POSTFX_MODULE(&ssao)
