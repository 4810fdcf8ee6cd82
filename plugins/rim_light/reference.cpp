// The rim in float64, from angles.
#include <testing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace postfx::testing {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}

Vector to_eye(const ReferenceInput& input, int x, int y) {
    if (input.camera.orthographic) return {0, 0, 1};
    const double per_pixel = input.camera.tan_half_fov() / input.color.height;
    const auto& [axis_right, axis_up] = input.camera.principal_point;
    const int width = input.color.width, height = input.color.height;
    const Vector made = {(width - 2 * x - 1 + axis_right * width) * per_pixel,
                         (height - 2 * y - 1 + axis_up * height) * per_pixel, 1};
    return {made[0] / length(made), made[1] / length(made), made[2] / length(made)};
}

/// Unpolarised reflectance from the angles of incidence and refraction (Snell).
double fresnel(double cosine, double index) {
    const double in = std::acos(cosine), out = std::asin(std::sin(in) / index);
    if (in + out < 1e-6) return std::pow((index - 1) / (index + 1), 2);
    const double crossed = std::sin(in - out) / std::sin(in + out);
    const double parallel = std::tan(in - out) / std::tan(in + out);
    return (crossed * crossed + parallel * parallel) / 2;
}

double share(const ReferenceInput& input, const Vector& normal, const Vector& eye) {
    const double width = input.value("width");
    if (input.level == "classic") return std::clamp((width - dot(normal, eye)) / width, 0.0, 1.0);
    const double cosine = std::min(std::abs(dot(normal, eye)) / length(normal), 1.0);
    if (input.value("profile") == 0) return std::max(1 - cosine / width, 0.0);
    return fresnel(cosine, input.value("refractive_index"));
}

} // namespace

Image64 reference(const ReferenceInput& input) {
    const Image64& normals = input.attachments.at("normal");
    Image64 result(input.color.width, input.color.height, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const Vector normal = {normals.at(x, y, 0), normals.at(x, y, 1), normals.at(x, y, 2)};
            const double added =
                length(normal) > 0 ? share(input, normal, to_eye(input, x, y)) * input.value("strength") : 0;
            for (int c = 0; c < 3; ++c) {
                result.at(x, y, c) =
                    input.color.at(x, y, c) + added * input.value("color." + std::to_string(c));
            }
        }
    }
    return result;
}

} // namespace postfx::testing
