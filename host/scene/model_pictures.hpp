// The pictures that one model's materials share.
#pragma once

#include "losses.hpp"
#include "model.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace postfx::host {

/// Which of a vertex's two pairs of texture coordinates stands for the file's set of that number: its place in `sets`,
/// which are those that the material has so far. A third one is a loss.
std::uint32_t pick_uv_set(std::size_t set, std::vector<std::size_t>& sets, const std::string& material,
                          Losses& losses);

class ModelPictures {
public:
    ModelPictures(std::filesystem::path model, const ReadingHooks& hooks, Losses& losses)
        : model_(std::move(model)), hooks_(hooks), losses_(losses) {}

    /// The file that the model calls `name`; null, and a loss, if there is none or it is of a kind that we don't read.
    /// Throws Error naming a file that is damaged.
    PicturePtr file(const std::string& name, bool srgb);
    /// The same of a picture that lies within the model's file; `name` is for messages and must be its own.
    PicturePtr embedded(const std::string& name, const std::vector<std::uint8_t>& bytes, bool srgb);
    /// The colours of one file, or white, with the opacity that another has: its alpha if it has any, else its
    /// brightness. Null, and a loss, if the mask is missing.
    struct Masked {
        PicturePtr picture;
        bool cuts = false; ///< the mask has hardly anything between nothing and all
    };
    Masked masked(const std::string& color, const std::string& mask);

private:
    PicturePtr decode(const std::string& name, const std::vector<std::uint8_t>& bytes, bool srgb);
    /// Without the hook.
    PicturePtr read(const std::string& name, bool srgb);

    std::filesystem::path model_;
    const ReadingHooks& hooks_;
    Losses& losses_;
    std::map<std::pair<std::string, bool>, PicturePtr> known_;
    std::map<std::pair<std::string, std::string>, Masked> masked_;
};

} // namespace postfx::host
