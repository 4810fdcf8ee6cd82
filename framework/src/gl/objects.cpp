#include <gl/objects.hpp>
