// my_effect in float64 on the CPU: what the GLSL must agree with. Written from the model, not from the GLSL.
#include <testing.hpp>

postfx::Image64 postfx::testing::reference(const ReferenceInput& input) {
    const double tint[] = {input.value("tint.0"), input.value("tint.1"), input.value("tint.2")};
    const double amount = input.value("amount");
    Image64 result(input.color.width, input.color.height, 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const double* color = input.color.pixel(x, y);
            // Relative luminance, ITU-R BT.709.
            const double luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
            for (int c = 0; c < 3; ++c)
                result.at(x, y, c) = (1 - amount) * color[c] + amount * luminance * tint[c];
        }
    }
    return result;
}
