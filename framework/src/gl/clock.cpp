#include <gl/clock.hpp>
