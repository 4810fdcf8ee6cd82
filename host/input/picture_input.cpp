#include "picture_input.hpp"

#include "terminal/warnings.hpp"

#include <image/orientation.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace postfx::host {
namespace {

/// Four channels; grey is repeated, missing alpha is 1.
Image widened(const Image& image) {
    Image result(image.width, image.height, 4, 1.0f);
    const bool grey = image.channels < 3, has_alpha = image.channels % 2 == 0;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float* from = image.values.data() + i * static_cast<std::size_t>(image.channels);
        float* to = result.values.data() + 4 * i;
        for (int c = 0; c < 3; ++c)
            to[c] = from[grey ? 0 : c];
        if (has_alpha) to[3] = from[image.channels - 1];
    }
    return result;
}

/// "X,Y", shares of width and height from the top left.
PicturePoint parse_point(const std::string& text) {
    PicturePoint point;
    char end = 0;
    const bool two = std::sscanf(text.c_str(), "%lf,%lf%c", &point.x, &point.y, &end) == 2;
    const auto inside = [](double share) { return share >= 0 && share <= 1; };
    if (!two || !inside(point.x) || !inside(point.y))
        throw Error(
            fmt::format("--focus-at \"{}\" is not X,Y with shares of the picture's width and height from "
                        "its top left, both 0 to 1, such as 0.4,0.6",
                        text));
    return point;
}

} // namespace

void PictureOptions::declare(CLI::App& app) {
    const auto image = [&](const char* name, std::string& file, const char* help) {
        return app.add_option(name, file, help)->type_name("IMG");
    };
    image("--color", color_, "The picture, of any kind that `inspect` knows; - is standard input")
        ->required();
    image("--depth", depth_, "Its depth (without: the depth map that a phone's photograph brings along)");
    image("--normal", normal_, "Its normals; codes as 0.5 + n/2");
    image("--emission", emission_, "Light that surfaces emit, part of the picture");
    image("--ambient", ambient_, "The picture's share that occlusion may darken");
    app.add_option("--focus-at", focus_at_,
                   "Focus the camera on what is seen there: shares of width and height from the top left")
        ->type_name("X,Y")
        ->default_str("");
    app.add_flag("--strict", strict_,
                 "Refuse files that have to be brought into shape, instead of telling so");
    layer_options_.declare(app);
    depth_options_.declare(app);
    normal_options_.declare(app);
}

/// One picture being read. A file that is named in several roles is read once: a pipe gives its bytes only once.
class PictureOptions::Reading {
public:
    Reading(const PictureOptions& options, bool quiet) : options_(options), quiet_(quiet) {}

    PictureInput read() {
        read_color();
        read_depth();
        read_normal();
        read_light(Role::emission, options_.emission_);
        read_light(Role::ambient, options_.ambient_);
        if (!options_.focus_at_.empty()) focus(parse_point(options_.focus_at_));
        return std::move(input_);
    }

private:
    void read_color() {
        input_.source = source(options_.color_);
        input_.request = options_.layer_options_.color_request();
        input_.color = file(*input_.source, input_.request);
        input_.color.image = widened(input_.color.image);
        input_.camera = options_.depth_options_.camera(width(), height(),
                                                       vertical_fov_of(input_.color.shot, width(), height()));
    }

    void read_depth() {
        const bool own = options_.depth_.empty();
        if (own && !input_.color.has_depth_map) return;
        const std::string& name = own ? options_.color_ : options_.depth_;
        DepthSamples depth = options_.depth_options_.read(name, measurement(Role::depth, name),
                                                          input_.color.image, input_.camera);
        tell_or_refuse(name, depth.warnings, options_.strict_);
        tell_lines(name, depth.remarks, false);
        input_.attachments["depth"] = std::move(depth.samples);
    }

    void read_normal() {
        if (options_.normal_.empty()) return;
        const std::string& name = options_.normal_;
        const ImageFile file = measurement(Role::normal, name);
        check_size(file.image, name);
        const ViewNormals normals = options_.normal_options_.read(name, file, input_.color, input_.camera);
        tell_or_refuse(name, normals.warnings, options_.strict_);
        input_.attachments["normal"] = widened(normals.image);
    }

    void read_light(Role role, const std::string& name) {
        if (name.empty()) return;
        const ImageFile light = file_in(role, name);
        check_size(light.image, name);
        input_.attachments[name_of(role)] = widened(light.image);
    }

    /// A map that belongs to the picture, turned as the picture was.
    ImageFile measurement(Role role, const std::string& name) {
        ImageFile map = file_in(role, name);
        const int orientation = input_.color.shot.orientation;
        if (map.shot.orientation != 1 || orientation == 1) return map;
        const Belonging belonging = belonging_of(map.image, width(), height(), orientation);
        if (belonging == Belonging::unknown)
            tell_or_refuse(
                name,
                {fmt::format("the picture was turned (EXIF orientation {}), and nothing says whether "
                             "this was made of it before or after; taken as made after",
                             orientation)},
                options_.strict_);
        if (belonging == Belonging::stored) {
            const bool codes = map.coding.numbers == Coding::Numbers::codes;
            map.image = role == Role::normal ? oriented_normals(
                            map.image, orientation, codes ? VectorCoding::halves : VectorCoding::as_they_are)
                                             : oriented(map.image, orientation);
            tell(name, {fmt::format("is turned along with the picture (EXIF orientation {})", orientation)});
        }
        return map;
    }

    void focus(PicturePoint point) {
        const auto depth = input_.attachments.find("depth");
        if (depth == input_.attachments.end())
            throw Error(
                "--focus-at needs a depth to look up: give --depth, or a photograph with a depth map");
        const std::optional<double> distance = distance_at(depth->second, input_.camera, point);
        if (!distance)
            throw Error(fmt::format("--focus-at {}: there is no surface to focus on", options_.focus_at_));
        input_.camera.focus_distance = *distance;
        tell(options_.color_, {fmt::format("focused {:.4g} m away", *distance)});
    }

    /// A pipe gives its bytes only once, so one file is known by any of its names.
    std::shared_ptr<const ImageSource> source(const std::string& name) {
        std::error_code ignored;
        for (const auto& known : sources_)
            if (known->name == name || std::filesystem::equivalent(known->name, name, ignored)) return known;
        return sources_.emplace_back(std::make_shared<const ImageSource>(open_image(name)));
    }

    ImageFile file_in(Role role, const std::string& name) {
        const std::shared_ptr<const ImageSource> from = source(name);
        return file(*from, options_.layer_options_.request(role, *from, {*input_.source, input_.color}));
    }

    ImageFile file(const ImageSource& source, const ImageRequest& request) const {
        ImageFile read = read_image(source, request);
        tell(source.name.string(), read.honoured);
        tell_or_refuse(source.name.string(), read.warnings, options_.strict_);
        return read;
    }

    void tell(const std::string& name, const std::vector<std::string>& lines) const {
        tell_lines(name, lines, quiet_);
    }

    void check_size(const Image& image, const std::string& name) const {
        if (image.width == width() && image.height == height()) return;
        throw Error(Place{.file = name}, fmt::format("is {}x{}, but {} is {}x{}", image.width, image.height,
                                                     options_.color_, width(), height()));
    }

    int width() const { return input_.color.image.width; }
    int height() const { return input_.color.image.height; }

    const PictureOptions& options_;
    bool quiet_;
    PictureInput input_;
    std::vector<std::shared_ptr<const ImageSource>> sources_;
};

PictureInput PictureOptions::read(bool quiet) const {
    return Reading(*this, quiet).read();
}

} // namespace postfx::host
