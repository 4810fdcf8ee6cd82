// A program that made its context and loaded its functions without postfx draws the same picture as `postfx apply`.
#include "../program/program.hpp"

#include <image/files.hpp>

#include <algorithm>
#include <cstdint>

using namespace postfx;
using namespace postfx::testing;

namespace {

constexpr int width = 61, height = 37; // rows that no alignment but that of their channels fits

void write_floats(const std::filesystem::path& path, const Image& image) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.values.data()),
               static_cast<std::streamsize>(image.values.size() * sizeof(float)));
}

} // namespace

TEST_CASE("a foreign program with its own context and loader draws what postfx apply draws") {
    const std::string loader = GENERATE("found", "given");
    CAPTURE(loader);
    const TemporaryDirectory scratch;
    const Image picture = noise(width, height, 0, 4, 7);
    write_image(scratch / "in.exr", picture);
    Image four(width, height, 4, 1.0f);
    for (std::size_t i = 0; i < picture.pixel_count(); ++i)
        std::copy_n(&picture.values[3 * i], 3, &four.values[4 * i]);
    write_floats(scratch / "in.raw", four);
    std::ofstream(scratch / "chain.yaml") << "effects: [bloom, vignette, tonemap, grain]\n";

    const Outcome apply = run_program({"apply", "--color", scratch / "in.exr", "--working", "rgba16f",
                                       "--chain", scratch / "chain.yaml", "-o", scratch / "out.png"},
                                      scratch.path());
    INFO(apply.err);
    REQUIRE(apply.status == 0);
    const Outcome foreign = run_command(
        {POSTFX_FOREIGN_PROGRAM, loader, POSTFX_BUILD_DIRECTORY "/postfx_plugins", scratch / "chain.yaml",
         std::to_string(width), std::to_string(height), scratch / "in.raw", scratch / "out.raw"});
    INFO(foreign.err);
    if (foreign.status == 77) return skip_case("no OpenGL 4.5 through EGL without a display");
    REQUIRE(foreign.status == 0);

    const std::string bytes = file_bytes(scratch / "out.raw");
    BasicImage<std::uint8_t> codes(width, height, 3);
    REQUIRE(bytes.size() == 4 * codes.pixel_count());
    for (std::size_t i = 0; i < codes.pixel_count(); ++i)
        std::copy_n(&bytes[4 * i], 3, &codes.values[3 * i]);
    write_codes(scratch / "foreign.png", codes);
    const Image shown = read_image(scratch / "out.png").image;
    REQUIRE(shown.channels == 3);
    const Image drawn = read_image(scratch / "foreign.png").image;
    std::size_t different = 0;
    for (std::size_t i = 0; i < shown.values.size(); ++i)
        different += shown.values[i] != drawn.values.at(i);
    CHECK(different == 0);
    CHECK(*std::min_element(bytes.begin(), bytes.end()) != *std::max_element(bytes.begin(), bytes.end()));
    // Loaders that were linked beside it found the same context.
    for (const std::string loader_beside : {"GLEW", "epoxy"}) {
        const bool linked =
            std::string_view(POSTFX_FOREIGN_LOADERS).find(loader_beside) != std::string_view::npos;
        CAPTURE(loader_beside, foreign.out);
        CHECK((foreign.out.find(loader_beside + ": \n") == std::string::npos) == linked);
    }
}

TEST_CASE("docs/embedding.md shows what the foreign program does") {
    const std::string page = file_bytes(POSTFX_SOURCE_DIRECTORY "/docs/embedding.md");
    const std::string program = file_bytes(POSTFX_SOURCE_DIRECTORY "/tests/embedding/foreign_program.cpp");
    const std::string begin = "```cpp\n", end = "```\n";
    std::size_t blocks = 0;
    for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at), ++blocks) {
        at += begin.size();
        const std::string block = page.substr(at, page.find(end, at) - at);
        INFO(block);
        CHECK(program.find(block) != std::string::npos);
    }
    CHECK(blocks == 2);
}
