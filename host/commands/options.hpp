// Options that several commands share.
#pragma once

#include "budget/met_budget.hpp"
#include "run/picture_file.hpp"

#include <postfx/catalog.hpp>
#include <postfx/chain.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace postfx::host {

/// A flag by its former name: understood, with a note, and not in the help.
void declare_former_flag(CLI::App& app, const std::string& former, const std::string& name, bool& value);

/// --plugin-dir: which effects there are.
class CatalogOptions {
public:
    void declare(CLI::App& app);
    /// Plugins that were refused are told on stderr. Throws Error when no effect at all is found.
    Catalog load() const;

private:
    std::vector<std::string> plugin_directories_;
};

/// --chain and --effect: which effects are used; --no-skip: whether called for or not; --budget, --curves and
/// --by-curves: at which levels.
class ChainOptions {
public:
    /// `default_chain` is used when neither option is given.
    explicit ChainOptions(std::string default_chain) : default_chain_(std::move(default_chain)) {}
    void declare(CLI::App& app);
    /// Was any of the two given?
    bool given() const { return !chain_.empty() || !effects_.empty(); }
    bool no_skip() const { return no_skip_; }
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
    bool no_skip_ = false;
};

/// A picture's `path`; of what is `-`, standard output, `kind` (--format) has to say what it is. Throws Error for a kind
/// that can't be written, and for standard output on a terminal.
PictureFile picture_file(const std::string& path, const std::string& kind);

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

} // namespace postfx::host
