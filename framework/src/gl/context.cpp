#include <gl/context.hpp>
