#include <postfx/chain.hpp>
