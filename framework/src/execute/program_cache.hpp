// Linked programs by their text: in memory for this executor, on disk between runs.
#pragma once

#include <gl/objects.hpp>

#include <postfx/plan.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace postfx {

class ProgramCache {
public:
    /// `directory`: where program binaries are kept; empty = nowhere.
    explicit ProgramCache(std::filesystem::path directory);

    /// The linked program, compiled at most once. `pass` names it in messages. Throws Error with the author's
    /// file:line.
    GLuint get(const ProgramSource& source, const std::string& pass);
    /// Is it here or in the directory?
    bool holds(const ProgramSource& source) const;
    /// Empty also where the driver gives no binaries.
    const std::filesystem::path& directory() const { return directory_; }

private:
    std::filesystem::path file_of(const ProgramSource& source) const;
    gl::Program load(const ProgramSource& source) const;
    void save(const ProgramSource& source, const gl::Program& program) const;

    std::filesystem::path directory_;
    std::vector<GLint> binary_formats_; ///< that the driver knows
    std::string made_by_; ///< what binaries depend on besides their text: the driver, the vertex shaders
    std::map<std::uint64_t, gl::Program> programs_;
};

} // namespace postfx
