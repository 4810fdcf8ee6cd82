// Options that several commands share.
#pragma once

#include <postfx/catalog.hpp>
#include <postfx/chain.hpp>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host {

/// --plugin-dir: which effects there are.
class CatalogOptions {
public:
    void declare(CLI::App& app);
    /// Plugins that were refused are told on stderr. Throws Error when no effect at all is found.
    Catalog load() const;

private:
    std::vector<std::string> plugin_directories_;
};

/// What is known of levels when a budget is met.
struct BudgetSource {
    std::string curves;     ///< file; "" = those of the current OpenGL context's device
    bool by_curves = false; ///< errors are those of the curves: levels are not tried in the scene
};

/// --chain and --effect: which effects are used; --run-all: whether called for or not; --budget, --curves and
/// --by-curves: at which levels.
class ChainOptions {
public:
    /// `default_chain` is used when neither option is given.
    explicit ChainOptions(std::string default_chain) : default_chain_(std::move(default_chain)) {}
    void declare(CLI::App& app);
    /// Was any of the two given?
    bool given() const { return !chain_.empty() || !effects_.empty(); }
    bool run_all() const { return run_all_; }
    /// By what a budget is to be met.
    const BudgetSource& budget_source() const { return budget_source_; }
    /// The chain file's effects, then those of --effect in order.
    Chain read(const Catalog& catalog) const;

private:
    std::string default_chain_;
    std::string chain_;
    std::vector<std::string> effects_;
    std::string budget_;
    BudgetSource budget_source_;
    bool run_all_ = false;
};

/// A chain by its file or its name in configs/chains/; it may include those that are there.
Chain read_chain_named(const std::string& name_or_path, const Catalog& catalog);

/// Where a picture is written, and as what kind of file.
struct PictureFile {
    std::filesystem::path path;
    std::string kind{};    ///< "png", "exr", ...; "" = as the path's ending says
    int bits = 8;          ///< of a PNG
    double quality = 0.92; ///< of a JPEG, 0..1

    /// Then nothing else may be printed there.
    bool is_standard_output() const { return path == "-"; }
};

/// -o, --format, --bits and --quality.
class OutputOptions {
public:
    /// `help`: of -o; the kinds of files and "-" are told behind it.
    void declare(CLI::App& app, const std::string& help);
    /// Throws Error for a kind that can't be written, a folder that is not there, and standard output on a terminal.
    PictureFile file() const;

private:
    std::string path_, kind_;
    int bits_ = 8;
    double quality_ = 0.92;
};

/// "1280x720". Throws Error for anything else, or a side of 0 or above 32768.
struct Size {
    int width = 0, height = 0;
};
Size parse_size(const std::string& text);

} // namespace postfx::host
