#include "output.hpp"

#include "effect_plots.hpp"
#include "page.hpp"
#include "pareto.hpp"
#include "plot.hpp"
#include "tables.hpp"

#include <base/read_file.hpp>
#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>

namespace fs = std::filesystem;

namespace postfx::host::study {
namespace {

constexpr std::size_t max_picture_bytes = std::size_t{1} << 28;

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error(Place{.file = folder.string()}, fmt::format("can't be made: {}", error.message()));
}

/// Returns the files' bytes by "<effect>-<thumbnail>".
std::map<std::string, std::string> write_pictures(const fs::path& folder, const Findings& findings) {
    std::map<std::string, std::string> pictures;
    for (const EffectFindings& effect : findings.effects) {
        for (const Thumbnail& thumbnail : effect.thumbnails) {
            const std::string name = effect.id + "-" + thumbnail.name;
            const fs::path file = folder / (name + ".png");
            write_codes(file, {thumbnail.width, thumbnail.height, 3, thumbnail.codes});
            pictures[name] = read_file(file, max_picture_bytes, "a picture");
        }
    }
    return pictures;
}

} // namespace

std::vector<std::string> write_study(const fs::path& folder, const Findings& findings) {
    make_folder(folder / "pictures");
    std::vector<std::string> names;
    const auto write = [&](const std::string& name, const std::string& text) {
        write_file_atomically(folder / name, text);
        names.push_back(name);
    };
    write("study.csv", findings_csv(findings));
    write("metrics.csv", metrics_csv(findings));
    write("growth.csv", growth_csv(findings));
    write("study.json", findings_json(findings).dump(2) + "\n");
    write("curves.json", curves_json(curves_of(findings)));
    for (const EffectFindings& effect : findings.effects) {
        for (const auto& plots : {error_plots(effect), growth_plots(effect)}) {
            for (const EffectPlot& plot : plots)
                write_file_atomically(folder / (effect.id + "-" + plot.name + ".svg"),
                                      standalone_svg(plot.svg));
        }
    }
    write("index.html", study_page(findings, write_pictures(folder / "pictures", findings)));
    return names;
}

} // namespace postfx::host::study
