// postfx diff on small pictures: numbers, statuses, the difference image.
#include "program.hpp"

#include <image/files.hpp>
#include <testing.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
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
    write_codes(scratch / name, {width, height, channels, codes});
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
        return read_image((scratch / name).string(), {.role = Role::data}).image;
    };
    const Image shown = written("shown.png", {});
    CHECK(shown.at(3, 1, 0) == 1.0f); // the largest difference is white
    CHECK(shown.at(0, 0, 0) == 0.0f);
    CHECK(written("gain.png", {"--gain", "5"}).at(3, 1, 0) == 50.0f / 255.0f);
    // 110/255 - 100/255, each rounded to float32.
    CHECK(written("exact.pfm", {}).at(3, 1, 0) == Approx(10.0 / 255).margin(1e-7));
}

TEST_CASE("diff tells relative errors in linear light") {
    const TemporaryDirectory scratch;
    // sRGB codes 188 and 255 are linear 0.5029 and 1: against A, the reference, one pixel of 192 is wrong.
    const std::string a = png(scratch, "a.png", 3, 188, 188), b = png(scratch, "b.png", 3, 188, 255);
    const double reference = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), error = 1 - reference;
    const Json difference = diff_json(a, b, 1);
    CHECK(difference["rel_mse"].get<double>()
          == Approx(std::pow(error / (reference + 0.01), 2) / (width * height)).epsilon(1e-6));
    CHECK(difference["relative_rmse"].get<double>()
          == Approx(error / reference / std::sqrt(width * height)).epsilon(1e-6));
    CHECK(difference["non_finite_light"] == 0);
    CHECK(!difference.contains("flip"));

    // A NaN in both pictures is no difference, but it is no light either.
    Image image = constant(width, height, {0.5f, 0.5f, 0.5f});
    image.at(2, 2, 1) = std::numeric_limits<float>::quiet_NaN();
    const std::string broken = pfm(scratch, "broken.pfm", image);
    const Json same = diff_json(broken, broken, 0);
    CHECK(same["non_finite"] == 0);
    CHECK(same["non_finite_light"] == 1);
    CHECK(same["rel_mse"].is_null());
    CHECK_THAT(run_program({"diff", broken, broken}).out, Catch::Contains("non_finite_light"));
}

TEST_CASE("diff --flip tells what a viewer sees") {
    const TemporaryDirectory scratch;
    const auto field = [&](const std::string& name, float red, float green, float blue) {
        return pfm(scratch, name, constant(width, height, {red, green, blue}));
    };
    const auto flip_of = [&](const std::string& a, const std::string& b, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"diff", a, b, "--flip", "--json"});
        return Json::parse(run_program(more).out)["flip"];
    };
    const std::string green = field("green.pfm", 0, 1, 0), blue = field("blue.pfm", 0, 0, 1);
    const Json largest = flip_of(green, blue);
    CHECK(largest["mean"].get<double>() == Approx(1));
    CHECK(largest["weighted_median"].get<double>() == Approx(1));
    CHECK(largest["pixels_per_degree"].get<double>() == Approx(67.0206).epsilon(1e-5));
    CHECK(largest["clipped"] == 0);
    CHECK(flip_of(green, green)["max"] == 0);
    CHECK(flip_of(green, field("bright.pfm", 0, 9, 0))["clipped"] == width * height);
    CHECK(flip_of(green, field("nan.pfm", 0, NAN, 0))["mean"].is_null());
    CHECK(flip_of(green, field("nan.pfm", 0, NAN, 0))["non_finite"] == width * height);

    // 8-bit files are decoded: the same pair as codes and as light.
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 200);
    const auto decoded = [&](const std::string& name, const std::string& file) {
        return pfm(scratch, name, read_image(file).image);
    };
    CHECK(flip_of(a, b)["mean"].get<double>()
          == Approx(flip_of(decoded("a.pfm", a), decoded("b.pfm", b))["mean"].get<double>()).epsilon(1e-5));
    // Seen from farther away one pixel is less.
    CHECK(flip_of(a, b, {"--ppd", "200"})["max"] < flip_of(a, b)["max"]);
    CHECK_THAT(run_program({"diff", a, b, "--flip"}).out, Catch::Contains("mean at 67.02 pixels per degree"));
}

TEST_CASE("diff --map writes FLIP per pixel") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 200);
    const auto map = [&](const std::string& name) {
        const Outcome outcome =
            run_program({"diff", a, b, "--flip", "--map", (scratch / name).string(), "--json"});
        INFO(outcome.err);
        REQUIRE(outcome.status == 1);
        CHECK(Json::parse(outcome.out)["flip"]["max"].get<double>() > 0);
        return read_image((scratch / name).string(), {.role = Role::data}).image;
    };
    const Image exact = map("map.exr"), shown = map("map.png");
    CHECK(exact.channels == 1);
    CHECK(exact.at(3, 1, 0) == *std::max_element(exact.values.begin(), exact.values.end()));
    CHECK(shown.channels == 3);
    CHECK(shown.at(3, 1, 0) > shown.at(15, 11, 0));
    check_refused(run_program({"diff", a, b, "--map", (scratch / "x.png").string()}), "--flip");
    check_refused(run_program({"diff", a, b, "--ppd", "60"}), "--flip");
    check_refused(run_program({"diff", a, b, "--flip", "--ppd", "0"}), "--ppd");
    check_refused(run_program({"diff", a, b, "--flip", "--map", (scratch / "x.txt").string()}), "x.txt");
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

TEST_CASE("diff writes a picture to standard output, and its words to standard error then") {
    const TemporaryDirectory scratch;
    const std::string a = png(scratch, "a.png", 3, 100, 100), b = png(scratch, "b.png", 3, 100, 120);
    const std::string file = (scratch / "difference.png").string();
    run_program({"diff", a, b, "-o", file});
    const Outcome outcome = run_program({"diff", a, b, "-o", "-", "--format", "png"});
    CHECK(outcome.status == 1);
    CHECK(read_image(ImageSource{"-", outcome.out}).image.values == read_image(file).image.values);
    CHECK_THAT(outcome.err, Catch::Contains("different"));
    const Outcome map = run_program({"diff", a, b, "--flip", "--map", "-", "--format", "png"});
    CHECK_THAT(map.out, Catch::StartsWith("\x89PNG"));
    check_refused(run_program({"diff", a, b, "-o", "-"}), "--format");
    check_refused(run_program({"diff", a, b, "--flip", "-o", "-", "--map", "-", "--format", "png"}), "both");
}
