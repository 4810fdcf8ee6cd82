#include <postfx/plan.hpp>
