#include "model_files.hpp"

#include "file_kind.hpp"

#include <base/read_file.hpp>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include <algorithm>
#include <cctype>
#include <memory>

namespace postfx::host {
namespace {

/// The files of a folder, with one more under a name of its own: what `file` holds, or `content`.
class FilesWithAlias : public Assimp::DefaultIOSystem {
public:
    FilesWithAlias(std::string alias, const std::filesystem::path& file, const std::string& content)
        : alias_(std::move(alias)), file_(file.string()), content_(content) {}

    bool Exists(const char* name) const override {
        return name == alias_ || Assimp::DefaultIOSystem::Exists(name);
    }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (name != alias_) return Assimp::DefaultIOSystem::Open(name, mode);
        if (content_.empty()) return Assimp::DefaultIOSystem::Open(file_.c_str(), mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()),
                                          content_.size());
    }

private:
    std::string alias_, file_;
    const std::string& content_;
};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string ending_by_content(const std::filesystem::path& file, const std::string& content) {
    if (!content.empty()) return model_ending(content, content.size());
    std::error_code unknown;
    return model_ending(read_start(file, recognized_bytes, "a model"),
                        std::filesystem::file_size(file, unknown));
}

} // namespace

const aiScene* read_by_content(Assimp::Importer& importer, const std::filesystem::path& file,
                               const std::string& content, unsigned steps) {
    const std::string ending = ending_by_content(file, content);
    const bool named_so = ending.empty() || lower(file.extension().string()) == ending;
    if (named_so && content.empty()) return importer.ReadFile(file.string(), steps);
    // Beside the file, so that the names in it are found from there.
    const std::string alias = (folder_of(file) / ("postfx-model" + ending)).string();
    importer.SetIOHandler(new FilesWithAlias(alias, file, content)); // the importer's from here on
    return importer.ReadFile(alias, steps);
}

} // namespace postfx::host
