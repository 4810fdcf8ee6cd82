#include "report_output.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace postfx::host {

void ReportOptions::declare(CLI::App& app) {
    app.add_flag("--json", json_, "Tell the report as JSON");
    app.add_flag("--quiet,-q", quiet_, "Tell nothing but errors");
    app.add_flag("--watch-nonfinite", watch_nonfinite_,
                 "Tell which pass first makes pixels that are NaN or infinite: reads every image once more");
    app.add_flag("--no-times", no_times_, "Do not draw a second time to measure what each pass costs");
}

void ReportOptions::tell(const Report& report, const std::optional<MetBudget>& budget,
                         const std::filesystem::path& output) const {
    if (quiet_) return;
    if (json_) {
        nlohmann::ordered_json json = {{"output", output.string()}};
        json.update(nlohmann::ordered_json::parse(report_json(report)));
        if (budget) json["budget"] = nlohmann::ordered_json::parse(budget->json());
        fmt::print("{}\n", json.dump(2));
        return;
    }
    fmt::print("{}{}wrote {}\n", report_text(report), budget ? budget->text() : "", output.string());
}

} // namespace postfx::host
