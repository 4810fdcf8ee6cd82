// What models bring and nothing else here reads: TGA, BMP and PSD, by stb_image. It believes every size and takes
// the end of a file for zeros or for whatever memory held, so sizes are asked first and it is watched while it reads.
#include <image/formats.hpp>
#include <image/stb_statements.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_ONLY_PSD
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#include <stb_image.h>

namespace postfx::formats {
namespace {

/// Bytes that tell when more is asked of them than they are. stb_image asks for its buffer's size ahead of need, and
/// for other sizes when it needs them all.
class WatchedBytes {
public:
    explicit WatchedBytes(std::string_view bytes) : rest_(bytes) {}

    bool overrun() const { return overrun_; }
    int read(char* to, std::size_t size) {
        const std::size_t there = std::min(size, rest_.size());
        std::memcpy(to, rest_.data(), there);
        std::memset(to + there, 0, size - there); // stb_image would use what memory held
        rest_.remove_prefix(there);
        const bool ahead = size == sizeof(stbi__context::buffer_start);
        if (size > 0 && (there == 0 || (there < size && !ahead))) overrun_ = true;
        return static_cast<int>(there);
    }
    void skip(int count) {
        const auto wanted = static_cast<std::size_t>(std::max(count, 0));
        overrun_ = overrun_ || wanted > rest_.size();
        rest_.remove_prefix(std::min(wanted, rest_.size()));
    }
    bool at_end() const { return rest_.empty(); }

private:
    std::string_view rest_;
    bool overrun_ = false;
};

constexpr stbi_io_callbacks callbacks = {
    [](void* user, char* to, int size) {
        return static_cast<WatchedBytes*>(user)->read(to, static_cast<std::size_t>(std::max(size, 0)));
    },
    [](void* user, int count) { static_cast<WatchedBytes*>(user)->skip(count); },
    [](void* user) { return static_cast<int>(static_cast<WatchedBytes*>(user)->at_end()); },
};

struct FreeCodes {
    void operator()(void* codes) const { stbi_image_free(codes); }
};

struct Head {
    int width = 0, height = 0, channels = 0;
};

bool read_head(std::string_view bytes, Head& head) {
    WatchedBytes input(bytes);
    if (!stbi_info_from_callbacks(&callbacks, &input, &head.width, &head.height, &head.channels))
        return false;
    // A BMP whose rows come from the top says so by its sign.
    head.height = std::abs(head.height);
    return !input.overrun();
}

template<class Code, class Load>
void read_codes(const Path& file, std::string_view bytes, Load load, StoredPicture& picture) {
    WatchedBytes input(bytes);
    Head head;
    const std::unique_ptr<Code, FreeCodes> codes(
        load(&callbacks, &input, &head.width, &head.height, &head.channels, 0));
    if (!codes) fail(file, fmt::format("damaged picture ({})", stbi_failure_reason()));
    if (input.overrun()) fail(file, "truncated: the file ends inside its pixels");
    picture.samples = Image(head.width, head.height, head.channels);
    const Code* code = codes.get();
    for (int y = head.height - 1; y >= 0; --y)
        for (int i = 0; i < head.width * head.channels; ++i)
            picture.samples.pixel(0, y)[i] = *code++;
}

/// By the first bytes; TGA has none of its own and is told by what its head may hold.
const char* kind_of(std::string_view bytes) {
    if (bytes.starts_with("BM")) return "BMP";
    if (bytes.starts_with("8BPS")) return "PSD";
    return "TGA";
}

StoredPicture stored_picture(const ImageSource& source) {
    const Path& file = source.name;
    const std::string_view kind = kind_of(source.bytes);
    if (const std::string problem = problem_of(source.bytes); !problem.empty()) fail(file, problem);
    Head head;
    if (!read_head(source.bytes, head))
        fail(file, fmt::format("truncated, damaged or not supported {} ({})", kind, stbi_failure_reason()));
    check_size(file, head.width, head.height);
    StoredPicture picture;
    if (psd_bits(source.bytes) == 16) {
        read_codes<stbi_us>(file, source.bytes, stbi_load_16_from_callbacks, picture);
        picture.coding.bits = 16;
        picture.largest = 65535;
    } else {
        read_codes<stbi_uc>(file, source.bytes, stbi_load_from_callbacks, picture);
    }
    if (picture.samples.channels % 2 == 0) picture.coding.alpha = Coding::Alpha::straight;
    const auto take = kind == "BMP"   ? take_bmp_statements
                      : kind == "PSD" ? take_psd_statements
                                      : take_tga_statements;
    take(source.bytes, picture);
    return picture;
}

bool recognises(std::string_view bytes) {
    Head head;
    return std::string_view(kind_of(bytes)) != "TGA" || read_head(bytes, head);
}

ImageFile read(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return as_asked(stored_picture(source), request);
}

ImageDescription describe(const ImageSource& source) {
    return described(kind_of(source.bytes), stored_picture(source));
}

} // namespace

const Format stb = {"TGA, BMP, PSD", recognises, read, describe};

} // namespace postfx::formats
