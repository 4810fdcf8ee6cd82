// A landscape as a function of (x, z): hills from noise, levelled beside its roads.
#pragma once

#include "path.hpp"

#include <cstdint>
#include <vector>

namespace postfx::host {

struct TerrainShape {
    double size = 400;     ///< metres, each side; centred at the origin
    double resolution = 4; ///< metres between grid points
    std::uint32_t seed = 1;
    double height = 10;       ///< metres, about the largest deviation of the noise
    double feature_size = 90; ///< metres, of the largest hills
    double hill_height = 0;   ///< metres, of one broad hill at the origin
    double hill_radius = 150; ///< metres
    double verge = 8;         ///< metres from a road's middle that are level
    double blend = 30;        ///< metres over which the level ground turns into hills
};

class Terrain {
public:
    explicit Terrain(TerrainShape shape) : shape_(shape) {}
    const TerrainShape& shape() const { return shape_; }

    /// Hills alone: what a road is laid on.
    double natural_height(double x, double z) const;
    /// From now on the ground is level beside that road and `drop` metres below it.
    void level(const Path& road, double drop);
    double height(double x, double z) const;

private:
    struct Road {
        Path path;
        double drop;
    };
    TerrainShape shape_;
    std::vector<Road> roads_;
};

} // namespace postfx::host
