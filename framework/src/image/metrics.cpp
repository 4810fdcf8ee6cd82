#include <image/metrics.hpp>
