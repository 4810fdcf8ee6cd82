// How an EXR file's channels make layers and views. Names only, no pixels.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace postfx::formats {

struct ExrChannel {
    std::string name{}; ///< as its part has it
    std::string type{}; ///< "half", "float", "uint"
    bool subsampled = false;
};

/// What a part's header says of names.
struct ExrPart {
    std::string name{}, view{};
    std::vector<ExrChannel> channels{};
};

/// Channels that belong together.
struct ExrLayer {
    enum class Shape {
        color,            ///< R, G, B in this order, in the file or not; alpha may follow
        grey,             ///< Y; alpha may follow
        luminance_chroma, ///< Y, RY, BY; alpha may follow
        vector,           ///< X, Y, Z
        single,           ///< one channel
        other             ///< u and v of a flow, and the like
    };

    std::string name{}; ///< "ViewLayer.Combined"; "" for R, G, B without a prefix
    std::string path{}; ///< the same with the view, as the file spells it: "ViewLayer.Combined.left"
    std::string view{}; ///< "" if it belongs to none
    int part = 0;
    Shape shape = Shape::other;
    std::vector<std::string> channels{}; ///< as the part has them
    bool has_alpha = false;              ///< the last of `channels`
    bool has_light = true; ///< false for uint channels and Cryptomatte: numbers that name objects

    /// What it is called towards the user, and found by: its name, or "R,G,B,A".
    std::string label() const;
    /// "ViewLayer" of "ViewLayer.Combined": what was rendered together.
    std::string family() const;
    /// "Combined" of "ViewLayer.Combined".
    std::string pass() const;
};

struct ExrContents {
    std::vector<std::string> views{}; ///< in the file's order; empty in a file without views
    std::string default_view{};
    std::vector<ExrLayer> layers{};

    /// May `layer` serve who looks for `view`? What belongs to no view belongs to the default one.
    bool is_in_view(const ExrLayer& layer, const std::string& view) const;
};

/// `multi_view`: the attribute of that name, or empty. `mattes`: names that Cryptomatte's attributes tell.
ExrContents contents_of(const std::vector<ExrPart>& parts, const std::vector<std::string>& multi_view,
                        const std::set<std::string>& mattes);

/// What follows the last dot, and what is before it.
std::string after_last_dot(const std::string& name);
std::string before_last_dot(const std::string& name);

} // namespace postfx::formats
