#include "options.hpp"

#include "run/picture_file.hpp"
#include "run/resources.hpp"

#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace postfx::host {

void declare_former_flag(CLI::App& app, const std::string& former, const std::string& name, bool& value) {
    const auto take = [former, name, &value] {
        fmt::print(stderr, "postfx: {} is called {} now\n", former, name);
        value = true;
    };
    app.add_flag_callback(former, take)->group("");
}

void CatalogOptions::declare(CLI::App& app) {
    app.add_option("--plugin-dir", plugin_directories_, "Look for effect plugins here first (repeatable)")
        ->type_name("DIR")
        ->default_str("");
}

Catalog CatalogOptions::load() const {
    Catalog catalog = Catalog::discover({plugin_directories_.begin(), plugin_directories_.end()});
    for (const std::string& note : catalog.notes())
        fmt::print(stderr, "postfx: {}\n", note);
    if (catalog.effects().empty()) {
        throw Error("no effect plugins found; name their folder with --plugin-dir or POSTFX_PLUGIN_PATH");
    }
    return catalog;
}

void ChainOptions::declare(CLI::App& app) {
    app.add_option("--chain", chain_, "Chain: a name from configs/chains/ or a YAML file")
        ->type_name("CHAIN");
    app.add_option("--effect", effects_,
                   "Append one effect, as in a chain file: 'glow: {intensity: 0.2}' (repeatable)")
        ->type_name("YAML")
        ->default_str("")
        ->allow_extra_args(false);
    app.add_flag("--no-skip", no_skip_, "Run every enabled effect, called for or not");
    declare_former_flag(app, "--run-all", "--no-skip", no_skip_);
    app.add_option(
           "--budget", budget_,
           "Choose the effects' levels: ms=6 (least error within a time) or error=0.01 (least time within "
           "an error); instead of the chain's own budget")
        ->type_name("KIND=LIMIT")
        ->default_str("");
    app.add_option(
           "--curves", budget_source_.curves,
           "What levels cost, for a budget; without, what `postfx calibrate` measured on this device, or "
           "what comes along")
        ->type_name("FILE.json")
        ->default_str("");
    app.add_flag(
        "--by-curves", budget_source_.by_curves,
        "Meet a budget by the curves alone, which are means over other scenes, without drawing levels to "
        "see what they do in this one");
    app.footer(default_chain_.empty() ? ""
                                      : "Without --chain and --effect the chain is " + default_chain_ + ".");
}

Chain ChainOptions::read(const Catalog& catalog) const {
    Chain chain;
    const std::string& name = chain_.empty() && effects_.empty() ? default_chain_ : chain_;
    if (!name.empty()) chain = read_chain_named(name, catalog);
    for (const std::string& effect : effects_)
        parse_chain_entry(effect, "--effect", catalog, chain);
    if (no_skip_) chain.skip = Skip::nothing;
    if (!budget_.empty()) chain.budget = parse_budget(budget_, "--budget");
    return chain;
}

void OutputOptions::declare(CLI::App& app, const std::string& help) {
    app.add_option("-o,--output", path_, help + "; - is standard output")->required()->type_name("FILE");
    app.add_option("--format", kind_, "Kind of picture, whatever FILE is called: png, jpg, exr, hdr or pfm")
        ->type_name("KIND")
        ->default_str("");
    app.add_option("--bits", bits_, "Per channel of a PNG")
        ->check(CLI::IsMember({8, 16}))
        ->capture_default_str();
    app.add_option("--quality", quality_, "Of a JPEG, 0 to 1")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
}

PictureFile picture_file(const std::string& path, const std::string& kind) {
    const bool standard_output = path == "-" || path == "/dev/stdout" || path == "/dev/fd/1";
    if (standard_output && kind.empty())
        throw Error("--format is needed for a picture on standard output, which has no ending: png, jpg, "
                    "exr, hdr or pfm");
    if (standard_output && ::isatty(STDOUT_FILENO) != 0)
        throw Error("standard output is a terminal, which shows no picture; send it to a file or a program");
    PictureFile file{standard_output ? "-" : path, kind};
    check_writable_kind(file.path, file.kind);
    return file;
}

PictureFile OutputOptions::file() const {
    PictureFile file = picture_file(path_, kind_);
    file.bits = bits_;
    file.quality = quality_;
    if (bits_ == 16 && written_kind(file.path, file.kind) != "png") throw Error("--bits 16 is for a PNG");
    check_output_folder(file.path);
    return file;
}

} // namespace postfx::host
