#include <postfx/executor.hpp>
