#include <postfx/catalog.hpp>
