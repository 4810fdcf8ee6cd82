// Effects that exist only in tests, with every kind of parameter, and helpers for the tests of chains.
#pragma once

#include <postfx/chain.hpp>
#include <postfx/error.hpp>
#include <postfx/plugin.hpp>

#include <string>
#include <vector>

namespace chain_fixture {

using postfx::Chain;
using postfx::ChainEntry;

inline void plan_nothing(const postfx::Request&, postfx::Builder& out) {
    out.lacks("it is only declared");
}

inline constexpr const char* shapes[] = {"round", "square", "hexagon"};
inline constexpr postfx::Parameter blur_parameters[] = {
    postfx::number("intensity", 0.25).range(0, 4).in_unit("stops").identity_at(0).about("How strong it is"),
    postfx::integer("taps", 8).range(1, 64).about("Samples per pixel"),
    postfx::toggle("wrap", false).about("Repeat at the edges"),
    postfx::choice("shape", shapes, 1).about("Outline of the kernel"),
    postfx::color("tint", 1, 0.5, 0).range(0, 2).about("Colour of what is added"),
};
inline constexpr postfx_level blur_levels[] = {postfx::level("low", "half size"),
                                               postfx::level("high", "full size")};
inline constexpr auto blur = postfx::effect<plan_nothing>("blur")
                                 .about("Spreads light")
                                 .with_parameters(blur_parameters)
                                 .with_levels(blur_levels, 1);

inline constexpr postfx::Parameter shade_parameters[] = {
    postfx::number("radius", 0.75).range(0, 1).in_unit("height").about("Where it begins"),
};
inline constexpr auto shade =
    postfx::effect<plan_nothing>("shade").about("Darkens the corners").with_parameters(shade_parameters);

inline postfx::Catalog make_catalog() {
    static constexpr const postfx_effect* effects[] = {&blur, &shade};
    static constexpr postfx_module module = {
        sizeof(postfx_module), POSTFX_ABI_MAJOR, POSTFX_ABI_MINOR, 2, effects, nullptr, 0, 0};
    postfx::Catalog catalog;
    catalog.add(module, "chain_test");
    return catalog;
}

inline const postfx::Catalog& catalog() {
    static const postfx::Catalog made = make_catalog();
    return made;
}

inline Chain parse(const std::string& yaml) {
    return postfx::parse_chain(yaml, "c.yaml", catalog());
}

template<class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "no error";
}

inline std::string parse_error(const std::string& yaml) {
    return error_of([&] { parse(yaml); });
}

inline std::vector<std::string> names(const Chain& chain) {
    std::vector<std::string> list;
    for (const ChainEntry& entry : chain.entries)
        list.push_back(entry.name);
    return list;
}

using Names = std::vector<std::string>;

inline std::string repeat(const std::string& text, int count) {
    std::string repeated;
    for (int i = 0; i < count; ++i)
        repeated += text;
    return repeated;
}

} // namespace chain_fixture
