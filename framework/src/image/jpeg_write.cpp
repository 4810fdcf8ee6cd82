// JPEG files of ours: sRGB, and they say so by a profile.
#include <image/c_errors.hpp>
#include <image/icc.hpp>

#include <fmt/format.h>

#include <cstdio> // before jpeglib.h, which needs it

#include <jpeglib.h>

#include <array>
#include <cmath>
#include <cstdlib>

namespace postfx::formats {
namespace {

/// From here on colour keeps every pixel: blocks of 2 x 2 would be what is seen first.
constexpr double full_color_quality = 0.85;

/// Everything that libjpeg keeps while it writes.
class Encoder {
public:
    explicit Encoder(const Path& file) : file_(file) {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = [](j_common_ptr info) {
            auto& target = static_cast<Encoder*>(info->client_data)->target_;
            std::array<char, JMSG_LENGTH_MAX> text{};
            info->err->format_message(info, text.data());
            target.message = text.data();
            std::longjmp(target.place, 1);
        };
        errors_.output_message = [](j_common_ptr) {};
        work([this] { jpeg_create_compress(&info_); });
    }
    ~Encoder() {
        jpeg_destroy_compress(&info_);
        std::free(bytes_);
    }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    std::string encoded(const BasicImage<std::uint8_t>& codes, double quality) {
        const std::string& profile = srgb_icc_profile();
        work([&] {
            jpeg_mem_dest(&info_, &bytes_, &size_);
            set_up(codes, quality);
            jpeg_start_compress(&info_, TRUE);
            // A profile of sRGB has three channels; grey is read as sRGB without.
            if (codes.channels == 3)
                jpeg_write_icc_profile(&info_, reinterpret_cast<const JOCTET*>(profile.data()),
                                       static_cast<unsigned>(profile.size()));
            for (int y = codes.height - 1; y >= 0; --y) {
                JSAMPROW row = const_cast<JSAMPROW>(codes.pixel(0, y));
                jpeg_write_scanlines(&info_, &row, 1);
            }
            jpeg_finish_compress(&info_);
        });
        return {reinterpret_cast<const char*>(bytes_), size_};
    }

private:
    void set_up(const BasicImage<std::uint8_t>& codes, double quality) {
        info_.image_width = static_cast<JDIMENSION>(codes.width);
        info_.image_height = static_cast<JDIMENSION>(codes.height);
        info_.input_components = codes.channels;
        info_.in_color_space = codes.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_set_defaults(&info_);
        jpeg_set_quality(&info_, static_cast<int>(std::lround(100 * quality)), TRUE);
        info_.dct_method = JDCT_ISLOW;
        info_.optimize_coding = TRUE;
        if (quality >= full_color_quality)
            info_.comp_info[0].h_samp_factor = info_.comp_info[0].v_samp_factor = 1;
    }
    template<class Work>
    void work(Work what) {
        if (!done_without_jump(target_, what))
            fail(file_, fmt::format("no JPEG could be made ({})", target_.message));
    }

    const Path& file_;
    jpeg_error_mgr errors_{};
    jpeg_compress_struct info_{};
    JumpTarget target_{};
    unsigned char* bytes_ = nullptr;
    unsigned long size_ = 0;
};

} // namespace

std::string jpeg_bytes(const Path& file, const BasicImage<std::uint8_t>& codes, double quality) {
    if (!(quality >= 0 && quality <= 1)) fail(file, fmt::format("a quality of {}, expected 0 to 1", quality));
    return Encoder(file).encoded(codes, quality);
}

} // namespace postfx::formats
