// The surface at this fragment: colours of the material and of the vertices.

Surface scene_surface() {
    return Surface(v_tint * u_material.diffuse.rgb, u_material.specular.rgb, u_material.specular.w,
                   v_tint * u_material.emission.rgb, u_material.diffuse.a, normalize(v_normal));
}
