// Models and the program: what it tells of them, its options for them, and that no file brings it down.
#include "../scene/gltf_files.hpp"
#include "program.hpp"

#include <image/files.hpp>

#include <catch2/catch.hpp>

#include <chrono>
#include <iostream>

using namespace postfx;
using namespace postfx::testing;
using Json = GltfFile::Json;

namespace {

Outcome render(const std::filesystem::path& folder, const std::string& model,
               std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render", model,   "-q",        "--no-times", "--chain", "none",
                                      "--size", "32x32", "--samples", "1",          "-o",      "out.pfm"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder);
}

void write_quad(const std::filesystem::path& file) {
    GltfFile gltf;
    for (const char* name : {"x.png", "y.png"})
        gltf.add_texture(name);
    for (int i = 0; i < 2; ++i)
        gltf.add_node(
            {{"mesh", gltf.add_quad({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}})}});
    gltf.add("cameras",
             {{"type", "perspective"}, {"name", "close"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    gltf.add_node({{"name", "tripod"}, {"camera", 0}, {"translation", {0, 0, 2}}});
    gltf.write(file);
}

/// A PLY whose faces name vertices twice, which an assertion in assimp's triangulation does not survive.
void write_asserting_ply(const std::filesystem::path& file) {
    std::ofstream out(file, std::ios::binary);
    out << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 2\nproperty list uchar int vertex_index\nend_header\n"
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n0\n";
}

} // namespace

TEST_CASE("what a model lacks is one line for each kind, and an error with --strict") {
    const TemporaryDirectory folder;
    write_quad(folder / "m.gltf");
    const Outcome told = render(folder.path(), "m.gltf");
    CHECK(told.status == 0);
    CHECK(told.err == "postfx: m.gltf: 2 textures are missing (first: x.png)\n");
    std::filesystem::remove(folder / "out.pfm");
    check_refused(render(folder.path(), "m.gltf", {"--strict"}),
                  "m.gltf: 2 textures are missing (first: x.png)");
    CHECK_FALSE(std::filesystem::exists(folder / "out.pfm"));
    // In a scene file just the same.
    std::ofstream(folder / "s.yaml") << "background: 1\nnodes: [{mesh: {model: m.gltf}}]\n";
    CHECK_THAT(render(folder.path(), "s.yaml").err, Catch::Contains("m.gltf: 2 textures are missing"));
}

TEST_CASE("--camera takes a model's own camera, by its name or that of its node") {
    const TemporaryDirectory folder;
    write_quad(folder / "m.gltf");
    REQUIRE(render(folder.path(), "m.gltf").status == 0);
    const Image around = read_image((folder / "out.pfm").string()).image;
    for (const char* name : {"close", "tripod"}) {
        REQUIRE(render(folder.path(), "m.gltf", {"--camera", name}).status == 0);
        const Image close = read_image((folder / "out.pfm").string()).image;
        // 2 m away with a field of view of half a radian, a quad of 2 m fills the picture.
        CHECK(close.at(0, 0, 0) != around.at(0, 0, 0));
        CHECK(close.at(0, 0, 0) == Approx(close.at(16, 16, 0)).epsilon(0.5));
    }
    const Outcome other = render(folder.path(), "m.gltf", {"--camera", "clos"});
    CHECK(other.status == 2);
    CHECK_THAT(other.err, Catch::Contains("did you mean \"close\"?; it has close, tripod"));
}

TEST_CASE("a file that the reader does not survive is one message") {
    const TemporaryDirectory folder;
    write_asserting_ply(folder / "a.ply");
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = render(folder.path(), "a.ply");
    INFO(outcome.err);
    CHECK((outcome.status == 0 || outcome.status == 2));
    if (outcome.status == 2) check_refused(outcome, "a.ply");
    // A count that asks for more memory than there is.
    std::ofstream(folder / "b.ply")
        << "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
           "property float y\nproperty float z\nend_header\n1234";
    check_refused(render(folder.path(), "b.ply"), "b.ply: ");
    std::ofstream(folder / "c.gltf") << std::string(1u << 20, '[');
    check_refused(render(folder.path(), "c.gltf"), "c.gltf: ");
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60)); // busy machines are slow
}

#if !defined(__SANITIZE_ADDRESS__) // whose runtime wants to be the first library
TEST_CASE("a reader that does not end, or eats all memory, is stopped") {
    const TemporaryDirectory folder;
    std::ofstream(folder / "m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    // In place of assimp's own.
    std::ofstream(folder / "bad.cpp") << R"(#include <cstdlib>
#include <new>
namespace Assimp {
struct Importer { const void* ReadFile(const char*, unsigned); };
const void* Importer::ReadFile(const char*, unsigned) {
    while (std::getenv("EAT")) {
        volatile char* page = static_cast<char*>(::operator new(1 << 20));
        for (int i = 0; i < 1 << 20; i += 4096) page[i] = 1;
    }
    for (volatile int i = 0;; i = i + 1) {}
}
}
)";
    const Outcome built =
        run_command({POSTFX_CXX_COMPILER, "-shared", "-fPIC", "bad.cpp", "-o", "bad.so"}, folder.path());
    INFO(built.err);
    REQUIRE(built.status == 0);
    const auto refused = [&](const std::string& variable, const std::string& words) {
        check_refused(run_command({"env", variable, "LD_PRELOAD=" + (folder / "bad.so").string(),
                                   POSTFX_BUILD_DIRECTORY "/postfx", "render", "m.obj", "--chain", "none",
                                   "-o", "out.png"},
                                  folder.path()),
                      "m.obj: can't read this model: the reader ran out of " + words);
    };
    refused("SPIN=1", "time");
    refused("EAT=1", "memory");
}
#endif

TEST_CASE("the reader of models is no command for users") {
    const Outcome help = run_program({"--help"});
    CHECK(help.status == 0);
    CHECK_THAT(help.out, !Catch::Contains("read-model"));
}

TEST_CASE("models of the field cases") {
    const std::filesystem::path cases = std::filesystem::path(POSTFX_SOURCE_DIRECTORY) / "../shared/cases";
    if (!std::filesystem::exists(cases)) {
        std::cout << "skipped: there is no " << cases.string() << "\n";
        return;
    }
    const TemporaryDirectory folder;
    const auto copy = [&](const std::string& name) {
        std::filesystem::remove_all(folder / "case");
        std::filesystem::copy(cases / name, folder / "case", std::filesystem::copy_options::recursive);
        return folder / "case";
    };
    const auto percent = copy("09-gltf-percent-encoded-uri");
    CHECK(render(percent, "a.gltf").status == 0);
    CHECK(render(percent, "b.gltf").status == 0);
    const auto extensions = copy("17-gltf-required-extensions-ignored");
    CHECK(render(extensions, "quantized.gltf").status == 0);
    check_refused(render(extensions, "basisu.gltf"), "KHR_texture_basisu");
    check_refused(render(extensions, "made-up.gltf"), "VENDOR_made_up");
    CHECK(render(copy("19-missing-texture-fails-the-model"), "a.gltf").status == 0);
    check_refused(render(copy("21-ply-aborts"), "cube.ply"),
                  "cube.ply: can't read this model: the reader crashed");
    const auto hostile = copy("hostile");
    for (const char* name : {"b1.glb", "g16.gltf", "t.obj"})
        check_refused(render(hostile, name), name == std::string("t.obj") ? "dht.jpg" : name);
}
