// A program that knows of postfx no more than its public headers: an engine that draws a chain into its own frame.
//     foreign_program found|given PLUGIN_DIRECTORY CHAIN WIDTH HEIGHT IN OUT
// IN: floats, four a pixel; OUT: 8-bit codes, four a pixel; both bottom row first. "given": the engine tells how it
// finds functions. Ends with 77 where there is no OpenGL 4.5.
#include "engine.hpp"

#include <postfx/postfx.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

std::vector<float> read_floats(const char* path, std::size_t count) {
    std::vector<float> values(count);
    std::ifstream(path, std::ios::binary)
        .read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(float)));
    return values;
}

postfx::ExecutorOptions options(const std::string& loader) {
    postfx::ExecutorOptions options;
    if (loader == "given") options.get_proc_address = engine::get_proc_address;
    return options;
}

void draw(char** arguments) {
    const int width = std::stoi(arguments[4]), height = std::stoi(arguments[5]);
    const std::uint32_t scene_color = engine::make_texture(
        width, height,
        read_floats(arguments[6], static_cast<std::size_t>(4 * width) * static_cast<std::size_t>(height)));

    postfx::Catalog catalog = postfx::Catalog::discover({arguments[2]});
    postfx::Chain chain = postfx::read_chain(arguments[3], catalog);
    postfx::SceneFacts facts;
    facts.width = width;
    facts.height = height;
    postfx::Plan plan = postfx::Planner().plan(chain, facts);

    postfx::Executor executor(options(arguments[1]));
    executor.prepare(plan);
    postfx::FrameInputs inputs;
    inputs.camera = facts.camera;
    inputs.textures.assign(plan.attachments.size(), scene_color);
    const std::uint32_t picture = executor.run(inputs);

    const std::vector<unsigned char> codes = engine::read_codes(picture, width, height);
    std::ofstream(arguments[7], std::ios::binary)
        .write(reinterpret_cast<const char*>(codes.data()), static_cast<std::streamsize>(codes.size()));
}

} // namespace

int main(int count, char** arguments) {
    if (count != 8) return 2;
    if (!engine::start()) return 77;
    try {
        draw(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    if (const unsigned error = engine::take_error()) {
        std::fprintf(stderr, "OpenGL error 0x%x\n", error);
        return 1;
    }
    std::printf("GLEW: %s\nepoxy: %s\n", engine::renderer_by_glew().c_str(),
                engine::renderer_by_epoxy().c_str());
    return 0;
}
