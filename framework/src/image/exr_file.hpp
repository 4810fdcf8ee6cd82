// An EXR file's parts and channels. The library's exceptions end here.
#pragma once

#include <image/exr_layers.hpp>
#include <image/formats.hpp>

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::formats {

/// Run `work`; what the library throws becomes a one-line Error.
template<class Work>
auto with_exr_errors(const Path& file, const char* doing, Work work) -> decltype(work()) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        std::string reason = error.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        fail(file, std::string(doing) + " (" + reason + ")");
    }
}

inline constexpr const char* reading_exr = "truncated or damaged EXR";

/// Bytes in memory as the library reads them, without the copy that its own StdISStream makes.
class ExrStream : public Imf::IStream {
public:
    explicit ExrStream(std::string_view bytes) : IStream("EXR"), bytes_(bytes) {}

    bool isMemoryMapped() const override { return false; }
    bool read(char to[], int count) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }
    void clear() override {}

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

struct ExrWindow {
    long long x = 0, y = 0, width = 0, height = 0;

    long long x_end() const { return x + width; }
    long long y_end() const { return y + height; }
};

ExrWindow window_of(const Imath::Box2i& box);

/// An open file. Sizes are checked before memory is asked for; deep parts have no layers.
class ExrFile {
public:
    explicit ExrFile(const ImageSource& source);

    int parts() const { return input_.parts(); }
    const Imf::Header& header(int part) const { return input_.header(part); }
    const ExrContents& contents() const { return contents_; }
    const ExrWindow& display() const { return display_; }
    Imf::MultiPartInputFile& input() { return input_; }
    bool is_deep(int part) const;
    /// "part 2 " where there are several.
    std::string called(int part) const;

    /// The display window with the channels of `layer`; 0 where the file has nothing. Throws Error if its part is
    /// truncated, absurdly large for the bytes that there are, or a channel is subsampled.
    Image read(const ExrLayer& layer);

private:
    void check_part(int part) const;
    void check_readable(const ExrLayer& layer) const;
    Image read_luminance_chroma(const ExrLayer& layer);

    const ImageSource& source_;
    ExrStream stream_;
    Imf::MultiPartInputFile input_;
    ExrWindow display_;
    ExrContents contents_;
};

/// The layer for the request. Throws Error with the reason why there is none; adds to `warnings` what was left out.
ExrLayer layer_for(const ImageSource& source, const ExrFile& exr, const ImageRequest& request,
                   std::vector<std::string>& warnings);

/// "half", "float", "uint".
const char* type_name(Imf::PixelType type);

} // namespace postfx::formats
