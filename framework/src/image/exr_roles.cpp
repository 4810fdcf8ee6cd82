#include <image/exr_roles.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <string_view>

namespace postfx::formats {
namespace {

using Shape = ExrLayer::Shape;

/// The pass as programs spell it: "Denoising Depth", "SceneDepth", "FinalImageMovieRenderQueue_WorldNormal" become
/// "denoisingdepth", "scenedepth", "worldnormal".
std::string word_of(const ExrLayer& layer) {
    std::string word;
    for (const unsigned char letter : layer.pass())
        if (letter != ' ' && letter != '_' && letter != '-') word += static_cast<char>(std::tolower(letter));
    constexpr std::string_view unreal = "movierenderqueue";
    if (const std::size_t at = word.find(unreal); at != std::string::npos) word.erase(0, at + unreal.size());
    return word;
}

/// A pass that some program gives a role; the lower rank is taken.
struct Convention {
    Role role;
    int rank;
    std::string_view word;
};

constexpr std::array conventions = {
    // OpenEXR, Nuke: R, G, B without prefix, or rgba.
    Convention{Role::color, 0, ""},
    Convention{Role::color, 0, "rgba"},
    Convention{Role::color, 0, "rgb"},
    // Blender; Arnold, Karma, Redshift; Karma; RenderMan; Unreal.
    Convention{Role::color, 1, "combined"},
    Convention{Role::color, 1, "beauty"},
    Convention{Role::color, 1, "c"},
    Convention{Role::color, 1, "ci"},
    Convention{Role::color, 1, "finalimage"},
    Convention{Role::color, 1, "pathtracer"},
    Convention{Role::color, 1, "color"},
    Convention{Role::color, 1, "main"},
    Convention{Role::color, 1, "primary"}, // 3Delight
    // Arnold, RenderMan, V-Ray; Nuke, Blender, Karma.
    Convention{Role::depth, 0, "z"},
    Convention{Role::depth, 0, "depth"},
    // V-Ray, Octane; Unreal; Mantra.
    Convention{Role::depth, 1, "zdepth"},
    Convention{Role::depth, 1, "vrayzdepth"},
    Convention{Role::depth, 1, "worlddepth"},
    Convention{Role::depth, 1, "scenedepth"},
    Convention{Role::depth, 1, "pz"},
    Convention{Role::depth, 1, "cameradepth"},
    Convention{Role::depth, 2, "denoisingdepth"}, // Blender
    // Normals in view space are what is asked for.
    Convention{Role::normal, 0, "cameranormal"},
    Convention{Role::normal, 0, "cameranormals"},
    Convention{Role::normal, 0, "normalcamera"},
    Convention{Role::normal, 0, "viewnormal"},
    Convention{Role::normal, 0, "viewnormals"},
    Convention{Role::normal, 0, "vraynormals"},
    // Arnold, Karma; Blender, Nuke; V-Ray; RenderMan.
    Convention{Role::normal, 1, "n"},
    Convention{Role::normal, 1, "normal"},
    Convention{Role::normal, 1, "normals"},
    Convention{Role::normal, 1, "nn"},
    Convention{Role::normal, 1, "shnormal"}, // Mitsuba, shading normals
    Convention{Role::normal, 1, "shadingnormal"},
    Convention{Role::normal, 1, "shadingnormals"},
    // Unreal, Redshift, RenderMan.
    Convention{Role::normal, 2, "worldnormal"},
    Convention{Role::normal, 2, "worldnormals"},
    Convention{Role::normal, 2, "normalworld"},
    Convention{Role::normal, 2, "normalsworld"},
    // V-Ray; Blender; Arnold.
    Convention{Role::normal, 3, "bumpnormals"},
    Convention{Role::normal, 3, "denoisingnormal"},
    Convention{Role::normal, 3, "ndenoise"},
    // Blender; Arnold, Karma, Blender 5; V-Ray; Mantra; Unreal; Redshift, 3Delight; Octane.
    Convention{Role::emission, 0, "emit"},
    Convention{Role::emission, 0, "emission"},
    Convention{Role::emission, 0, "selfillum"},
    Convention{Role::emission, 0, "selfillumination"},
    Convention{Role::emission, 0, "vrayselfillumination"},
    Convention{Role::emission, 0, "ce"},
    Convention{Role::emission, 0, "emissive"},
    Convention{Role::emission, 0, "incandescence"},
    Convention{Role::emission, 0, "emitters"},
    // Arnold; V-Ray; Arnold and Karma, of whose indirect light it is a share.
    Convention{Role::ambient, 0, "ambient"},
    Convention{Role::ambient, 1, "indirect"},
    Convention{Role::ambient, 1, "gi"},
    Convention{Role::ambient, 1, "vrayglobalillumination"},
    Convention{Role::ambient, 2, "diffuseindirect"},
    Convention{Role::ambient, 2, "indirectdiffuse"},
};

/// Passes that are no picture of the scene, by how their names begin: occlusion, shares of the light, surfaces, places,
/// motion, masks. AO, Mist and Z of a volume are among them: neither light nor depth.
constexpr std::array other_passes = {"ao",
                                     "ambientocclusion",
                                     "materialao",
                                     "mist",
                                     "diff",
                                     "gloss",
                                     "trans",
                                     "subsurface",
                                     "sss",
                                     "specular",
                                     "reflect",
                                     "refract",
                                     "coat",
                                     "sheen",
                                     "direct",
                                     "light",
                                     "indirect",
                                     "raw",
                                     "gi",
                                     "volume",
                                     "albedo",
                                     "basecolor",
                                     "metal",
                                     "rough",
                                     "opacity",
                                     "shadow",
                                     "caustic",
                                     "env",
                                     "environment",
                                     "background",
                                     "atmosphere",
                                     "position",
                                     "world",
                                     "p",
                                     "pref",
                                     "pworld",
                                     "uv",
                                     "st",
                                     "vector",
                                     "motion",
                                     "velocity",
                                     "forward",
                                     "backward",
                                     "disparity",
                                     "mask",
                                     "matte",
                                     "multimatte",
                                     "id",
                                     "index",
                                     "object",
                                     "material",
                                     "noisy",
                                     "denois",
                                     "debug",
                                     "variance",
                                     "sample",
                                     "effectsresult",
                                     "zback",
                                     "cputime",
                                     "raycount",
                                     "aa",
                                     "extratex",
                                     "coverage"};

/// Names that are whole words, since many others begin so.
bool is_whole_word(std::string_view name) {
    return name.size() <= 3;
}

const Convention* convention_for(const std::string& word, Role role) {
    const auto found = std::find_if(conventions.begin(), conventions.end(), [&](const Convention& entry) {
        return entry.role == role && entry.word == word;
    });
    return found == conventions.end() ? nullptr : &*found;
}

bool has_other_role(const std::string& word, Role role) {
    if (std::any_of(conventions.begin(), conventions.end(), [&](const Convention& entry) {
            return entry.role != role && !entry.word.empty() && entry.word == word;
        }))
        return true;
    return std::any_of(other_passes.begin(), other_passes.end(), [&](std::string_view pass) {
        return is_whole_word(pass) ? word == pass : word.starts_with(pass);
    });
}

bool is_picture(const ExrLayer& layer) {
    return layer.shape == Shape::color || layer.shape == Shape::grey
           || layer.shape == Shape::luminance_chroma;
}

constexpr int no_convention = 100, only_one = 200, contrary = 300,
              unsuitable = std::numeric_limits<int>::max();

/// Layers of one view, and how well they serve.
class Ranking {
public:
    Ranking(const ExrContents& contents, const LayerWish& wish, const std::string& view)
        : contents_(contents), wish_(wish) {
        for (const ExrLayer& layer : contents.layers)
            if (contents.is_in_view(layer, view)) layers_.push_back(&layer);
    }

