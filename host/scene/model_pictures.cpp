#include "model_pictures.hpp"

#include "asset_files.hpp"
#include "assets.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace postfx::host {
namespace {

bool has_alpha(const Picture& picture) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        if (picture.rgba[i] != 255) return true;
    }
    return false;
}

/// The opacity that a mask has at a pixel of a picture of that size, its pixels averaged or repeated.
class Mask {
public:
    explicit Mask(const Picture& picture) : picture_(picture), channel_(has_alpha(picture) ? 3 : 1) {}

    std::uint8_t at(int x, int y, int width, int height) const {
        const auto begin = [](int i, int count, int pixels) {
            return static_cast<int>(static_cast<std::int64_t>(i) * pixels / count);
        };
        const int left = begin(x, width, picture_.width), bottom = begin(y, height, picture_.height);
        const int right = std::max(left + 1, begin(x + 1, width, picture_.width));
        const int top = std::max(bottom + 1, begin(y + 1, height, picture_.height));
        std::uint64_t sum = 0;
        for (int row = bottom; row < top; ++row) {
            for (int column = left; column < right; ++column)
                sum += picture_.rgba[4 * pixel(column, row) + channel_];
        }
        return static_cast<std::uint8_t>(sum / static_cast<std::uint64_t>((right - left) * (top - bottom)));
    }

private:
    std::size_t pixel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width)
               + static_cast<std::size_t>(x);
    }
    const Picture& picture_;
    std::size_t channel_; ///< alpha, or green of a grey picture
};

} // namespace

std::uint32_t pick_uv_set(std::size_t set, std::vector<std::size_t>& sets, const std::string& material,
                          Losses& losses) {
    static const LossKind kind{
        "texture is read with the coordinates of another, since a material has at most 2 sets",
        "textures are read with the coordinates of others, since a material has at most 2 sets"};
    const auto known = std::find(sets.begin(), sets.end(), set);
    if (known == sets.end() && sets.size() == 2) {
        losses.add(kind, material);
        return 0;
    }
    const auto place = static_cast<std::uint32_t>(known - sets.begin());
    if (known == sets.end()) sets.push_back(set);
    return place;
}

PicturePtr ModelPictures::decode(const std::string& name, const std::vector<std::uint8_t>& bytes, bool srgb) {
    static const LossKind unread{"texture is of a kind that postfx doesn't read",
                                 "textures are of kinds that postfx doesn't read"};
    if (const std::string kind = unread_picture_kind(bytes.data(), bytes.size()); !kind.empty()) {
        losses_.add(unread, fmt::format("{}: {}", name, kind));
        return nullptr;
    }
    return decode_picture(bytes.data(), bytes.size(), srgb, fmt::format("{} ({})", model_.string(), name));
}

PicturePtr ModelPictures::read(const std::string& name, bool srgb) {
    static const LossKind missing{"texture is missing", "textures are missing"};
    const auto asset = find_asset(model_, name);
    if (!asset) {
        losses_.add(missing, percent_decoded(name));
        return nullptr;
    }
    const std::vector<std::uint8_t> bytes = read_asset(*asset);
    hooks_.opening(bytes.size());
    return decode(asset->filename().string(), bytes, srgb);
}

PicturePtr ModelPictures::file(const std::string& name, bool srgb) {
    const auto [known, added] = known_.try_emplace({name, srgb});
    if (!added) return known->second;
    if (const PicturePtr picture = read(name, srgb)) known->second = hooks_.picture(picture);
    return known->second;
}

PicturePtr ModelPictures::embedded(const std::string& name, const std::vector<std::uint8_t>& bytes,
                                   bool srgb) {
    const auto [known, added] = known_.try_emplace({name, srgb});
    if (!added) return known->second;
    if (const PicturePtr picture = decode(name, bytes, srgb)) known->second = hooks_.picture(picture);
    return known->second;
}

ModelPictures::Masked ModelPictures::masked(const std::string& color, const std::string& mask) {
    const auto [known, added] = masked_.try_emplace({color, mask});
    if (!added) return known->second;
    const PicturePtr opacity = read(mask, false);
    if (!opacity) return {};
    const PicturePtr colors = color.empty() ? nullptr : read(color, true);
    auto result = std::make_shared<Picture>();
    result->width = colors ? colors->width : opacity->width;
    result->height = colors ? colors->height : opacity->height;
    result->rgba = colors ? colors->rgba : std::vector<std::uint8_t>(opacity->rgba.size(), 255);
    const Mask alpha(*opacity);
    std::uint8_t* pixel = result->rgba.data();
    std::size_t between = 0;
    for (int y = 0; y < result->height; ++y) {
        for (int x = 0; x < result->width; ++x, pixel += 4) {
            pixel[3] = alpha.at(x, y, result->width, result->height);
            between += pixel[3] > 16 && pixel[3] < 239;
        }
    }
    // Leaves and fences have a soft pixel at their edges at most; smoke and glass are soft all over.
    known->second = {hooks_.picture(result), between * 10 < result->rgba.size() / 4};
    return known->second;
}

} // namespace postfx::host
