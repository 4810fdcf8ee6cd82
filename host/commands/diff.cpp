// postfx diff: how far two pictures are from each other, for people and for scripts.
#include "command.hpp"
#include "options.hpp"

#include "terminal/effect_text.hpp"
#include "terminal/text_table.hpp"

#include <image/files.hpp>
#include <image/flip.hpp>
#include <image/heat_colors.hpp>
#include <image/metrics.hpp>
#include <image/srgb.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
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

bool is_8bit_srgb(const ImageFile& file) {
    return file.coding.plain_srgb && file.coding.bits == 8;
}

Pair read_pair(const std::string& file_a, const std::string& file_b, const std::string& layer) {
    const ImageSource source_a = open_image(file_a), source_b = open_image(file_b);
    Pair pair;
    if (!layer.empty()) {
        pair.a = read_image(source_a, {.role = Role::data, .layer = layer}).image;
        pair.b = read_image(source_b, {.role = Role::data, .layer = layer}).image;
        return pair;
    }
    ImageFile a = read_image(source_a), b = read_image(source_b);
    pair.codes = is_8bit_srgb(a) && is_8bit_srgb(b);
    if (pair.codes) {
        a.image = read_image(source_a, {.role = Role::data}).image;
        b.image = read_image(source_b, {.role = Role::data}).image;
    }
    if (describe_image(source_a).layers.size() > 1 || describe_image(source_b).layers.size() > 1)
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
void write_difference_png(const std::string& file, const std::string& kind, const Image& difference,
                          double gain) {
    const Image rgb = reshaped(difference, 3, false);
    std::vector<std::uint8_t> codes;
    for (float value : rgb.values)
        codes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, value * gain))));
    write_codes(file, {rgb.width, rgb.height, 3, std::move(codes)}, {.kind = kind});
}

/// Light in float64, whatever the files hold; alpha is never encoded.
Image64 light(const Image& image, bool codes) {
    Image64 result = convert<double>(image);
    if (!codes) return result;
    const std::size_t colors = image.channels < 3 ? 1 : 3;
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        for (std::size_t c = 0; c < colors; ++c) {
            double& value = result.values[i * static_cast<std::size_t>(image.channels) + c];
            value = srgb_to_linear(value);
        }
    return result;
}

/// .png in heat colours, else the errors themselves in one channel.
void write_map(const std::string& file, const std::string& kind, const Image& map) {
    if (is_display_kind(file, kind))
        write_codes(file, {map.width, map.height, 3, heat_colors(map)}, {.kind = kind});
    else
        write_image(file, map, {.kind = kind});
}

/// All that is measured.
struct Measured {
    Difference difference;
    RelativeError relative;
    std::optional<FlipError> flip;
};

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

class DiffCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("A", a_, "Picture: PNG, JPEG, HDR, EXR or PFM; the reference of the relative errors")
            ->required()
            ->type_name("");
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
        app.add_option(
               "--format", format_,
               "Kind of the picture of -o - or --map -, standard output, where text goes to stderr then")
            ->type_name("KIND")
            ->default_str("");
        CLI::Option* flip =
            app.add_flag("--flip", flip_, "Also LDR-FLIP: what a viewer sees who flips between the pictures");
        app.add_option(
               "--ppd", ppd_,
               "Viewing condition of FLIP: pixels per degree of the visual field (67.02: a 3840 pixels "
               "and 0.7 m wide screen seen from 0.7 m)")
            ->check(CLI::Range(1.0, 1000.0))
            ->needs(flip);
        app.add_option(
               "--map", map_,
               "Write FLIP per pixel: .png in heat colours (black 0, white 1, green not finite), .exr "
               "or .pfm as it is")
            ->type_name("FILE")
            ->needs(flip);
        app.add_flag("--json", json_, "As JSON");
        app.footer(
            "Two 8-bit files are compared as their codes / 255, anything else as linear values.\n"
            "differing counts pixels with any difference in bits; worst is counted from the top left.\n"
            "A pixel that is not finite in one picture only is beyond every bound, and makes SSIM 0.\n"
            "rel_mse is the mean of (b - a)^2 / (|a| + 0.01)^2, relative_rmse is sqrt(sum (b - a)^2 / sum "
            "a^2), "
            "both over\n"
            "the colours in linear light (8-bit files are decoded for them); without a value when any pixel "
            "of "
            "either\n"
            "picture is not finite (non_finite_light counts them).\n"
            "FLIP (Andersson et al. 2020) is for pictures as a display shows them: 8-bit files, or linear "
            "light in "
            "0..1;\n"
            "what lies outside is shown as 0 or 1 and counted (clipped), so tone map light first. Median and "
            "quartiles are\n"
            "weighted by the error: half of all error is in pixels below the median.\n"
            "JSON: {max_abs, rmse, psnr, ssim, rel_mse, relative_rmse, differing, non_finite, "
            "non_finite_light, "
            "worst: {x, y},\n"
            "pixels, peak, compared, notes, passed} and with --flip {flip: {pixels_per_degree, mean, "
            "weighted_median,\n"
            "weighted_first_quartile, weighted_third_quartile, min, max, non_finite, clipped}}; what is "
            "infinite "
            "is null:\n"
            "psnr of equal pictures, psnr, rmse and flip with a non_finite pixel.\n"
            "Status: 0 equal (with --max-abs and --min-psnr: within both), 1 different, 2 bad input.");
    }

    Status run() override {
        check_outputs();
        const Pair pair = read_pair(a_, b_, layer_);
        const Measured measured = measure(pair);
        const bool passes = passed(measured.difference);
        if (json_) {
            fmt::print(text_output(), "{}\n", json(pair, measured, passes).dump(2));
        } else {
            print(pair, measured, passes);
        }
        if (!output_.empty()) write_difference(pair, measured.difference);
        if (!map_.empty()) write_map(map_, kind_for(map_), measured.flip->map);
        return passes ? Status::success : Status::differs;
    }

