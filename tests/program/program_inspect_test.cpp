// postfx inspect: what is in a file, and what would be taken as what.
#include "program.hpp"

#include <exr_files.hpp>

#include <image/files.hpp>

#include <nlohmann/json.hpp>

using namespace postfx;
using namespace postfx::testing;

namespace {

void write_layers(const std::filesystem::path& file) {
    Imf::Header header = header_of(box(0, 0, 4, 3), box(1, 1, 2, 1));
    Imf::addOwner(header, "someone");
    write_scanlines(file, header,
                    {"ViewLayer.AO.R", "ViewLayer.AO.G", "ViewLayer.AO.B", "ViewLayer.Combined.R",
                     "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Depth.Z"});
}

} // namespace

TEST_CASE("inspect tells layers and roles in words") {
    const TemporaryDirectory directory;
    write_layers(directory / "a.exr");
    const Outcome outcome = run_program({"inspect", (directory / "a.exr").string()});
    CHECK(outcome.status == 0);
    for (const char* words :
         {"OpenEXR\n4 x 3\n", "dataWindow          1 1 to 2 1\n", "owner               someone\n",
          "color     ViewLayer.Combined\n", "depth     ViewLayer.Depth\n", "--normal-layer"})
        CHECK_THAT(outcome.out, Catch::Contains(words));
}

TEST_CASE("inspect tells the same as JSON") {
    const TemporaryDirectory directory;
    write_layers(directory / "a.exr");
    const Outcome outcome = run_program({"inspect", (directory / "a.exr").string(), "--json"});
    const auto json = nlohmann::json::parse(outcome.out);
    CHECK(json["kind"] == "OpenEXR");
    CHECK(json["parts"][0]["attributes"]["owner"] == "someone");
    CHECK(json["layers"].size() == 3);
    CHECK(json["roles"]["depth"]["layer"] == "ViewLayer.Depth");
    CHECK(json["roles"]["normal"]["taken"] == false);
    CHECK(json["roles"]["normal"]["layer"].is_null());
}

TEST_CASE("inspect reads every kind of image, by its content") {
    const TemporaryDirectory directory;
    for (const char* ending : {".png", ".hdr", ".pfm", ".exr"}) {
        const std::filesystem::path named = directory / (std::string("a") + ending),
                                    file = directory / "picture";
        write_image(named, Image(3, 2, 3, 0.5f));
        std::filesystem::rename(named, file);
        const Outcome outcome = run_program({"inspect", file.string(), "--json"});
        REQUIRE(outcome.status == 0);
        const auto json = nlohmann::json::parse(outcome.out);
        CHECK(json["parts"][0]["width"] == 3);
        CHECK(json["roles"]["color"]["taken"] == true);
    }
    put_bytes(directory / "text", "no picture");
    check_refused(run_program({"inspect", (directory / "text").string()}), "not an image of a known kind");
}
