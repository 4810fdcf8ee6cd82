// ICC profiles, by Little CMS.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace postfx {

/// A profile of grey, RGB or CMYK samples and the way from them to light. Relative colorimetric: the medium's white
/// becomes 1, and nothing is clipped where the profile is a matrix and curves.
class IccProfile {
public:
    /// Nothing if the bytes are no such profile.
    static std::shared_ptr<const IccProfile> open(std::string_view bytes);
    ~IccProfile();
    IccProfile(const IccProfile&) = delete;
    IccProfile& operator=(const IccProfile&) = delete;

    const std::string& name() const;
    int channels() const;       ///< 1 grey, 3 RGB, 4 CMYK
    int light_channels() const; ///< 1 for grey, else 3
    /// Is it sRGB (grey: its curve), by its numbers and not by its name?
    bool is_srgb() const;
    /// `samples`: 0 to 1 (CMYK: the share of ink); `light`: linear Rec. 709, or grey.
    void to_light(const float* samples, float* light, std::size_t pixels) const;

private:
    struct Parts;
    explicit IccProfile(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

/// The profile that says sRGB, for files that we write; always the same bytes.
const std::string& srgb_icc_profile();

} // namespace postfx
