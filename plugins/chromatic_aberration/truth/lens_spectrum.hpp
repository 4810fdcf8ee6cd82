// How a lens of one glass magnifies the wavelengths that a camera's channels see.
#pragma once

namespace postfx::host {

/// The refractive index follows Cauchy's A + B / wavelength^2. Red (612 nm), green (549 nm) and blue (464 nm) have
/// kernels that are linear in the index: red's and blue's rise from green's place to their own, green's falls to
/// both, half of it on either side.
class LensSpectrum {
public:
    /// Red and blue lie `strength` picture heights apart in the corner of a picture of that size, with the optical axis
    /// in its middle.
    LensSpectrum(double strength, int width, int height);

    /// Magnification - 1 of a wavelength that `channel` sees; `quantile`, 0 to 1, of its kernel.
    double displacement(int channel, double quantile) const;

    /// Of the wavelengths at which red and blue end, magnification - 1.
    double red_end() const { return red_end_; }
    double blue_end() const { return blue_end_; }

private:
    double red_end_, blue_end_;
};

} // namespace postfx::host
