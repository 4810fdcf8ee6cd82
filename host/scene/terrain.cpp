#include "terrain.hpp"

#include "random.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host {

double Terrain::natural_height(double x, double z) const {
    double sum = 0, amplitude = 0.62, scale = 1 / shape_.feature_size;
    for (std::uint32_t octave = 0; octave < 4; ++octave) {
        sum += amplitude * lattice_noise(x * scale, z * scale, shape_.seed + octave);
        amplitude *= 0.4;
        scale *= 2.17;
    }
    const double r = std::hypot(x, z) / shape_.hill_radius;
    return shape_.height * sum + shape_.hill_height * std::exp(-r * r);
}

void Terrain::level(const Path& road, double drop) {
    roads_.push_back({road, drop});
}

double Terrain::height(double x, double z) const {
    double height = natural_height(x, z);
    for (const Road& road : roads_) {
        const Path::Nearest nearest = road.path.nearest(x, z);
        const double away = std::clamp((nearest.distance - shape_.verge) / shape_.blend, 0.0, 1.0);
        height = glm::mix(nearest.height - road.drop, height, away * away * (3 - 2 * away));
    }
    return height;
}

} // namespace postfx::host
