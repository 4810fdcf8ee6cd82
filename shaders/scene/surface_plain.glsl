// The surface at this fragment: colours of the material and of the vertices.

Surface scene_surface() {
    Surface surface = scene_untextured();
    if (SCENE_CUT && surface.opacity < u_material.emission.w) discard;
    if (SCENE_METAL_ROUGH) scene_metal_rough(surface, u_material.factors.w, u_material.factors.z);
    return surface;
}
