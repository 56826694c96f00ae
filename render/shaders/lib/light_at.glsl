// Light of a single point of a mesh, for the shading rates that interpolate colors. Color and emission maps apply per
// pixel, the roughness and metalness map only by its mean, others not at all. Include after lib/lighting.glsl and
// lib/material_maps.glsl; definitions of those, and DOUBLE_SIDED: normals are turned towards the viewer.

const float kLastLevel = 16.0;  // or the last one

struct MeshPoint {
    vec3 position_ws;
    vec3 normal_ws;           // unit
    vec4 color;               // of the vertex
    uvec2 material_and_flags;
    uint object;
};

SurfaceSample point_surface(MeshPoint p) {
    vec4 base = material_texel(p.material_and_flags.x, 0);
    vec4 factors = material_texel(p.material_and_flags.x, 2);
    SurfaceSample s;
    s.normal_ws = p.normal_ws;
    s.albedo = base.rgb;
#ifdef VERTEX_COLOR
    s.albedo *= max(p.color.rgb, 0.0);
#endif
    s.emission = vec3(0.0);
    s.occlusion = 1.0;
    s.roughness = factors.y;
    s.metalness = factors.x;
    s.material = p.material_and_flags.x;
    s.model = p.material_and_flags.y >> 8;
#ifdef METAL_ROUGH_MAP
    float layer = map_layer(map_layers_of(p.material_and_flags.x), kMetalRoughSlot);
    vec2 mean = textureLod(material_maps[METAL_ROUGH_MAP], vec3(0.5, 0.5, layer), kLastLevel).gb;
    s.roughness *= mean.x;
    s.metalness *= mean.y;
#endif
#if defined(VERTEX_COLOR) && !defined(ALPHA_MASK) && !defined(DRESSED)
    set_cavity(s, p.color.a);
#else
    set_cavity(s, 1.0);
#endif
#ifdef DOUBLE_SIDED
    s.normal_ws *= dot(s.normal_ws, view.camera_ws.xyz - p.position_ws) < 0.0 ? -1.0 : 1.0;
#endif
    split_unlit(s);
    set_plain(s);
    return s;
}

// Position of a point of a mesh on the screen [px].
vec2 point_pixel(MeshPoint p) {
    vec4 clip = view.clip_from_world * vec4(p.position_ws, 1.0);
    return (clip.xy / clip.w * 0.5 + 0.5) * view.size.xy;
}

// The point and spot lights of the point's object, as in add_listed(): here light_cells holds the lists of objects, not
// of cells.
uvec2 point_list(MeshPoint p) {
#ifdef LOCAL_LIGHTS
    return texelFetch(light_cells, int(p.object)).xy;
#else
    return uvec2(0u);
#endif
}

// Diffuse: still to be multiplied by the base color map and the dress; with the emission of unlit surfaces.
Reflected light_at(MeshPoint p) {
    SurfaceSample s = point_surface(p);
    Reflected light = reflect_all(s, p.position_ws, point_pixel(p), point_list(p));
    return Reflected(light.diffuse + s.emission, light.specular);
}
