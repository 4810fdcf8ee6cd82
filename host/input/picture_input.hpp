// A picture that someone else made, with what belongs to it, from files to what a chain wants.
#pragma once

#include "depth_input.hpp"
#include "layer_input.hpp"
#include "normal_input.hpp"
#include "photo_camera.hpp"

#include <image/files.hpp>

#include <postfx/camera.hpp>

#include <CLI/CLI.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

struct PictureInput {
    std::shared_ptr<const ImageSource> source; ///< the colour's file, and
    ImageRequest request; ///< how the colour was asked of it: to write the picture back into it
    ImageFile color;      ///< its image has four channels
    Camera camera;
    std::map<std::string, Image> attachments; ///< by name; everything but the colour, of the colour's size
};

/// Options that name files and say what is in them: --color, --depth, ..., --view, --strict.
class PictureOptions {
public:
    void declare(CLI::App& app);

    /// Reads everything. What was brought into shape is told on stderr, or refused with --strict; what files say of
    /// their pixels and was followed is told unless `quiet`. Throws Error naming file and option.
    PictureInput read(bool quiet) const;
    bool strict() const { return strict_; }
    /// Does an EXR go out with all that was in it?
    bool carries() const { return layer_options_.carries(); }

private:
    class Reading;

    std::string color_, depth_, normal_, emission_, ambient_;
    std::string focus_at_;
    bool strict_ = false;
    LayerOptions layer_options_;
    DepthOptions depth_options_;
    NormalOptions normal_options_;
};

} // namespace postfx::host
