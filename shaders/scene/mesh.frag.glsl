// One fragment of a mesh.

void main() {
    Surface surface = scene_surface();
    // Seen from behind. A blade of grass whose normals point up still has them towards a viewer above.
    if (!gl_FrontFacing && dot(surface.normal, scene_to_eye()) < 0.0) surface.normal = -surface.normal;
    Radiance radiance = scene_shade(surface);
    scene_write(surface, radiance, u_material.is.x ? surface.opacity : 1.0);
}
