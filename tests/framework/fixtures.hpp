// The fixture effects of tests/framework/fixtures, for tests of the framework.
#pragma once

#include <postfx/catalog.hpp>

#include <filesystem>
#include <string>

namespace postfx::testing {

/// The module of tests/framework/fixtures/<name>.
inline std::filesystem::path fixture(const std::string& name) {
    return std::filesystem::path(POSTFX_FIXTURES) / ("postfx_fixture_" + name + ".so");
}

/// Every fixture whose declarations are right (plans and shaders of some are not).
inline const Catalog& fixtures() {
    static const Catalog catalog = [] {
        Catalog made;
        for (const char* name :
             {"blur", "broken_shader", "curve", "faulty", "flare", "gauge", "grown", "many", "near", "pack",
              "plain_c", "shift", "sneaky", "split", "spoil", "spots", "tint"}) {
            made.load(fixture(name));
        }
        return made;
    }();
    return catalog;
}

} // namespace postfx::testing
