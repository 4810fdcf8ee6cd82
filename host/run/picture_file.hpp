// From a finished chain to a file.
#pragma once

#include "chain_runner.hpp"

#include <image/files.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

/// Where a picture is written, and as what kind of file.
struct PictureFile {
    std::filesystem::path path;
    std::string kind{};    ///< "png", "exr", ...; "" = as the path's ending says
    int bits = 8;          ///< of a PNG
    double quality = 0.92; ///< of a JPEG, 0..1

    /// Then nothing else may be printed there.
    bool is_standard_output() const { return path == "-"; }
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

/// Does the chain's last pass have to divide by alpha (PlanOptions::divide_by_alpha)?
bool divides_by_alpha(const PictureFile& file, const Written& written);

/// Write the last picture of `runner` to `file` by its kind. Returns what could not be kept of the origin, a line each.
std::vector<std::string> write_picture(ChainRunner& runner, const PictureFile& file,
                                       const Written& written = {});

} // namespace postfx::host
