#include "thin_lens.hpp"

#include <truths/sampling.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

namespace postfx::host {
namespace {

/// The f-number that stands for a pinhole, and the focus of a camera that names none: as the effect's page says.
constexpr double pinhole = 128, unsaid_focus = 5;

/// By how many times the difference between red and blue the focal length is longer than for green, by Cauchy's
/// n = a + b / wavelength^2 at 612, 549 and 464 nm: f grows as n falls.
std::array<double, 3> focal_shifts() {
    const auto index = [](double micrometres) { return 1 / (micrometres * micrometres); };
    const double red = index(0.612), green = index(0.549), blue = index(0.464);
    return {(green - red) / (blue - red), 0, (green - blue) / (blue - red)};
}

} // namespace

std::string ThinLens::text() const {
    return fmt::format("aperture {} m, focus at {}, {}, {} 1/m", aperture, focus[0], focus[1], focus[2]);
}

ThinLens thin_lens(const TruthRequest& request, const Camera& camera) {
    const Place place{.effect = request.entry.effect->id};
    if (camera.orthographic)
        throw Error(place, "the truth needs a perspective camera; this one is orthographic");
    if (request.value("view") != 0) throw Error(place, "there is a truth of view: picture only");
    const double focal_length = request.value("focal_length") / 1000;
    double distance = request.value("focus_distance");
    if (distance == 0) distance = camera.focus_distance > 0 ? camera.focus_distance : unsaid_focus;

    ThinLens lens;
    const double f_number = request.value("f_number");
    lens.aperture = f_number >= pinhole ? 0 : focal_length / f_number;
    // The sensor stays; with 1/f = 1/v + 1/s a focal length longer by the share e moves 1/s by -e/f.
    const double aberration = request.value("axial_aberration");
    for (std::size_t c = 0; c < 3; ++c)
        lens.focus[c] = 1 / distance - aberration * focal_shifts()[c] / focal_length;
    const double up = camera.tan_half_fov();
    lens.half_extent = {up * request.width / request.height, up};
    return lens;
}

glm::dvec2 lens_point(int index) {
    return disc_point(truth_point(index, 1));
}

} // namespace postfx::host
