// postfx diff on small pictures: numbers, statuses, the difference image.
#include "program.hpp"

#include <image/files.hpp>
#include <testing.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

using namespace postfx;
using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

constexpr int width = 16, height = 12;

/// A grey PNG of those 8-bit codes with one pixel of another code.
std::string png(const TemporaryDirectory& scratch, const std::string& name, int channels, std::uint8_t code,
                std::uint8_t odd) {
    std::vector<std::uint8_t> codes(std::size_t(width) * height * channels, code);
    // Column 3, second row from the bottom.
    for (int c = 0; c < channels; ++c)
        codes[(std::size_t(width) + 3) * channels + c] = odd;
    write_png((scratch / name).string(), width, height, channels, codes);
    return (scratch / name).string();
}

std::string pfm(const TemporaryDirectory& scratch, const std::string& name, const Image& image) {
    write_image((scratch / name).string(), image);
    return (scratch / name).string();
}

Json diff_json(const std::string& a, const std::string& b, int expected_status) {
    const Outcome outcome = run_program({"diff", a, b, "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.status == expected_status);
    return Json::parse(outcome.out);
}

} // namespace

TEST_CASE("diff of equal pictures") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 100);
    const Json difference = diff_json(a, b, 0);
    CHECK(difference["max_abs"] == 0);
    CHECK(difference["rmse"] == 0);
    CHECK(difference["psnr"].is_null());
    CHECK(difference["ssim"] == 1);
    CHECK(difference["differing"] == 0);
    CHECK(difference["passed"] == true);
    CHECK_THAT(run_program({"diff", a, b}).out, Catch::StartsWith("equal\n"));
}

TEST_CASE("diff of 8-bit pictures counts codes") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 151);
    const Json difference = diff_json(a, b, 1);
    // 51 codes are a fifth; one float32 rounding of each code / 255.
    CHECK(difference["max_abs"].get<double>() == Approx(0.2).margin(1e-7));
    CHECK(difference["rmse"].get<double>() == Approx(0.2 / std::sqrt(width * height)).epsilon(1e-6));
    CHECK(difference["psnr"].get<double>()
          == Approx(20 * std::log10(std::sqrt(width * height) / 0.2)).epsilon(1e-6));
    CHECK(difference["ssim"].get<double>() < 1);
    CHECK(difference["differing"] == 1);
    CHECK(difference["compared"] == "codes");
    CHECK(difference["worst"] == Json{{"x", 3}, {"y", height - 2}});
    CHECK_THAT(run_program({"diff", a, b}).out,
               Catch::StartsWith("different\n") && Catch::Contains("51 of 255 codes"));
}

TEST_CASE("diff holds pictures to bounds") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 151);
    const auto status = [&](std::vector<std::string> bounds) {
        bounds.insert(bounds.begin(), {"diff", a, b});
        return run_program(bounds).status;
    };
    CHECK(status({"--max-abs", "0.21"}) == 0);
    CHECK(status({"--max-abs", "0.19"}) == 1);
    CHECK(status({"--min-psnr", "36"}) == 0); // it is 36.8 dB
    CHECK(status({"--min-psnr", "37"}) == 1);
    CHECK(status({"--max-abs", "0.21", "--min-psnr", "37"}) == 1);
    CHECK(status({"--max-abs", "-1"}) == 2);
}

TEST_CASE("diff leaves out alpha that only one picture has, and says so") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 4, 100, 100);
    const Json difference = diff_json(a, b, 0);
    CHECK_THAT(difference["notes"].dump(), Catch::Contains("alpha"));
}

TEST_CASE("diff compares float pictures as linear values") {
    const TemporaryDirectory scratch;
    Image image = constant(width, height, {2.0f, 3.0f, 4.0f});
    const std::string a = pfm(scratch, "a.pfm", image);
    image.at(5, 0, 2) = 4.5f;
    const std::string b = pfm(scratch, "b.pfm", image);
    const Json difference = diff_json(a, b, 1);
    CHECK(difference["compared"] == "linear");
    CHECK(difference["max_abs"] == 0.5);
    CHECK(difference["worst"] == Json{{"x", 5}, {"y", height - 1}});

    image.at(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    const std::string c = pfm(scratch, "c.pfm", image);
    const Json broken = diff_json(a, c, 1);
    CHECK(broken["non_finite"] == 1);
    CHECK(broken["psnr"].is_null());
    CHECK(run_program({"diff", a, c, "--max-abs", "1000"}).status == 1);
}

TEST_CASE("diff writes the difference") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 110);
    const auto written = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.begin(), {"diff", a, b, "-o", (scratch / name).string()});
        REQUIRE(run_program(more).status == 1);
        return read_data((scratch / name).string());
    };
    const Image shown = written("shown.png", {});
    CHECK(shown.at(3, 1, 0) == 1.0f); // the largest difference is white
    CHECK(shown.at(0, 0, 0) == 0.0f);
    CHECK(written("gain.png", {"--gain", "5"}).at(3, 1, 0) == 50.0f / 255.0f);
    // 110/255 - 100/255, each rounded to float32.
    CHECK(written("exact.pfm", {}).at(3, 1, 0) == Approx(10.0 / 255).margin(1e-7));
}

TEST_CASE("diff refuses what can't be compared") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100);
    const std::string small = pfm(scratch, "small.pfm", constant(4, 4, {1.0f, 1.0f, 1.0f}));
    check_refused(run_program({"diff", a, small}), "4 x 4");
    check_refused(run_program({"diff", a, (scratch / "missing.png").string()}), "missing.png");
    check_refused(run_program({"diff", a, a, "-o", (scratch / "difference.txt").string()}), "difference.txt");
    check_refused(run_program({"diff", a}), "B");
}
