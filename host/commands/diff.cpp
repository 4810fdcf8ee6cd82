// postfx diff: how far two pictures are from each other, for people and for scripts.
#include "command.hpp"
#include "effect_text.hpp"
#include "text_table.hpp"

#include <image/files.hpp>
#include <image/metrics.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace postfx::host {
namespace {

/// Two pictures made comparable, and in words what that took.
struct Pair {
    Image a, b;
    bool codes = false; ///< 8-bit codes / 255; otherwise linear values
    std::vector<std::string> notes;
};

bool has_alpha(const Image& image) {
    return image.channels == 2 || image.channels == 4;
}

/// Grey is repeated into RGB when `colors` is 3; alpha is left out unless `alpha`.
Image reshaped(const Image& image, int colors, bool alpha) {
    const int own_colors = image.channels < 3 ? 1 : 3;
    Image result(image.width, image.height, colors + (alpha ? 1 : 0));
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float* from = image.values.data() + i * image.channels;
        float* to = result.values.data() + i * result.channels;
        for (int c = 0; c < colors; ++c)
            to[c] = from[std::min(c, own_colors - 1)];
        if (alpha) to[colors] = from[own_colors];
    }
    return result;
}

void match_channels(Pair& pair) {
    if (pair.a.channels == pair.b.channels) return;
    const bool alpha = has_alpha(pair.a) && has_alpha(pair.b);
    const int colors = std::max(pair.a.channels, pair.b.channels) < 3 ? 1 : 3;
    if (has_alpha(pair.a) != has_alpha(pair.b)) pair.notes.emplace_back("only one has alpha; it is left out");
    if ((pair.a.channels < 3) != (pair.b.channels < 3))
        pair.notes.emplace_back("one is grey; it is taken as equal red, green and blue");
    pair.a = reshaped(pair.a, colors, alpha);
    pair.b = reshaped(pair.b, colors, alpha);
}

Pair read_pair(const std::string& file_a, const std::string& file_b, const std::string& layer) {
    Pair pair;
    if (!layer.empty()) {
        pair.a = read_data(file_a, layer);
        pair.b = read_data(file_b, layer);
        return pair;
    }
    ImageFile a = read_image(file_a), b = read_image(file_b);
    pair.codes = a.was_8bit && b.was_8bit;
    if (pair.codes) {
        a.image = read_data(file_a);
        b.image = read_data(file_b);
    }
    if (!a.layers.empty() || !b.layers.empty())
        pair.notes.emplace_back("only the colour is compared; --layer selects another layer");
    pair.a = std::move(a.image);
    pair.b = std::move(b.image);
    match_channels(pair);
    return pair;
}

/// |a - b| of every channel; infinity where one is not finite and the other is or is another.
Image absolute_difference(const Image& a, const Image& b) {
    Image result(a.width, a.height, a.channels);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const float x = a.values[i], y = b.values[i];
        const bool same = x == y || (std::isnan(x) && std::isnan(y));
        const float difference = same ? 0.0f : std::abs(x - y);
        result.values[i] = std::isnan(difference) ? std::numeric_limits<float>::infinity() : difference;
    }
    return result;
}

/// A PNG shows the colours' difference times `gain` as it is, without sRGB encoding: twice the difference,
/// twice the code.
void write_difference_png(const std::string& file, const Image& difference, double gain) {
    const Image rgb = reshaped(difference, 3, false);
    std::vector<std::uint8_t> codes;
    for (float value : rgb.values)
        codes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, value * gain))));
    write_png(file, rgb.width, rgb.height, 3, codes);
}

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

class DiffCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("A", a_, "Picture: PNG, JPEG, HDR, EXR or PFM")->required()->type_name("");
        app.add_option("B", b_, "Picture of the same size")->required()->type_name("");
        app.add_option("-o,--output", output_,
                       "Write the absolute difference: .png amplified (--gain), .exr, .hdr or .pfm as it is")
            ->type_name("FILE");
        app.add_option("--gain", gain_,
                       "Factor for the difference in a .png; the largest becomes white without it")
            ->check(CLI::PositiveNumber);
        app.add_option("--peak", peak_, "The value that PSNR and SSIM take for full scale")
            ->check(CLI::PositiveNumber);
        app.add_option("--max-abs", max_abs_, "Status 0 when no value differs by more than this")
            ->check(CLI::NonNegativeNumber);
        app.add_option("--min-psnr", min_psnr_, "Status 0 when the PSNR is at least this [dB]");
        app.add_option("--layer", layer_, "Compare this layer of two EXR files instead of the colour")
            ->type_name("NAME");
        app.add_flag("--json", json_, "As JSON");
        app.footer(
            "Two 8-bit files are compared as their codes / 255, anything else as linear values.\n"
            "differing counts pixels with any difference in bits; worst is counted from the top left.\n"
            "A pixel that is not finite in one picture only is beyond every bound, and makes SSIM 0.\n"
            "JSON: {max_abs, rmse, psnr, ssim, differing, non_finite, worst: {x, y}, pixels, peak, compared, "
            "notes,\n"
            "passed}; psnr is null when infinite (equal pictures), psnr and rmse with a non_finite pixel.\n"
            "Status: 0 equal (with --max-abs and --min-psnr: within both), 1 different, 2 bad input.");
    }

    Status run() override {
        if (!output_.empty()) check_writable_kind(output_);
        const Pair pair = read_pair(a_, b_, layer_);
        const Difference difference = compare(pair.a, pair.b, peak_);
        const bool passes = passed(difference);
        if (json_) {
            fmt::print("{}\n", json(pair, difference, passes).dump(2));
        } else {
            print(pair, difference, passes);
        }
        if (!output_.empty()) write_difference(pair, difference);
        return passes ? Status::success : Status::differs;
    }

private:
    bool passed(const Difference& difference) const {
        if (!max_abs_ && !min_psnr_) return difference.differing == 0;
        return difference.non_finite == 0 && (!max_abs_ || difference.max_abs <= *max_abs_)
               && (!min_psnr_ || difference.psnr >= *min_psnr_);
    }

    Json json(const Pair& pair, const Difference& difference, bool passes) const {
        return {
            {"max_abs", difference.max_abs},
            {"rmse", finite_or_null(difference.rmse)},
            {"psnr", finite_or_null(difference.psnr)},
            {"ssim", difference.ssim},
            {"differing", difference.differing},
            {"non_finite", difference.non_finite},
            {"worst", {{"x", difference.worst_x}, {"y", pair.a.height - 1 - difference.worst_y}}},
            {"pixels", pair.a.pixel_count()},
            {"peak", peak_},
            {"compared", pair.codes ? "codes" : "linear"},
            {"notes", pair.notes},
            {"passed", passes},
        };
    }

    void print(const Pair& pair, const Difference& difference, bool passes) const {
        const double share =
            100.0 * static_cast<double>(difference.differing) / static_cast<double>(pair.a.pixel_count());
        const bool bounded = max_abs_ || min_psnr_;
        std::string max_abs = fmt::format("{:.6g}", difference.max_abs);
        if (pair.codes) max_abs += fmt::format(" ({:.0f} of 255 codes)", 255 * difference.max_abs);
        std::vector<std::vector<std::string>> rows = {
            {"max_abs", max_abs},
            {"rmse", fmt::format("{:.6g}", difference.rmse)},
            {"psnr", fmt::format("{:.4g} dB", difference.psnr)},
            {"ssim", fmt::format("{:.6f}", difference.ssim)},
            {"differing",
             fmt::format("{} of {} pixels ({:.3g} %)", difference.differing, pair.a.pixel_count(), share)},
        };
        if (difference.non_finite > 0)
            rows.push_back(
                {"non_finite", fmt::format("{} pixels in one picture only", difference.non_finite)});
        if (difference.differing > 0) {
            rows.push_back({"worst", fmt::format("at {}, {} from the top left", difference.worst_x,
                                                 pair.a.height - 1 - difference.worst_y)});
        }
        rows.push_back({"compared", pair.codes ? "8-bit codes / 255" : "linear values"});
        for (const std::string& note : pair.notes)
            rows.push_back({"note", note});
        fmt::print("{}\n{}",
                   bounded ? (passes ? "within the bounds" : "beyond the bounds")
                           : (passes ? "equal" : "different"),
                   text_table(rows, 2));
    }

    void write_difference(const Pair& pair, const Difference& difference) const {
        const Image image = absolute_difference(pair.a, pair.b);
        if (!is_display_kind(output_)) {
            write_image(output_, image);
            return;
        }
        const double gain = gain_.value_or(difference.max_abs > 0 ? 1 / difference.max_abs : 1);
        write_difference_png(output_, image, gain);
        if (!json_) fmt::print("  {} shows the difference times {:.4g}\n", output_, gain);
    }

    std::string a_, b_, output_, layer_;
    std::optional<double> gain_, max_abs_, min_psnr_;
    double peak_ = 1;
    bool json_ = false;
};

const Register<DiffCommand> registered("diff",
                                       "Compare two pictures: largest, mean and perceived difference");

} // namespace
} // namespace postfx::host
