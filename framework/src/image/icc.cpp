#include <image/icc.hpp>
#include <image/srgb.hpp>

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace postfx {
namespace {

struct CloseProfile {
    void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct DeleteTransform {
    void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
struct DeleteContext {
    void operator()(cmsContext context) const { cmsDeleteContext(context); }
};
struct FreeCurve {
    void operator()(cmsToneCurve* curve) const { cmsFreeToneCurve(curve); }
};
using Context = std::unique_ptr<std::remove_pointer_t<cmsContext>, DeleteContext>;
using Profile = std::unique_ptr<void, CloseProfile>;
using Transform = std::unique_ptr<void, DeleteTransform>;
using Curve = std::unique_ptr<cmsToneCurve, FreeCurve>;

constexpr cmsCIExyY d65 = {0.3127, 0.3290, 1};

/// A context of its own, because lcms would print and share what goes wrong.
Context new_context() {
    Context context(cmsCreateContext(nullptr, nullptr));
    if (context) cmsSetLogErrorHandlerTHR(context.get(), [](cmsContext, cmsUInt32Number, const char*) {});
    return context;
}

Profile linear_rec709(cmsContext context, bool grey) {
    const Curve line(cmsBuildGamma(context, 1));
    if (!line) return nullptr;
    if (grey) return Profile(cmsCreateGrayProfileTHR(context, &d65, line.get()));
    const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
    cmsToneCurve* const curves[3] = {line.get(), line.get(), line.get()};
    return Profile(cmsCreateRGBProfileTHR(context, &d65, &primaries, curves));
}

int channels_of(cmsColorSpaceSignature space) {
    return space == cmsSigGrayData ? 1 : space == cmsSigRgbData ? 3 : space == cmsSigCmykData ? 4 : 0;
}

std::string description_of(cmsHPROFILE profile) {
    std::array<char, 256> text{};
    cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text.data(), text.size() - 1);
    std::string name(text.data());
    std::replace_if(
        name.begin(), name.end(), [](unsigned char letter) { return letter < 32; }, ' ');
    return name;
}

} // namespace

struct IccProfile::Parts {
    Context context{};
    Profile profile{};
    Transform transform{};
    std::string name{};
    int channels = 0;
};

IccProfile::IccProfile(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
IccProfile::~IccProfile() = default;

std::shared_ptr<const IccProfile> IccProfile::open(std::string_view bytes) {
    auto parts = std::make_unique<Parts>();
    parts->context = new_context();
    if (!parts->context) return nullptr;
    cmsContext context = parts->context.get();
    parts->profile.reset(
        cmsOpenProfileFromMemTHR(context, bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
    if (!parts->profile || cmsGetDeviceClass(parts->profile.get()) == cmsSigLinkClass) return nullptr;
    parts->channels = channels_of(cmsGetColorSpace(parts->profile.get()));
    if (parts->channels == 0) return nullptr;
    const Profile light = linear_rec709(context, parts->channels == 1);
    if (!light) return nullptr;
    static constexpr cmsUInt32Number formats[] = {0, TYPE_GRAY_FLT, 0, TYPE_RGB_FLT, TYPE_CMYK_FLT};
    // The optimizer would bake the way into 16-bit tables, which clip.
    parts->transform.reset(cmsCreateTransformTHR(context, parts->profile.get(), formats[parts->channels],
                                                 light.get(),
                                                 parts->channels == 1 ? TYPE_GRAY_FLT : TYPE_RGB_FLT,
                                                 INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE));
    if (!parts->transform) return nullptr;
    parts->name = description_of(parts->profile.get());
    return std::shared_ptr<const IccProfile>(new IccProfile(std::move(parts)));
}

const std::string& IccProfile::name() const {
    return parts_->name;
}

int IccProfile::channels() const {
    return parts_->channels;
}

int IccProfile::light_channels() const {
    return parts_->channels == 1 ? 1 : 3;
}

bool IccProfile::is_srgb() const {
    if (channels() == 4) return false;
    // The profiles in use differ from the standard in rounding and in tables, by less than a tenth of an 8-bit code;
    // Adobe RGB and Display P3 by dozens.
    constexpr double tolerance = 0.4 / 255;
    constexpr int steps = 8;
    const auto differs = [&](const std::vector<float>& samples) {
        std::vector<float> light(samples.size());
        to_light(samples.data(), light.data(), 1);
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (!(std::abs(linear_to_srgb(light[i]) - samples[i]) <= tolerance)) return true;
        return false;
    };
    const auto at = [](int step) { return static_cast<float>(step) / steps; };
    for (int r = 0; r <= steps; ++r) {
        if (channels() == 1 && differs({at(r)})) return false;
        for (int g = 0; channels() == 3 && g <= steps; ++g)
            for (int b = 0; b <= steps; ++b)
                if (differs({at(r), at(g), at(b)})) return false;
    }
    return true;
}

void IccProfile::to_light(const float* samples, float* light, std::size_t pixels) const {
    if (channels() != 4) {
        cmsDoTransform(parts_->transform.get(), samples, light, static_cast<cmsUInt32Number>(pixels));
        return;
    }
    std::vector<float> percent(samples, samples + 4 * pixels); // of ink, as lcms has floats of CMYK
    for (float& value : percent)
        value *= 100;
    cmsDoTransform(parts_->transform.get(), percent.data(), light, static_cast<cmsUInt32Number>(pixels));
}

namespace {

std::string make_srgb_icc_profile() {
    const Context context = new_context();
    const Profile profile(context ? cmsCreate_sRGBProfileTHR(context.get()) : nullptr);
    cmsUInt32Number size = 0;
    if (!profile || !cmsSaveProfileToMem(profile.get(), nullptr, &size)) throw std::bad_alloc();
    std::string bytes(size, '\0');
    if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) throw std::bad_alloc();
    // Bytes 24 to 35 of the header are the moment at which it was made, here that of sRGB's own standard: the same
    // picture is the same file.
    static constexpr std::array<char, 12> made = {0x07, static_cast<char>(0xcf), 0, 10, 0, 18, 0, 0, 0, 0, 0,
                                                  0};
    std::copy(made.begin(), made.end(), bytes.begin() + 24);
    return bytes;
}

} // namespace

const std::string& srgb_icc_profile() {
    static const std::string profile = make_srgb_icc_profile();
    return profile;
}

} // namespace postfx
