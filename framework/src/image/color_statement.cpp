#include <image/color_statement.hpp>
#include <image/srgb.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

using Curve = std::function<double(double)>;

constexpr Chromaticity d65 = {0.3127, 0.3290};
constexpr Chromaticity illuminant_c = {0.310, 0.316};

struct NamedPrimaries {
    int code;
    const char* name;
    Chromaticities space;
};

/// ITU-T H.273, table 2. 1 (Rec. 709) is what we have.
constexpr NamedPrimaries known_primaries[] = {
    {1, "Rec. 709", rec709_chromaticities},
    {4, "BT.470 M", {{0.67, 0.33}, {0.21, 0.71}, {0.14, 0.08}, illuminant_c}},
    {5, "BT.470 BG", {{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, d65}},
    {6, "BT.601", {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, d65}},
    {7, "SMPTE 240M", {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, d65}},
    {8, "film", {{0.681, 0.319}, {0.243, 0.692}, {0.145, 0.049}, illuminant_c}},
    {9, "BT.2020", {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, d65}},
    {10, "XYZ", {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}}},
    {11, "DCI-P3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.314, 0.351}}},
    {12, "Display P3", {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, d65}},
    {22, "EBU 3213", {{0.630, 0.340}, {0.295, 0.605}, {0.155, 0.077}, d65}},
};

double rec709_to_light(double code) {
    return code < 0.081 ? code / 4.5 : std::pow((code + 0.099) / 1.099, 1 / 0.45);
}

double smpte_240m_to_light(double code) {
    return code < 0.0913 ? code / 4 : std::pow((code + 0.1115) / 1.1115, 1 / 0.45);
}

/// SMPTE ST 2084, with 203 cd/m^2, the reference white of ITU-R BT.2408, as 1.
double pq_to_light(double code) {
    constexpr double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128,
                     c3 = 2392.0 / 128;
    const double power = std::pow(std::max(code, 0.0), 1 / m2);
    const double share = std::max(power - c1, 0.0) / (c2 - c3 * power);
    return 10000 / 203.0 * std::pow(share, 1 / m1);
}

/// ITU-R BT.2100, the light of the scene, with 75 % of the signal, reference white of BT.2408, as 1.
double hlg_to_light(double code) {
    constexpr double a = 0.17883277, b = 1 - 4 * a;
    const double c = 0.5 - a * std::log(4 * a);
    const auto scene = [&](double signal) {
        return signal <= 0.5 ? signal * std::abs(signal) / 3 : (std::exp((signal - c) / a) + b) / 12;
    };
    return scene(code) / scene(0.75);
}

Curve power(double exponent) {
    return [exponent](double code) { return std::copysign(std::pow(std::abs(code), exponent), code); };
}

struct NamedCurve {
    const char* name;
    Curve to_light; ///< nothing: sRGB
};

/// ITU-T H.273, table 3.
std::optional<NamedCurve> curve_of_cicp(int transfer) {
    switch (transfer) {
    case 1:
    case 6:
    case 11:
    case 14:
    case 15:
        return NamedCurve{"the curve of Rec. 709", rec709_to_light};
    case 4:
        return NamedCurve{"gamma 2.2", power(2.2)};
    case 5:
        return NamedCurve{"gamma 2.8", power(2.8)};
    case 7:
        return NamedCurve{"the curve of SMPTE 240M", smpte_240m_to_light};
    case 8:
        return NamedCurve{"linear", [](double code) { return code; }};
    case 13:
        return NamedCurve{"the curve of sRGB", {}};
    case 16:
        return NamedCurve{"PQ, 203 cd/m2 are 1", pq_to_light};
    case 17:
        return NamedCurve{"gamma 2.6", [](double code) { return 52.37 / 48 * power(2.6)(code); }};
    case 18:
        return NamedCurve{"HLG, the scene's light, 75 % of the signal are 1", hlg_to_light};
    default:
        return std::nullopt;
    }
}

/// Codes of 8 bits that begin at 16 and end at 235, and those of more bits likewise, stretched to 0 to 1.
Curve from_narrow_range(Curve to_light, int bits) {
    const double largest = std::ldexp(1.0, bits) - 1, unit = std::ldexp(1.0, bits - 8);
    return [=, curve = to_light ? std::move(to_light) : Curve(srgb_to_linear)](double code) {
        return curve((code * largest / unit - 16) / 219);
    };
}

} // namespace

ColorStatement color_of_cicp(const std::string& where, int primaries, int transfer, bool full_range,
                             int bits) {
    const auto space = std::find_if(std::begin(known_primaries), std::end(known_primaries),
                                    [&](const NamedPrimaries& known) { return known.code == primaries; });
    const std::optional<NamedCurve> curve = curve_of_cicp(transfer);
    ColorStatement statement;
    if (space == std::end(known_primaries) || !curve) {
        statement.warnings.push_back(fmt::format(
            "{}: primaries {} with transfer {} are not known; not followed", where, primaries, transfer));
        return statement;
    }
    statement.to_light = curve->to_light;
    if (!full_range) statement.to_light = from_narrow_range(statement.to_light, bits);
    if (!is_rec709(space->space)) statement.to_rec709 = matrix_to_rec709(space->space, Adaptation::bradford);
    if (!statement.is_plain_srgb())
        statement.honoured.push_back(fmt::format("{}: {} primaries, {}{}", where, space->name, curve->name,
                                                 full_range ? "" : ", narrow range"));
    return statement;
}

ColorStatement color_of_icc(std::string_view bytes, int channels) {
    ColorStatement statement;
    std::shared_ptr<const IccProfile> profile = IccProfile::open(bytes);
    if (!profile) {
        statement.warnings.emplace_back("its ICC profile is damaged or of no known kind; not followed");
        return statement;
    }
    if (profile->channels() != channels) {
        statement.warnings.push_back(
            fmt::format("its ICC profile \"{}\" is for {} channels where the picture has {}; not followed",
                        profile->name(), profile->channels(), channels));
        return statement;
    }
    if (profile->is_srgb()) return statement;
    statement.honoured.push_back(fmt::format("ICC profile \"{}\"", profile->name()));
    statement.profile = std::move(profile);
    return statement;
}

ColorStatement color_of_colorimetry(const std::string& where, std::optional<double> gamma,
                                    const std::optional<Chromaticities>& space) {
    ColorStatement statement;
    if (gamma) {
        statement.to_light = power(*gamma);
        statement.honoured.push_back(fmt::format("{}: gamma {:.4g}", where, *gamma));
    }
    if (!space || is_rec709(*space)) return statement;
    statement.to_rec709 = matrix_to_rec709(*space, Adaptation::bradford);
    if (statement.to_rec709)
        statement.honoured.push_back(fmt::format("{}: primaries, converted to Rec. 709", where));
    else
        statement.warnings.push_back(
            fmt::format("{}: its primaries make no colour space; not followed", where));
    return statement;
}

ColorStatement adobe_rgb_color() {
    // Adobe RGB (1998) color image encoding, 4.3.
    constexpr Chromaticities space = {{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, d65};
    ColorStatement statement;
    statement.to_light = power(563 / 256.0);
    statement.to_rec709 = matrix_to_rec709(space, Adaptation::bradford);
    statement.honoured.emplace_back("EXIF: Adobe RGB");
    return statement;
}

} // namespace postfx
