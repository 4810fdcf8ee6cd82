// JPEG, by libjpeg-turbo.
#include <image/c_errors.hpp>
#include <image/jpeg_depth.hpp>
#include <image/jpeg_file.hpp>
#include <image/orientation.hpp>
#include <image/stored_picture.hpp>

#include <fmt/format.h>

#include <cstdio> // before jpeglib.h, which needs it

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>

namespace postfx::formats {
namespace {

/// More scans than any encoder makes; each costs as much as a picture.
constexpr int most_scans = 100;
/// Blocks of 8 x 8 samples with nothing in them, of which the first scan needs a bit each.
constexpr std::size_t most_pixels_a_byte = 64 * 8;

/// Warnings of libjpeg about files that are whole; all others mean that pixels were made up.
bool is_harmless(int code) {
    return code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR || code == JWRN_ADOBE_XFORM
           || code == JWRN_BOGUS_ICC;
}

class Decoder {
public:
    Decoder(const Path& file, std::string_view bytes) : file_(file), bytes_(bytes) {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = [](j_common_ptr info) { of(info).jump(info); };
        errors_.emit_message = [](j_common_ptr info, int level) { of(info).note(info, level); };
        errors_.output_message = [](j_common_ptr) {};
        progress_.progress_monitor = [](j_common_ptr info) { of(info).check_scans(info); };
        work([this] { jpeg_create_decompress(&info_); });
        info_.progress = &progress_;
    }
    ~Decoder() { jpeg_destroy_decompress(&info_); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    /// Grey, RGB or CMYK, as libjpeg converts the file's own colours.
    void read_head() {
        work([this] {
            jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
            jpeg_read_header(&info_, TRUE);
        });
        check_size(file_, info_.image_width, info_.image_height);
        const int components = info_.num_components;
        if (components != 1 && components != 3 && components != 4)
            fail(file_, fmt::format("a JPEG of {} components, expected 1, 3 or 4", components));
        const std::size_t pixels = std::size_t{info_.image_width} * info_.image_height;
        if (!info_.arith_code && pixels / most_pixels_a_byte > bytes_.size())
            fail(file_, fmt::format("truncated or damaged JPEG: {} bytes can't hold {} x {} pixels",
                                    bytes_.size(), info_.image_width, info_.image_height));
        info_.out_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
        info_.dct_method = JDCT_ISLOW;
    }
    /// Top row first; 8 bits.
    void read_rows(Image& samples) {
        work([this] { jpeg_start_decompress(&info_); });
        std::vector<JSAMPLE> row(std::size_t{info_.output_width}
                                 * static_cast<std::size_t>(info_.output_components));
        for (int y = samples.height - 1; y >= 0; --y) {
            JSAMPROW pointer = row.data();
            work([&] { jpeg_read_scanlines(&info_, &pointer, 1); });
            std::copy(row.begin(), row.end(), samples.pixel(0, y));
        }
        work([this] { jpeg_finish_decompress(&info_); });
    }
    const jpeg_decompress_struct& info() const { return info_; }
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    static Decoder& of(j_common_ptr info) { return *static_cast<Decoder*>(info->client_data); }

    [[noreturn]] void jump(j_common_ptr info) {
        target_.message = message_of(info);
        std::longjmp(target_.place, 1);
    }
    void note(j_common_ptr info, int level) {
        constexpr std::size_t most = 8;
        if (level >= 0) return; // what it traces
        if (!is_harmless(errors_.msg_code)) jump(info);
        if (warnings_.size() < most) warnings_.push_back("libjpeg: " + message_of(info));
    }
    void check_scans(j_common_ptr info) {
        if (info_.input_scan_number <= most_scans) return;
        target_.message = fmt::format("more than {} scans", most_scans);
        (void)info;
        std::longjmp(target_.place, 1);
    }
    std::string message_of(j_common_ptr info) {
        std::array<char, JMSG_LENGTH_MAX> text{};
        errors_.format_message(info, text.data());
        return text.data();
    }
    template<class Work>
    void work(Work what) {
        if (!done_without_jump(target_, what))
            fail(file_, fmt::format("truncated or damaged JPEG ({})", target_.message));
    }

    const Path& file_;
    std::string_view bytes_;
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    jpeg_decompress_struct info_{};
    JumpTarget target_{};
    std::vector<std::string> warnings_{};
};

/// Photoshop writes light where the others write ink, and marks its files.
void take_ink(StoredPicture& picture, bool adobe) {
    picture.cmyk = true;
    if (!adobe) return;
    for (float& sample : picture.samples.values)
        sample = 255 - sample;
}

void take_color(StoredPicture& picture, const std::vector<JpegSegment>& segments) {
    const std::optional<std::string> profile = icc_profile_of(segments);
    if (profile) picture.color = color_of_icc(*profile, picture.color_channels());
    if (picture.color.profile) picture.attributes.emplace_back("ICC profile", picture.color.profile->name());
    if (const auto exif = find_application_data(segments, 0xe1, std::string_view("Exif\0", 5)))
        take_exif(picture, exif->substr(std::min<std::size_t>(1, exif->size())), profile.has_value());
}

/// JFIF's density: the shape of a pixel.
void take_density(StoredPicture& picture, const jpeg_decompress_struct& info) {
    if (info.saw_JFIF_marker && info.X_density > 0 && info.Y_density > 0 && info.X_density != info.Y_density)
        picture.shot.pixel_aspect_ratio = static_cast<double>(info.Y_density) / info.X_density;
}

StoredPicture stored_jpeg(const ImageSource& source) {
    const std::vector<JpegSegment> segments = jpeg_segments(source.name, source.bytes);
    Decoder decoder(source.name, source.bytes);
    decoder.read_head();
    const jpeg_decompress_struct& info = decoder.info();
    StoredPicture picture;
    picture.samples =
        Image(static_cast<int>(info.image_width), static_cast<int>(info.image_height), info.num_components);
    decoder.read_rows(picture.samples);
    if (info.num_components == 4) take_ink(picture, info.saw_Adobe_marker);
    take_color(picture, segments);
    take_density(picture, info);
    picture.attributes.emplace_back("coding", info.progressive_mode ? "progressive" : "sequential");
    picture.warnings.insert(picture.warnings.end(), decoder.warnings().begin(), decoder.warnings().end());
    return picture;
}

bool recognises_jpeg(std::string_view bytes) {
    return bytes.starts_with("\xff\xd8\xff");
}

/// The depth map inside of a photograph, turned as the photograph is; nothing if it has none.
std::optional<ImageFile> depth_of_photograph(const ImageSource& source) {
    const std::vector<JpegSegment> segments = jpeg_segments(source.name, source.bytes);
    std::optional<ImageFile> depth = depth_in_jpeg(source, segments);
    if (!depth) return std::nullopt;
    StoredPicture statements;
    take_color(statements, segments);
    depth->image = oriented(depth->image, statements.orientation);
    depth->shot.orientation = statements.orientation;
    return depth;
}

ImageFile read_jpeg(const ImageSource& source, const ImageRequest& request) {
    expect_no_layers(source, request);
    if (request.role == Role::depth)
        if (std::optional<ImageFile> depth = depth_of_photograph(source)) return *std::move(depth);
    ImageFile file = as_asked(stored_jpeg(source), request);
    if (request.role != Role::color) return file;
    try {
        file.has_depth_map = depth_in_jpeg(source, jpeg_segments(source.name, source.bytes)).has_value();
    } catch (const Error& error) {
        file.warnings.push_back("its depth map is left out: " + error.message());
    }
    return file;
}

ImageDescription describe_jpeg(const ImageSource& source) {
    return described(jpeg.name, stored_jpeg(source));
}

} // namespace

const Format jpeg = {"JPEG", recognises_jpeg, read_jpeg, describe_jpeg};

} // namespace postfx::formats
