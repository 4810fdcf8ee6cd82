#include <image/files.hpp>