    const std::vector<const ExrLayer*>& layers() const { return layers_; }

    /// The best ones; several if they are equally good. `rank`: how good.
    std::vector<const ExrLayer*> best(int& rank) const {
        std::vector<const ExrLayer*> found;
        rank = unsuitable;
        for (const ExrLayer* layer : layers_) {
            const int its = rank_of(*layer);
            if (its < rank) found.clear();
            rank = std::min(rank, its);
            if (its == rank && its != unsuitable) found.push_back(layer);
        }
        return found;
    }

private:
    int rank_of(const ExrLayer& layer) const {
        if (is_light(wish_.role) && !layer.has_light && layers_.size() > 1) return unsuitable;
        const int by_name = rank_by_name(layer);
        if (by_name == unsuitable) return is_alone() ? only_one : unsuitable;
        constexpr int strange_family = 1000;
        const std::optional<int> distance = distance_from_color(layer);
        return distance ? by_name + strange_family * *distance : unsuitable;
    }

    /// Nothing else is in the file, but for the same in other views: it may be anything.
    bool is_alone() const {
        return layers_.size() == 1
               && contents_.layers.size() <= std::max<std::size_t>(1, contents_.views.size());
    }

    int rank_by_name(const ExrLayer& layer) const {
        switch (wish_.role) {
        case Role::depth:
            return depth_rank(layer);
        case Role::normal:
            return map_rank(layer, layer.shape == Shape::vector || layer.shape == Shape::color);
        case Role::emission:
        case Role::ambient:
            return map_rank(layer, is_picture(layer));
        default:
            return color_rank(layer);
        }
    }

