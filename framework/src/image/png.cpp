// PNG, by libpng; what its chunks say is read by png_chunks.
#include <image/c_errors.hpp>
#include <image/png_chunks.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <png.h>

#include <cstring>
#include <memory>

namespace postfx::formats {
namespace {

/// zlib's best: a byte for each 1032 of them.
constexpr std::size_t best_compression = 1032;

struct Input {
    std::string_view rest;
    JumpTarget target{};
    std::vector<std::string> warnings{};
};

void read_bytes(png_structp png, png_bytep to, std::size_t size) {
    auto& input = *static_cast<Input*>(png_get_io_ptr(png));
    if (size > input.rest.size()) png_error(png, "it ends too early");
    std::memcpy(to, input.rest.data(), size);
    input.rest.remove_prefix(size);
}

[[noreturn]] void jump(png_structp png, png_const_charp message) {
    auto& target = static_cast<Input*>(png_get_error_ptr(png))->target;
    target.message = message;
    std::longjmp(target.place, 1);
}

void note_warning(png_structp png, png_const_charp message) {
    constexpr std::size_t most = 8;
    if (std::string_view(message).find("CRC") != std::string_view::npos) return; // png_chunks tells of it
    auto& warnings = static_cast<Input*>(png_get_error_ptr(png))->warnings;
    if (warnings.size() < most) warnings.push_back(std::string("libpng: ") + message);
}

/// Everything that libpng keeps while it reads.
class Decoder {
public:
    Decoder(const Path& file, std::string_view bytes) : file_(file), input_{.rest = bytes} {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input_, jump, note_warning);
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (!info_) throw std::bad_alloc();
        png_set_read_fn(png_, &input_, read_bytes);
        png_set_user_limits(png_, max_side, max_side);
        png_set_chunk_malloc_max(png_, 1 << 24);
    }
    ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    /// Samples of 8 or 16 bits, palettes and fewer bits spread out, transparency as alpha.
    void read_head() {
        work([this] {
            leave_statements_to_others();
            png_read_info(png_, info_);
            png_set_expand(png_);
            if (png_get_bit_depth(png_, info_) == 16) png_set_swap(png_); // to this machine's order
            if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
        });
    }
    int channels() const { return png_get_channels(png_, info_); }
    int bits() const { return png_get_bit_depth(png_, info_); }
    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    void read_rows(std::vector<png_bytep>& rows) {
        work([&] { png_read_image(png_, rows.data()); });
    }
    const std::vector<std::string>& warnings() const { return input_.warnings; }

private:
    /// libpng would drop what contradicts itself, and some of it by an order that is not the standard's.
    void leave_statements_to_others() {
        static constexpr png_byte chunks[] = "cHRM\0gAMA\0iCCP\0sRGB\0sBIT\0bKGD\0hIST\0pHYs\0sPLT\0tIME\0"
                                             "tEXt\0zTXt\0iTXt\0eXIf\0oFFs\0pCAL\0sCAL";
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, chunks, sizeof chunks / 5);
    }
    template<class Work>
    void work(Work what) {
        if (!done_without_jump(input_.target, what))
            fail(file_, fmt::format("truncated or damaged PNG ({})", input_.target.message));
    }

