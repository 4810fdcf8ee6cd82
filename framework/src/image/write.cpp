#include <image/files.hpp>
#include <image/formats.hpp>
#include <image/srgb.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace postfx {
namespace {

using formats::fail;
using formats::Path;

[[noreturn]] void fail_writing(const Path& file, int code) {
    fail(file, fmt::format("can't be written: {}", std::strerror(code)));
}

/// An open file; what is written is checked.
class OutputDescriptor {
public:
    explicit OutputDescriptor(int descriptor) : descriptor_(descriptor) {}
    ~OutputDescriptor() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    OutputDescriptor(const OutputDescriptor&) = delete;
    OutputDescriptor& operator=(const OutputDescriptor&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    /// Write all and close; false with errno set when that fails, on close too (network file systems tell it
    /// there).
    bool write_and_close(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
        return ::close(std::exchange(descriptor_, -1)) == 0;
    }

private:
    int descriptor_;
};

/// A name beside `file`, so that renaming never crosses file systems; short, as `file`'s own may be as long
/// as names get.
Path name_beside(const Path& file) {
    static std::atomic<unsigned> count = 0;
    return file.parent_path() / fmt::format(".postfx-{}-{}.new", ::getpid(), count++);
}

/// What a chain of links leads to, which need not be there; `file` itself when it is no link.
Path end_of_links(const Path& file) {
    constexpr int most_links = 40; // as Linux has it
    Path target = file;
    std::error_code ignored;
    for (int links = 0; std::filesystem::is_symlink(target, ignored); ++links) {
        if (links == most_links) fail_writing(file, ELOOP);
        target = target.parent_path() / std::filesystem::read_symlink(target);
    }
    return target;
}

void write_to_standard_output(std::string_view bytes) {
    std::fflush(stdout);
    OutputDescriptor output(::dup(STDOUT_FILENO));
    if (!output.is_open() || !output.write_and_close(bytes)) fail_writing("standard output", errno);
}

void check_image(const Path& file, int width, int height, int channels, std::size_t values) {
    formats::check_size(file, width, height);
    if (channels < 1 || channels > 4)
        fail(file, fmt::format("can't be written: the picture has {} channels, expected 1 to 4", channels));
    if (values != static_cast<std::size_t>(width) * height * channels)
        fail(file,
             fmt::format("can't be written: {} values for {} x {} x {}", values, width, height, channels));
}

/// The same picture with other channels: colour is repeated from one channel or cut to it, alpha is left out.
template<class Number>
BasicImage<Number> with_color_channels(const BasicImage<Number>& image, int channels) {
    BasicImage<Number> colors(image.width, image.height, channels);
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        for (int channel = 0; channel < channels; ++channel)
            colors.values[pixel * channels + channel] =
                image.values[pixel * image.channels + (image.channels < 3 ? 0 : channel)];
    return colors;
}

/// The channels of what has no alpha: 1 for grey, else 3.
int color_channels(int channels) {
    return channels < 3 ? 1 : 3;
}

template<class Code>
BasicImage<Code> display_codes(const Image& image) {
    constexpr double largest = std::numeric_limits<Code>::max();
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    BasicImage<Code> codes(image.width, image.height, image.channels);
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        const bool is_alpha = has_alpha && static_cast<int>(i % image.channels) == image.channels - 1;
        const double value = image.values[i];
        const double encoded = !is_alpha ? linear_to_srgb(value) : value > 0 ? std::min(value, 1.0) : 0.0;
        codes.values[i] = static_cast<Code>(std::lround(largest * encoded));
    }
    return codes;
}

std::string encoded_codes(const Path& file, const BasicImage<std::uint8_t>& codes,
                          const WriteOptions& options) {
    if (written_kind(file, options.kind) != "jpg") return formats::png_bytes(file, codes);
    return formats::jpeg_bytes(file, with_color_channels(codes, color_channels(codes.channels)),
                               options.quality);
}

bool carries(const WriteOptions& options) {
    return options.origin && formats::exr.recognises(options.origin->source->bytes);
}

std::string encoded(const Path& file, const Image& image, const WriteOptions& options,
                    std::vector<std::string>& remarks) {
    const std::string kind = written_kind(file, options.kind);
    if (kind == "exr" && carries(options))
        return formats::exr_bytes_carrying(file, image, *options.origin, remarks);
    if (kind == "png" && options.bits == 16)
        return formats::png_bytes(file, display_codes<std::uint16_t>(image));
    if (is_display_kind(file, kind)) return encoded_codes(file, display_codes<std::uint8_t>(image), options);
    if (kind == "exr") return formats::exr_bytes(file, image, options.half);
    if (kind == "hdr") return formats::hdr_bytes(with_color_channels(image, 3));
    return formats::pfm_bytes(with_color_channels(image, color_channels(image.channels)));
}

} // namespace

