// From a planned chain to a file.
#pragma once

#include <image/files.hpp>
#include <postfx/postfx.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace postfx::host {

/// GL names of textures by attachment name.
using Textures = std::map<std::string, std::uint32_t>;

/// Runs one chain on textures, planning again when facts change.
class ChainRunner {
public:
    ChainRunner(Chain chain, Facts facts);

    /// What the chain reads of the scene, decided before anything is rendered.
    const std::vector<std::string>& attachments() const { return plan_.attachments; }
    const Plan& plan() const { return plan_; }
    Chain& chain() { return chain_; }
    const Chain& chain() const { return chain_; }

    /// Plan again for another camera or changed values. A failing shader throws and the old plan stays.
    void replan(const Facts& facts);

    /// Draw one frame. `textures` must hold what attachments() names. Returns the picture's texture.
    std::uint32_t run(const Textures& textures, const FrameInputs& frame, Timing timing,
                      Watch watch = Watch::off);

    Executor& executor() { return executor_; }
    const Facts& facts() const { return facts_; }

private:
    Planner planner_;
    Chain chain_;
    Facts facts_;
    Plan plan_;
    Executor executor_;
    FrameInputs inputs_;
};

/// What the file's ending asks of the chain: codes for .png, linear light for the others. Throws Error for an
/// ending that can't be written.
Output output_for(const std::filesystem::path& file);

/// Write the last picture of `runner` to `file` by its ending, with 4 channels when `keep_alpha`. Returns what write_image
/// does.
std::vector<std::string> write_picture(ChainRunner& runner, const std::filesystem::path& file,
                                       bool keep_alpha, const WriteOptions& options = {});

/// A line that grows on a terminal's stderr, or nothing when stderr is no terminal. Finished by its
/// destructor.
class ProgressBar {
public:
    ProgressBar(std::string what, int total);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void advance();

private:
    void draw() const;

    std::string what_;
    int total_, done_ = 0;
    double start_seconds_;
    bool terminal_;
};

} // namespace postfx::host
