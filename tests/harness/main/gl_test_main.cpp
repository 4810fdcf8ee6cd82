// main() of tests that need OpenGL: without a GL 4.5 context they are skipped, or fail if one is required. Catch2's own
// code is compiled here once, not in every test.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <testing.hpp>

int main(int argc, char** argv) {
    std::string why;
    if (!postfx::testing::has_gl(&why)) return postfx::testing::skipped("no GL 4.5 context: " + why);
    // Catch2 returns the number of failures, which might happen to be 77.
    return Catch::Session().run(argc, argv) == 0 ? 0 : 1;
}
