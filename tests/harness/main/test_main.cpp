// main() of tests that run anywhere. Catch2's own code is compiled here once, not in every test.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