private:
    void check_outputs() const {
        if (output_ == "-" && map_ == "-") throw Error("-o - and --map - can't both be standard output");
        for (const std::string& file : {output_, map_})
            if (!file.empty()) picture_file(file, kind_for(file));
    }

    /// Of other files the ending says it.
    std::string kind_for(const std::string& file) const { return file == "-" ? format_ : ""; }

    /// Where no picture goes.
    std::FILE* text_output() const { return output_ == "-" || map_ == "-" ? stderr : stdout; }

    Measured measure(const Pair& pair) const {
        Measured measured{compare(pair.a, pair.b, peak_),
                          relative_error(light(pair.b, pair.codes), light(pair.a, pair.codes)), std::nullopt};
        if (flip_) measured.flip = flip(pair.a, pair.b, pair.codes ? Encoding::srgb : Encoding::linear, ppd_);
        return measured;
    }

    bool passed(const Difference& difference) const {
        if (!max_abs_ && !min_psnr_) return difference.differing == 0;
        return difference.non_finite == 0 && (!max_abs_ || difference.max_abs <= *max_abs_)
               && (!min_psnr_ || difference.psnr >= *min_psnr_);
    }

    Json json(const Pair& pair, const Measured& measured, bool passes) const {
        const Difference& difference = measured.difference;
        Json json = {
            {"max_abs", difference.max_abs},
            {"rmse", finite_or_null(difference.rmse)},
            {"psnr", finite_or_null(difference.psnr)},
            {"ssim", difference.ssim},
            {"rel_mse", finite_or_null(measured.relative.rel_mse)},
            {"relative_rmse", finite_or_null(measured.relative.relative_rmse)},
            {"differing", difference.differing},
            {"non_finite", difference.non_finite},
            {"non_finite_light", measured.relative.non_finite},
            {"worst", {{"x", difference.worst_x}, {"y", pair.a.height - 1 - difference.worst_y}}},
            {"pixels", pair.a.pixel_count()},
            {"peak", peak_},
            {"compared", pair.codes ? "codes" : "linear"},
            {"notes", pair.notes},
            {"passed", passes},
        };
        if (measured.flip) json["flip"] = flip_json(*measured.flip);
        return json;
    }

    Json flip_json(const FlipError& error) const {
        return {
            {"pixels_per_degree", ppd_},
            {"mean", finite_or_null(error.mean)},
            {"weighted_median", finite_or_null(error.weighted_median)},
            {"weighted_first_quartile", finite_or_null(error.weighted_first_quartile)},
            {"weighted_third_quartile", finite_or_null(error.weighted_third_quartile)},
            {"min", finite_or_null(error.min)},
            {"max", finite_or_null(error.max)},
            {"non_finite", error.non_finite},
            {"clipped", error.clipped},
        };
    }

    void print(const Pair& pair, const Measured& measured, bool passes) const {
        const Difference& difference = measured.difference;
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
            {"rel_mse", fmt::format("{:.6g}", measured.relative.rel_mse)},
            {"relative_rmse", fmt::format("{:.6g}", measured.relative.relative_rmse)},
            {"differing",
             fmt::format("{} of {} pixels ({:.3g} %)", difference.differing, pair.a.pixel_count(), share)},
        };
        if (difference.non_finite > 0)
            rows.push_back(
                {"non_finite", fmt::format("{} pixels in one picture only", difference.non_finite)});
        if (measured.relative.non_finite > difference.non_finite)
            rows.push_back({"non_finite_light", fmt::format("{} pixels", measured.relative.non_finite)});
        if (difference.differing > 0) {
            rows.push_back({"worst", fmt::format("at {}, {} from the top left", difference.worst_x,
                                                 pair.a.height - 1 - difference.worst_y)});
        }
        if (measured.flip) add_flip(rows, *measured.flip);
        rows.push_back({"compared", pair.codes ? "8-bit codes / 255" : "linear values"});
        for (const std::string& note : pair.notes)
            rows.push_back({"note", note});
        fmt::print(text_output(), "{}\n{}",
                   bounded ? (passes ? "within the bounds" : "beyond the bounds")
                           : (passes ? "equal" : "different"),
                   text_table(rows, 2));
    }

    void add_flip(std::vector<std::vector<std::string>>& rows, const FlipError& error) const {
        rows.push_back({"flip", fmt::format("{:.6f} mean at {:.4g} pixels per degree", error.mean, ppd_)});
        rows.push_back({"flip range", fmt::format("{:.6f} to {:.6f}", error.min, error.max)});
        rows.push_back(
            {"flip weighted", fmt::format("median {:.6f}, quartiles {:.6f} and {:.6f}", error.weighted_median,
                                          error.weighted_first_quartile, error.weighted_third_quartile)});
        if (error.clipped > 0)
            rows.push_back({"flip clipped", fmt::format("{} pixels outside 0..1", error.clipped)});
    }

    void write_difference(const Pair& pair, const Difference& difference) const {
        const Image image = absolute_difference(pair.a, pair.b);
        const std::string kind = kind_for(output_);
        if (!is_display_kind(output_, kind)) {
            write_image(output_, image, {.kind = kind});
            return;
        }
        const double gain = gain_.value_or(difference.max_abs > 0 ? 1 / difference.max_abs : 1);
        write_difference_png(output_, kind, image, gain);
        if (!json_) fmt::print(text_output(), "  {} shows the difference times {:.4g}\n", output_, gain);
    }

    std::string a_, b_, output_, layer_, map_, format_;
    std::optional<double> gain_, max_abs_, min_psnr_;
    double peak_ = 1, ppd_ = default_pixels_per_degree;
    bool json_ = false, flip_ = false;
};

const Register<DiffCommand> registered("diff",
                                       "Compare two pictures: largest, mean and perceived difference");

} // namespace
} // namespace postfx::host
