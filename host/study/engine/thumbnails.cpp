#include "thumbnails.hpp"

#include <image/heat_colors.hpp>
#include <image/srgb.hpp>

#include <algorithm>
#include <cmath>

namespace postfx::host::study {
namespace {

constexpr int about_columns = 240;

/// Means of squares of pixels; what is left over at the right and top is cut off.
template<class Number>
BasicImage<Number> smaller(const BasicImage<Number>& image) {
    const int side =
        std::max(1, std::min({static_cast<int>(std::lround(static_cast<double>(image.width) / about_columns)),
                              image.width, image.height}));
    BasicImage<Number> result(image.width / side, image.height / side, image.channels);
    for (int y = 0; y < result.height * side; ++y) {
        for (int x = 0; x < result.width * side; ++x) {
            for (int c = 0; c < image.channels; ++c)
                result.at(x / side, y / side, c) += image.at(x, y, c) / static_cast<Number>(side * side);
        }
    }
    return result;
}

Thumbnail picture_thumbnail(const std::string& name, const Image64& shown) {
    const Image64 image = smaller(shown);
    Thumbnail thumbnail{name, image.width, image.height, {}};
    for (const double value : image.values)
        thumbnail.codes.push_back(static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(value))));
    return thumbnail;
}

Thumbnail map_thumbnail(const std::string& name, Image map, double white) {
    for (float& value : map.values)
        value /= static_cast<float>(white);
    return {name, map.width, map.height, heat_colors(map)};
}

/// Below which nearly all values of all maps are, so that a few bright pixels don't darken the rest.
double nearly_largest(const std::vector<Image>& maps) {
    std::vector<float> values;
    for (const Image& map : maps)
        values.insert(values.end(), map.values.begin(), map.values.end());
    std::erase_if(values, [](float value) { return !std::isfinite(value); });
    if (values.empty()) return 1;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    constexpr float darkest_scale = 0.01F; // FLIP below is nothing that anybody sees
    return std::max(*at, darkest_scale);
}

} // namespace

void add_thumbnails(EffectFindings& findings, const View& view, const std::vector<LevelPicture>& pictures,
                    const Image64* truth) {
    findings.thumbnails.push_back(picture_thumbnail("given", view.shown(view.light())));
    if (!truth) {
        for (std::size_t i = 0; i < pictures.size(); ++i)
            findings.thumbnails.push_back(
                picture_thumbnail(findings.levels[i].id, view.shown(pictures[i].light)));
        return;
    }
    findings.thumbnails.push_back(picture_thumbnail("truth", view.shown(*truth)));
    std::vector<Image> maps;
    for (const LevelPicture& picture : pictures)
        maps.push_back(smaller(flip_map(picture.light, *truth, view)));
    findings.heat_white = nearly_largest(maps);
    for (std::size_t i = 0; i < maps.size(); ++i)
        findings.thumbnails.push_back(map_thumbnail(findings.levels[i].id, maps[i], findings.heat_white));
}

} // namespace postfx::host::study
