// The lights of a mesh point one by one, for methods with separate terms per light: directional lights first, then
// those of the object's list. Include after lib/light_at.glsl. Definition:
//   SINGLE_LIGHTS  maximum number of lights with separate terms. All others, and all lights on surfaces with models
//                  other than Blinn and Phong, are evaluated per vertex

const int kEveryLight = 0x7fffffff;

struct LitPoint {
    SurfaceSample surface;
    Reflector reflector;
    vec3 position_ws;
    vec2 pixel;
    uvec2 list;   // see add_listed()
    int lights;   // number of lights that reach the point's object
    int single;   // number of those with separate terms
};

LitPoint lit_point(MeshPoint at) {
    LitPoint p;
    p.surface = point_surface(at);
    p.reflector = make_reflector(p.surface, to_viewer(at.position_ws));
    p.position_ws = at.position_ws;
    p.pixel = point_pixel(at);
    p.list = point_list(at);
    p.lights = int(p.list.y);
#ifdef DIRECTIONAL_LIGHTS
    p.lights += int(view.grid_depth.z);
#endif
    bool has_terms = p.surface.model == kModelBlinn || p.surface.model == kModelPhong;
    p.single = has_terms ? min(p.lights, SINGLE_LIGHTS) : 0;
    return p;
}

// Incoming light of light number `k` < p.lights.
Incoming single_light(LitPoint p, int k) {
    Incoming light = Incoming(p.reflector.normal, vec3(0.0), vec3(0.0));
    int local = k;
#ifdef DIRECTIONAL_LIGHTS
    local = k - int(view.grid_depth.z);
    if (local < 0) {
        return incoming_directional(k, p.position_ws, p.reflector.normal, p.pixel);
    }
#endif
#ifdef LOCAL_LIGHTS
    int index = existing_light(int(texelFetch(light_indices, int(p.list.x) + local).x));
    light = incoming_local(index, p.position_ws, p.reflector.normal, water_medium(p.position_ws));
#ifdef LIGHT_TRANSMITTANCE
    if (index >= int(view.grid_depth.w)) {
        light.irradiance *= light_transmittance(index, p.position_ws, p.reflector.normal, light.to_light, p.pixel);
    }
#endif
#endif
    return light;
}

// Light of the environment and of the lights below `end`: diffuse from number `diffuse_from` on, specular from number
// `specular_from` on. Diffuse: still to be multiplied by the base color map and the dress; with the emission of unlit surfaces.
Reflected light_from(LitPoint p, int diffuse_from, int specular_from, int end) {
    LightSum sum = no_light();
    for (int k = min(diffuse_from, specular_from); k < min(p.lights, end); ++k) {
        LightSum one = no_light();
        add_light(one, p.reflector, single_light(p, k));
        sum.diffuse += k < diffuse_from ? vec3(0.0) : one.diffuse;
        sum.specular += k < specular_from ? vec3(0.0) : one.specular;
        sum.fresnel += k < specular_from ? vec3(0.0) : one.fresnel;
    }
    Reflected light =
        add_reflected(reflect_lights(p.reflector, sum), reflect_surroundings(p.reflector, p.surface, p.position_ws));
    return Reflected(light.diffuse + p.surface.emission, light.specular);
}

// Exponent of Blinn's highlight that best matches the model's: Phong's lobe is four times as wide in the exponent
// (Fisher and Woo, "R.E versus N.H Specular Highlights", 1994).
float blinn_exponent(uint model, float shininess) {
    return model == kModelPhong ? 4.0 * shininess : shininess;
}
