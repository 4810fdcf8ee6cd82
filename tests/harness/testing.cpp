#include <testing.hpp>
