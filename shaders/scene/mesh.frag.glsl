// One fragment of a mesh.

void main() {
    Surface surface = scene_surface();
    if (!gl_FrontFacing) surface.normal = -surface.normal;
    Radiance radiance = scene_shade(surface);
    scene_write(surface, radiance, u_material.has_maps.z ? surface.opacity : 1.0);
}