    const Path& file_;
    Input input_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

/// `Code`: the type of a sample. Rows come from the top.
template<class Code>
void copy_rows(const std::vector<png_bytep>& rows, Image& samples) {
    const auto count = static_cast<std::size_t>(samples.width) * static_cast<std::size_t>(samples.channels);
    for (int y = 0; y < samples.height; ++y) {
        float* to = samples.pixel(0, samples.height - 1 - y);
        const png_bytep row = rows[static_cast<std::size_t>(y)];
        for (std::size_t i = 0; i < count; ++i) {
            Code code;
            std::memcpy(&code, row + i * sizeof code, sizeof code);
            to[i] = code;
        }
    }
}

void read_pixels(const Path& file, std::string_view bytes, StoredPicture& picture, int width, int height) {
    Decoder decoder(file, bytes);
    decoder.read_head();
    const int channels = decoder.channels(), bits = decoder.bits();
    std::vector<png_byte> codes(decoder.row_bytes() * static_cast<std::size_t>(height));
    std::vector<png_bytep> rows;
    for (int y = 0; y < height; ++y)
        rows.push_back(codes.data() + decoder.row_bytes() * static_cast<std::size_t>(y));
    decoder.read_rows(rows);

    picture.samples = Image(width, height, channels);
    if (bits == 16)
        copy_rows<std::uint16_t>(rows, picture.samples);
    else
        copy_rows<std::uint8_t>(rows, picture.samples);
    picture.largest = bits == 16 ? 65535 : 255;
    picture.coding.bits = bits;
    picture.coding.alpha = channels % 2 == 0 ? Coding::Alpha::straight : Coding::Alpha::none;
    picture.warnings.insert(picture.warnings.end(), decoder.warnings().begin(), decoder.warnings().end());
}

/// The least that the pixels of the head's size can be compressed to.
void check_plausible(const Path& file, const PngChunks& png, std::size_t bytes) {
    static constexpr std::size_t channels[] = {1, 0, 3, 1, 2, 0, 4};
    check_size(file, png.width, png.height);
    if (png.color_type > 6 || channels[png.color_type] == 0 || png.bits > 16) return; // libpng will say so
    const std::size_t row = png.width * channels[png.color_type] * static_cast<std::size_t>(png.bits) / 8;
    if (row * png.height / best_compression > bytes)
        fail(file, fmt::format("truncated or damaged PNG: {} bytes can't hold {} x {} pixels", bytes,
                               png.width, png.height));
}

void note_statements(const PngChunks& png, StoredPicture& picture) {
    if (!png.complete) picture.warnings.emplace_back("the file is cut off behind its pixels");
    if (png.find("acTL")) picture.warnings.emplace_back("it is animated: the first picture was taken");
    if (const auto* size = png.find("pHYs"); size && size->size() >= 9) {
        const double across = big_endian(*size, 0), down = big_endian(*size, 4);
        if (across > 0 && down > 0 && across != down) picture.shot.pixel_aspect_ratio = down / across;
    }
    static constexpr std::pair<const char*, const char*> told[] = {{"cICP", "colour by code points"},
                                                                   {"iCCP", "ICC profile"},
                                                                   {"sRGB", "sRGB"},
                                                                   {"gAMA", "gamma"},
                                                                   {"cHRM", "chromaticities"},
                                                                   {"sBIT", "significant bits"},
                                                                   {"bKGD", "background, not drawn"},
                                                                   {"mDCV", "mastering display"},
                                                                   {"cLLI", "content light level"}};
    for (const auto& [type, meaning] : told)
        if (const auto* data = png.find(type)) {
            const bool profile = std::string_view(type) == "iCCP";
            std::string value = profile ? std::string(data->substr(0, data->find('\0'))) : std::string();
            for (std::size_t i = 0; i < data->size() && !profile; ++i)
                value += fmt::format("{}{:02x}", i == 0 ? "" : " ", static_cast<std::uint8_t>((*data)[i]));
            picture.attributes.emplace_back(fmt::format("{} ({})", type, meaning), value);
        }
}

StoredPicture stored_png(const ImageSource& source) {
    const PngChunks png = png_chunks(source.name, source.bytes);
    check_plausible(source.name, png, source.bytes.size());
    StoredPicture picture;
    picture.warnings = png.warnings;
    picture.color = color_of(png);
    note_statements(png, picture);
    const bool color_is_said = png.find("cICP") || png.find("iCCP") || png.find("sRGB") || png.find("gAMA");
    if (const auto* exif = png.find("eXIf")) take_exif(picture, *exif, color_is_said);
    read_pixels(source.name, source.bytes, picture, static_cast<int>(png.width),
                static_cast<int>(png.height));
    return picture;
}

bool recognises_png(std::string_view bytes) {
    return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

ImageFile read_png(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    return as_asked(stored_png(source), request);
}

ImageDescription describe_png(const ImageSource& source) {
    return described(png.name, stored_png(source));
}

} // namespace

const Format png = {"PNG", recognises_png, read_png, describe_png};

} // namespace postfx::formats
