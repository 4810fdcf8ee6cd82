// The program between pipes: chains, scenes and curves come through them, pictures go to standard output.
#include "program.hpp"

#include <image/files.hpp>

namespace fs = std::filesystem;
using namespace postfx;
using namespace postfx::testing;

namespace {

/// A folder with a picture, a chain and a scene, and a shell in it in which $postfx is the program.
class Workplace {
public:
    Workplace() {
        write_image(folder_ / "p.png", Image(8, 4, 3, 0.25f));
        put_bytes(folder_ / "chain.yaml", "effects: [vignette: {strength: 1}]\n");
        put_bytes(folder_ / "more.yaml", "include: chain.yaml\n");
        put_bytes(folder_ / "scene.yaml", "nodes:\n  - {mesh: {box: {}}}\nambient: [1, 1, 1]\n");
        REQUIRE(shell("$apply --chain chain.yaml -o by_file.png").status == 0);
        REQUIRE(shell("$render scene.yaml -o scene_by_file.png").status == 0);
    }

    Outcome shell(const std::string& script) const {
        const std::string names = "apply='" POSTFX_BUILD_DIRECTORY
                                  "/postfx apply --no-times --color p.png'; render='" POSTFX_BUILD_DIRECTORY
                                  "/postfx render --no-times --size 16x9 --chain chain.yaml'; ";
        return run_command({"bash", "-c", names + script}, folder_.path());
    }
    std::string bytes(const std::string& name) const { return file_bytes(folder_ / name); }
    fs::path file(const std::string& name) const { return folder_ / name; }

private:
    TemporaryDirectory folder_;
};

} // namespace

TEST_CASE("a chain comes from a pipe, from standard input and from a descriptor") {
    const Workplace place;
    for (const char* chain : {"--chain <(cat chain.yaml)", "--chain - < chain.yaml",
                              "--chain /dev/stdin < chain.yaml", "--chain /dev/fd/7 7< chain.yaml",
                              "--chain - <<< 'include: chain.yaml'", "--chain <(cat more.yaml)"}) {
        INFO(chain);
        const Outcome outcome = place.shell(std::string("$apply -q -o out.png ") + chain);
        INFO(outcome.err);
        CHECK(outcome.status == 0);
        CHECK(place.bytes("out.png") == place.bytes("by_file.png"));
    }
}

TEST_CASE("a scene comes from a pipe and from standard input") {
    const Workplace place;
    for (const char* scene : {"<(cat scene.yaml)", "- < scene.yaml", "- <<< 'include: scene.yaml'"}) {
        INFO(scene);
        const Outcome outcome = place.shell(std::string("$render -q -o out.png ") + scene);
        INFO(outcome.err);
        CHECK(outcome.status == 0);
        CHECK(place.bytes("out.png") == place.bytes("scene_by_file.png"));
    }
}

TEST_CASE("a picture goes to standard output alone, the report to standard error") {
    const Workplace place;
    for (const char* output : {"-o -", "-o /dev/stdout"}) {
        INFO(output);
        const Outcome piped = place.shell(std::string("$apply --format png --chain chain.yaml ") + output);
        CHECK(piped.status == 0);
        CHECK(piped.out == place.bytes("by_file.png"));
        CHECK_THAT(piped.err, Catch::Contains("vignette") && Catch::Contains("wrote standard output"));
    }
    CHECK(place.shell("$render --format pfm -o - scene.yaml | head -c 2").out == "PF");
    CHECK(place.shell("$render --format exr -o picture scene.yaml").status == 0);
    CHECK(place.bytes("picture").substr(0, 4) == "\x76\x2F\x31\x01");
    const Outcome sequence = place.shell("$render -q --frames 2 --format png -o - scene.yaml");
    const std::string frame = place.bytes("scene_by_file.png");
    CHECK(sequence.out.size() > frame.size());
    CHECK(sequence.out.starts_with(frame.substr(0, 8)));
}

TEST_CASE("what is wrong with a pipe is said of it") {
    const Workplace place;
    check_refused(place.shell("$apply --chain chain.yaml -o -"), "--format is needed");
    check_refused(place.shell("$apply --chain - -o x.png < /dev/null"),
                  "standard input:1:1: the chain is empty");
    check_refused(place.shell("$apply --chain <(printf 'effects: [no_such]') -o x.png"),
                  "no effect \"no_such\"");
    check_refused(place.shell("$apply --chain cahin.yaml -o x.png"),
                  "cahin.yaml: no such file; did you mean \"chain.yaml\"?");
    check_refused(place.shell("$apply --chain chain.yaml -o nowhere/x.png"), "there is no folder nowhere");
    check_refused(place.shell("$apply --chain chain.yaml -o x.gif"), "its ending is \".gif\"");
    check_refused(
        place.shell(POSTFX_BUILD_DIRECTORY "/postfx render --chain - - -o x.png <<< 'effects: [vignette]'"),
        "standard input: was read before");
}

TEST_CASE("a picture is written through a link to what is not there yet") {
    const Workplace place;
    fs::create_symlink("real.png", place.file("link.png"));
    CHECK(place.shell("$apply -q --chain chain.yaml -o link.png").status == 0);
    CHECK(fs::is_symlink(place.file("link.png")));
    CHECK(place.bytes("real.png") == place.bytes("by_file.png"));
    fs::create_symlink("nowhere/real.png", place.file("lost.png"));
    check_refused(place.shell("$apply -q --chain chain.yaml -o lost.png"), "there is no folder nowhere");
}
