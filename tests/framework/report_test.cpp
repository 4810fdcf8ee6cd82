// What a plan says of itself before anything is drawn, as text and as JSON; the words of its enums.
#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <image/role.hpp>

#include <postfx/postfx.hpp>

#include <nlohmann/json.hpp>

#include <string>

using namespace postfx;
using postfx::testing::fixtures;

namespace {

Plan plan_of_gauge() {
    Chain chain;
    chain.add(fixtures(), "tint").enabled = false;
    chain.add(fixtures(), "gauge");
    SceneFacts facts;
    facts.width = 64;
    facts.height = 48;
    facts.attachments = {"normal", "depth", "color"};
    return Planner().plan(chain, facts);
}

} // namespace

TEST_CASE("a plan as JSON says what is skipped, what is drawn, and what has to be rendered") {
    const auto json = nlohmann::json::parse(plan_json(plan_of_gauge()));
    CHECK(json["clock"] == "none: nothing was drawn");
    CHECK(json["attachments"] == nlohmann::json({"color", "depth"}));
    CHECK(json["effects"][0]["status"] == "skipped");
    CHECK(json["effects"][0]["moment"] == "configuration");
    CHECK(json["effects"][0]["kind"] == "exact");
    CHECK(json["effects"][1]["moment"] == ""); // it is not skipped
    CHECK(json["passes"][0]["name"] == "gauge+output");
    CHECK(json["passes"][0]["drawn"].is_null());
}

TEST_CASE("a plan as text says the same") {
    const std::string text = plan_text(plan_of_gauge(), "by ear");
    CHECK_THAT(text, Catch::Contains("configuration: enabled is false (exact)\n"));
    CHECK_THAT(text, Catch::Contains("reads color, depth\n"));
    CHECK_THAT(text, Catch::Contains("clock     by ear\n"));
    CHECK_THAT(text, Catch::EndsWith("attachments rendered: color, depth\n"));
}

TEST_CASE("every word of a plan's enums is read back, and no other") {
    for (const Moment moment : {Moment::configuration, Moment::scene, Moment::frame})
        CHECK(moment_by_word(moment_word(moment)) == moment);
    for (const SkipKind kind : {SkipKind::exact, SkipKind::code, SkipKind::visible, SkipKind::lacks})
        CHECK(skip_kind_by_word(skip_kind_word(kind)) == kind);
    for (const EffectStage stage : {EffectStage::scene, EffectStage::scene_to_display, EffectStage::display})
        CHECK(stage_by_word(stage_word(stage)) == stage);
    CHECK_FALSE(moment_by_word("exact"));
    CHECK_FALSE(skip_kind_by_word(""));
    CHECK_FALSE(stage_by_word("print"));
}

TEST_CASE("attachments are read in the role of their name") {
    for (const Role role : {Role::color, Role::depth, Role::normal, Role::emission, Role::ambient}) {
        CAPTURE(name_of(role));
        const AttachmentInfo* info = find_attachment(name_of(role));
        REQUIRE(info);
        CHECK((info->holds == AttachmentInfo::Holds::light) == is_light(role));
    }
    CHECK_FALSE(find_attachment(name_of(Role::texture)));
    CHECK(attachment_names().front() == "color");
}
