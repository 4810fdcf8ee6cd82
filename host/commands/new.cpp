// postfx new: an effect's folder that builds, runs and passes its tests as it is.
#include "command.hpp"

#include "run/resources.hpp"
#include "terminal/text_table.hpp"

#include <base/read_file.hpp>
#include <postfx/catalog.hpp>
#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

/// Words that can't name an effect although they look like an id: its GLSL function has the effect's name
/// (the keywords of GLSL 4.50, chapter 3.6), and so have files that lie beside test.cpp and reference.cpp.
constexpr std::string_view reserved_words =
    " active asm atomic_uint attribute bool break buffer bvec2 bvec3 bvec4 case cast centroid class coherent "
    "common "
    "const continue default discard dmat2 dmat3 dmat4 do double dvec2 dvec3 dvec4 else enum extern external "
    "false "
    "filter fixed flat float for fvec2 fvec3 fvec4 goto half highp hvec2 hvec3 hvec4 if in inline inout "
    "input int "
    "interface invariant isampler2 ivec2 ivec3 ivec4 layout long lowp main mat2 mat2x2 mat2x3 mat2x4 mat3 "
    "mat3x2 "
    "mat3x3 mat3x4 mat4 mat4x2 mat4x3 mat4x4 mediump namespace noinline noperspective out output partition "
    "patch "
    "postfx precise precision public readonly reference resource restrict return sample shared short sizeof "
    "smooth "
    "static struct subroutine superp switch template test this true typedef uint uniform union unsigned "
    "using uvec2 "
    "uvec3 uvec4 varying vec2 vec3 vec4 void volatile while writeonly ";

/// Throws Error that tells the rule.
void check_name(const std::string& name) {
    const auto legal = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    const bool is_id = !name.empty() && name.size() <= 63 && name[0] >= 'a' && name[0] <= 'z'
                       && std::all_of(name.begin(), name.end(), legal) && name.find("__") == std::string::npos
                       && !name.ends_with('_') && !name.starts_with("gl_");
    if (!is_id) {
        throw Error(
            fmt::format("\"{}\" can't name an effect: small letters, digits and single underscores, a letter "
                        "first, at most 63, such as film_tint",
                        name));
    }
    if (reserved_words.find(" " + name + " ") != std::string::npos)
        throw Error(
            fmt::format("\"{}\" can't name an effect: the word has another meaning in GLSL or here", name));
}

/// "film_tint" -> "FilmTint", as the framework names parameter structs.
std::string pascal(const std::string& name) {
    std::string result;
    bool start = true;
    for (char c : name) {
        if (c != '_') result += start ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        start = c == '_';
    }
    return result;
}

std::string upper(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    return name;
}

std::string replaced(std::string text, std::string_view from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

constexpr std::size_t max_template_bytes = std::size_t{1} << 20;

/// The template's text or file name with the effect's name in all spellings.
std::string named(std::string text, const std::string& name) {
    text = replaced(std::move(text), "my_effect", name);
    text = replaced(std::move(text), "MyEffect", pascal(name));
    return replaced(std::move(text), "MY_EFFECT", upper(name));
}

void write_text(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw Error(Place{.file = file.string()}, fmt::format("can't be written: {}", std::strerror(errno)));
}

/// A folder that goes away unless it was renamed.
struct Unfinished {
    fs::path folder;
    ~Unfinished() {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
};

/// Made beside and renamed, so that there is a whole folder or none.
void write_folder(const fs::path& folder, const std::string& name) {
    const Unfinished unfinished{folder.string() + ".unfinished"};
    try {
        fs::create_directories(unfinished.folder);
        for (const fs::directory_entry& entry :
             fs::directory_iterator(data_directory() / "templates/effect")) {
            write_text(unfinished.folder / named(entry.path().filename().string(), name),
                       named(read_file(entry.path(), max_template_bytes, "a template"), name));
        }
        fs::rename(unfinished.folder, folder);
    } catch (const fs::filesystem_error& error) {
        throw Error(Place{.file = folder.string()}, "can't be made: " + error.code().message());
    }
}

/// A file's name as one word of a command line.
std::string for_shell(const std::string& name) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+@%,=-";
    if (name.find_first_not_of(plain) == std::string::npos) return name;
    return "'" + replaced(name, "'", "'\\''") + "'";
}

/// What find_package(postfx) needs to be told: the build tree or the installation that this program is of.
std::string cmake_directory() {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& directory : {program, program.parent_path() / "lib/cmake/postfx"}) {
        if (fs::exists(directory / "postfx-config.cmake")) return directory.string();
    }
    return "BUILD_TREE_OF_POSTFX";
}

class NewCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("NAME", name_, "The effect's id: small letters, digits and underscores")
            ->required()
            ->type_name("");
        app.add_option("--dir", folder_, "The folder to make; ./NAME without it")->type_name("DIR");
        app.footer("The folder builds out of tree with CMake. Moved into plugins/ of the postfx sources, it "
                   "is built\n"
                   "with them; its name must then be the effect's.");
    }

    Status run() override {
        check_name(name_);
        fs::path folder = folder_.empty() ? fs::path(name_) : fs::path(folder_);
        if (!folder.has_filename()) folder = folder.parent_path(); // "dir/"
        if (fs::symlink_status(folder).type() != fs::file_type::not_found)
            throw Error(Place{.file = folder.string()}, "exists already and is left as it is");
        if (const EffectPtr taken = Catalog::discover().find(name_)) {
            fmt::print(stderr,
                       "postfx: warning: there is an effect {} already, {}; the first one found is used\n",
                       name_, taken->module_path.string());
        }
        write_folder(folder, name_);
        print_next_steps(folder.string());
        return Status::success;
    }

private:
    void print_next_steps(const std::string& folder) const {
        fmt::print("The new effect {} is in {}:\n{}", name_, folder,
                   text_table({{name_ + ".cpp", "parameters, and plan(): what runs for given values"},
                               {name_ + ".glsl", "what happens to a pixel"},
                               {"reference.cpp", "the same in float64, for the test"},
                               {"test.cpp", "one against the other, the identity, hostile pixels"}},
                              2));
        fmt::print(
            "\nBuild and test it:\n"
            "  cmake -S {0} -B {0}/build -G Ninja -Dpostfx_DIR={1}\n"
            "  cmake --build {0}/build\n"
            "  ctest --test-dir {0}/build --output-on-failure\n"
            "\nUse it:\n"
            "  postfx apply --color PICTURE --plugin-dir {0}/build/postfx_plugins --effect {2} -o {2}.png\n",
            for_shell(folder), for_shell(cmake_directory()), name_);
    }

    std::string name_, folder_;
};

const Register<NewCommand> registered("new", "Make the folder of a new effect from a template");

} // namespace
} // namespace postfx::host
