#include <execute/program_cache.hpp>

#include <execute/tile_passes.hpp>

#include <gl/context.hpp>
#include <gl/full_screen.hpp>
#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

namespace postfx {
namespace {

/// Every set of compiled-in values is a file of its own; beyond so many, the half that was not used longest goes.
constexpr std::size_t most_files = 1000;

void forget_oldest(const std::filesystem::path& directory) {
    namespace fs = std::filesystem;
    std::error_code error; // a cache that can't be tidied costs space, nothing else
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const auto& entry : fs::directory_iterator(directory, error)) {
        if (entry.path().extension() == ".program")
            files.emplace_back(entry.last_write_time(error), entry.path());
    }
    if (files.size() <= most_files) return;
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i < files.size() - most_files / 2; ++i)
        fs::remove(files[i].second, error);
}

} // namespace

ProgramCache::ProgramCache(std::filesystem::path directory) : directory_(std::move(directory)) {
    const gl::DeviceInfo device = gl::current_device();
    made_by_ = device.vendor + "\n" + device.renderer + "\n" + device.version;
    made_by_ += gl::full_screen_vertex_text;
    made_by_ += tile_vertex_text;
    GLint count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    binary_formats_.resize(static_cast<std::size_t>(count));
    if (count > 0) {
        glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, binary_formats_.data());
    } else {
        directory_.clear(); // the driver gives no binaries
    }
    if (!directory_.empty()) forget_oldest(directory_);
}

namespace {

gl::Program link(const ProgramSource& source) {
    switch (source.kind) {
    case ProgramKind::full_screen:
        return gl::make_program(gl::full_screen_vertex_text, source.text, "", source.files);
    case ProgramKind::tiles:
        return gl::make_program(tile_vertex_text, source.text, "", source.files);
    case ProgramKind::compute:
        return gl::make_compute_program(source.text, "", source.files);
    }
    return {};
}

} // namespace

GLuint ProgramCache::get(const ProgramSource& source, const std::string& pass) {
    gl::Program& program = programs_[source.key];
    if (program) return program.name();
    program = load(source);
    if (program) return program.name();
    try {
        program = link(source);
    } catch (const Error& error) {
        Place place = error.place();
        place.effect = pass;
        throw Error(place, error.message());
    }
    save(source, program);
    return program.name();
}

bool ProgramCache::holds(const ProgramSource& source) const {
    if (programs_.contains(source.key)) return true;
    std::error_code error; // what can't be looked at is not there
    return !directory_.empty() && std::filesystem::exists(file_of(source), error);
}

std::filesystem::path ProgramCache::file_of(const ProgramSource& source) const {
    const std::size_t device_key = std::hash<std::string>{}(made_by_);
    return directory_ / fmt::format("{:016x}{:016x}.program", device_key, source.key);
}

/// The stored file is: binary format (4 bytes), length of the shader text (8 bytes), shader text, binary. The
/// text is compared, so that two texts of one hash never share a program.
gl::Program ProgramCache::load(const ProgramSource& source) const {
    if (directory_.empty()) return {};
    std::ifstream file(file_of(source), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    GLenum format = 0;
    std::uint64_t length = 0;
    const std::size_t head = sizeof(format) + sizeof(length);
    if (bytes.size() <= head) return {};
    std::memcpy(&format, bytes.data(), sizeof(format));
    std::memcpy(&length, bytes.data() + sizeof(format), sizeof(length));
    // A format that the driver does not know would be a GL error.
    if (std::find(binary_formats_.begin(), binary_formats_.end(), static_cast<GLint>(format))
        == binary_formats_.end()) {
        return {};
    }
    if (length != source.text.size() || bytes.size() <= head + length
        || bytes.compare(head, length, source.text) != 0) {
        return {};
    }
    gl::Program program(glCreateProgram());
    glProgramBinary(program.name(), format, bytes.data() + head + length,
                    static_cast<GLsizei>(bytes.size() - head - length));
    GLint linked = 0;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (!linked) return {};
    std::error_code error; // it was used: the oldest are forgotten first
    std::filesystem::last_write_time(file_of(source), std::filesystem::file_time_type::clock::now(), error);
    return program;
}

void ProgramCache::save(const ProgramSource& source, const gl::Program& program) const {
    if (directory_.empty()) return;
    GLint size = 0;
    glGetProgramiv(program.name(), GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0) return;
    std::string binary(static_cast<std::size_t>(size), '\0');
    GLenum format = 0;
    GLsizei written = 0;
    glGetProgramBinary(program.name(), size, &written, &format, binary.data());
    binary.resize(static_cast<std::size_t>(written));
    const std::uint64_t length = source.text.size();
    std::string bytes(reinterpret_cast<const char*>(&format), sizeof(format));
    bytes.append(reinterpret_cast<const char*>(&length), sizeof(length));
    bytes += source.text;
    bytes += binary;
    try {
        std::filesystem::create_directories(directory_);
        write_file_atomically(file_of(source), bytes);
    } catch (const std::exception&) {
        // A cache that can't be written costs time at the next start, nothing else.
    }
}

} // namespace postfx
