// From a planned chain to a file.
#pragma once

#include "options.hpp"

#include <image/files.hpp>

#include <postfx/postfx.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace postfx::host {

/// GL names of textures by attachment name.
using Textures = std::map<std::string, std::uint32_t>;

/// Runs one chain on textures, planning again when facts change.
class ChainRunner {
public:
    /// `formats`: of the attachments, by name. Given, and up to the first run, a second thread compiles too where that
    /// helps (Executor::prepare).
    ChainRunner(Chain chain, Facts facts, const std::map<std::string, Format>& formats = {});

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

/// What the file's kind asks of the chain: codes for PNG, linear light for the others. Throws Error for a kind that
/// can't be written.
Output output_for(const PictureFile& file);

/// What of a picture goes into its file besides its light.
struct Written {
    Coding::Alpha alpha_of_chain =
        Coding::Alpha::none; ///< of what the chain was given; none: there is no alpha
    Coding::Alpha alpha_of_file = Coding::Alpha::none; ///< none: it is left out
    Origin origin{}; ///< the file that the picture is from: an EXR goes back into it
};

/// Does the chain's last pass have to divide by alpha (Facts::divide_by_alpha)?
bool divides_by_alpha(const PictureFile& file, const Written& written);

/// Write the last picture of `runner` to `file` by its kind. Returns what could not be kept of the origin, a line each.
std::vector<std::string> write_picture(ChainRunner& runner, const PictureFile& file,
                                       const Written& written = {});

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