    int color_rank(const ExrLayer& layer) const {
        if (!is_picture(layer)) return unsuitable;
        const std::string word = word_of(layer);
        // Blender's compositor makes the picture of its view layers.
        if (layer.name == "Composite.Combined") return 0;
        if (const Convention* found = convention_for(word, Role::color)) return found->rank;
        return has_other_role(word, Role::color) ? contrary : no_convention;
    }

    static int depth_rank(const ExrLayer& layer) {
        const std::string word = word_of(layer);
        const Convention* found = convention_for(word, Role::depth);
        if (layer.shape != Shape::single) return found && is_picture(layer) ? found->rank : unsuitable;
        if (found) return found->rank;
        const std::string component = after_last_dot(layer.channels.front());
        const bool called_z = component == "Z" || component == "z" || component == "depth";
        return called_z && !has_other_role(word, Role::depth) ? no_convention : unsuitable;
    }

    /// Normals, emission and ambient light have a name, or are all that there is.
    int map_rank(const ExrLayer& layer, bool shape_fits) const {
        if (!shape_fits) return unsuitable;
        const std::string word = word_of(layer);
        if (const Convention* found = convention_for(word, wish_.role)) return found->rank;
        if (has_other_role(word, wish_.role) || layer.label() == wish_.beside) return unsuitable;
        const bool vector_without_name = layer.shape == Shape::vector && layer.family().empty();
        if (vector_without_name && (word.empty() || word == "x,y,z")) return no_convention;
        const auto fits = [](const ExrLayer* other) {
            return (other->shape == Shape::vector || is_picture(*other)) && other->has_light;
        };
        return std::count_if(layers_.begin(), layers_.end(), fits) == 1 ? only_one : unsuitable;
    }

    /// 0 for what was rendered with the colour; 1 if one of both is of the whole picture; else nothing.
    std::optional<int> distance_from_color(const ExrLayer& layer) const {
        if (wish_.beside.empty()) return 0;
        const std::string own = layer.family();
        const std::string color = before_last_dot(wish_.beside);
        if (own == color || own == wish_.beside) return 0;
        const bool whole = own.empty() || color.empty() || color == "Composite";
        return whole ? std::optional(1) : std::nullopt;
    }

