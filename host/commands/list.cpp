// postfx list: what there is to use, by name.
#include "command.hpp"
#include "options.hpp"

#include "run/resources.hpp"
#include "scene/scene.hpp"
#include "terminal/effect_text.hpp"
#include "terminal/text_table.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace postfx::host {
namespace {

/// The first sentence of the comment that a configuration file starts with; "" when it starts otherwise.
std::string first_sentence(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string comment;
    for (std::string line; std::getline(in, line) && line.starts_with("#");) {
        const std::size_t text = line.find_first_not_of("# ");
        if (text == std::string::npos) break;
        comment += (comment.empty() ? "" : " ") + line.substr(text);
        const std::size_t end = comment.find(". ");
        if (end != std::string::npos) return comment.substr(0, end);
    }
    if (comment.ends_with('.')) comment.pop_back();
    return comment;
}

class ListCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("WHAT", what_, "effects, scenes or chains")->required()->type_name("");
        app.add_flag("--json", json_, "As JSON");
        app.add_flag("-v,--verbose", verbose_, "Also say from which file each comes");
        catalog_.declare(app);
        app.footer("JSON: effects as [{id, stage, help, version, module}], scenes and chains as [{id, help, "
                   "path}].");
    }

    Status run() override {
        const std::vector<std::string> kinds = {"effects", "scenes", "chains"};
        if (std::find(kinds.begin(), kinds.end(), what_) == kinds.end()) {
            throw Error(fmt::format("nothing called \"{}\" to list{} (effects, scenes or chains)", what_,
                                    did_you_mean(what_, kinds)));
        }
        const Json items = what_ == "effects" ? effects() : what_ == "scenes" ? scenes() : chains();
        if (json_) {
            fmt::print("{}\n", items.dump(2));
        } else {
            print(items);
        }
        return Status::success;
    }

private:
    Json effects() const {
        Json items = Json::array();
        const Catalog catalog = catalog_.load();
        for (const EffectPtr& effect : catalog.effects()) {
            items.push_back({{"id", effect->id},
                             {"stage", stage_word(effect->stage)},
                             {"help", effect->help},
                             {"version", effect->version},
                             {"module", effect->module_path.string()}});
        }
        return items;
    }

    static Json chains() {
        Json items = Json::array();
        for (const std::string& name : chain_names()) {
            const std::filesystem::path file = find_chain(name);
            items.push_back({{"id", name}, {"help", first_sentence(file)}, {"path", file.string()}});
        }
        return items;
    }

    static Json scenes() {
        Json items = Json::array();
        for (const SceneEntry& scene : list_scenes(data_directory() / "configs/scenes")) {
            items.push_back({{"id", scene.name}, {"help", scene.description}, {"path", scene.file.string()}});
        }
        return items;
    }

    void print(const Json& items) const {
        std::vector<std::vector<std::string>> rows;
        for (const Json& item : items) {
            std::vector<std::string>& row = rows.emplace_back();
            for (const char* key : {"id", "stage", "help"}) {
                if (item.contains(key)) row.push_back(item[key]);
            }
            if (verbose_) row.push_back(item[item.contains("module") ? "module" : "path"]);
        }
        fmt::print("{}", text_table(rows, 0));
    }

    CatalogOptions catalog_;
    std::string what_;
    bool json_ = false, verbose_ = false;
};

const Register<ListCommand> registered("list", "List the effects, scenes or chains that there are");

} // namespace
} // namespace postfx::host
