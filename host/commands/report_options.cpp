#include "report_options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace postfx::host {

void ReportOptions::declare(CLI::App& app) {
    app.add_flag("--json", json_, "Tell the report as JSON");
    app.add_flag("--quiet,-q", quiet_, "Tell nothing but errors");
    app.add_flag("--watch-nonfinite", watch_nonfinite_,
                 "Tell which pass first makes pixels that are NaN or infinite: reads every image once more");
    app.add_flag("--no-times", no_times_, "Do not draw a second time to measure what each pass costs");
}

void ReportOptions::tell(const Report& report, const std::optional<MetBudget>& budget,
                         const PictureFile& output) const {
    if (quiet_) return;
    std::FILE* stream = output.is_standard_output() ? stderr : stdout;
    const std::string name = output.is_standard_output() ? "standard output" : output.path.string();
    if (json_) {
        nlohmann::ordered_json json = {{"output", name}};
        json.update(nlohmann::ordered_json::parse(report_json(report)));
        if (budget) json["budget"] = nlohmann::ordered_json::parse(budget->json());
        fmt::print(stream, "{}\n", json.dump(2));
        return;
    }
    fmt::print(stream, "{}{}wrote {}\n", report_text(report), budget ? budget->text() : "", name);
}

} // namespace postfx::host