    const ExrContents& contents_;
    const LayerWish& wish_;
    std::vector<const ExrLayer*> layers_;
};

std::string quoted(const std::vector<std::string>& names) {
    return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

std::vector<std::string> labels_of(const std::vector<const ExrLayer*>& layers) {
    std::vector<std::string> labels;
    for (const ExrLayer* layer : layers)
        labels.push_back(layer->label());
    return labels;
}

/// The option that names a layer for a role.
std::string option_for(Role role) {
    return role == Role::data || role == Role::texture ? "--layer" : fmt::format("--{}-layer", name_of(role));
}

std::string same_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return text;
}

ExrLayer single_channel(const ExrLayer& layer, const std::string& channel) {
    ExrLayer single = layer;
    single.name = single.path = channel;
    single.shape = Shape::single;
    single.channels = {channel};
    single.has_alpha = false;
    return single;
}

/// The layers and channels that are called `name`, spelt exactly so.
std::vector<ExrLayer> layers_called(const ExrContents& contents, const std::string& name) {
    std::vector<ExrLayer> found;
    for (const ExrLayer& layer : contents.layers)
        if (layer.label() == name || layer.path == name || layer.view + "." + layer.name == name)
            found.push_back(layer);
    if (!found.empty()) return found;
    for (const ExrLayer& layer : contents.layers)
        for (const std::string& channel : layer.channels)
            if (channel == name) found.push_back(single_channel(layer, channel));
    return found;
}

/// The same whatever the case of letters; then "rgba" for the channels without a prefix.
std::vector<ExrLayer> layers_almost_called(const ExrContents& contents, const std::string& name) {
    std::vector<ExrLayer> found;
    const std::string wanted = same_case(name);
    for (const ExrLayer& layer : contents.layers)
        if (same_case(layer.label()) == wanted || same_case(layer.path) == wanted) found.push_back(layer);
    if (!found.empty() || (wanted != "rgba" && wanted != "rgb")) return found;
    for (const ExrLayer& layer : contents.layers)
        if (layer.name.empty() && is_picture(layer)) found.push_back(layer);
    return found;
}

/// What the role needs of a layer that was named: nothing is taken that has too few or too many channels.
std::string misfit(const ExrLayer& layer, Role role) {
    const std::size_t count = layer.channels.size() - (layer.has_alpha ? 1 : 0);
    const std::string has =
        fmt::format("its layer \"{}\" has the channels {}", layer.label(), fmt::join(layer.channels, ", "));
    if (role == Role::depth && layer.shape != Shape::single && !is_picture(layer))
        return fmt::format("{}: depth is one of them, name it with {}", has, option_for(role));
    if (role == Role::normal && layer.shape != Shape::vector && layer.shape != Shape::color)
        return fmt::format("{}: normals have three", has);
    if (is_light(role) && !is_picture(layer) && count != 1 && count != 3)
        return fmt::format("{}: no colour", has);
    if (count > 4) return fmt::format("{}: at most four can be read, name one of them", has);
    return "";
}

LayerChoice taken(const ExrLayer& layer, Role role) {
    const std::string problem = misfit(layer, role);
    if (!problem.empty()) return {.layer = {}, .refusal = problem, .warnings = {}};
    return {.layer = layer, .refusal = {}, .warnings = {}};
}

LayerChoice refused(std::string why) {
    return {.layer = {}, .refusal = std::move(why), .warnings = {}};
}

LayerChoice ambiguous(const std::vector<const ExrLayer*>& layers, Role role) {
    return refused(fmt::format("has {} layers that are equally good as {}: {} (choose with {})",
                               layers.size(), name_of(role), quoted(labels_of(layers)), option_for(role)));
}

std::string in_view(const std::string& view) {
    return view.empty() ? "" : fmt::format(" in its view \"{}\"", view);
}

LayerChoice choice_by_name(const ExrContents& contents, const LayerWish& wish, const std::string& view) {
    std::vector<ExrLayer> found = layers_called(contents, wish.layer);
    if (found.empty()) found = layers_almost_called(contents, wish.layer);
    std::vector<std::string> views;
    for (const ExrLayer& layer : found) {
        if (layer.view.empty() || layer.view == view) return taken(layer, wish.role);
        views.push_back(layer.view);
    }
    // A name that holds its view says which one is meant.
    const bool names_view = !found.empty() && found.front().label() != wish.layer;
    if (names_view && wish.view.empty()) return taken(found.front(), wish.role);
    if (!found.empty())
        return refused(fmt::format("has no layer \"{}\"{}, but in {} (choose with --view)", wish.layer,
                                   in_view(view), quoted(views)));
    std::vector<std::string> names;
    for (const ExrLayer& layer : contents.layers) {
        names.push_back(layer.label());
        if (layer.shape != Shape::single)
            names.insert(names.end(), layer.channels.begin(), layer.channels.end());
    }
    return refused(fmt::format("has no layer or channel \"{}\"{} (it has {})", wish.layer,
                               did_you_mean(wish.layer, names), fmt::join(names, ", ")));
}

LayerChoice nothing_for(const ExrContents& contents, const LayerWish& wish, const Ranking& ranking,
                        const std::string& view) {
    std::string text = fmt::format("has no {}{}; its layers are {}", name_of(wish.role), in_view(view),
                                   quoted(labels_of(ranking.layers())));
    if (!wish.beside.empty())
        text = fmt::format("has no {}{} beside \"{}\"; its layers are {} (choose with {})",
                           name_of(wish.role), in_view(view), wish.beside,
                           quoted(labels_of(ranking.layers())), option_for(wish.role));
    std::vector<std::string> others;
    for (const std::string& other : contents.views) {
        int rank = unsuitable;
        if (other != view && !Ranking(contents, wish, other).best(rank).empty()) others.push_back(other);
    }
    if (!others.empty()) text += fmt::format("; it has one in {} (choose with --view)", quoted(others));
    return refused(text);
}

LayerChoice choice_by_convention(const ExrContents& contents, const LayerWish& wish,
                                 const std::string& view) {
    const Ranking ranking(contents, wish, view);
    int rank = unsuitable;
    const std::vector<const ExrLayer*> best = ranking.best(rank);
    if (best.empty()) return nothing_for(contents, wish, ranking, view);
    if (best.size() > 1) return ambiguous(best, wish.role);
    LayerChoice choice = taken(*best.front(), wish.role);
    if (choice.layer && rank % 1000 == contrary && ranking.layers().size() > 1)
        choice.warnings.push_back(fmt::format(
            "\"{}\" was taken for the picture, the only one there is, though its name says something else",
            best.front()->label()));
    return choice;
}

/// Layers whose family is called so: "ViewLayer" for the passes of that view layer.
ExrContents family_called(const ExrContents& contents, const std::string& name) {
    ExrContents family = contents;
    std::erase_if(family.layers, [&](const ExrLayer& layer) { return layer.family() != name; });
    return family;
}

} // namespace

LayerChoice choose_layer(const ExrContents& contents, const LayerWish& wish) {
    const bool known = std::count(contents.views.begin(), contents.views.end(), wish.view) > 0;
    if (!wish.view.empty() && contents.views.empty())
        return refused(fmt::format("has no views, so there is no \"{}\" in it", wish.view));
    if (!wish.view.empty() && !known)
        return refused(fmt::format("has no view \"{}\"{} (it has {})", wish.view,
                                   did_you_mean(wish.view, contents.views), quoted(contents.views)));
    const std::string view = wish.view.empty() ? contents.default_view : wish.view;
    if (wish.layer.empty()) return choice_by_convention(contents, wish, view);
    LayerChoice choice = choice_by_name(contents, wish, view);
    if (choice.layer || !layers_called(contents, wish.layer).empty()) return choice;
    const ExrContents family = family_called(contents, wish.layer);
    if (family.layers.empty()) return choice;
    return choice_by_convention(family, {wish.role, "", wish.view, ""}, view);
}

std::optional<bool> has_world_normals(const ExrLayer& layer, const std::string& program) {
    const std::string word = word_of(layer);
    if (word.find("world") != std::string::npos) return true;
    if (word.find("camera") != std::string::npos || word.find("view") != std::string::npos) return false;
    // Chaos, "VRayNormals": camera space. Autodesk, "AOVs": N is in world space; Blender's Normal pass is too.
    if (word == "vraynormals" || (program == "V-Ray" && word != "n")) return false;
    if (program == "Arnold" || program == "Blender") return true;
    const bool blender_names = word == "normal" && !layer.family().empty() && layer.shape == Shape::vector;
    return blender_names ? std::optional(true) : std::nullopt;
}

} // namespace postfx::formats
