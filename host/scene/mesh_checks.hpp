// Bringing meshes of other people into shape.
#pragma once

#include "geometry.hpp"
#include "losses.hpp"

#include <string>

namespace postfx::host {

/// Take out the triangles that have a vertex which is not there or whose position is not finite, and count them; bring
/// what else is not finite to what it is without. `what` names the mesh.
void drop_broken_triangles(Mesh& mesh, const std::string& what, Losses& losses);

/// Give every triangle vertices and normals of its own: what has no normals is flat.
void make_flat(Mesh& mesh);

} // namespace postfx::host