std::string written_kind(const std::filesystem::path& file, const std::string& kind) {
    std::string word = kind.empty() ? file.extension().string() : kind;
    if (word.starts_with('.')) word.erase(0, 1);
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return word == "jpeg" ? "jpg" : word;
}

void check_writable_kind(const std::filesystem::path& file, const std::string& kind) {
    static constexpr std::array known = {"png", "jpg", "exr", "hdr", "pfm"};
    const std::string wanted = written_kind(file, kind);
    if (std::find(known.begin(), known.end(), wanted) != known.end()) return;
    // As the user writes it: an ending has a dot.
    const auto word = [&](const std::string& name) { return (kind.empty() ? "." : "") + name; };
    std::vector<std::string> words;
    for (const char* name : known)
        words.push_back(word(name));
    fail(file == "-" ? "standard output" : file,
         fmt::format("can't be written: its {} is \"{}\", expected one of {}{}",
                     kind.empty() ? "ending" : "kind", wanted.empty() ? "" : word(wanted),
                     fmt::join(words, ", "), wanted.empty() ? "" : did_you_mean(word(wanted), words)));
}

bool is_display_kind(const std::filesystem::path& file, const std::string& kind) {
    const std::string written = written_kind(file, kind);
    return written == "png" || written == "jpg";
}

void write_codes(const std::filesystem::path& file, const BasicImage<std::uint8_t>& codes,
                 const WriteOptions& options) {
    check_image(file, codes.width, codes.height, codes.channels, codes.values.size());
    write_file_atomically(file, encoded_codes(file, codes, options));
}

std::vector<std::string> write_image(const std::filesystem::path& file, const Image& image,
                                     const WriteOptions& options) {
    check_writable_kind(file, options.kind);
    check_image(file, image.width, image.height, image.channels, image.values.size());
    std::vector<std::string> remarks;
    write_file_atomically(file, encoded(file, image, options, remarks));
    return remarks;
}

void check_output_folder(const std::filesystem::path& file) {
    if (file == "-") return;
    const Path target = end_of_links(file);
    const Path folder = target.parent_path();
    if (folder.empty() || std::filesystem::is_directory(folder)) return;
    fail(file, fmt::format("can't be written: {}there is no folder {}",
                           target == file ? "" : fmt::format("it is a link to {}, and ", target.string()),
                           folder.string()));
}

void write_file_atomically(const std::filesystem::path& file, const std::string& bytes) {
    if (file == "-") {
        write_to_standard_output(bytes);
        return;
    }
    std::error_code ignored;
    const std::filesystem::file_status before = std::filesystem::status(file, ignored);
    const auto type = before.type();
    using std::filesystem::file_type;
    if (type == file_type::directory) fail_writing(file, EISDIR);
    // A device or a pipe can't be replaced and never holds half a file.
    if (type == file_type::character || type == file_type::fifo) {
        OutputDescriptor output(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
        if (!output.is_open() || !output.write_and_close(bytes)) fail_writing(file, errno);
        return;
    }
    // Renaming would replace a protected file all the same, or a link instead of what it points at.
    if (type == file_type::regular && ::access(file.c_str(), W_OK) != 0) fail_writing(file, errno);
    check_output_folder(file);
    const Path target = end_of_links(file);
    const Path beside = name_beside(target);
    OutputDescriptor output(::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!output.is_open()) fail_writing(file, errno);
    if (type == file_type::regular) std::filesystem::permissions(beside, before.permissions(), ignored);
    if (output.write_and_close(bytes) && ::rename(beside.c_str(), target.c_str()) == 0) return;
    const int code = errno;
    ::unlink(beside.c_str());
    fail_writing(file, code);
}

} // namespace postfx
